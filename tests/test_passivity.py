"""Passivity against energies written down by hand, the host's own solver, and frequencies where energy comes out."""

import control as ct
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import block_diag

import hsictrl as hsi
from hsictrl.loop.popov import dissipation

admissible = st.builds(hsi.Pedestrian, mass=st.floats(1, 500), frequency=st.floats(0.2, 30), damping=st.floats(0, 0.99),
                       sprung_ratio=st.floats(0.01, 1))


def matrices(system):
    return system.A, system.B, system.C, system.D


def spring_and_damper(m, k, c):
    """A body of any sign, from the velocity of the deck to the force on the body."""
    return ct.ss([[0, 1], [-k / m, -c / m]], [[-1], [c / m]], [[-k, -c]], [[c]])


def rational(*coefficients):
    return ct.ss(ct.tf(*coefficients))


# --- bodies ------------------------------------------------------------------------------------------------


@settings(deadline=None, max_examples=1000)
@given(body=admissible)
def test_every_admissible_body_is_passive(body):
    """With the energies of spring and mass: K of Kalman, Yakubovich and Popov holds the damper's 2c(du − v)² alone."""
    certificate = hsi.passivity(body)
    assert certificate.passive
    k, m, c = body.stiffness, body.sprung_mass, body.damping_coefficient
    assert certificate.storage == pytest.approx(np.diag([k, m]))
    assert certificate.unsprung_mass == pytest.approx([body.mass - m])
    lost = 2 * c * np.array([[0, 0, 0], [0, 1, -1], [0, -1, 1]])
    assert dissipation(matrices(certificate.system), certificate.storage) == pytest.approx(lost, abs=1e-9 * k)


@settings(deadline=None, max_examples=50)
@given(body=admissible)
def test_the_system_certified_and_its_unsprung_mass_are_the_apparent_mass(body):
    """Z(s) + s m₀ = s α(s)."""
    certificate, s = hsi.passivity(body), 1j * np.array([1.0, 12.0, 50.0])
    found = certificate.system(s) + s * certificate.unsprung_mass[0]
    assert found == pytest.approx(s * body.apparent_mass(s), rel=1e-9)


def test_a_body_with_negative_damping_is_not():
    body = hsi.Pedestrian()
    certificate = hsi.passivity(spring_and_damper(body.sprung_mass, body.stiffness, -body.damping_coefficient))
    assert not certificate
    assert certificate.storage is None
    assert str(certificate).startswith("not passive: a pole at 6.126+19.48j rad/s grows")


def test_the_witness_is_a_frequency_at_which_energy_comes_out():
    """A stable body whose damper is half undone by the deck's own velocity."""
    body = hsi.Pedestrian()
    honest = spring_and_damper(body.sprung_mass, body.stiffness, body.damping_coefficient)
    certificate = hsi.passivity(honest - 1.5 * body.damping_coefficient)
    assert not certificate.passive
    drawn = 2 * certificate.system(2j * np.pi * certificate.frequency).real
    assert drawn == pytest.approx(certificate.margin)
    assert drawn < 0


def test_the_margin_is_the_smallest_over_all_frequencies():
    """Of 1/(s + 1)² it is 2 Re = 2(1 − ω²)/(1 + ω²)², least at √3: −1/4."""
    certificate = hsi.passivity(rational([1], [1, 2, 1]))
    assert certificate.margin == pytest.approx(-0.25, rel=1e-9)
    assert certificate.frequency == pytest.approx(np.sqrt(3) / (2 * np.pi), rel=1e-6)


def test_a_narrow_failure_is_found():
    """A resonance of a millionth of the damping, beside a thousandth of its height of feedthrough."""
    system = rational([-1e-3, 0], [1, 1e-6, 1]) + 500.0
    assert not hsi.passivity(system)
    assert hsi.passivity(system).frequency == pytest.approx(1 / (2 * np.pi), rel=1e-5)
    assert hsi.passivity(system + 600.0)


# --- crowds and bridges ----------------------------------------------------------------------------------------


def test_a_crowd_stores_what_its_bodies_store():
    people = hsi.Population.walking().sample(225, np.random.default_rng(0))
    certificate = hsi.passivity(people)
    assert certificate.passive
    assert np.diag(certificate.storage)[0::2] == pytest.approx(people.stiffness)
    assert np.diag(certificate.storage)[1::2] == pytest.approx(people.sprung_mass)
    assert certificate.system.ninputs == len(certificate.unsprung_mass) == 225


def beam(n_modes=3):
    return hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=0.005,
                                           n_modes=n_modes)


def test_a_bridge_is_passive_between_any_points():
    certificate = hsi.passivity(beam())
    assert certificate.passive
    assert certificate.storage == pytest.approx(block_diag(*(np.diag([w**2, 1]) for w in beam().omega)))
    rows = beam().participation([10.0, 25.0])
    at_points = rows @ np.moveaxis(certificate.system(1j * np.array([3.0, 12.0])), -1, 0) @ rows.T
    block = beam().ss(at=[10.0, 25.0])[["v[0]", "v[1]"], :]
    assert np.moveaxis(at_points, 0, -1) == pytest.approx(block(1j * np.array([3.0, 12.0])))


@settings(deadline=None, max_examples=30)
@given(seed=st.integers(0, 10**6), n=st.integers(1, 8), n_modes=st.integers(1, 3))
def test_the_energies_of_bridge_and_crowd_are_a_lyapunov_function_of_the_occupied_bridge(seed, n, n_modes):
    """Hence stability for every crowd: ½z'Ω²z + ½ż² + Σ ½k(u − φz)² + ½m₁u̇² + ½m₀(φż)² never grows."""
    rng = np.random.default_rng(seed)
    people = hsi.Crowd(mass=rng.uniform(1, 1e4, n), frequency=rng.uniform(0.5, 10, n), damping=rng.uniform(0, 0.9, n))
    occupied = hsi.couple(beam(n_modes), people, rng.uniform(0, 50, n))
    rows, (bridge, crowd) = occupied.condensed.rows, map(hsi.passivity, (occupied.bridge, people))
    z, u, dz, du = np.split(np.eye(2 * (n + n_modes)), np.cumsum([n_modes, n, n_modes]))
    on_bridge = np.stack([z, dz], axis=1).reshape(2 * n_modes, -1)
    on_crowd = np.stack([u - rows @ z, du], axis=1).reshape(2 * n, -1)
    energy = (on_bridge.T @ bridge.storage @ on_bridge + on_crowd.T @ crowd.storage @ on_crowd
              + (rows @ dz).T * crowd.unsprung_mass @ (rows @ dz))
    assert np.linalg.eigvalsh(energy).min() > 0
    change = occupied.A.T @ energy + energy @ occupied.A
    assert np.linalg.eigvalsh(change).max() < 1e-9 * np.linalg.norm(change, 2)


# --- the host's solver ---------------------------------------------------------------------------------------


SYSTEMS = {
    "body": hsi.passivity(hsi.Pedestrian()).system,
    "body without damping": hsi.passivity(hsi.Pedestrian(damping=0.0)).system,
    "body of negative damping": spring_and_damper(66.5, 28e3, -800.0),
    "body of negative stiffness": spring_and_damper(66.5, -28e3, 800.0),
    "two bodies": hsi.passivity(hsi.Crowd(mass=[70.0, 80.0], frequency=[3.0, 1.0], damping=0.3)).system,
    "mode": hsi.passivity(beam(1)).system,
    "mode backwards": -hsi.passivity(beam(1)).system,
    "mode without damping, backwards": ct.ss([[0, 1], [-150, 0]], [[0], [1]], [[0, -1]], 0),
    "lag": rational([1], [1, 1]),
    "two lags": rational([1], [1, 2, 1]),
    "lead": rational([1, 2], [1, 1]),
    "integrator": rational([1], [1, 0]),
    "two integrators": rational([1], [1, 0, 0]),
    "unstable": rational([1], [1, -1]),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_the_host_agrees(name):
    assert hsi.passivity(SYSTEMS[name]).passive is ct.ispassive(SYSTEMS[name])


@pytest.mark.parametrize("name", ["body", "body without damping", "two bodies", "mode", "lag", "lead", "integrator"])
def test_what_a_system_stores_is_solved_for(name):
    """P > 0 satisfies the inequality of Kalman, Yakubovich and Popov with a millionth of |G| more of feedthrough."""
    certificate = hsi.passivity(ct.ss(*matrices(SYSTEMS[name])))
    assert np.linalg.eigvalsh(certificate.storage).min() > 0
    A, B, C, D = matrices(certificate.system)
    largest = np.abs(certificate.system(1j * np.geomspace(1e-2, 1e3, 5001))).max()
    held = dissipation((A, B, C, D + 1e-6 * largest * np.eye(len(D))), certificate.storage)
    assert np.linalg.eigvalsh(held).min() > -1e-9 * np.linalg.norm(held, 2)


def test_a_gain_stores_nothing():
    certificate = hsi.passivity(ct.ss([], [], [], [[2.0]]))
    assert certificate.passive
    assert certificate.margin == 4.0
    assert not hsi.passivity(ct.ss([], [], [], [[0.0, 3.0], [0.0, 0.0]]))


# --- refusals ------------------------------------------------------------------------------------------------


def test_refusals():
    with pytest.raises(TypeError, match="system must be of type StateSpace, got str"):
        hsi.passivity("body")
    with pytest.raises(TypeError, match="system must lead from velocity to force, or back, got OccupiedBridge"):
        hsi.passivity(hsi.couple(beam()))
    with pytest.raises(ValueError, match="system must have as many outputs as inputs, got 2 and 1"):
        hsi.passivity(ct.ss([[-1.0]], [[1.0]], [[1.0], [1.0]], 0))
    with pytest.raises(ValueError, match=r"system must be in continuous time, got steps of 0.1 s"):
        hsi.passivity(ct.ss([[0.5]], [[1.0]], [[1.0]], 0, 0.1))
    with pytest.raises(ValueError, match="a crowd must hold at least one body, got none"):
        hsi.passivity(hsi.Crowd(mass=[], frequency=[], damping=[]))

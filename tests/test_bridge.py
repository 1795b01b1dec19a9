"""Bridges and modes against closed forms: eq. (15), modal masses by quadrature, blocks point to point."""

import pickle
from dataclasses import FrozenInstanceError, dataclass

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from second_road import sines

import hsictrl as hsi
from hsictrl.bridge import BeamShape

quick = settings(deadline=None, derandomize=True, max_examples=40)


def three_modes(**changed):
    return hsi.Footbridge.simply_supported(
        **{"length": 50.0, "width": 3.0, "mass": 50e3, "frequency": 2.0, "damping": [0.005, 0.01, 0.02], "n_modes": 3}
        | changed)


@dataclass(frozen=True)
class Torsion(hsi.Shape):
    """Half a sine along the deck, the edges up and down; a mode as FE models give them."""

    length: float = 50.0
    width: float = 3.0

    def __call__(self, x, y=0.0, direction="vertical"):
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        return np.sin(np.pi * x / self.length) * (2 * y / self.width if direction == "vertical" else 0.2)

    antinode = (25.0, 1.5)
    mean_square = 1 / 6
    mean_absolute = 1 / np.pi


# --- what a bridge is made of ---------------------------------------------------------------------


def test_simply_supported_beam():
    """Frequencies j²f₁ and modal masses of half the mass (section 3.1)."""
    bridge = three_modes()
    assert [mode.frequency for mode in bridge.modes] == pytest.approx([2.0, 8.0, 18.0], rel=1e-15)
    assert [mode.modal_mass for mode in bridge.modes] == pytest.approx([25e3] * 3, rel=1e-15)
    np.testing.assert_allclose(bridge.omega, 2 * np.pi * np.array([2.0, 8.0, 18.0]), rtol=1e-15)
    np.testing.assert_array_equal(bridge.damping, [0.005, 0.01, 0.02])
    assert (bridge.n_modes, bridge.area) == (3, 150.0)


def test_reference_bridge_is_section_3_1():
    bridge = hsi.reference_bridge(frequency=3.25, damping=0.005)
    same = hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=3.25, damping=0.005)
    assert bridge == same
    assert hsi.reference_bridge(modal_mass=20e3).mass == 40e3


@pytest.mark.parametrize(("spans", "ends"), [
    ([20.0, 30.0, 20.0], ("pinned", "pinned")), ([40.0], ("clamped", "clamped")),
    ([15.0, 25.0], ("clamped", "pinned"))])
def test_modal_masses_of_a_beam_by_quadrature(spans, ends):
    """m_j = (m/L) ∫ φ_j² dx by scipy.integrate.quad; frequencies go with the squared wavenumbers."""
    bridge = hsi.Footbridge.beam(spans=spans, ends=ends, width=3.0, mass=70e3, frequency=2.5, damping=0.01, n_modes=3)
    length = sum(spans)
    for j, mode in enumerate(bridge.modes, start=1):
        supports = np.cumsum(spans)[:-1]
        area = quad(lambda x, shape=mode.shape: float(shape(x))**2, 0, length, points=supports, limit=200)[0]
        assert mode.modal_mass == pytest.approx(70e3 / length * area, rel=1e-9)
        ratio = (BeamShape(spans, ends, j).wavenumber / BeamShape(spans, ends, 1).wavenumber)**2
        assert mode.frequency == pytest.approx(2.5 * ratio, rel=1e-12)


def test_participation_is_the_mass_normalised_sine():
    bridge = three_modes()
    x = np.linspace(0, 50, 11)
    np.testing.assert_allclose(bridge.participation(x), sines(bridge, x), atol=1e-17)
    np.testing.assert_array_equal(bridge.participation(np.column_stack([x, 0 * x + 1.5])), bridge.participation(x))


@pytest.mark.parametrize("place", [[-0.1, 0.0], [50.1, 0.0], [25.0, 1.6], [25.0, -1.6]])
def test_off_the_deck_nothing_takes_part(place):
    np.testing.assert_array_equal(three_modes().participation([place]), 0)


def test_offsets_are_carried_up_to_the_edges_wherever_along_the_deck():
    bridge, offsets = three_modes(), [-1.6, -1.5, 0.0, 1.5, 1.6]
    np.testing.assert_array_equal(bridge.carries_across(offsets), [False, True, True, True, False])
    for x in (0.0, 20.0, 50.0):
        np.testing.assert_array_equal(bridge.carries_across(offsets), bridge.carries([[x, y] for y in offsets]))
    assert bridge.carries_across([]).shape == (0,)


def test_directions_take_part_in_their_own_modes():
    vertical = hsi.Mode(frequency=2, damping=0.01, modal_mass=25e3, shape=hsi.SineShape(50.0))
    lateral = hsi.Mode(frequency=1, damping=0.01, modal_mass=16e3, shape=hsi.SineShape(50.0, direction="lateral"))
    torsion = hsi.Mode(frequency=3, damping=0.01, modal_mass=9e3, shape=Torsion())
    bridge = hsi.Footbridge(modes=[vertical, lateral, torsion], length=50.0, width=3.0, mass=50e3)
    rows = bridge.participation([[25.0, 1.5], [25.0, 1.5]], ["vertical", "lateral"])
    np.testing.assert_allclose(rows, [[1 / np.sqrt(25e3), 0, 1 / np.sqrt(9e3)],
                                      [0, 1 / np.sqrt(16e3), 0.2 / np.sqrt(9e3)]], atol=1e-18)


def test_a_bridge_prints_is_frozen_and_travels():
    bridge = three_modes(n_modes=2, damping=[0.005, 0.01])
    assert str(bridge) == ("footbridge 50 m × 3 m, 50000 kg\n  mode 0: 2.000 Hz, 0.50 %, 25000 kg\n"
                           "  mode 1: 8.000 Hz, 1.00 %, 25000 kg")
    assert pickle.loads(pickle.dumps(bridge)) == bridge
    assert bridge.mode(1) is bridge.modes[1]
    with pytest.raises(FrozenInstanceError):
        bridge.length = 3.0


# --- blocks ---------------------------------------------------------------------------------------


def at(system, s):
    return system.D + system.C @ np.linalg.solve(s * np.eye(system.nstates) - system.A, system.B)


@quick
@given(frequency=st.floats(0.5, 10), damping=st.floats(0, 0.9), hertz=st.floats(0.1, 20))
def test_mode_block_is_its_closed_form(frequency, damping, hertz):
    """z, ż, z̈ = (1, s, s²)/(s² + 2ξω s + ω²) P (eq. 1)."""
    mode = hsi.Mode(frequency=frequency, damping=damping, modal_mass=25e3, shape=hsi.SineShape(50.0))
    s, omega = 2j * np.pi * hertz + 0.1, 2 * np.pi * frequency
    expected = np.array([1, s, s**2]) / (s**2 + 2 * damping * omega * s + omega**2)
    np.testing.assert_allclose(at(mode.ss(), s)[:, 0], expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("hertz", [0.3, 2.0, 5.0, 18.0])
def test_bridge_block_is_its_closed_form(hertz):
    """Σ_j φ_j(x)φ_j(ξ)/m_j (1, s, s²)/(s² + 2ξ_jω_j s + ω_j²) between any two points, y[0], v[0], a[0], y[1], …"""
    bridge, x = three_modes(), [10.0, 25.0, 31.0]
    plant, s = bridge.ss(at=x), 2j * np.pi * hertz
    rows, omega = sines(bridge, x), bridge.omega
    receptance = rows / (s**2 + 2 * bridge.damping * omega * s + omega**2) @ rows.T
    expected = np.stack([receptance, s * receptance, s**2 * receptance], axis=1).reshape(9, 3)
    for j in range(9):
        np.testing.assert_allclose(at(plant, s)[j], expected[j], atol=1e-12 * np.abs(expected[j]).max())


def test_names_of_all_signals():
    bridge = three_modes()
    plant = bridge.ss(at=[[10.0, 0.0], [20.0, 1.0]], name="deck")
    assert plant.name == "deck"
    assert plant.input_labels == ["F[0]", "F[1]"]
    assert plant.output_labels == ["y[0]", "v[0]", "a[0]", "y[1]", "v[1]", "a[1]"]
    assert plant.state_labels == ["z[0]", "z[1]", "z[2]", "dz[0]", "dz[1]", "dz[2]"]
    mode = bridge.modes[0].ss(name="first")
    assert (mode.name, mode.input_labels, mode.output_labels, mode.state_labels) == (
        "first", ["P"], ["z", "dz", "ddz"], ["z", "dz"])


def test_ports_without_acceleration_have_no_feedthrough():
    whole, part = three_modes().ss(at=[10.0, 20.0]), three_modes().ss(at=[10.0, 20.0], ports=("y", "v"))
    assert part.output_labels == ["y[0]", "v[0]", "y[1]", "v[1]"]
    np.testing.assert_array_equal(part.C, whole.C[[0, 1, 3, 4]])
    np.testing.assert_array_equal(part.D, 0)
    assert np.all(whole.D[[2, 5]] > 0)


# --- refusals: the rule, the value, the remedy ----------------------------------------------------

MODE = {"frequency": 2.0, "damping": 0.005, "modal_mass": 25e3, "shape": hsi.SineShape(50.0)}
DECK = {"length": 50.0, "width": 3.0, "mass": 50e3}


@pytest.mark.parametrize(("make", "error", "message"), [
    (lambda: hsi.Mode(**MODE | {"damping": 5.0}), ValueError, r"damping must lie in \[0, 1\), got 5; give a fraction"),
    (lambda: hsi.Mode(**MODE | {"damping": -0.01}), ValueError, r"damping must lie in \[0, 1\), got -0.01; give a fr"),
    (lambda: hsi.Mode(**MODE | {"frequency": np.nan}), ValueError, "frequency must be above 0, got nan; give Hz"),
    (lambda: hsi.Mode(**MODE | {"modal_mass": 0}), ValueError, "modal_mass must be above 0, got 0; give kg"),
    (lambda: hsi.Mode(**MODE | {"shape": np.sin}), TypeError, "shape must be of type Shape, got ufunc; use SineShape"),
    (lambda: hsi.Footbridge(modes=[], **DECK), ValueError, "modes must hold at least one Mode, got none; describe"),
    (lambda: hsi.Footbridge(modes=[2.0], **DECK), TypeError, "modes must be of type Mode, got float; give a seq"),
    (lambda: hsi.Footbridge(modes=[hsi.Mode(**MODE)], **DECK | {"length": 40.0}), ValueError,
     "every shape must be as long as the deck, 40 m, got 50 m; make shape and bridge of one length"),
    (lambda: hsi.Footbridge(modes=[hsi.Mode(**MODE)], **DECK | {"width": -3}), ValueError,
     "width must be .* -3; give m"),
    (lambda: three_modes(n_modes=0, damping=0.01), ValueError, "n_modes must be at least 1, got 0; ask for at least"),
    (lambda: three_modes(n_modes=2.0, damping=0.01), TypeError, "n_modes must be a whole number, got 2.0; ask for"),
    (lambda: three_modes(n_modes=2), ValueError,
     r"damping must be one number or one per mode \(2\), got shape \(3,\); m"),
    (lambda: three_modes(damping=[0.01, 1.0, 0.01]), ValueError,
     r"damping\[1\] must lie in \[0, 1\), got 1; give a fr"),
    (lambda: three_modes(length=-1.0), ValueError, "length must be above 0, got -1; give m"),
    (lambda: three_modes(mass="50 t"), TypeError, "mass must be real numbers, got '50 t'; give kg"),
    (lambda: hsi.reference_bridge(modal_mass=-1), ValueError, "modal_mass must be above 0, got -1; give kg"),
    (lambda: hsi.Footbridge.beam(spans=[20.0], width=3, mass=1e4, frequency=2, damping=0.01, ends=("pinned",)),
     ValueError, "ends must be two, got 1; give one word for each end"),
    (lambda: hsi.Footbridge.beam(spans=[20.0], width=3, mass=1e4, frequency=2, damping=0.01, ends=("pinned", "free")),
     ValueError, "each of the ends must be one of 'pinned', 'clamped', got 'free'; choose one of these"),
    (lambda: hsi.Footbridge.beam(spans=[], width=3, mass=1e4, frequency=2, damping=0.01), ValueError,
     "the number of spans must be at least 1, got 0; give a list"),
    (lambda: three_modes().mode(3), ValueError, "mode must be below the number of modes 3, got 3; count modes from 0"),
    (lambda: three_modes().mode(-1), ValueError, "mode must be at least 0, got -1; count modes from 0"),
    (lambda: three_modes().ss(at=[25.0], ports=("a",)), ValueError, r"ports must be .*, got \('a',\); choose one of"),
    (lambda: three_modes().ss(at=[25.0, 51.0]), ValueError,
     r"at must lie on the deck, 0 ≤ x ≤ 50 and \|y\| ≤ 1.5 m, got at\[1\] = \(51, 0\); move it, or leave it out"),
    (lambda: three_modes().ss(at=[[25.0, 1.51]]), ValueError, r"got at\[0\] = \(25, 1.51\); move it"),
    (lambda: three_modes().ss(at=[[1.0, 2.0, 3.0]]), ValueError,
     r"at must have shape \(n,\) or \(n, 2\), got \(1, 3\)"),
    (lambda: three_modes().ss(at=[]), ValueError, r"at must hold at least 1 place\(s\), got 0; give x"),
    (lambda: three_modes().ss(at=[np.nan]), ValueError, r"at\[0\] must be finite, got nan; give x"),
    (lambda: three_modes().carries_across([[25.0, 1.0]]), ValueError,
     r"offsets must have 1 dimension\(s\), got shape \(1, 2\); give one place y in m per walker"),
    (lambda: three_modes().participation([25.0], "up"), ValueError, "direction must be .* got 'up'; choose one of"),
])
def test_refusals(make, error, message):
    with pytest.raises(error, match=message):
        make()

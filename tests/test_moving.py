"""The moving crowd as a time-varying system, against the standing one, the empty bridge and hand-written equations."""

from __future__ import annotations

import control as ct
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hsictrl as hsi

BRIDGE = hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=20e3, frequency=2.0, damping=0.005, n_modes=2)


def walker(**given: float) -> hsi.Walker:
    own = {"force": hsi.HarmonicForce([0.43, 0.08], phases=[0.2, 0.7]), "step_frequency": 2.0, "speed": 1.25}
    return hsi.Walker(**own | given)


TRAFFIC = hsi.Traffic([walker(speed=2.5), walker(arrival=3.3, speed=2.5, body=hsi.Pedestrian(mass=300.0), offset=0.5),
                       walker(arrival=8.9, speed=3.2)])
TIMES = np.linspace(0.0, 30.0, 1501)


def solved(system: ct.NonlinearIOSystem, times: np.ndarray = TIMES) -> np.ndarray:
    record = ct.input_output_response(system, times, np.zeros((system.ninputs, len(times))), squeeze=False,
                                      solve_ivp_method="DOP853",
                                      solve_ivp_kwargs={"rtol": 1e-9, "atol": 1e-12, "max_step": 0.05})
    return record.outputs


def by_hand(traffic: hsi.Traffic, convective: bool = False) -> np.ndarray:
    """Equations (1)–(4), (A.1) and (A.3) written out walker by walker; acceleration at midspan.

    With convective terms, y = φ(vt)·z is differentiated by the chain rule.
    """
    masses = np.array([mode.modal_mass for mode in BRIDGE.modes])
    order = np.arange(1, BRIDGE.n_modes + 1)
    people = list(traffic.walkers)

    def shapes(one: hsi.Walker, t: float) -> np.ndarray:
        """φ, and its first and second derivative in time."""
        x, beta = one.speed * (t - one.arrival), order * np.pi / 50.0
        waves = [np.sin(beta * x), beta * one.speed * np.cos(beta * x), -(beta * one.speed)**2 * np.sin(beta * x)]
        rates = np.array(waves) if convective else np.array([waves[0], 0 * beta, 0 * beta])
        return rates / np.sqrt(masses) if 0 <= x <= 50.0 else np.zeros((3, len(order)))

    def accelerations(t: float, state: np.ndarray) -> tuple[np.ndarray, list[float]]:
        z, dz, bodies = state[:2], state[2:4], state[4:].reshape(-1, 2)
        mass, modal, own = np.eye(2), -2 * BRIDGE.damping * BRIDGE.omega * dz - BRIDGE.omega**2 * z, []
        for one, (u, du) in zip(people, bodies, strict=True):
            (phi, dphi, ddphi), body, W = shapes(one, t), one.body, 2 * np.pi * one.step_frequency
            contact = body.stiffness * (u - phi @ z) + body.damping_coefficient * (du - phi @ dz - dphi @ z)
            force = one.weight * (0.43 * np.cos(W * t + 0.2) + 0.08 * np.cos(2 * W * t + 0.7))
            mass += body.unsprung_mass * np.outer(phi, phi)
            modal = modal + phi * (contact + force - body.unsprung_mass * (2 * dphi @ dz + ddphi @ z))
            own.append(-contact / body.sprung_mass)
        return np.linalg.solve(mass, modal), own

    def rates(t: float, state: np.ndarray) -> np.ndarray:
        modes, own = accelerations(t, state)
        pairs = [value for (u, du), a in zip(state[4:].reshape(-1, 2), own, strict=True) for value in (du, a)]
        return np.concatenate([state[2:4], modes, pairs])

    found = solve_ivp(rates, (0.0, TIMES[-1]), np.zeros(4 + 2 * len(people)), method="DOP853",
                      t_eval=TIMES, rtol=1e-9, atol=1e-12,
                      max_step=0.05)
    midspan = np.array([1.0, 0.0]) / np.sqrt(masses)
    return np.array([midspan @ accelerations(t, state)[0] for t, state in zip(TIMES, found.y.T, strict=True)])


@pytest.mark.parametrize("convective", [False, True])
def test_the_hosts_nonlinear_system_solves_the_equations_of_section_2(convective: bool) -> None:
    ours = solved(hsi.moving_crowd(BRIDGE, TRAFFIC, convective=convective).to_nlsys())[0]
    theirs = by_hand(TRAFFIC, convective)
    assert np.abs(ours - theirs).max() < 1e-6 * np.abs(theirs).max()


def test_convective_terms_are_small_but_there() -> None:
    """A walker covers a half wave in 40 s, while the bridge swings twice a second: some v/(L f), that is 1e-2."""
    without, with_them = (hsi.simulate(hsi.moving_crowd(BRIDGE, TRAFFIC, convective=given)).response.y[0]
                          for given in (False, True))
    assert 1e-4 < np.abs(with_them - without).max() / np.abs(without).max() < 3e-2


def test_light_bodies_leave_the_moving_forces() -> None:
    """Without mass to speak of the model is MF, which another road solves."""
    light = hsi.Traffic([walker(body=hsi.Pedestrian(mass=1e-6))])
    times = np.linspace(0.0, 40.0, 4001)
    ours = solved(hsi.moving_crowd(BRIDGE, light).to_nlsys(), times)[0]
    theirs = hsi.predict("MF", BRIDGE, light, timepts=times).response.outputs
    assert np.abs(ours - theirs).max() < 1e-5 * np.abs(theirs).max()


def test_the_system_of_an_instant_is_the_occupied_bridge() -> None:
    system = hsi.moving_crowd(BRIDGE, TRAFFIC).at(10.0)
    people = hsi.Crowd.of([hsi.Pedestrian(), hsi.Pedestrian(mass=300.0), hsi.Pedestrian()])
    places = [(25.0, 0.0), (2.5 * 6.7, 0.5), (3.2 * 1.1, 0.0)]
    np.testing.assert_allclose(system.A, hsi.couple(BRIDGE, people, places).A, rtol=1e-12, atol=1e-12)


def test_nobody_is_there_before_the_first_and_after_the_last() -> None:
    crowd = hsi.moving_crowd(BRIDGE, TRAFFIC)
    for time in (-0.1, 60.0):
        np.testing.assert_array_equal(crowd.at(time).A, hsi.couple(BRIDGE).A)
        assert not crowd.rows(time).any()


def test_damping_along_a_crossing_is_largest_at_the_antinode() -> None:
    """One walker on the 2 Hz reference bridge: φ² rises to one at midspan, and effective damping with it."""
    crowd = hsi.moving_crowd(hsi.reference_bridge(), hsi.Traffic([walker()]))
    frequency, damping = hsi.effective_along(crowd, [0.0, 10.0, 20.0, 30.0, 40.0])
    assert np.argmax(damping) == 2
    assert np.argmin(frequency) == 2
    assert (frequency[1], damping[1]) == tuple(hsi.effective(crowd.at(10.0)))
    assert damping[0] == pytest.approx(hsi.effective(hsi.reference_bridge()).damping, rel=1e-9)
    assert damping[1] == pytest.approx(damping[3], rel=1e-9)


def test_two_bodies_at_one_place_are_one_twice_as_heavy_along_the_crossing() -> None:
    pair, heavy = (hsi.moving_crowd(BRIDGE, hsi.Traffic(crowd)) for crowd in (
        [walker(), walker()], [walker(body=hsi.Pedestrian(mass=140.0))]))
    for mode in (0, 1):
        found = [np.array(hsi.effective_along(one, [5.0, 17.0], mode=mode, method="pole")) for one in (pair, heavy)]
        np.testing.assert_allclose(*found, rtol=1e-9)


def test_signals_are_named_and_points_are_chosen() -> None:
    system = hsi.moving_crowd(BRIDGE, TRAFFIC).to_nlsys(force_at=[10.0, 20.0], sense_at=[15.0], name="deck")
    assert system.input_labels == ["F[0]", "F[1]"]
    assert system.output_labels == ["a[0]"]
    assert system.state_labels == ["z[0]", "z[1]", "u[0]", "u[1]", "u[2]", "dz[0]", "dz[1]", "du[0]", "du[1]", "du[2]"]


def test_further_forces_act_as_on_the_empty_bridge_before_anybody_comes() -> None:
    """A late walker; until then, the host's `forced_response` of the empty bridge."""
    late = hsi.Traffic([walker(arrival=100.0)])
    times = np.linspace(0.0, 5.0, 501)
    force = 300.0 * np.sin(2 * np.pi * 1.7 * times)
    system = hsi.moving_crowd(BRIDGE, late).to_nlsys(force_at=[10.0], sense_at=[20.0])
    tight = {"rtol": 1e-9, "atol": 1e-12, "max_step": 0.01}
    ours = ct.input_output_response(system, times, force, solve_ivp_kwargs=tight)
    theirs = ct.forced_response(hsi.couple(BRIDGE, force_at=[10.0], sense_at=[20.0]), times, force)
    assert np.abs(ours.outputs - theirs.outputs).max() < 1e-6 * np.abs(theirs.outputs).max()


@pytest.mark.parametrize(("call", "message"), [
    (lambda: hsi.moving_crowd("bridge", TRAFFIC), "bridge must be of type Footbridge, got str; describe"),
    (lambda: hsi.moving_crowd(BRIDGE, [walker()]), "traffic must be of type Traffic, got list; draw it"),
    (lambda: hsi.moving_crowd(BRIDGE, TRAFFIC).at(np.nan), "time must be finite, got nan; give s"),
    (lambda: hsi.moving_crowd(BRIDGE, TRAFFIC).at("now"), "time must be real numbers, got 'now'; give s"),
    (lambda: hsi.effective_along(BRIDGE, [0.0]), "crowd must be of type MovingCrowd, got Footbridge; make it with"),
    (lambda: hsi.effective_along(hsi.moving_crowd(BRIDGE, TRAFFIC), 3.0), r"times must have 1 dimension\(s\), got"),
    (lambda: hsi.effective_along(hsi.moving_crowd(BRIDGE, TRAFFIC), [0.0], mode=2), "mode must"),
    (lambda: hsi.moving_crowd(BRIDGE, TRAFFIC).to_nlsys(sense_at=[51.0]), "sense_at must lie on the deck"),
])
def test_refusals(call, message: str) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        call()

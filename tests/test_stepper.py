"""The stepper against equations written out by hand, the host's integrators, closed forms, and its own order."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from itertools import pairwise
from multiprocessing import get_context

import control as ct
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import hsictrl as hsi
from hsictrl.stepper import kernel
from hsictrl.stepper.clock import Clock
from hsictrl.stepper.deck import Deck
from tests.second_road import sines

FACTORS, PHASES = [0.43, 0.10, 0.06], 2 * np.pi
FROZEN = 1e-9      # m/s: nobody gets anywhere


def beam(frequency: float = 2.0, damping: float = 0.005, n_modes: int = 1, mass: float = 50e3) -> hsi.Footbridge:
    return hsi.Footbridge.simply_supported(
        length=50.0, width=3.0, mass=mass, frequency=frequency, damping=damping, n_modes=n_modes)


def walking(n: int, step_frequency: float, speed: float, end: float, seed: int) -> hsi.Traffic:
    """Walkers with three harmonics, who step on from well before 0 until the end, at no round time."""
    rng = np.random.default_rng(seed)
    people, arrivals = hsi.Population.walking().sample(n, rng), rng.uniform(-40.0 / speed, 0.95 * end, n)
    return hsi.Traffic([hsi.Walker(
        body=people[k], force=hsi.HarmonicForce(FACTORS, phases=rng.uniform(0, PHASES, 3)), speed=speed,
        step_frequency=step_frequency, arrival=float(arrivals[k])) for k in range(n)], window=(0.0, end))


def standing(bodies: list[hsi.Pedestrian], places: np.ndarray) -> hsi.Traffic:
    """Walkers so slow that they stand, without force."""
    return hsi.Traffic([hsi.Walker(body=body, force=hsi.HarmonicForce([0.0]), step_frequency=2.0, speed=FROZEN,
                                   arrival=-float(x) / FROZEN) for body, x in zip(bodies, places, strict=True)],
                       window=(0.0, 10.0))


def by_hand(crowd: hsi.MovingCrowd, times: np.ndarray) -> np.ndarray:
    """Equations (1)–(4), (A.1) and (A.3), stepped by DOP853 at rtol 1e-10 from event to event; at midspan."""
    bridge, walkers = crowd.bridge, crowd.traffic.walkers
    people, arrival, speed, W = walkers.bodies, walkers.arrival, walkers.speed, 2 * np.pi * walkers.step_frequency
    departure, n_m, n = arrival + 50.0 / speed, bridge.n_modes, len(walkers)
    phases = np.array([one.force.phases for one in walkers])

    def accelerations(t: float, state: np.ndarray, present: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        z, u, dz, du = np.split(state, [n_m, n_m + n, 2 * n_m + n])
        phi = present[:, None] * sines(bridge, speed * (t - arrival))
        force = 700.0 * np.sum(FACTORS * np.cos(np.outer(W, [1, 2, 3]) * t + phases), axis=1)
        contact = people.stiffness * (u - phi @ z) + people.damping_coefficient * (du - phi @ dz)
        modal = phi.T @ (contact + force) - 2 * bridge.damping * bridge.omega * dz - bridge.omega**2 * z
        mass = np.eye(n_m) + phi.T * people.unsprung_mass @ phi
        return np.linalg.solve(mass, modal), -contact / people.sprung_mass

    events = np.concatenate([arrival, departure, [times[-1]]])
    edges = np.unique(events[events <= times[-1]])
    state, found = np.zeros(2 * (n_m + n)), np.zeros((n_m, len(times)))
    for start, stop in pairwise(edges):
        present = (arrival < (start + stop) / 2) & (departure > (start + stop) / 2)

        def rates(t: float, state: np.ndarray, present: np.ndarray = present) -> np.ndarray:
            return np.concatenate([state[n_m + n:], *accelerations(t, state, present)])

        asked = np.flatnonzero((times >= start) & (times <= stop))
        path = solve_ivp(rates, (start, stop), state, method="DOP853", rtol=1e-10, atol=1e-14,
                         t_eval=np.unique([*times[asked], stop]))
        for i in asked:
            found[:, i] = accelerations(times[i], path.y[:, np.searchsorted(path.t, times[i])], present)[0]
        state = path.y[:, -1]
    return sines(bridge, 25.0)[0] @ found


CASES = {
    "one resonant walker, 2 Hz 0.5 %": (beam(), walking(1, 2.0, 2.5, 12.0, 10)),
    "30 at 2 Hz 0.5 %": (beam(), walking(30, 2.0, 1.3, 20.0, 1)),
    "30 at 3.25 Hz 0.5 %": (beam(3.25), walking(30, 1.625, 1.3, 20.0, 2)),
    "30 at 5 Hz 0.2 %": (beam(5.0, 0.002), walking(30, 2.5, 1.3, 20.0, 3)),
    "150 at 2 Hz 0.5 %": (beam(), walking(150, 2.0, 1.06, 10.0, 4)),
    "three modes": (beam(n_modes=3), walking(30, 2.0, 1.3, 8.0, 5)),
}


@cache
def case(name: str) -> tuple[hsi.MovingCrowd, np.ndarray, np.ndarray]:
    crowd = hsi.moving_crowd(*CASES[name])
    times = np.arange(0.0, crowd.traffic.window[1] + 1e-9, 0.02)
    return crowd, times, by_hand(crowd, times)


def error(found: hsi.Simulation, reference: np.ndarray) -> float:
    """Largest over the window, relative to the peak."""
    return float(np.max(np.abs(found.response.y[0] - reference)) / np.max(np.abs(reference)))


@pytest.mark.parametrize("name", CASES)
def test_the_default_step_keeps_the_error_within_1e_4(name: str) -> None:
    crowd, times, reference = case(name)
    assert error(hsi.simulate(crowd, times), reference) <= 1e-4


@pytest.mark.parametrize("name", CASES)
def test_the_order_is_four_though_walkers_step_on_and_off_between_steps(name: str) -> None:
    crowd, times, reference = case(name)
    steps = 0.02 / np.array([4, 5, 6, 8] if name == "three modes" else [1, 2, 4, 8])
    found = [hsi.simulate(crowd, times, step=step) for step in steps]
    true = np.array([error(one, reference) for one in found])
    assert [one.step for one in found] == pytest.approx(steps)
    assert np.polyfit(np.log(steps), np.log(true), 1)[0] >= 3.7
    for one, size in zip(found, true, strict=True):
        assert one.error >= size * 2 / 3
        assert one.error <= 5 * size or size < 1e-8


def test_a_default_step_that_is_too_long_is_halved() -> None:
    """Thirty times as heavy people on a lighter bridge: what they do to it is faster than either alone."""
    heavy = [hsi.Pedestrian(mass=2000.0, frequency=6.0) for _ in range(15)]
    crowd = hsi.moving_crowd(beam(mass=10e3), standing(heavy, np.linspace(2, 48, 15)))
    times = np.linspace(0.0, 5.0, 251)
    found = hsi.simulate(crowd, times, initial_state=[1.0, 0.0])
    assert found.step < 0.01
    occupied = hsi.couple(crowd.bridge, crowd.traffic.walkers.bodies, np.linspace(2, 48, 15))
    free = ct.forced_response(occupied, times, np.zeros(251), [1.0, *np.zeros(15), 0.0, *np.zeros(15)])
    assert error(found, free.outputs) <= 1e-4


def test_standing_walkers_are_the_occupied_bridge_under_the_same_piecewise_linear_record() -> None:
    rng = np.random.default_rng(6)
    people, places = hsi.Population.walking().sample(20, rng), rng.uniform(0, 50, 20)
    crowd = hsi.moving_crowd(beam(n_modes=2), standing(list(people), places))
    times, record = np.linspace(0.0, 20.0, 2001), 100 * rng.normal(size=(2, 2001))
    given = {"force_at": [12.0, 30.0], "sense_at": [10.0, 25.0]}
    host = ct.forced_response(hsi.couple(crowd.bridge, people, places, **given), times, record)
    ours = hsi.simulate(crowd, times, record, initial_state=0, step=0.0025, **given)
    assert np.max(np.abs(ours.response.outputs - host.outputs)) <= 1e-6 * np.max(np.abs(host.outputs))
    by_default = hsi.simulate(crowd, times, record, initial_state=0, **given)
    assert np.max(np.abs(by_default.response.outputs - host.outputs)) <= 1e-4 * np.max(np.abs(host.outputs))


def integrated(crowd: hsi.MovingCrowd, times: np.ndarray, **points: list[float]) -> np.ndarray:
    system = crowd.to_nlsys(**points)
    return ct.input_output_response(
        system, times, np.zeros((system.ninputs, len(times))), squeeze=False, solve_ivp_method="DOP853",
        solve_ivp_kwargs={"rtol": 1e-10, "atol": 1e-13, "max_step": 0.05}).outputs


def mixed() -> hsi.Traffic:
    """Quick walkers of several kinds, more of them than are ever on the deck together, whose bodies swing for long."""
    rng = np.random.default_rng(7)
    forces = [hsi.HarmonicForce([0.4, 0.1]), hsi.YoungForce(), hsi.ZivanovicForce(spacing=0.05, scaling="variance")]
    return hsi.Traffic([hsi.Walker(
        body=hsi.Pedestrian(mass=60.0 + 10 * k, frequency=3.0 + 0.1 * k, damping=0.005, sprung_ratio=0.9),
        force=forces[k % 3], speed=8.0 + 0.5 * (k % 4), step_frequency=1.8 + 0.04 * k, arrival=0.311 + 0.67 * k,
        offset=0.2 * (k % 5)) for k in range(16)], window=(0.0, 14.0), rng=rng)


@pytest.mark.parametrize("convective", [False, True])
def test_a_moving_crowd_is_what_the_host_integrates(convective: bool) -> None:
    crowd = hsi.moving_crowd(beam(n_modes=2, mass=20e3), mixed(), convective=convective)
    times = np.linspace(0.0, 14.0, 701)
    host = integrated(crowd, times, sense_at=[10.0, 25.0])
    scale = np.max(np.abs(host))
    by_default = hsi.simulate(crowd, times, sense_at=[10.0, 25.0])
    assert np.max(np.abs(by_default.response.outputs - host)) <= 1e-4 * scale
    finer = hsi.simulate(crowd, times, sense_at=[10.0, 25.0], step=by_default.step / 8)
    assert np.max(np.abs(finer.response.outputs - host)) <= 1e-7 * scale


def test_lateral_bodies_push_back_laterally_and_walk_vertically() -> None:
    swaying = hsi.Mode(frequency=1.0, damping=0.01, modal_mass=20e3, shape=hsi.SineShape(50.0, 1, "lateral"))
    upright = hsi.Mode(frequency=2.0, damping=0.01, modal_mass=20e3, shape=hsi.SineShape(50.0))
    bridge = hsi.Footbridge(length=50.0, width=3.0, mass=40e3, modes=(upright, swaying))
    lateral = hsi.Pedestrian(frequency=0.75, direction="lateral")
    crowd = hsi.moving_crowd(bridge, hsi.Traffic(
        [hsi.Walker(body=body, force=hsi.HarmonicForce([0.4]), speed=3.0, step_frequency=2.0, arrival=0.3 + t)
         for t, body in enumerate([lateral, hsi.Pedestrian(), lateral])], window=(0.0, 10.0)))
    times = np.linspace(0.0, 10.0, 501)
    start = [0.0, 1.0, 0.0, 0.0]                     # the lateral mode swings, which walking does not set off
    ours = hsi.simulate(crowd, times, initial_state=start, step=0.002)
    host = ct.input_output_response(
        crowd.to_nlsys(), times, np.zeros((1, 501)), [0.0, 1.0, *np.zeros(8)], solve_ivp_method="DOP853",
        solve_ivp_kwargs={"rtol": 1e-10, "atol": 1e-13, "max_step": 0.05})
    assert ours.response.states == pytest.approx(host.states[[0, 1, 5, 6]], abs=1e-7)


def test_a_lateral_body_takes_no_force_over_with_its_seat() -> None:
    """No force acts laterally, so a lateral mode at rest stays there exactly, whoever comes and goes."""
    swaying = hsi.Mode(frequency=1.0, damping=0.01, modal_mass=20e3, shape=hsi.SineShape(50.0, 1, "lateral"))
    upright = hsi.Mode(frequency=2.0, damping=0.01, modal_mass=20e3, shape=hsi.SineShape(50.0))
    bridge = hsi.Footbridge(length=50.0, width=3.0, mass=40e3, modes=(upright, swaying))
    rng = np.random.default_rng(1)
    crowd = hsi.moving_crowd(bridge, hsi.Traffic([hsi.Walker(
        body=hsi.Pedestrian(frequency=0.75, direction="lateral" if lateral else "vertical"), speed=5.0,
        force=hsi.HarmonicForce([0.4]), step_frequency=2.0, arrival=float(arrival))
        for arrival, lateral in zip(rng.uniform(0, 40, 60), rng.random(60) < 0.7, strict=True)]))
    found = hsi.simulate(crowd).response.states
    assert np.max(np.abs(found[0])) > 0.1
    assert not np.any(found[1])


class Cantilever(hsi.Shape):
    """Largest where walkers step on, and not zero where they leave."""

    length, antinode, mean_square, mean_absolute = 50.0, (0.0, 0.0), 0.4, 0.6

    def __call__(self, x, y=0.0, direction="vertical"):
        x, y = np.broadcast_arrays(x, y)
        return np.where((x >= 0) & (x <= 50.0), np.cos(0.7 * np.pi * x / 50.0), 0.0)


@pytest.mark.parametrize("arrival", [3.0, 3.003])     # on a step, and between two
def test_a_jump_of_the_shape_is_met_wherever_it_comes(arrival: float) -> None:
    mode = hsi.Mode(frequency=2.0, damping=0.005, modal_mass=20e3, shape=Cantilever())
    bridge = hsi.Footbridge(length=50.0, width=3.0, mass=40e3, modes=(mode,))
    crowd = hsi.moving_crowd(bridge, hsi.Traffic([hsi.Walker(
        force=hsi.HarmonicForce([0.4]), step_frequency=2.0, speed=10.0, arrival=arrival)], window=(0.0, 10.0)))
    times = np.linspace(0.0, 10.0, 801)
    edges, state, host = [0.0, arrival, arrival + 5.0, 10.0], np.zeros(4), np.zeros(801)
    system = crowd.to_nlsys()
    for start, stop in pairwise(edges):
        def rates(t: float, x: np.ndarray, low: float = start + 1e-12, high: float = stop - 1e-12) -> np.ndarray:
            return system._rhs(min(max(t, low), high), x, np.zeros(1))

        path = solve_ivp(rates, (start, stop), state, method="DOP853", rtol=1e-10, atol=1e-14, dense_output=True)
        asked = np.flatnonzero((times > start + 1e-9) & (times < stop - 1e-9))
        host[asked] = [path.sol(t)[0] for t in times[asked]]
        state = path.y[:, -1]
    z = hsi.simulate(crowd, times).response.states[0]
    between = host != 0
    assert np.max(np.abs(z[between] - host[between])) <= 1e-4 * np.max(np.abs(host))


def test_without_walkers_it_is_the_empty_bridge() -> None:
    nobody = walking(1, 2.0, 1.3, 10.0, 1).since(100.0)
    times, record = np.linspace(0.0, 10.0, 1001), np.cos(np.arange(1001))
    crowd = hsi.moving_crowd(beam(n_modes=2), nobody)
    found = hsi.simulate(crowd, times, record)
    empty = ct.forced_response(hsi.couple(crowd.bridge), times, record)
    assert error(found, empty.outputs) <= 1e-6
    assert np.all(hsi.simulate(crowd, times).response.outputs == 0)


def test_further_forces_begin_with_the_times_though_people_came_before() -> None:
    early = hsi.Traffic([hsi.Walker(body=hsi.Pedestrian(mass=1e-9), force=hsi.HarmonicForce([0.4]), speed=1.3,
                                    step_frequency=2.0, arrival=-5.3)], window=(0.0, 10.0))
    crowd, times = hsi.moving_crowd(beam(), early), np.linspace(0.0, 10.0, 1001)
    record = 200 * np.cos(10 * times)
    both, walkers = (hsi.simulate(crowd, times, forces).response.outputs for forces in (record, None))
    empty = ct.forced_response(hsi.couple(crowd.bridge), times, record).outputs
    assert np.max(np.abs(both - walkers - empty)) <= 1e-5 * np.max(np.abs(empty))


def test_bodies_without_mass_leave_the_moving_force_model() -> None:
    traffic = walking(12, 2.0, 1.3, 30.0, 8)
    weightless = hsi.Traffic([hsi.Walker(
        body=hsi.Pedestrian(mass=1e-9), force=one.force, speed=one.speed, step_frequency=one.step_frequency,
        arrival=one.arrival) for one in CASES["30 at 2 Hz 0.5 %"][1].walkers], window=(0.0, 20.0))
    assert len(traffic.walkers) == 12
    times = np.linspace(0.0, 20.0, 2001)
    moving_force = hsi.predict("MF", beam(), weightless, timepts=times)
    assert error(hsi.simulate(hsi.moving_crowd(beam(), weightless), times), moving_force.response.y[0]) <= 1e-4


people = st.builds(
    hsi.Pedestrian, mass=st.floats(1.0, 1000.0), frequency=st.floats(0.5, 15.0), damping=st.floats(0.0, 0.99),
    sprung_ratio=st.floats(0.05, 1.0))


@settings(max_examples=60)
@given(bodies=st.lists(people, min_size=1, max_size=8), frequency=st.floats(0.5, 10.0), damping=st.floats(0.0, 0.1),
       n_modes=st.integers(1, 3), mass=st.floats(3e3, 1e5), seed=st.integers(0, 2**32 - 1))
def test_the_energy_of_free_decay_never_grows(
    bodies: list[hsi.Pedestrian], frequency: float, damping: float, n_modes: int, mass: float, seed: int,
) -> None:
    """Kinetic and elastic energy of bridge and bodies; by more than rounding and what the estimate admits."""
    rng = np.random.default_rng(seed)
    bridge = beam(frequency, damping, n_modes, mass)
    crowd = hsi.moving_crowd(bridge, standing(bodies, rng.uniform(1, 49, len(bodies))))
    start = rng.normal(size=(2, n_modes)) * [1 / bridge.omega, np.ones(n_modes)]
    found = hsi.simulate(crowd, np.linspace(0.0, 2.0, 101), initial_state=start.ravel())
    energy = energies(crowd, found.step, start, 2.0)
    assert np.all(energy[1:] <= np.minimum.accumulate(energy)[:-1] + (2 * found.error + 1e-6) * energy[0])


def energies(crowd: hsi.MovingCrowd, step: float, start: np.ndarray, duration: float) -> np.ndarray:
    deck = Deck(crowd, step, np.array([0.0, duration]))
    deck.enter(0)
    n_m, row = crowd.bridge.n_modes, crowd.rows(0.0)
    deck.fine[:, :n_m] = start
    crowd_at_rest, values = crowd.traffic.walkers.bodies, []
    for pair in range(int(duration / step / 2)):
        (z, dz), (u, du) = deck.fine[:, :n_m], deck.fine[:, n_m:]
        values.append((dz @ dz + (crowd.bridge.omega * z) @ (crowd.bridge.omega * z)
                       + crowd_at_rest.unsprung_mass @ (row @ dz)**2 + crowd_at_rest.sprung_mass @ du**2
                       + crowd_at_rest.stiffness @ (u - row @ z)**2) / 2)
        kernel.march(2 * pair * step, step, deck.bridge, deck.contacts, np.zeros((5, n_m)), deck.fine, deck.coarse,
                     np.empty((3, 3, n_m)), np.empty((2, 3, n_m)))
    return np.array(values)


def test_memory_holds_those_on_the_deck_however_many_have_come_and_gone() -> None:
    """A walker every 0.8 s crosses in 10 s: 12.5 on the deck, a quarter more for those of a block's 1.25 s twice."""
    def seats(n: int) -> int:
        crowd = hsi.moving_crowd(beam(), hsi.Traffic([hsi.Walker(
            force=hsi.HarmonicForce([0.4]), step_frequency=2.0, speed=5.0, arrival=0.8 * k) for k in range(n)]))
        clock = Clock(times=np.linspace(0.0, 0.8 * n, 10 * n + 1), start=0.0, substeps=8)
        return Deck(crowd, clock.step, clock.time(clock.blocks(10.0))).contacts.paths.shape[1]

    assert seats(40) <= seats(400) <= 16


def peak_of(bridge: hsi.Footbridge, rng: np.random.Generator) -> float:
    traffic = hsi.CrowdFlow(persons=5).sample(bridge, rng=rng)
    return hsi.predict("MC", bridge, hsi.tune("MC", bridge, traffic)).peak_acceleration


def test_digits_do_not_depend_on_processes() -> None:
    rule, trial = hsi.MeanRule(tolerance=0.5), partial(peak_of, beam())
    in_place = hsi.monte_carlo(trial, rule=rule, seed=3, max_trials=10)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        spread = hsi.monte_carlo(trial, rule=rule, seed=3, max_trials=10, executor=pool)
    assert np.array_equal(in_place.samples, spread.samples)


def test_prediction_and_simulation_are_one() -> None:
    bridge = beam()
    traffic = hsi.CrowdFlow(persons=5).sample(bridge, rng=np.random.default_rng(4))
    found = hsi.predict("MC", bridge, traffic, sense_at=[20.0])
    again = hsi.simulate(found.system, sense_at=[20.0])
    assert np.array_equal(found.response.outputs, again.response.outputs)
    assert found.error == again.error


CROWD = hsi.moving_crowd(beam(n_modes=2), walking(3, 2.0, 1.3, 10.0, 1))
QUICK = hsi.moving_crowd(beam(), hsi.Traffic(
    [hsi.Walker(force=hsi.HarmonicForce([0.4]), step_frequency=2.0, speed=9.0)], window=(0.0, 10.0)))
LATE = hsi.moving_crowd(beam(), hsi.Traffic(
    [hsi.Walker(force=hsi.HarmonicForce([0.4]), step_frequency=2.0, speed=1.3, arrival=11.0)], window=(0.0, 10.0)))
HEAVY = hsi.moving_crowd(beam(mass=5e3), standing([hsi.Pedestrian(mass=5000.0, frequency=8.0)], np.array([25.0])))
TIMES = np.linspace(0.0, 10.0, 101)


@pytest.mark.parametrize(("crowd", "given", "error", "match"), [
    (CROWD.bridge, {}, TypeError, r"crowd must be of type MovingCrowd, got Footbridge; make it with moving_crowd"),
    (CROWD, {"step": 0.02}, ValueError, r"step must be at most a tenth of the period of the highest mode, 8 Hz, got "
                                        r"0.02 s; give at most 0.0125"),
    (CROWD, {"step": 0.0}, ValueError, r"step must be above 0, got 0"),
    (hsi.moving_crowd(beam(0.1), QUICK.traffic), {"step": 0.6}, ValueError,
     r"step must be at most a tenth of the time that any walker is on the deck, got 0.6 s and 5.55556 s; give at most"),
    (CROWD, {"timepts": [0.0]}, ValueError, r"timepts must hold at least two times, got 1"),
    (CROWD, {"timepts": [0.0, 1.0, 3.0]}, ValueError, r"timepts must increase evenly"),
    (CROWD, {"timepts": [0.0, np.nan]}, ValueError, r"timepts\[1\] must be finite, got nan"),
    (CROWD, {"timepts": TIMES, "forces": np.zeros(100)}, ValueError,
     r"forces must be given at every point and time, of shape \(1, 101\), got \(1, 100\); sample them at timepts"),
    (CROWD, {"timepts": TIMES, "forces": np.full(101, np.inf)}, ValueError, r"forces\[0\] must be finite, got inf"),
    (CROWD, {"timepts": TIMES, "initial_state": [1.0, 0.0]}, ValueError,
     r"initial_state must hold z and dz of 2 mode\(s\), got shape \(2,\); give 4 numbers, or 0 for rest"),
    (CROWD, {"sense_at": [60.0]}, ValueError, r"sense_at must lie on the deck"),
    (hsi.moving_crowd(beam(), hsi.Traffic([hsi.Walker(
        force=hsi.HarmonicForce([0.4]), step_frequency=2.0, speed=1e-7)])), {}, ValueError,
     r"the window must hold at most 1e\+07 steps of 0.0125 s, got 5e\+08 s; give the traffic a window, or timepts"),
    (LATE, {}, ValueError, r"somebody must arrive before the window ends at 10 s, got a first arrival at 11 s"),
    (HEAVY, {"timepts": TIMES, "initial_state": [1.0, 0.0], "step": 0.05}, ValueError,
     r"the step must be short enough for what people do to the bridge, got 0.05 s and an estimated error of .*% of"),
    (hsi.moving_crowd(beam(), standing([hsi.Pedestrian()], np.array([25.0]))), {}, ValueError,
     r"traffic must begin at most 1e\+07 double steps before timepts, got an arrival 2.5e\+10 s before; leave"),
])
def test_refusals(crowd: hsi.MovingCrowd, given: dict, error: type[Exception], match: str) -> None:
    with pytest.raises(error, match=match):
        hsi.simulate(crowd, **given)


def test_convective_terms_need_derivatives() -> None:
    class Parabola(hsi.Shape):
        length, antinode, mean_square, mean_absolute = 50.0, (25.0, 0.0), 8 / 15, 2 / 3

        def __call__(self, x, y=0.0, direction="vertical"):
            x, y = np.broadcast_arrays(x, y)
            return np.where((x >= 0) & (x <= 50.0), 4 * x / 50.0 * (1 - x / 50.0), 0.0)

    mode = hsi.Mode(frequency=2.0, damping=0.01, modal_mass=20e3, shape=Parabola())
    bridge = hsi.Footbridge(length=50.0, width=3.0, mass=40e3, modes=(mode,))
    traffic = walking(3, 2.0, 1.3, 10.0, 1)
    assert hsi.simulate(hsi.moving_crowd(bridge, traffic)).error < 1e-4
    with pytest.raises(ValueError, match=r"convective terms need the derivatives of every shape, got none of Parabola; "
                                         r"give it a method derivative"):
        hsi.simulate(hsi.moving_crowd(bridge, traffic, convective=True))
    with pytest.raises(TypeError, match=r"convective must be of type bool, got int; give True or False"):
        hsi.moving_crowd(bridge, traffic, convective=1)

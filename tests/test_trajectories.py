"""People who follow trajectories: against straight walkers, equations by hand, and the rows of the files they come from."""

from __future__ import annotations

import importlib.util
import pickle
import sqlite3
from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import control as ct
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import PchipInterpolator

import hsictrl as hsi

ROOT = Path(__file__).parent.parent
MODELS = ("SF", "MF", "MFAM", "PMC", "MC")
COSINES = hsi.HarmonicForce([0.43, 0.08], phases=[0.2, 0.7])
SILENT = hsi.HarmonicForce([0.0])
BRIDGE = hsi.reference_bridge(frequency=2.0)     # 50 m × 3 m
X = np.linspace(0.0, 50.0, 51)
WAVE = np.sin(np.pi * X / 50)
TWISTING = hsi.Footbridge(length=50.0, width=3.0, mass=50e3, modes=[
    hsi.Mode(frequency=2.0, damping=0.005, modal_mass=25e3, shape=hsi.SineShape(50.0)),
    hsi.Mode(frequency=3.1, damping=0.008, modal_mass=9e3, shape=hsi.SampledShape(
        x=X, y=[-1.5, 1.5], vertical=np.outer(WAVE, [-1, 1]), lateral=0.3 * WAVE))])


def made_by(script: str):
    """The script that wrote the recordings."""
    spec = importlib.util.spec_from_file_location("script", ROOT / "docs" / script)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


RECORDED = made_by("trajectories.py")
WRITE = {"sqlite": RECORDED.write_jupedsim, "txt": RECORDED.write_text}
# where the deck is in each of them: origin and angle
WHERE = {"sqlite": {}, "txt": {"origin": (12.0, 3.0), "angle": np.pi / 2}}


def walker(**given) -> hsi.Walker:
    return hsi.Walker(**{"force": COSINES, "step_frequency": 2.0} | given)


def read(path, bridge=BRIDGE, **given) -> hsi.Traffic:
    return hsi.Traffic.from_trajectories(
        path, bridge, **{"rng": np.random.default_rng(1)} | WHERE.get(str(path).rpartition(".")[2], {}) | given)


def apart(ours, theirs) -> float:
    """Largest difference, relative to the peak."""
    return float(np.max(np.abs(ours - theirs)) / np.max(np.abs(theirs)))


# one trajectory

def test_the_curve_keeps_the_order_of_its_places() -> None:
    rng = np.random.default_rng(1)
    times, x, y = np.cumsum(rng.uniform(0.5, 1.0, 30)), rng.uniform(10, 12, 30), rng.uniform(-1, 1, 30)
    found = hsi.Trajectory(times, x, y)
    np.testing.assert_allclose(found(times), np.column_stack([x, y]), rtol=0, atol=1e-12)
    for i in range(29):
        between = found(np.linspace(times[i], times[i + 1], 50))
        assert np.all(np.diff(between, axis=0) * np.sign([x[i + 1] - x[i], y[i + 1] - y[i]]) >= -1e-12)


def test_nobody_is_there_before_the_arrival_and_after_the_departure() -> None:
    found = hsi.Trajectory([1.0, 2.0], [25.0, 26.0], y=0.5)
    np.testing.assert_array_equal(BRIDGE.carries(found([0.999, 1.0, 1.5, 2.0, 2.001])), [False, True, True, True, False])


@pytest.mark.parametrize(("places", "expected"), [
    ([(0, -5, 0), (60, 55, 0)], [(5, 55)]),                                   # between two frames
    ([(0, 55, 0), (60, -5, 0)], [(5, 55)]),                                   # the other way
    ([(0, 25, -2), (40, 25, 2)], [(5, 35)]),                                  # across
    ([(0, 25, 0), (9, 25, 0)], [(0, 9)]),                                     # standing
    ([(0, 0, 1.5), (50, 50, 1.5)], [(0, 50)]),                                # along the very edge
    ([(0, 0, 1.6), (50, 50, 1.6)], []),                                       # beside it
    ([(0, -10, 0), (20, 10, 0), (30, 10, 0), (50, -10, 0), (70, 10, 0)], [(None, None), (None, 70)]),   # on, off, on
])
def test_stays_end_where_the_deck_does(places, expected) -> None:
    stays = hsi.Trajectory(*np.array(places, dtype=float).T).stays_on(BRIDGE)
    assert len(stays) == len(expected)
    for stay, (start, stop) in zip(stays, expected, strict=True):
        assert stay.arrival == pytest.approx(start, abs=1e-9) or start is None
        assert stay.departure == pytest.approx(stop, abs=1e-9) or stop is None
        assert np.all(BRIDGE.carries(stay(np.linspace(stay.arrival, stay.departure, 500))))
        if start is None:
            assert stay.x[0] == pytest.approx(0.0, abs=1e-12)


def test_speed_is_how_fast_a_person_walks() -> None:
    """At 1.5 m/s, with a rest of a third of the time and a sway of 5 cm that a second step undoes."""
    times = np.arange(0.0, 60.0, 0.1)
    x = np.interp(times, [0.0, 20.0, 40.0, 60.0], [0.0, 30.0, 30.0, 60.0])
    found = hsi.Trajectory(times, x, 0.05 * np.sin(2 * np.pi * times))
    assert found.speed == pytest.approx(1.5, rel=1e-9)
    assert hsi.Trajectory([0.0, 60.0], [25.0, 25.0]).speed == 0.0


# walkers who follow one

STRAIGHT = walker(speed=1.25, arrival=0.37, offset=0.5)
SAMPLES = np.linspace(0.37, 40.37, 401)
FOLLOWING = walker(trajectory=hsi.Trajectory(SAMPLES, np.linspace(0.0, 50.0, 401), 0.5))
TIMES = np.linspace(0.37, 40.0, 3001)


@pytest.mark.parametrize("model", MODELS)
def test_at_constant_speed_a_trajectory_is_a_straight_way(model: str) -> None:
    ours, theirs = (hsi.predict(model, TWISTING, hsi.Traffic([one]), timepts=TIMES).response.y
                    for one in (FOLLOWING, STRAIGHT))
    assert apart(ours, theirs) < 1e-9


@pytest.mark.parametrize("model", ["MF", "MC"])
def test_on_a_symmetric_deck_the_way_back_is_the_way_there(model: str) -> None:
    back = walker(trajectory=hsi.Trajectory([0.37, 40.37], [50.0, 0.0]))
    ours, theirs = (hsi.predict(model, BRIDGE, hsi.Traffic([one]), timepts=TIMES).response.y
                    for one in (back, walker(speed=1.25, arrival=0.37)))
    assert apart(ours, theirs) < 1e-9


def wandering(seed: int, start: float, turn: float) -> hsi.Trajectory:
    """Out, round and back for 8 s, from side to side, ten frames per second of a tracker that errs by 1 cm."""
    times, rng = np.linspace(0.0, 8.0, 81), np.random.default_rng(seed)
    x = 8 - 8 * np.cos(2 * np.pi * times / turn) + rng.normal(scale=0.01, size=81) * (times > 0) * (times < 8)
    return hsi.Trajectory(start + times, np.clip(x, 0, 50), 1.2 * np.sin(2 * np.pi * times / 5 + seed))


WANDERERS = [
    walker(trajectory=wandering(0, 0.103, 13.0), body=hsi.Pedestrian(mass=150.0)),
    walker(trajectory=wandering(1, 1.017, 8.0), step_frequency=1.55),
    walker(speed=2.4, arrival=0.5, offset=-1.0),
    walker(trajectory=hsi.Trajectory([0.0, 9.001], [20.0, 20.0], -1.0), force=SILENT),
    walker(trajectory=wandering(2, 0.0, 11.0), force=SILENT, body=hsi.Pedestrian(direction="lateral", frequency=0.9)),
]


def by_hand(walkers: list[hsi.Walker], times: np.ndarray) -> np.ndarray:
    """Equations (1)–(4), (A.1) and (A.3), from event to event; acceleration at (25, 0) and (10, 1.5) m of TWISTING."""
    masses, omega = np.array([25e3, 9e3]), 2 * np.pi * np.array([2.0, 3.1])
    damping, n = 2 * np.array([0.005, 0.008]) * omega, len(walkers)
    ways = [None if one.trajectory is None else (
        PchipInterpolator(one.trajectory.times, one.trajectory.x), PchipInterpolator(one.trajectory.times,
                                                                                      one.trajectory.y))
            for one in walkers]
    ends = [(one.arrival, one.arrival + 50 / one.speed if way is None else one.trajectory.times[-1])
            for one, way in zip(walkers, ways, strict=True)]

    def shapes(x, y, direction="vertical"):
        wave = np.sin(np.pi * x / 50)
        return np.array([wave, wave * y / 1.5] if direction == "vertical" else [0.0, 0.3 * wave]) / np.sqrt(masses)

    def rates(t, state, present):
        z, dz, u, du = state[:2], state[2:4], state[4:4 + n], state[4 + n:]
        mass, modal, own = np.eye(2), -damping * dz - omega**2 * z, np.zeros(n)
        for k, (one, way) in enumerate(zip(walkers, ways, strict=True)):
            x, y = (one.speed * (t - one.arrival), one.offset) if way is None else (way[0](t), way[1](t))
            body, W = one.body, 2 * np.pi * one.step_frequency
            phi = present[k] * shapes(x, y, body.direction)
            contact = body.stiffness * (u[k] - phi @ z) + body.damping_coefficient * (du[k] - phi @ dz)
            mass += body.unsprung_mass * np.outer(phi, phi)
            modal = modal + phi * contact
            if one.force is COSINES:
                modal += present[k] * shapes(x, y) * 700 * (0.43 * np.cos(W * t + 0.2) + 0.08 * np.cos(2 * W * t + 0.7))
            own[k] = -contact / body.sprung_mass
        return np.concatenate([dz, np.linalg.solve(mass, modal), du, own])

    state, found = np.zeros(4 + 2 * n), []
    for start, stop in pairwise(np.unique([0.0, times[-1], *(t for pair in ends for t in pair if 0 < t < times[-1])])):
        present = np.array([first <= start and last >= stop for first, last in ends], dtype=float)
        asked = times[(times >= start) & ((times < stop) | (stop == times[-1]))]
        path = solve_ivp(rates, (start, stop), state, args=(present,), method="DOP853", rtol=1e-9, atol=1e-13,
                         max_step=0.05, t_eval=np.unique([*asked, stop]))
        found += [rates(t, path.y[:, i], present)[2:4] for i, t in enumerate(path.t[:len(asked)])]
        state = path.y[:, -1]
    return np.array([shapes(25.0, 0.0), shapes(10.0, 1.5)]) @ np.array(found).T


def test_whoever_turns_and_wanders_is_followed_as_the_equations_say() -> None:
    """Coming and going on the deck itself costs orders: φ jumps there, as at a free end (see docs/stepper.md)."""
    times = np.linspace(0.0, 10.0, 501)
    crowd, theirs = hsi.moving_crowd(TWISTING, hsi.Traffic(WANDERERS)), by_hand(WANDERERS, times)
    found = hsi.simulate(crowd, times, sense_at=[(25.0, 0.0), (10.0, 1.5)])
    assert apart(found.response.y, theirs) < 6e-5
    fine = hsi.simulate(crowd, times, sense_at=[(25.0, 0.0), (10.0, 1.5)], step=0.001)
    assert apart(fine.response.y, theirs) < 1e-5


def test_the_hosts_nonlinear_system_follows_trajectories_too() -> None:
    times = np.linspace(0.0, 2.5, 126)
    system = hsi.moving_crowd(TWISTING, hsi.Traffic(WANDERERS)).to_nlsys(sense_at=[(25.0, 0.0), (10.0, 1.5)])
    ours = ct.input_output_response(system, times, np.zeros((1, len(times))), squeeze=False, solve_ivp_method="DOP853",
                                    solve_ivp_kwargs={"rtol": 1e-7, "atol": 1e-11, "max_step": 0.05}).outputs
    assert apart(ours, by_hand(WANDERERS, times)) < 1e-4


def test_moving_forces_follow_trajectories() -> None:
    """The modal force written out, for people who come and go at the end of the deck, where a force begins smoothly; and
    the host's `forced_response` of the empty bridge."""
    times, load = np.linspace(0.0, 12.0, 12_001), np.zeros((2, 12_001))
    people = [walker(trajectory=wandering(seed, start, 8.0), step_frequency=f)
              for seed, start, f in ((0, 0.5, 2.0), (1, 2.2, 1.55))]
    for one in people:
        way, W = one.trajectory, 2 * np.pi * one.step_frequency
        x, y = (PchipInterpolator(way.times, part, extrapolate=False)(times) for part in (way.x, way.y))
        force = 700 * (0.43 * np.cos(W * times + 0.2) + 0.08 * np.cos(2 * W * times + 0.7))
        load += np.nan_to_num([np.sin(np.pi * x / 50) * force, np.sin(np.pi * x / 50) * y / 1.5 * force])
    plant = hsi.couple(TWISTING, force_at=[(25.0, 0.0), (25.0, 1.5)], sense_at=[(25.0, 1.5)])     # φ is (1, 0), (1, 1)
    theirs = ct.forced_response(plant, times, [load[0] - load[1], load[1]]).outputs
    ours = hsi.predict("MF", TWISTING, hsi.Traffic(people, window=(0.0, 12.0)), timepts=times, sense_at=[(25.0, 1.5)])
    assert apart(ours.response.y[0], np.ravel(theirs)) < 1e-4


def test_a_crowd_that_stands_longer_than_a_table_lasts_is_coupled_all_along() -> None:
    """Free decay after a minute: the host's own of the occupied bridge."""
    places = [(20.0, 1.0), (31.0, -0.5)]
    people = [walker(trajectory=hsi.Trajectory([0.0, 100.0], [x, x], y), force=SILENT) for x, y in places]
    times = np.linspace(60.0, 70.0, 501)
    ours = hsi.simulate(hsi.moving_crowd(BRIDGE, hsi.Traffic(people)), times, initial_state=[1.0, 0.0]).response
    system = hsi.couple(BRIDGE, hsi.Pedestrian(), places)
    theirs = ct.initial_response(system, times - 60.0, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert apart(ours.y[0], theirs.outputs) < 1e-6


def test_traffic_answers_for_those_who_follow_trajectories() -> None:
    out = hsi.Trajectory([0.0, 20.0, 30.0, 50.0], [0.0, 25.0, 25.0, 0.0], y=0.5)
    late = walker(speed=1.25, arrival=5.0)
    traffic = hsi.Traffic([walker(trajectory=out), late])
    assert traffic.observed(BRIDGE) == (0.0, 50.0)
    np.testing.assert_array_equal(traffic.persons_on(BRIDGE, [-1.0, 0.0, 5.0, 44.9, 45.1, 50.1]), [0, 1, 2, 2, 1, 0])
    _, places = traffic.standing_on(BRIDGE)
    np.testing.assert_allclose(places, [[25.0, 0.5], [25.0, 0.0]], rtol=1e-12)
    walkers, stopped = traffic.stopped_on(BRIDGE)
    np.testing.assert_array_equal(stopped, places)
    assert walkers[0].trajectory is out
    assert len(traffic.since(1.0).walkers) == 1
    assert traffic.since(1.0).walkers.trajectories == ()
    tuned = traffic.tuned(1.9)
    assert tuned.walkers.trajectories[0] is out
    np.testing.assert_array_equal(tuned.walkers.step_frequency, 1.9)
    assert list(traffic.walkers)[1] == late
    copy = pickle.loads(pickle.dumps(traffic))
    np.testing.assert_array_equal(copy.walkers.position([3.0, 33.0]), traffic.walkers.position([3.0, 33.0]))


# files

def test_a_person_is_where_the_row_says() -> None:
    for path in ("simulated.sqlite", "filmed.txt"):
        walkers = read(ROOT / "examples" / path).walkers
        assert len(walkers) == 4
        for person, frame, x, y in RECORDED.rows():
            if 0 < x < 50:
                assert walkers.places(frame / RECORDED.RATE)[person - 1] == pytest.approx([x, y], abs=2e-3)


def test_the_recordings_are_those_that_the_script_writes(tmp_path: Path) -> None:
    for name in ("simulated.sqlite", "filmed.txt"):
        WRITE[name.rpartition(".")[2]](tmp_path / name, RECORDED.rows())
        for ours, theirs in zip(read(tmp_path / name).walkers, read(ROOT / "examples" / name).walkers, strict=True):
            np.testing.assert_array_equal(ours.trajectory.x, theirs.trajectory.x)


@pytest.mark.parametrize("kind", WRITE)
def test_a_recorded_crowd_walks_as_straight_walkers_do(kind: str, tmp_path: Path) -> None:
    """Each at a constant speed, with a frame at either end of the deck, one of them against the stream."""
    speeds, offsets, starts = [1.25, -1.0, 2.0], [0.4, -1.1, 0.0], [0.0, 4.0, 12.0]
    rows = [(k, 10 * int(start) + frame, (0.0 if v > 0 else 50.0) + v * frame / 10, y)
            for k, (v, y, start) in enumerate(zip(speeds, offsets, starts, strict=True), start=1)
            for frame in range(0, int(500 / abs(v)) + 1, 10)]
    WRITE[kind](tmp_path / f"walk.{kind}", rows, rate=10.0)
    recorded = read(tmp_path / f"walk.{kind}", force=COSINES, population=hsi.Population(frequency=3.25, damping=0.3))
    straight = hsi.Traffic([
        hsi.Walker(force=COSINES, body=recorded.walkers.bodies[k], arrival=starts[k], offset=offsets[k], speed=abs(v),
                   step_frequency=0.35 * abs(v)**3 - 1.59 * v**2 + 2.93 * abs(v)) for k, v in enumerate(speeds)])
    times = np.linspace(0.0, 50.0, 5001)
    for model in ("MF", "MC"):
        ours, theirs = (hsi.predict(model, BRIDGE, one, timepts=times).response.y for one in (recorded, straight))
        assert apart(ours, theirs) < 1e-6


@pytest.mark.parametrize("kind", WRITE)
def test_a_recorded_crowd_that_stands_still_gives_the_pseudo_moving_crowd(kind: str, tmp_path: Path) -> None:
    """They step in place. Both models start from rest, when they arrive: bridge, bodies, and no force before. PMC then
    has the bodies where MC has them, and the forces, too; one is solved by frequencies and the other step by step."""
    places = [(7.0, 0.5), (18.0, -1.0), (24.0, 0.0), (26.5, 1.2), (41.0, -0.3)]
    rows = [(k, frame, x, y) for k, (x, y) in enumerate(places, start=1) for frame in range(0, 601, 5)]
    WRITE[kind](tmp_path / f"still.{kind}", rows, rate=20.0)
    traffic = read(tmp_path / f"still.{kind}", TWISTING, still=0.0, step_frequency=1.97)
    times = np.linspace(0.0, 20.0, 8001)
    moving, standing = (hsi.predict(model, TWISTING, traffic, timepts=times) for model in ("MC", "PMC"))
    assert len(standing.system.people) == 5
    assert apart(moving.response.y, standing.response.y) < 2e-4


@pytest.mark.parametrize("kind", WRITE)
def test_whoever_stands_weighs_on_the_deck_while_others_walk_by(kind: str, tmp_path: Path) -> None:
    """The walker has next to no mass, so that only the bodies that stand push back, in MC as in PMC."""
    rows = [(1, frame, 1.25 * frame / 10, 0.3) for frame in range(401)]
    rows += [(2, frame, 24.0, -1.0) for frame in range(401)] + [(3, frame, 31.0, 0.6) for frame in range(401)]
    WRITE[kind](tmp_path / f"by.{kind}", rows, rate=10.0)
    traffic = read(tmp_path / f"by.{kind}", population=hsi.Population(mass=1e-6, frequency=3.0, damping=0.3))
    assert traffic.target == pytest.approx(0.35 * 1.25**3 - 1.59 * 1.25**2 + 2.93 * 1.25)
    times = np.linspace(0.0, 40.0, 8001)
    moving, standing = (hsi.predict(model, BRIDGE, traffic, timepts=times).response.y for model in ("MC", "PMC"))
    assert apart(moving, standing) < 1e-5
    assert apart(moving, hsi.predict("MF", BRIDGE, traffic, timepts=times).response.y) > 0.01

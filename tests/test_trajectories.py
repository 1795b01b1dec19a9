"""People who follow trajectories: against straight walkers, equations by hand, and the rows of their files."""

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
    there = BRIDGE.carries(found([0.999, 1.0, 1.5, 2.0, 2.001]))
    np.testing.assert_array_equal(there, [False, True, True, True, False])


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


def test_stays_are_found_however_often_rounding_meets_an_edge() -> None:
    """Pacing along the edge and across it by what rounding leaves; every instant on the deck belongs to a stay."""
    rng = np.random.default_rng(1)
    times, x = np.arange(0.0, 100.0, 0.5), np.linspace(0.0, 50.0, 200)
    for size in (1e-16, 1e-12, 1e-9, 1e-6, 1e-2):
        whole = hsi.Trajectory(times, x, 1.5 + size * rng.choice([-1, 0, 1], size=200))
        stays, asked = whole.stays_on(BRIDGE), np.linspace(0.0, 99.5, 4001)
        held = np.any([(asked >= one.arrival - 1e-5) & (asked <= one.departure + 1e-5) for one in stays], axis=0)
        y = whole(asked)[:, 1]
        assert np.all(held[y < 1.5 - 2e-9])
        assert not np.any(held[y > 1.5 + size / 2 + 2e-9])
        assert all(np.all(BRIDGE.carries(one(one.times))) for one in stays)


def test_whoever_ends_a_rounding_error_beyond_the_deck_has_walked_to_its_end() -> None:
    for seed in range(20):
        rng = np.random.default_rng(seed)
        times, x = np.cumsum(rng.uniform(0.2, 1.0, 5)), np.append(rng.uniform(0.01, 1.5, 4), -1e-17)
        [stay] = hsi.Trajectory(times, x).stays_on(BRIDGE)
        assert (stay.arrival, stay.departure) == (times[0], pytest.approx(times[-1], rel=1e-9))


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
                         max_step=0.1, t_eval=np.unique([*asked, stop]))
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
    times = np.linspace(0.0, 1.5, 76)
    people = [WANDERERS[0], WANDERERS[4]]
    system = hsi.moving_crowd(TWISTING, hsi.Traffic(people)).to_nlsys(sense_at=[(25.0, 0.0), (10.0, 1.5)])
    ours = ct.input_output_response(system, times, np.zeros((1, len(times))), squeeze=False, solve_ivp_method="DOP853",
                                    solve_ivp_kwargs={"rtol": 1e-7, "atol": 1e-11, "max_step": 0.05}).outputs
    assert apart(ours, by_hand(people, times)) < 1e-5


def test_moving_forces_follow_trajectories() -> None:
    """The modal force written out, for people who come and go at the end of the deck, where forces begin smoothly;
    and the host's `forced_response` of the empty bridge."""
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


def test_whoever_appears_where_two_steps_meet_is_not_lost_between_them() -> None:
    """In the middle of the deck, at 3 s: steps from −3 s on end a rounding error before and begin one after."""
    there = walker(force=SILENT, trajectory=hsi.Trajectory([3.0, 25.0], [24.0, 24.0]))
    crowd = hsi.moving_crowd(BRIDGE, hsi.Traffic([walker(speed=1.6, arrival=-3.0), there]))
    times = np.linspace(-3.0, 10.0, 1301)
    coarse, fine = (hsi.simulate(crowd, times, step=step) for step in (0.01, 0.000625))
    assert apart(coarse.response.y, fine.response.y) < 2 * coarse.error < 1e-5


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
    assert apart(moving.response.y, standing.response.y) < 1e-4


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


# columns, units, step frequencies

TABLE = {"id": [1, 1, 1, 2, 2], "time": [0.0, 20.0, 40.0, 3.0, 33.0], "x": [0.0, 25.0, 50.0, 12.0, 12.0],
         "y": [0.5, 0.5, 0.5, -1.0, -1.0]}
TEXT = "#framerate: 10.00\n#ID FR X Y Z, {unit}\n1 0 {a} 0 1.7\n2 0 {b} 0 1.7\n1 400 {c} 0 1.7\n2 400 {b} 0 1.7\n"


class Frame:
    """What a data frame is to us: columns, and a column by its name."""

    columns = tuple(TABLE)

    def __getitem__(self, name: str) -> list[float]:
        return TABLE[name]


def test_tables_in_memory_are_read_by_the_names_of_their_columns() -> None:
    structured = np.array(list(zip(*TABLE.values(), strict=True)), dtype=[(name, float) for name in TABLE])
    frames = {name: column for name, column in TABLE.items() if name != "time"} | {
        "frame": [10 * time for time in TABLE["time"]]}
    backwards = {name: column[::-1] for name, column in TABLE.items()}
    for table, given in ((TABLE, {}), (structured, {}), (Frame(), {}), (backwards, {}), (frames, {"frame_rate": 10.0})):
        walkers = read(table, **given).walkers
        np.testing.assert_allclose(walkers.places(13.0), [[16.25, 0.5], [12.0, -1.0]], rtol=1e-12)
        np.testing.assert_allclose(walkers.departure(50.0), [40.0, 33.0], rtol=1e-12)


@pytest.mark.parametrize(("head", "scale"), [
    ("in m", 1), ("in metres", 1), ("in meters", 1), ("in cm", 100), ("id frame x/cm y/cm z/cm", 100), ("X/M", 1)])
def test_text_tells_its_unit_as_pedpy_reads_it(head: str, scale: int, tmp_path: Path) -> None:
    path = tmp_path / "walk.csv"
    path.write_text(TEXT.format(unit=head, a=0, b=25 * scale, c=50 * scale), encoding="utf-8-sig")
    np.testing.assert_allclose(read(path).walkers.places(20.0), [[25.0, 0.0], [25.0, 0.0]], rtol=1e-12)


def test_step_frequencies_follow_from_speeds() -> None:
    """By hand: 0.35 · 1.25³ − 1.59 · 1.25² + 2.93 · 1.25 = 1.86172 Hz; who stands has no force, and their mean."""
    walkers = read(TABLE).walkers
    np.testing.assert_allclose(walkers.step_frequency, 1.86171875, rtol=1e-12)
    assert float(hsi.preferred_step_frequency(1.25)) == pytest.approx(1.86171875, rel=1e-12)
    assert walkers[1].force == SILENT
    assert isinstance(walkers[0].force, hsi.ZivanovicForce)
    assert np.all(np.diff(hsi.preferred_step_frequency(np.linspace(0, 10, 1001))) > 0)


def test_step_frequencies_are_told() -> None:
    np.testing.assert_array_equal(read(TABLE, step_frequency=2.1).walkers.step_frequency, 2.1)
    told = TABLE | {"steps": [1.7, 1.7, 1.7, 2.2, 2.2]}
    np.testing.assert_array_equal(read(told, step_frequency="steps").walkers.step_frequency, 1.7)
    everybody = read(told, step_frequency="steps", still=0.0).walkers
    np.testing.assert_array_equal(everybody.step_frequency, [1.7, 2.2])
    assert everybody[1].force == everybody[0].force


def test_bodies_stand_or_walk_and_belong_to_persons() -> None:
    """Whoever leaves the deck and comes again has the same body and the same force."""
    table = {"id": [5] * 4 + [7] * 2, "time": [0.0, 20.0, 40.0, 60.0, 0.0, 60.0],
             "x": [10.0, -10.0, 10.0, 10.0 + 20.0, 30.0, 30.0], "y": [0.0] * 6}
    walkers = read(table, population=hsi.Population(frequency=(3.0, 0.1), damping=0.3),
                   standing_population=hsi.Population(frequency=(6.0, 0.1), damping=0.4)).walkers
    assert len(walkers) == 3
    assert walkers.bodies.frequency[0] == walkers.bodies.frequency[1] != 3.0
    assert abs(walkers.bodies.frequency[2] - 6.0) < 1.0
    assert walkers.bodies.damping.tolist() == [0.3, 0.3, 0.4]
    np.testing.assert_array_equal(walkers.draws[0][0], walkers.draws[0][1])


def test_whoever_never_comes_on_the_deck_or_is_seen_once_is_left_out() -> None:
    more = {"id": [8, 8, 9], "time": [0.0, 40.0, 5.0], "x": [10.0, 20.0, 10.0], "y": [5.0, 5.0, 0.0]}
    assert len(read({name: TABLE[name] + more[name] for name in TABLE}).walkers) == 2


# refusals

def sqlite(path: Path, *statements: str) -> Path:
    path.unlink(missing_ok=True)
    with closing(sqlite3.connect(path)) as file, file:
        for statement in statements:
            file.execute(statement)
    return path


def text(path: Path, content: str) -> Path:
    path.write_text(content, encoding="utf-8")
    return path


DATA = "CREATE TABLE trajectory_data (frame, id, pos_x, pos_y, ori_x, ori_y)"
META = "CREATE TABLE metadata (key TEXT, value TEXT)"
FPS = "INSERT INTO metadata VALUES ('fps', '10')"
HEAD = "# framerate: 10\n# id frame x/m y/m\n"


@pytest.mark.parametrize(("statements", "message"), [
    (["CREATE TABLE other (a)"], r"must have a column 'id', got none; add it"),
    ([DATA], "must be one of JuPedSim, got no such table: metadata"),
    ([DATA, META], "the frame rate must be known, got none; give frame_rate, or write fps into"),
    ([DATA, META, FPS], "table trajectory_data: the table must hold somebody, got no rows"),
    ([DATA.replace("pos_y", "py"), META, FPS], "must have a column 'pos_y', got 'frame', 'id', 'pos_x', 'py'"),
    ([DATA, META, FPS, "INSERT INTO trajectory_data VALUES (0, 1, 1, 1, 1, 0), (1, 1, NULL, 1, 1, 0)"],
     "table trajectory_data, row 2, column x: the cell must be finite, got nan"),
    ([DATA, META, FPS, "INSERT INTO trajectory_data VALUES (0, 1, 1, 'a', 1, 0)"],
     "row 1, column pos_y: the cell must be a number, got 'a'"),
    ([DATA, META, FPS.replace("10", "0")], "the frame rate must be a number above 0, got '0'"),
])
def test_files_of_jupedsim_that_are_refused(statements: list[str], message: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=message):
        hsi.Traffic.from_trajectories(sqlite(tmp_path / "a.db", *statements), BRIDGE, rng=np.random.default_rng(1))


@pytest.mark.parametrize(("content", "message"), [
    ("", "a.dat: the frame rate must be known"),
    (HEAD, "a.dat: the table must hold somebody, got no rows; give the SQLite file of JuPedSim, or text"),
    ("# id frame x/m y/m\n1 0 1 1", "the frame rate must be known, got none; give frame_rate, or add a line '# framer"),
    ("# framerate: 12,5\n# in m\n1 0 1 1", "the frame rate must be a number above 0, got '12,5'"),
    ("# framerate: fast\n# in m\n1 0 1 1", "the frame rate must be a number above 0, got 'fast'"),
    ("# framerate: 10\n1 0 1 1", "the unit of x and y must be told once, as m or cm, got none; add a line '# id frame"),
    ("# framerate: 10\n# x/mm y/mm\n1 0 1 1", "the unit of x and y must be told once, as m or cm, got none"),
    (HEAD + "1 0 1", r"a.dat, row 3: a row must hold id, frame, x and y between blanks, got 3 cell\(s\)"),
    (HEAD + "1 0 1 1\n\n1 1 1.2 oh", "a.dat, row 5, column y: the cell must be a number, got 'oh'"),
    (HEAD + "1 0 1 1\n1 1 nan 1", "a.dat, row 4, column x: the cell must be finite, got nan"),
    (HEAD + "1 0 1 1\n2 0 1 1\n1 0 2 1", "a.dat, row 5, column id: nobody can be recorded twice at a time, got person "
     "1 at 0 s in row 3, too"),
    (HEAD + "1 0 1 1\n1 1 90 1", "a.dat, person 1: a trajectory must go at most 10 m/s, got 890 m/s from 0 to 0.1 s"),
    (HEAD + "1 0 100 1\n1 10 101 9", r"a.dat: somebody must come on the deck, 0 ≤ x ≤ 50 and \|y\| ≤ 1.5 m, got x from "
     "100 to 101 m and y from 1 to 9 m; give origin and angle"),
    (HEAD + "1 0 1 1\n1 100 31 1", "person 1: step_frequency must lie in .* got 3.93; it follows from 3 m/s; give"),
])
def test_texts_that_are_refused(content: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=message):
        hsi.Traffic.from_trajectories(text(tmp_path / "a.dat", content), BRIDGE, rng=np.random.default_rng(1))


def test_files_that_are_neither_are_refused(tmp_path: Path) -> None:
    (tmp_path / "picture.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    with pytest.raises(ValueError, match=r"picture\.png: the file must be SQLite or text in UTF-8, got neither; give"):
        read(tmp_path / "picture.png")


def column(**changes) -> dict:
    return TABLE | changes


LEAVING = hsi.Traffic([walker(trajectory=hsi.Trajectory([0.0, 60.0], [0.0, 60.0]))])


@pytest.mark.parametrize(("call", "message"), [
    (lambda: read("no such file"), "no such file: the trajectories must be a file that can be read, got No such file"),
    (lambda: read(np.zeros((3, 4))), "table must be a file, or have columns by name, got ndarray; give the name"),
    (lambda: read({"id": [1], "x": [1.0], "y": [0.0]}), "must have a column 'time' or 'frame', got 'id', 'x', 'y'"),
    (lambda: read({"time": [1], "x": [1.0], "y": [0.0]}), "table: the table must have a column 'id'"),
    (lambda: read(column(x=[0.0])), "the columns must have the same length, got {'id': 5, 'time': 5, 'x': 1, 'y': 5}"),
    (lambda: read(column(id=["anna"] * 5)), "table, row 0, column id: the cell must be a number, got 'anna'"),
    (lambda: read(column(time=np.array(TABLE["time"]).astype("timedelta64[ns]"))),
     r"table, column time: the cells must be plain numbers, got timedelta64\[ns\]; give seconds"),
    (lambda: read(column(time=np.array(TABLE["time"]).astype("datetime64[s]"))), "column time: .* got datetime64"),
    (lambda: read(TABLE, frame_rate=10.0), "frame_rate must be left out where the table has a column 'time'"),
    (lambda: read(ROOT / "examples" / "filmed.txt", frame_rate=25.0), "filmed.txt, 1 Hz, got 25 Hz; leave it out"),
    (lambda: read(TABLE, frame_rate=0.0), "frame_rate must be above 0"),
    (lambda: read(TABLE, origin=3.0), r"origin must have 1 dimension\(s\)"),
    (lambda: read(TABLE, origin=(1.0, 2.0, 3.0)), r"origin must be \(x, y\), got 3 number\(s\)"),
    (lambda: read(TABLE, angle="north"), "angle must be real numbers, got 'north'; give rad"),
    (lambda: read(TABLE, still=-1.0), "still must be at least 0, got -1"),
    (lambda: read(TABLE, still=0.0), "table, person 2: step_frequency must lie in .* follows from 0 m/s; give"),
    (lambda: read(TABLE, step_frequency=9.0), r"step_frequency must lie in \[0.5, 3.5\], got 9"),
    (lambda: read(TABLE, step_frequency="pace"), "step_frequency must name a column, one of .*, got 'pace'"),
    (lambda: read(column(pace=[2.0, 2.0, 1.9, 2.0, 2.0]), step_frequency="pace"),
     "table, row 2, column pace: a person must keep one step frequency, got 1.9 after 2.0; give the mean"),
    (lambda: read(TABLE, weight=[700.0, 800.0]), r"weight must be one number, got an array of shape \(2,\); give N"),
    (lambda: read(TABLE, rng=1), "rng must be of type Generator, got int"),
    (lambda: read(TABLE, bridge="bridge"), "bridge must be of type Footbridge, got str"),
    (lambda: read(TABLE, force="jump"), "force must be of type WalkingForce, got str"),
    (lambda: read(TABLE, population="all"), "population must be of type Population, got str"),
    (lambda: hsi.Trajectory([0.0], [1.0]), r"times must hold at least 2 number\(s\), got 1"),
    (lambda: hsi.Trajectory([0.0, 0.0], [1.0, 2.0]), "times must increase, got 0 and then 0; give seconds"),
    (lambda: hsi.Trajectory([0.0, 1.0], [1.0]), "times, x and y must have the same length, got 2, 1 and 2"),
    (lambda: hsi.Trajectory([0.0, 1.0], [1.0, np.nan]), r"x\[1\] must be finite, got nan"),
    (lambda: hsi.Trajectory([0.0, 1.0], [0.0, 11.0]), "a trajectory must go at most 10 m/s, got 11 m/s from 0 to 1 s"),
    (lambda: hsi.Trajectory([0.0, 9.0], [1.0, 2.0]).stays_on("bridge"), "bridge must be of type Footbridge, got str"),
    (lambda: walker(), "speed must be real numbers, got None; give m/s, at most 10"),
    (lambda: walker(speed=1.2, trajectory=wandering(0, 0.0, 9.0)), "speed must be left to the trajectory, got 1.2"),
    (lambda: walker(arrival=3.0, trajectory=wandering(0, 0.0, 9.0)), "arrival must be left to the trajectory, got 3.0"),
    (lambda: walker(trajectory=[1.0, 2.0]), "trajectory must be of type Trajectory, got list"),
    (lambda: hsi.moving_crowd(BRIDGE, LEAVING), r"a trajectory must lie on the deck, .* got \(60, 0\) m at 60 s; cut"),
    (lambda: hsi.predict("MF", BRIDGE, LEAVING), "a trajectory must lie on the deck"),
    (lambda: LEAVING.persons_on(BRIDGE, [1.0]), "a trajectory must lie on the deck"),
    (lambda: hsi.moving_crowd(BRIDGE, hsi.Traffic([FOLLOWING]), convective=True),
     "convective terms need walkers who go straight on, got some who follow a trajectory; leave"),
    (lambda: replace(hsi.Traffic([FOLLOWING]).walkers, trajectories=None), "trajectories must be of type Sequence"),
    (lambda: replace(hsi.Traffic([FOLLOWING]).walkers, trajectories=["a"]), "trajectories must be of type Trajectory"),
    (lambda: replace(hsi.Traffic([FOLLOWING]).walkers, trajectories=[None, 1]), "must have the same length"),
])
def test_refusals(call, message: str) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        call()

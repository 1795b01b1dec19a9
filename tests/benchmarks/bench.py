"""Ours, the host's road and the ratio, in one run on one thread: `make bench`.

Nothing here passes or fails: speed is a ratio that is read, with the bar it is held against beside it. `make bench`
sets one BLAS thread, without which a busy machine gives figures that mean nothing.
"""

from __future__ import annotations

import sys
import time
import tracemalloc
from collections.abc import Iterator
from functools import partial

import control as ct
import numpy as np
from rows import Row, best, show
from scipy.optimize import linear_sum_assignment

import hsictrl as hsi
from hsictrl.prediction.forces import modal_force
from hsictrl.prediction.grid import Grid
from hsictrl.prediction.spectral import accelerations
from hsictrl.walking.lines import spline

WALKERS, POINTS, SEED = 225, 500, 1
OMEGA = 2 * np.pi * np.linspace(1.0, 6.0, POINTS)
BRIDGE = hsi.reference_bridge(frequency=2.0, damping=0.005)


def crowd(n: int, sprung_ratio: float = 0.95) -> tuple[hsi.Crowd, np.ndarray]:
    """A random crowd on the reference bridge."""
    rng = np.random.default_rng(SEED)
    people = hsi.Population(frequency=(3.25, 0.32), damping=(0.30, 0.05), sprung_ratio=sprung_ratio).sample(n, rng)
    return people, rng.uniform(0, BRIDGE.length, n)


def coupling() -> Row:
    """`couple` against `ct.interconnect` of one system per walker, without unsprung mass, which the host refuses."""
    people, places = crowd(WALKERS, sprung_ratio=1.0)
    plant = BRIDGE.ss(at=[25.0, *places], ports=("y", "v"))
    bodies = [body.ss(ports=("y", "v"), name=f"walker{k}") for k, body in enumerate(people)]
    wires = [[f"walker{k}.{port}", f"bridge.{port}[{k + 1}]"] for k in range(WALKERS) for port in ("y", "v")]
    wires += [[f"bridge.F[{k + 1}]", f"walker{k}.F"] for k in range(WALKERS)]
    ours = best(lambda: hsi.couple(BRIDGE, people, places), 20)
    theirs = best(lambda: ct.interconnect([plant, *bodies], connections=wires, inplist=["bridge.F[0]"],
                                          outlist=["bridge.y[0]"], check_unused=False), 1)
    return Row(f"couple, {WALKERS} walkers", ours, "ct.interconnect", theirs, "≥ 1000×")


def frequency_response() -> list[Row]:
    """`ct.frequency_response` of an OccupiedBridge against the plain system, and against the bare formula."""
    people, places = crowd(WALKERS)
    occupied = hsi.couple(BRIDGE, people, places)
    plain = ct.ss(occupied.A, occupied.B, occupied.C, occupied.D)
    ours = best(lambda: ct.frequency_response(occupied, OMEGA), 20)
    what = f"ct.frequency_response, {POINTS} points, {WALKERS} walkers"
    return [Row(what, ours, "plain ct.ss" + (" (slycot)" if "slycot" in sys.modules else ""),
                best(lambda: ct.frequency_response(plain, OMEGA), 1), "≥ 100×"),
            Row(what, ours, "bare array expression", best(lambda: bare_response(occupied), 20), "≥ 0.25×")]


def bare_response(occupied: hsi.OccupiedBridge) -> np.ndarray:
    """H = s²φ²/(s² + 2ξω s + ω² + s² Σφₖ² αₖ(s)), written down as it stands in the books."""
    s, people, rows = 1j * OMEGA, occupied.people, occupied.condensed.rows[:, 0]
    k, c, m1, m0 = (column[:, None] for column in (
        people.stiffness, people.damping_coefficient, people.sprung_mass, people.unsprung_mass))
    apparent = m0 + m1 * (c * s + k) / (m1 * s**2 + c * s + k)
    mode = occupied.bridge.modes[0]
    stiffness = s**2 + 2 * mode.damping * mode.omega * s + mode.omega**2 + s**2 * (rows**2 @ apparent)
    return s**2 / stiffness / mode.modal_mass


def effective() -> Row:
    """`effective` against the H-infinity norm of the host, which finds the same peak."""
    people, places = crowd(WALKERS)
    occupied = hsi.couple(BRIDGE, people, places)
    plain = ct.ss(occupied.A, occupied.B, occupied.C, occupied.D)
    return Row(f"effective, {WALKERS} walkers", best(lambda: hsi.effective(occupied), 20), "ct.norm(…, 'inf')",
               best(lambda: ct.norm(plain, "inf"), 1), "≥ 500×, ≤ 10 ms")


def reduced() -> list[Row]:
    """A crowd of order 8, what it costs to make and to bound, and `ct.forced_response` with it and with everyone."""
    people, places = crowd(WALKERS)
    small = people.reduced(order=8, bridge=BRIDGE, positions=places)
    times = np.arange(0.0, 50.0, 0.01)
    force, few, whole = np.sin(4 * np.pi * times), hsi.couple(BRIDGE, *small), hsi.couple(BRIDGE, people, places)
    making = best(lambda: people.reduced(order=8, bridge=BRIDGE, positions=places), 20)
    bounding, other = best(lambda: small.bound(BRIDGE), 20), f"crowd of order {2 * WALKERS}"
    return [Row(f"ct.forced_response, {len(times)} times, crowd of order 8", best(
                lambda: ct.forced_response(few, times, force), 5), other, best(
                lambda: ct.forced_response(whole, times, force), 3), "≥ 6×"),
            Row("poles, crowd of order 8", best(few.poles, 20), other, best(whole.poles, 3), "-"),
            Row(f"Crowd.reduced, {WALKERS} walkers to order 8", making, "-", None, "≤ 50 ms"),
            Row(f"ReducedCrowd.bound, {small.bound(BRIDGE):.0e}", bounding, "-", None, "-")]


def root_locus() -> list[Row]:
    """`root_locus` against the poles of `couple` for every number of people, dense eigenvalue problems."""
    people, random_places = crowd(WALKERS)
    return [locus_row("equal", hsi.Pedestrian(), (np.arange(WALKERS) + 0.5) * BRIDGE.length / WALKERS, 50, "≥ 1000×"),
            locus_row("random", people, random_places, 1, "-")]


def locus_row(kind: str, people: hsi.Crowd | hsi.Pedestrian, places: np.ndarray, repeats: int, bar: str) -> Row:
    start = time.perf_counter()
    dense = [hsi.couple(BRIDGE, people.part(slice(k)) if isinstance(people, hsi.Crowd) else people, places[:k]).poles()
             for k in range(WALKERS + 1)]
    theirs = time.perf_counter() - start
    locus = hsi.root_locus(BRIDGE, people, places)
    error = max(apart(poles[~np.isnan(poles)], known) for poles, known in zip(locus.poles, dense, strict=True))
    ours = best(lambda: hsi.root_locus(BRIDGE, people, places), repeats)
    return Row(f"root_locus, 0 to {WALKERS} {kind} walkers, error {error:.0e} rad/s", ours,
               f"{WALKERS + 1} times couple(…).poles()", theirs, bar)


def apart(poles: np.ndarray, known: np.ndarray) -> float:
    """Largest distance between poles, each matched to its own."""
    distances = np.abs(np.subtract.outer(poles, known))
    return float(distances[linear_sum_assignment(distances)].max())


def trial() -> list[Row]:
    """One PMC trial: 150 walkers with narrow-band forces who step on during one crossing time, and its response."""
    flow = hsi.CrowdFlow(density=1.0)
    drawn = hsi.tune("PMC", BRIDGE, flow.sample(BRIDGE, rng=np.random.default_rng(SEED)))
    walkers, start = last(drawn.walkers, flow.persons_on(BRIDGE))
    window = start, start + drawn.window[1]
    traffic = hsi.Traffic(walkers, window=window, target=drawn.target, standing=drawn.standing_on(BRIDGE))
    prediction = hsi.predict("PMC", BRIDGE, traffic)
    system, lines = prediction.system, walkers.lines()
    found = hsi.effective(system)
    decay, highest = 2 * np.pi * found.frequency * found.damping, lines[0][1].highest_frequency
    coarse = Grid.over(window, start, highest, found.frequency)
    force = modal_force(BRIDGE, walkers, lines, coarse)
    fine = Grid.at(prediction.response.time, start, highest, found.frequency)
    record = modal_force(BRIDGE, walkers, lines, fine)[0, :len(fine.times)] / BRIDGE.participation([25.0])[0, 0]
    ours = best(lambda: accelerations(system, force, coarse, decay), 20)
    theirs = best(lambda: ct.forced_response(system, fine.times, record), 3)
    whole = best(lambda: hsi.predict("PMC", BRIDGE, traffic), 20)
    n, times = len(walkers), len(fine.times)
    return [Row(f"PMC, {n} walkers, {times} times, forces given", ours, "ct.forced_response", theirs, "≥ 30×"),
            Row(f"PMC trial in all, {n} walkers, narrow-band force", whole, "-", None, "≤ 25 ms")]


def stream(n: int, force: hsi.WalkingForce) -> hsi.MovingCrowd:
    """Walkers who step on, one by one, during the 50 s in which the first of them crosses."""
    rng = np.random.default_rng(SEED)
    people, arrivals = hsi.Population.walking().sample(n, rng), np.sort(rng.uniform(0, 50, n))
    return hsi.moving_crowd(BRIDGE, hsi.Traffic([
        hsi.Walker(body=body, force=force, step_frequency=1.8, speed=1.0, arrival=float(arrival))
        for body, arrival in zip(people, arrivals, strict=True)], window=(0.0, 50.0), rng=rng))


def stepping() -> list[Row]:
    """The time-varying system, by the stepper and by `ct.input_output_response`, no further off than 1e-4 of the peak.

    Once against the equations as a user of the host would write them down for speed, under narrow-band forces that
    both read off the same tables, and once against our own `to_nlsys`, under two harmonics.
    """
    crowd, periodic = stream(WALKERS, hsi.ZivanovicForce()), stream(WALKERS, hsi.HarmonicForce([0.4, 0.1]))
    whole, synthesis = best(lambda: hsi.simulate(crowd), 15), best(lambda: tables_of(crowd), 15)
    few, many = (best(partial(hsi.simulate, stream(n, hsi.HarmonicForce([0.4]))), 15) for n in (50, 400))
    what = f"simulate, {WALKERS} walkers, 50 s"
    return [Row(f"{what}, error {error_of(crowd):.0e}, without synthesis", whole - synthesis,
                *as_good(crowd, bare_system(crowd), "a bare ct.nlsys"), "≥ 100×, ≤ 40 ms"),
            Row(f"{what}, with the synthesis of narrow-band forces", whole, "-", None, "≤ 60 ms"),
            Row(f"{what}, error {error_of(periodic):.0e}, two harmonics", best(lambda: hsi.simulate(periodic), 15),
                *as_good(periodic, periodic.to_nlsys(), "to_nlsys"), "≥ 100×, ≤ 40 ms"),
            Row("simulate, 400 walkers", many, "8 × 50 walkers", 8 * few, "≥ 0.83×")]


def exact(crowd: hsi.MovingCrowd) -> np.ndarray:
    """The response at the times of the default step, by steps an eighth as long."""
    found = hsi.simulate(crowd)
    return hsi.simulate(crowd, found.response.time, step=found.step / 8).response.outputs


def error_of(crowd: hsi.MovingCrowd) -> float:
    return away(hsi.simulate(crowd).response.outputs, exact(crowd))


def away(found: np.ndarray, reference: np.ndarray) -> float:
    """Largest difference over the window, relative to the peak."""
    return float(np.max(np.abs(found - reference)) / np.max(np.abs(reference)))


def as_good(crowd: hsi.MovingCrowd, system: ct.NonlinearIOSystem, name: str) -> tuple[str, float]:
    """The host at the loosest tolerance that keeps the error within 1e-4 of the peak: name and error, seconds."""
    times, reference = hsi.simulate(crowd).response.time, exact(crowd)
    for tolerance in 10.0 ** -np.arange(2, 9):
        start = time.perf_counter()
        found = ct.input_output_response(system, times, 0 * times, solve_ivp_kwargs={
            "rtol": tolerance, "atol": 1e-3 * tolerance})
        seconds, error = time.perf_counter() - start, away(found.outputs, reference)
        if error <= 1e-4:
            break
    return f"ct.input_output_response, {name}, {error:.0e}", seconds


def tables_of(crowd: hsi.MovingCrowd) -> tuple[np.ndarray, np.ndarray]:
    """Tables of the walking forces, and how many table points go by in a second."""
    [(_, lines)] = crowd.traffic.walkers.lines()
    tables = lines.tables()
    return tables, lines.spacing * lines.step_frequency * (tables.shape[1] - 4)


def bare_system(crowd: hsi.MovingCrowd) -> ct.NonlinearIOSystem:
    """The same equations as a host's user would write them down, vectorised over walkers."""
    walkers, mode = crowd.traffic.walkers, BRIDGE.modes[0]
    people, n = walkers.bodies, len(walkers)
    k, c, m1, m0 = people.stiffness, people.damping_coefficient, people.sprung_mass, people.unsprung_mass
    (tables, pace), square, gamma = tables_of(crowd), mode.omega**2, 2 * mode.damping * mode.omega
    flat, rows, size = tables.ravel(), tables.shape[1] * np.arange(n), tables.shape[1] - 4

    def rates(t: float, x: np.ndarray) -> np.ndarray:
        place = walkers.speed * (t - walkers.arrival) / BRIDGE.length
        phi = np.where((place >= 0) & (place <= 1), np.sin(np.pi * place), 0.0) / np.sqrt(mode.modal_mass)
        z, u, dz, du = x[0], x[1:n + 1], x[n + 1], x[n + 2:]
        contact = k * (u - phi * z) + c * (du - phi * dz)
        knot = (pace * t) % size
        first = knot.astype(np.intp)
        force = spline(*(flat[rows + first + tap] for tap in range(4)), knot - first)
        acceleration = (phi @ (contact + force) - gamma * dz - square * z) / (1 + m0 @ phi**2)
        return np.concatenate([[dz], du, [acceleration], -contact / m1])

    antinode = 1 / np.sqrt(mode.modal_mass)
    return ct.nlsys(lambda t, x, u, params: rates(t, x), lambda t, x, u, params: antinode * rates(t, x)[n + 1],
                    inputs=1, outputs=1, states=2 * (n + 1))


def memory() -> str:
    """Largest memory of a simulation before whose window as many, or ten times as many, have come and gone."""
    peaks = []
    for crossings in (1, 10):
        arrivals = np.linspace(-40.0 * crossings, 40.0, WALKERS * (crossings + 1))
        crowd = hsi.moving_crowd(BRIDGE, hsi.Traffic([
            hsi.Walker(force=hsi.HarmonicForce([0.4]), step_frequency=1.7, speed=1.25, arrival=float(arrival))
            for arrival in arrivals], window=(0.0, 40.0)))
        tracemalloc.start()
        hsi.simulate(crowd)
        peaks.append(f"{len(arrivals)} walkers {tracemalloc.get_traced_memory()[1] / 2**20:.1f} MB")
        tracemalloc.stop()
    return f"memory of simulate, {WALKERS} walkers on the deck, a 40-s window at its end: {', '.join(peaks)}"


def last(walkers: hsi.Walkers, n: int) -> tuple[hsi.Walkers, float]:
    """The last n to arrive, and when the first of them does [s]."""
    kept = walkers.part(slice(-n, None))
    return kept, float(kept.arrival[0])


def rows() -> Iterator[Row]:
    yield coupling()
    yield from frequency_response()
    yield effective()
    yield from reduced()
    yield from root_locus()
    yield from trial()
    yield from stepping()


if __name__ == "__main__":
    show("systems", "one thread, one run, medians", rows, memory)

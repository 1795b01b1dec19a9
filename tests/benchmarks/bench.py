"""Ours, the host's road and the ratio, in one run on one thread: `make bench`.

Nothing here passes or fails: speed is a ratio that is read, with the bar it is held against beside it. `make bench`
sets one BLAS thread, without which a busy machine gives figures that mean nothing.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import control as ct
import numpy as np
from rich.console import Console
from rich.table import Table

import hsictrl as hsi
from hsictrl.prediction.forces import modal_force
from hsictrl.prediction.grid import Grid
from hsictrl.prediction.spectral import accelerations

WALKERS, POINTS, SEED = 225, 500, 1
OMEGA = 2 * np.pi * np.linspace(1.0, 6.0, POINTS)
BRIDGE = hsi.reference_bridge(frequency=2.0, damping=0.005)


@dataclass(frozen=True)
class Row:
    """One comparison: seconds of ours, seconds of the other road, and what was asked for."""

    what: str
    ours: float
    other: str
    theirs: float | None
    bar: str


def best(run: Callable[[], object], repeats: int) -> float:
    """Median time of several runs [s]; a first run warms caches up."""
    if repeats > 1:
        run()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return float(np.median(times))


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


def last(walkers: hsi.Walkers, n: int) -> tuple[hsi.Walkers, float]:
    """The last n to arrive, and when the first of them does [s]."""
    kept = walkers.part(slice(-n, None))
    return kept, float(kept.arrival[0])


def main() -> None:
    """Print the table."""
    if os.environ.get("OPENBLAS_NUM_THREADS") != "1":
        sys.exit("OPENBLAS_NUM_THREADS must be 1, so that one thread is compared with one; use make bench")
    table = Table("what", "ours, ms", "other road", "ms", "ratio", "bar", title="one thread, one run, medians")
    for row in [coupling(), *frequency_response(), effective(), *trial()]:
        compared = row.theirs is not None
        theirs, ratio = (f"{1e3 * row.theirs:.1f}", f"{row.theirs / row.ours:.3g}×") if compared else ("-", "-")
        table.add_row(row.what, f"{1e3 * row.ours:.2f}", row.other, theirs, ratio, row.bar)
    Console(width=130).print(table)


if __name__ == "__main__":
    main()

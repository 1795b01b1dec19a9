"""Studies: two processes against one, what a trial costs beside itself, how long the paper's maps take: `make bench`.

What takes long is timed on a sample, told in its row, and extrapolated to the whole: linearly between the densities
and frequencies of the sample, whose ends are those of the grid.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from functools import partial
from itertools import product
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from rows import Row, best, seconds_of, show
from scipy.interpolate import RegularGridInterpolator

import hsictrl as hsi
from hsictrl.assessment import PeakTrial
from hsictrl.cli.workers import workers
from hsictrl.paper.maps import DAMPINGS, DENSITIES, GRIDS
from hsictrl.prediction import predict_tuned, tuned_peaks

SEED = 1
GRID = GRIDS["coarse"]
SOME_DENSITIES, SOME_FREQUENCIES = (0.2, 0.8, 1.5), (1.0, 1.5, 2.0, 3.25, 4.5, 6.0)
SAMPLE = f"{len(SOME_DENSITIES)} densities × {len(SOME_FREQUENCIES)} frequencies"
ENDLESS = hsi.PercentileRule(tolerance=1e-9)        # nothing settles to this: as many trials as are asked for
NOTHING = np.random.Generator.random                # a trial that costs nothing


def study(trial: Callable[[np.random.Generator], Any], trials: int, executor: Executor | None = None,
          ledger: hsi.Ledger | None = None) -> hsi.Ensemble:
    """A study of so many trials."""
    return hsi.monte_carlo(trial, rule=ENDLESS, seed=SEED, max_trials=trials, executor=executor, ledger=ledger)


def efficiency(two: Executor, trials: int = 400, repeats: int = 3) -> Row:
    """Two processes against half the time in place, in turns: the ratio is the parallel efficiency."""
    peak = PeakTrial(model="PMC", bridge=hsi.reference_bridge(frequency=2.0, damping=0.005),
                     flow=hsi.CrowdFlow(density=1.0))
    roads = [partial(study, peak, trials, two), partial(study, peak, trials)]
    study(peak, trials, two), study(peak, 10)       # loads the workers, and compiles in place
    ours, in_place = np.median([[seconds_of(road) for road in roads] for _ in range(repeats)], axis=0)
    return Row(f"{trials} PMC trials, 150 walkers, in 2 processes", ours, "half the time in place", in_place / 2,
               "≥ 0.85×")


def overhead(two: Executor, trials: int = 5000) -> list[Row]:
    """Seconds of a study per trial, where the trial itself costs nothing, against a loop over the same trials."""
    bare = best(lambda: [NOTHING(hsi.trial_rng(SEED, i)) for i in range(trials)], 5)
    roads = {"in place": lambda: study(NOTHING, trials), "in 2 processes": lambda: study(NOTHING, trials, two),
             "in place, with a ledger": lambda: kept(trials)}
    return [Row(f"a trial that costs nothing, {where}, of {trials}", best(road, 5) / trials, "a bare loop",
                bare / trials, "-") for where, road in roads.items()]


def kept(trials: int) -> None:
    """A study with a ledger that is new."""
    with TemporaryDirectory() as folder:
        study(NOTHING, trials, ledger=hsi.Ledger(f"{folder}/study.ledger"))


def sharing(density: float = 1.0, f_b: float = 2.0) -> Row:
    """`tuned_peaks` against `predict_tuned` of each bridge and model, under the same traffic."""
    bridges, models = GRID.trial(density=density, f_b=f_b).bridges, ("MF", "PMC")
    traffic = hsi.CrowdFlow(density=density).sample(slowest(bridges), rng=np.random.default_rng(SEED))
    together, apart = (partial(road, models, bridges, traffic) for road in (tuned_peaks, one_by_one))
    error = np.max(np.abs(together() / apart() - 1))
    return Row(f"tuned_peaks, MF and PMC, {len(bridges)} bridges, density {density:g}, f_B {f_b:g} Hz, "
               f"within {error:.0e}", best(together, 10), f"{2 * len(bridges)} × predict_tuned", best(apart, 3), "-")


def slowest(bridges: Sequence[hsi.Footbridge]) -> hsi.Footbridge:
    return min(bridges, key=lambda bridge: bridge.damping[0] * bridge.omega[0])


def one_by_one(models: Sequence[str], bridges: Sequence[hsi.Footbridge], traffic: hsi.Traffic) -> np.ndarray:
    return np.array([[predict_tuned(model, bridge, traffic).peak_acceleration for bridge in bridges]
                     for model in models])


def maps(two: Executor, trials: int = 8) -> Row:
    """Figures 9 to 11 from trials: a sample of the cells, whose trials are shared out as in the study."""
    def cost(density: float, f_b: float) -> float:
        trial = GRID.trial(density=density, f_b=f_b)
        return seconds_of(lambda: study(trial, trials, two)) / trials

    cost(DENSITIES[0], GRID.frequencies[-1])        # loads the workers
    return Row(f"maps --grid coarse, {GRID.trials} trials a cell, in 2 processes, from {trials} trials at {SAMPLE}",
               GRID.trials * over_grid(cost), "-", None, "≤ 45 min")


def spectral_maps() -> Row:
    """The same maps from spectra, in place."""
    masses = GRID.masses[0], GRID.masses[-1]
    kinds, sample = (list(product(("MF", "PMC"), some, DAMPINGS)) for some in (GRID.masses, masses))

    def cost(density: float, f_b: float) -> float:
        return seconds_of(lambda: [estimate(*kind, density, f_b) for kind in sample]) / len(sample)

    cost(DENSITIES[0], GRID.frequencies[-1])        # warms caches up
    return Row(f"the same by spectral_estimate, in place, from {len(masses)} of {len(GRID.masses)} masses at {SAMPLE}",
               len(kinds) * over_grid(cost), "-", None, "≤ 60 s")


def estimate(model: str, mass: float, damping: float, density: float, f_b: float) -> hsi.SpectralEstimate:
    bridge = hsi.reference_bridge(frequency=f_b, damping=damping, modal_mass=mass)
    return hsi.spectral_estimate(model, bridge, hsi.CrowdFlow(density=density))


def over_grid(cost: Callable[[float, float], float]) -> float:
    """A cost summed over densities and frequencies of the grid, interpolated between those of the sample."""
    sample = [[cost(density, f_b) for f_b in SOME_FREQUENCIES] for density in SOME_DENSITIES]
    interpolated = RegularGridInterpolator((SOME_DENSITIES, SOME_FREQUENCIES), sample)
    return float(np.sum(interpolated(list(product(DENSITIES, GRID.frequencies)))))


def rows() -> Iterator[Row]:
    with workers(2) as two:
        yield efficiency(two)
        yield from overhead(two)
        yield maps(two)
    yield spectral_maps()
    yield sharing()


if __name__ == "__main__":
    show("studies", "studies, one thread in each process, one run, medians or extrapolated", rows)

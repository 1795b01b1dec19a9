"""Which reading of what the paper leaves open comes closest to its table 2, and by how much."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import Any, final

import numpy as np

from hsictrl._checks import Array
from hsictrl.paper.cells import CELLS, DEFAULT, Cell, Reading, SharedTrafficTrial
from hsictrl.paper.intervals import Interval, ratio
from hsictrl.paper.reports import Report, Rows, Run, committed, rounded
from hsictrl.paper.table2 import SEED, printed
from hsictrl.prediction import MODELS
from hsictrl.study import Ensemble, Ledger, PercentileRule, monte_carlo

TRIALS = 48
NEVER = PercentileRule(tolerance=1e-12)    # no percentile settles to that: all readings get the same trials
READINGS = (
    DEFAULT,
    *(Reading(name=f"ξ_B {100 * damping:g} %", damping=damping) for damping in (0.002, 0.01, 0.02)),
    *(Reading(name=f"m_B {mass / 1e3:g} t", modal_mass=mass) for mass in (20e3, 50e3)),
    Reading(name="ξ_B 1 %, m_B 50 t", damping=0.01, modal_mass=50e3),
    Reading(name="no warm-up", warm_up=0.0),
    Reading(name="all tuned to f_B", tuned_to="empty"),
)
COMPARED = tuple(model for model in MODELS if model != "MC")
COLUMNS = ["reading", "trials", "median_deviation", "worst_deviation", "worst", "contained",
           *(f"median_{model.lower()}" for model in COMPARED)]


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Compared:
    """A ratio to MC, and the printed one.

    Parameters
    ----------
    cell : Cell
        Bridge and crowd.
    model : str
        Which model is divided by MC.
    ratio : Interval
        As computed [-].
    printed : float
        As printed [-].
    """

    cell: Cell
    model: str
    ratio: Interval
    printed: float

    @property
    def deviation(self) -> float:
        """Of the ratio from the printed one, relative to the latter [-]."""
        return self.ratio.estimate / self.printed - 1

    @property
    def contained(self) -> bool:
        """Whether the interval of the ratio contains the printed one."""
        return self.ratio.low <= self.printed <= self.ratio.high


def report(run: Run) -> Report:
    """A row per reading, the closest first."""
    rows = study(READINGS, CELLS, run.executor, run.ledger) if run.recompute else committed("readings")
    return Report(name="readings", rows=rows, columns=COLUMNS, study=True, caption=(
        "Readings of section 4.1 beside table 2, each changing what its name says of the default (ξ_B "
        f"{100 * DEFAULT.damping:g} %, m_B {DEFAULT.modal_mass / 1e3:g} t, warm-up max(T, 5/(ξω)), each model tuned "
        f"to its own resonance): median and worst deviation of the {len(CELLS) * len(COMPARED)} ratios to MC, "
        "relative to the printed ones; contained: how many 95 % intervals contain the printed ratio; median_*: of one "
        "model alone; same random streams for all"))


def study(
    readings: Sequence[Reading], cells: Sequence[Cell], executor: Executor | None = None, ledger: Ledger | None = None,
    *, trials: int = TRIALS,
) -> Rows:
    """Run the same trials for all readings."""
    run_trials = partial(monte_carlo, rule=NEVER, seed=SEED, executor=executor, max_trials=trials, ledger=ledger)
    rows = [_row(reading, [one for cell in cells for one in _compared(reading, cell, run_trials)], trials)
            for reading in readings]
    return sorted(rows, key=lambda row: row["median_deviation"])


def _row(reading: Reading, compared: list[Compared], trials: int) -> dict[str, Any]:
    """How far one reading is from the printed table."""
    worst = max(compared, key=lambda one: abs(one.deviation))
    return {"reading": reading.name, "xi_b": reading.damping, "m_b_kg": reading.modal_mass,
            "warm_up_s": reading.warm_up, "tuned_to": reading.tuned_to, "trials": trials,
            "median_deviation": _median(compared), "worst_deviation": rounded(worst.deviation),
            "worst": f"{worst.model}, {worst.cell}", "contained": sum(one.contained for one in compared),
            "ratios": len(compared), **_medians(compared)}


def _compared(reading: Reading, cell: Cell, run_trials: Callable[..., Ensemble]) -> list[Compared]:
    """The ratios of one cell."""
    ensemble = run_trials(SharedTrafficTrial(cell=cell, reading=reading), label=f"readings, {reading.name}, {cell}")
    peaks: dict[str, Array] = dict(zip(MODELS, ensemble.samples.T, strict=True))
    return [Compared(cell=cell, model=model, ratio=ratio(peaks[model], peaks["MC"]), printed=printed(cell, model)[1])
            for model in COMPARED]


def _medians(compared: list[Compared]) -> dict[str, float]:
    """Median of each model."""
    return {f"median_{model.lower()}": _median([one for one in compared if one.model == model]) for model in COMPARED}


def _median(compared: list[Compared]) -> float:
    return rounded(float(np.median([abs(one.deviation) for one in compared])))

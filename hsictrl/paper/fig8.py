"""Figure 8: what inter- and intra-person variability do to the response (section 4.1)."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from copy import deepcopy
from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np

from hsictrl._checks import Array
from hsictrl.crowd import Traffic
from hsictrl.paper.cells import CELLS, DEFAULT, DENSITIES, FREQUENCIES, SPREADS, Cell
from hsictrl.paper.intervals import Interval, percentile, ratio
from hsictrl.paper.reports import Report, Rows, Run, committed
from hsictrl.paper.studies import study_each
from hsictrl.paper.table2 import cell_of
from hsictrl.prediction import predict_tuned
from hsictrl.study import Ensemble, Ledger, PercentileRule
from hsictrl.walking import WalkingForce, YoungForce, ZivanovicForce

FORCES: dict[str, WalkingForce] = {
    "narrow band": ZivanovicForce(), "Young": YoungForce(), "periodic": ZivanovicForce().periodic()}
MODELS = ("MF", "PMC")      # without and with interaction; the paper does not say which model is the latter
CONDITIONS = [(model, force) for model in MODELS for force in FORCES]
DRAWN = {"without interaction (MF)": ("MF", "narrow band"), "MF, Young's force": ("MF", "Young"),
         "with interaction (PMC)": ("PMC", "narrow band"), "PMC, Young's force": ("PMC", "Young")}
SEED, MAX_TRIALS = 8, 3000
RULE = PercentileRule(tolerance=0.1)      # the ratios, which are paired, settle sooner
COLUMNS = ["density_per_m2", "case", "f_b_hz", "model", "force", "a95_m_per_s2", "a95_low_m_per_s2",
           "a95_high_m_per_s2", "ratio", "ratio_low", "ratio_high", "trials", "settled"]


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class ForcesTrial:
    """A trial: the same people with and without intra-person variability, on the bridge with and without interaction.

    Parameters
    ----------
    cell : Cell
        Bridge and crowd.

    Examples
    --------
    >>> trial = ForcesTrial(cell=Cell(frequency=2.0, density=0.2, case=1))
    >>> trial(np.random.default_rng(1)).shape       # MF and PMC under three forces each [m/s²]
    (6,)
    """

    cell: Cell

    def __call__(self, rng: np.random.Generator) -> Array:
        bridge, traffic = DEFAULT.bridge(self.cell.frequency), self.traffic(rng)
        return np.array([predict_tuned(model, bridge, traffic[force]).peak_acceleration for model, force in CONDITIONS])

    def traffic(self, rng: np.random.Generator) -> dict[str, Traffic]:
        """The same arrivals, step frequencies and bodies under each force, from copies of one generator."""
        bridge = DEFAULT.bridge(self.cell.frequency)
        return {name: self.cell.flow.sample(bridge, rng=deepcopy(rng), force=force) for name, force in FORCES.items()}


def report(run: Run) -> Report:
    """Twelve cells, two models, three forces."""
    rows = study(CELLS, run.executor, run.ledger) if run.recompute else committed("fig8")
    return Report(name="fig8", rows=rows, columns=COLUMNS, draw=lambda: _draw(rows), study=True, caption=(
        f"Fig. 8: a95 of the peak acceleration, ξ_B {100 * DEFAULT.damping:g} %, m_B {DEFAULT.modal_mass:g} kg, for "
        "the narrow-band force, for Young's periodic force (white in the figure), and for the walkers of the "
        "narrow-band force with all steps alike (periodic); ratio: over that of the narrow-band force, 95 % interval "
        f"by a paired bootstrap; trials run until all six a95 have settled to ±{100 * RULE.tolerance:g} %, at most "
        f"{MAX_TRIALS}"))


def study(
    cells: Sequence[Cell], executor: Executor | None = None, ledger: Ledger | None = None, *,
    max_trials: int = MAX_TRIALS,
) -> Rows:
    """Run the trials of some cells."""
    return study_each(cells, lambda cell: ForcesTrial(cell=cell), _rows, label="fig8, {}", rule=RULE, seed=SEED,
                      executor=executor, max_trials=max_trials, ledger=ledger)


def _rows(cell: Cell, ensemble: Ensemble) -> Rows:
    """One row per model and force."""
    peaks = dict(zip(CONDITIONS, ensemble.samples.T, strict=True))
    return [{"density_per_m2": cell.density, "case": cell.case, "f_b_hz": cell.frequency, "model": model,
             "force": force, **percentile(peaks[model, force]).row("a95", "_m_per_s2"),
             **ratio(peaks[model, force], peaks[model, "narrow band"]).row("ratio"),
             "trials": ensemble.n_trials, "settled": ensemble.converged} for model, force in CONDITIONS]


def found(rows: Rows, model: str, force: str, name: str = "ratio", unit: str = "") -> dict[Cell, Interval]:
    """One quantity of one model under one force in all cells."""
    return {cell_of(row): Interval.of(row, name, unit) for row in rows
            if (row["model"], row["force"]) == (model, force)}


def _draw(rows: Rows) -> ct.ControlPlot:
    from hsictrl import plots
    bars = {label: found(rows, *condition, "a95", "_m_per_s2") for label, condition in DRAWN.items()}
    return plots.bars_plot({f"{f_b:g} Hz, {density:g} persons/m²": _groups(bars, f_b, density)
                            for density in DENSITIES for f_b in FREQUENCIES},
                           quantity=r"$\ddot{u}_\mathrm{max95}$ [m/s²]", columns=len(FREQUENCIES))


def _groups(bars: dict[str, dict[Cell, Interval]], frequency: float, density: float) -> dict[str, dict[str, Any]]:
    """Bars of both cases."""
    return {f"case {case}": {label: ends[Cell(frequency=frequency, density=density, case=case)]
                             for label, ends in bars.items()} for case in SPREADS}

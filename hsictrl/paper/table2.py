"""Table 2: the five models against the moving crowd model (section 4.1)."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor

from hsictrl.paper.cells import CELLS, DEFAULT, FREQUENCIES, SPREADS, Cell, SharedTrafficTrial
from hsictrl.paper.intervals import RULE, Interval, percentile, ratio
from hsictrl.paper.reports import Report, Rows, Run, committed, rounded
from hsictrl.paper.studies import study_each
from hsictrl.prediction import ASSUMPTIONS, MODELS
from hsictrl.study import Ensemble, Ledger
from hsictrl.study.ratios import RESAMPLES

SEED, MAX_TRIALS = 2, 3000
# Δa95 [%] by density and model, f_B = 2.00, 3.25, 5.00 Hz of case 1 and then of case 2
PRINTED = {
    0.2: {"SF": "+19 +131 +158 +33 +180 +196", "MF": "+16 +109 +132 +23 +124 +135",
          "MFAM": "+15 +104 +125 +22 +117 +127", "PMC": "-5 +2 +4 +4 +5 -3", "MC": "+0 +0 +0 +0 +0 +0"},
    1.0: {"SF": "+130 +339 +368 +185 +617 +707", "MF": "+116 +303 +329 +122 +406 +465",
          "MFAM": "+87 +227 +247 +92 +305 +349", "PMC": "+1 <1 -3 +1 -1 -2", "MC": "+0 +0 +0 +0 +0 +0"}}
COLUMNS = ["density_per_m2", "case", "f_b_hz", "model", "order", "time_variant", "a95_m_per_s2", "ratio", "ratio_low",
           "ratio_high", "printed_ratio", "deviation", "trials", "settled"]


def printed(cell: Cell, model: str) -> tuple[str, float]:
    """Difference to MC as printed [%], and the ratio it stands for; "<1" leaves the sign open and counts as one."""
    place = list(SPREADS).index(cell.case) * len(FREQUENCIES) + FREQUENCIES.index(cell.frequency)
    text = PRINTED[cell.density][model].split()[place]
    return text, 1.0 if text.startswith("<") else 1 + int(text) / 100


def report(run: Run) -> Report:
    """Sixty rows: two densities, two cases, three natural frequencies, five models."""
    rows = study(CELLS, run.executor, run.ledger) if run.recompute else committed("table2")
    return Report(name="table2", rows=rows, columns=COLUMNS, study=True, caption=(
        f"Table 2: a95 of the peak acceleration, and its ratio to that of MC with a 95 % interval (paired bootstrap, "
        f"{RESAMPLES} resamples), ξ_B {100 * DEFAULT.damping:g} %, m_B {DEFAULT.modal_mass:g} kg; all models of a cell "
        f"see the same traffic, each tuned to its own resonance; trials run until all five a95 have settled to "
        f"±{100 * RULE.tolerance:g} % at {100 * RULE.confidence:g} %, at most {MAX_TRIALS}; deviation: ratio over the "
        "printed one, less one"))


def study(
    cells: Sequence[Cell], executor: Executor | None = None, ledger: Ledger | None = None, *,
    max_trials: int = MAX_TRIALS,
) -> Rows:
    """Run the trials of some cells."""
    return study_each(cells, lambda cell: SharedTrafficTrial(cell=cell), _rows, label="table2, {}", rule=RULE,
                      seed=SEED, executor=executor, max_trials=max_trials, ledger=ledger)


def _rows(cell: Cell, ensemble: Ensemble) -> Rows:
    """One row per model."""
    return [{"density_per_m2": cell.density, "case": cell.case, "f_b_hz": cell.frequency, "model": model,
             "order": ASSUMPTIONS[model].order, "time_variant": ASSUMPTIONS[model].time_variant,
             **_measured(cell, model, ensemble), "trials": ensemble.n_trials, "settled": ensemble.converged}
            for model in MODELS]


def _measured(cell: Cell, model: str, ensemble: Ensemble) -> dict[str, float | str]:
    """What one model predicts, absolutely, over MC, over MF, and beside what is printed."""
    peaks = dict(zip(MODELS, ensemble.samples.T, strict=True))
    over_mc, (text, wanted) = ratio(peaks[model], peaks["MC"]), printed(cell, model)
    return {**percentile(peaks[model]).row("a95", "_m_per_s2"), **over_mc.row("ratio"),
            "printed_percent": text, "printed_ratio": wanted, "deviation": rounded(over_mc.estimate / wanted - 1),
            **ratio(peaks[model], peaks["MF"]).row("over_mf")}


def found(rows: Rows, name: str, model: str) -> dict[Cell, Interval]:
    """One quantity of one model in all cells."""
    return {cell_of(row): Interval.of(row, name) for row in rows if row["model"] == model}


def cell_of(row: dict[str, float]) -> Cell:
    """The cell that a row is about."""
    return Cell(frequency=row["f_b_hz"], density=row["density_per_m2"], case=int(row["case"]))

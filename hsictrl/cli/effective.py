"""``hsictrl effective``: effective frequency and damping under standing crowds."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from rich.table import Table

from hsictrl import assessment
from hsictrl.bridge import Footbridge
from hsictrl.cli import options, tables
from hsictrl.cli.description import Description
from hsictrl.cli.endings import failing, refusing
from hsictrl.cli.files import checked_ledger
from hsictrl.cli.outcome import Outcome, Rows, one_form
from hsictrl.cli.tables import Column, estimate
from hsictrl.cli.workers import checked_processes, workers
from hsictrl.crowd import CrowdFlow
from hsictrl.study import Ensemble, MeanRule

QUANTITIES = (("f_eff", "_hz"), ("xi_eff", ""))
STATISTICS = (("mean", "mean"), ("p5", "5 %"), ("p95", "95 %"))


def effective(
    file: options.File = None,
    frequency: options.Frequency = None,
    damping: options.Damping = None,
    modal_mass: options.ModalMass = None,
    density: options.Densities = None,
    tolerance: options.Tolerance = 0.05,
    seed: options.Seed = None,
    processes: options.Processes = 1,
    ledger: options.LedgerFile = None,
    resume: options.Resume = False,
    as_json: options.AsJson = False,
    as_csv: options.AsCsv = False,
) -> None:
    """Effective frequency and damping with people, a row per density.

    Mean, 5 % and 95 % percentile over standing crowds, at which |H| has its peak (eq. 17).

    FILE and exit codes are those of 'hsictrl assess'.
    """
    with refusing():
        case = options.described(file, frequency=frequency, damping=damping, modal_mass=modal_mass, density=density,
                                 seed=seed)
        rule = MeanRule(tolerance=tolerance)
        one_form(as_json, as_csv)
        processes, book = checked_processes(processes), checked_ledger(ledger, resume)
    with failing(), workers(processes) as executor:
        study = partial(assessment.study_effective, case.bridge, rule=assessment.effective_rule(tolerance),
                        seed=case.seed, executor=executor, ledger=book)
        found = [study(flow) for flow in case.flows]
    rows = [_row(case.bridge, *pair) for pair in zip(case.flows, found, strict=True)]
    Outcome(
        description=case, settings={"tolerance": tolerance, "confidence": rule.confidence},
        rows=rows, table=_table(rows), notes=_notes(case, rule, found),
    ).show(as_json=as_json, as_csv=as_csv)


def _row(bridge: Footbridge, flow: CrowdFlow, ensemble: Ensemble) -> dict[str, Any]:
    """The numbers of one flow with the units in the keys."""
    ends = np.stack([ensemble.estimate, *ensemble.interval])   # estimate, low, high; quantity; statistic
    numbers = {f"{name}_{key}{end}{unit}": float(ends[i, j, k])
               for j, (name, unit) in enumerate(QUANTITIES) for k, (key, _) in enumerate(STATISTICS)
               for i, end in enumerate(("", "_low", "_high"))}
    return {"density_per_m2": flow.density_on(bridge), "persons": flow.persons_on(bridge), **numbers,
            "trials": ensemble.n_trials, "converged": ensemble.converged,
            "remarks": "" if ensemble.converged else ensemble.reason}


def _table(rows: Rows) -> Table:
    frequencies = [Column(f"f_eff {words}", "[Hz]", estimate(f"f_eff_{key}", unit="_hz", trials="trials", digits=4))
                   for key, words in STATISTICS]
    dampings = [Column(f"ξ_eff {words}", "[%]", estimate(f"xi_eff_{key}", trials="trials", scale=100.0))
                for key, words in STATISTICS]
    return tables.table([tables.FLOW, *frequencies, *dampings], rows)


def _notes(case: Description, rule: MeanRule, found: list[Ensemble]) -> list[str]:
    unsettled = [(flow, one.reason) for flow, one in zip(case.flows, found, strict=True) if not one.converged]
    lateral = [] if case.bridge.moves_vertically(0) else [
        "Remark: the first mode does not move vertically at its antinode, where people would change it the most."]
    return [*tables.case_notes(case), tables.interval_note(rule), *lateral,
            *(f"Remark on {flow}: {reason}." for flow, reason in unsettled)]

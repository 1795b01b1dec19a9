"""``hsictrl assess``: from a description to design accelerations and comfort classes."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from hsictrl import assessment
from hsictrl.cli import options, tables
from hsictrl.cli.description import Description
from hsictrl.cli.endings import failing, refusing
from hsictrl.cli.files import checked_figure, checked_ledger, whole_file
from hsictrl.cli.outcome import Outcome, Rows, one_form
from hsictrl.cli.tables import Column, estimate
from hsictrl.cli.workers import checked_processes, workers
from hsictrl.study import PercentileRule


def assess(
    file: options.File = None,
    frequency: options.Frequency = None,
    damping: options.Damping = None,
    modal_mass: options.ModalMass = None,
    density: options.Densities = None,
    percentile: options.Percentile = 95.0,
    tolerance: options.Tolerance = 0.05,
    seed: options.Seed = None,
    processes: options.Processes = 1,
    ledger: options.LedgerFile = None,
    resume: options.Resume = False,
    figure: Annotated[Path | None, typer.Option(
        metavar="FILE", help="Draw the flow with the largest acceleration: frequency responses, one history, "
                             "convergence.")] = None,
    as_json: options.AsJson = False,
    as_csv: options.AsCsv = False,
) -> None:
    """Design accelerations and comfort classes, a row per density.

    Each without and with human-structure interaction, beside the effective frequency and damping of the bridge.

    \b
    A description; any of its tables may be left out:
        seed = 1
        [bridge]
        kind = "simply_supported"     # or "beam" with spans = […], "csv", "reference"
        length = 50.0                 # m
        width = 3.0                   # m
        mass = 50e3                   # kg
        frequency = 2.0               # Hz
        damping = 0.005               # a fraction
        [traffic]
        density = [0.2, 1.0]          # persons/m²; or persons = 15
        [force]
        model = "zivanovic"           # or "young", or "harmonic" with factors = […]

    Exit code: 0 when it worked, also where an estimate has not settled, which a remark below the table says;
    1 when a trial failed; 2 for bad input; 130 when interrupted.
    """
    with refusing():
        case = options.described(file, frequency=frequency, damping=damping, modal_mass=modal_mass, density=density,
                                 seed=seed)
        rule = PercentileRule(percentile=percentile, tolerance=tolerance)
        one_form(as_json, as_csv)
        processes, book = checked_processes(processes), checked_ledger(ledger, resume)
        figure = None if figure is None else checked_figure(figure)
        _rehearse(case)
    with failing(), workers(processes) as executor:
        study = partial(assessment.assess, case.bridge, force=case.force, rule=rule, seed=case.seed, executor=executor,
                        ledger=book)
        found = [study(flow) for flow in case.flows]
    if figure is not None:
        _draw(figure, found, case)
    rows = [one.to_dict() for one in found]
    Outcome(
        description=case, settings={"percentile": percentile, "tolerance": tolerance, "confidence": rule.confidence},
        rows=rows, table=_table(rows, rule), notes=_notes(case, rule, found),
    ).show(as_json=as_json, as_csv=as_csv)


def _rehearse(case: Description) -> None:
    """Ask what refuses a flow once, before the long work."""
    for flow in case.flows:
        assessment.check_assessable(case.bridge, flow)


def _draw(path: Path, found: list[assessment.Assessment], case: Description) -> None:
    from hsictrl.cli.figure import draw  # only now: it loads matplotlib

    largest = max(found, key=lambda one: one.pmc.estimate)
    with whole_file(path) as draft:
        draw(draft, largest, case)


def _table(rows: Rows, rule: PercentileRule) -> Table:
    accelerations = [Column(f"a{rule.percentile:g} {model}", "[m/s²]", estimate(
        f"a_{model.lower()}", unit="_m_per_s2", trials=f"a_{model.lower()}_trials")) for model in ("MF", "PMC")]
    return tables.table([
        tables.FLOW,
        Column("f_eff", "[Hz]", estimate("f_eff", unit="_hz", trials="effective_trials", digits=4)),
        Column("ξ_eff", "[%]", estimate("xi_eff", trials="effective_trials", scale=100.0)),
        *accelerations,
        Column("R_HSI", "[-]", estimate("r_hsi")),
        Column("comfort", "MF→PMC", lambda row: f"{row['class_mf']}→{row['class_pmc']}"),
        Column("HiVoSS", "[m/s²]", lambda row: tables.significant(row["hivoss_m_per_s2"])),
    ], rows)


def _notes(case: Description, rule: PercentileRule, found: list[assessment.Assessment]) -> list[str]:
    percentile = f"{rule.percentile:g}"
    return [
        *tables.case_notes(case),
        f"a{percentile}: percentile {percentile} of the peak acceleration. f_eff, ξ_eff: means. "
        f"{tables.interval_note(rule)}",
        "MF: moving forces on the empty bridge, without interaction. PMC: moving forces on the bridge with a standing "
        "crowd, with interaction.",
        f"R_HSI: a{percentile} MF / a{percentile} PMC (eq. 18). HiVoSS: design acceleration of the guide.",
        *(f"Remark on {one.flow}: {remark}." for one in found for remark in one.remarks)]

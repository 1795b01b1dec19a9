"""``hsictrl assess``: from a description to design accelerations and comfort classes."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from hsictrl import assessment
from hsictrl.cli import options
from hsictrl.cli.assessed import guide_rows, guide_table, notes, table
from hsictrl.cli.description import Description
from hsictrl.cli.endings import failing, refusing
from hsictrl.cli.files import checked_figure, checked_ledger, checked_report, whole_file
from hsictrl.cli.outcome import Outcome, one_form
from hsictrl.cli.workers import checked_processes, workers
from hsictrl.study import PercentileRule

ASIDE = ("processes", "ledger", "resume", "figure", "as_json", "as_csv")    # options that change no digit of a report


def assess(
    context: typer.Context,
    file: options.File = None,
    frequency: options.Frequency = None,
    damping: options.Damping = None,
    modal_mass: options.ModalMass = None,
    density: options.Densities = None,
    mode: options.Mode = 0,
    percentile: options.Percentile = 95.0,
    tolerance: options.Tolerance = 0.05,
    seed: options.Seed = None,
    processes: options.Processes = 1,
    ledger: options.LedgerFile = None,
    resume: options.Resume = False,
    figure: Annotated[Path | None, typer.Option(
        metavar="FILE", help="Draw the flow with the largest acceleration: frequency responses, one history, "
                             "convergence.")] = None,
    report: Annotated[Path | None, typer.Option(
        metavar="FILE.html", help="Write all of it, with pictures, guides and assumptions, on one page that needs "
                                  "nothing else.")] = None,
    as_json: options.AsJson = False,
    as_csv: options.AsCsv = False,
) -> None:
    """Design accelerations and comfort classes, a row per density or traffic class.

    Each without and with human-structure interaction, beside the effective frequency and damping of the bridge, and
    the load cases of HiVoSS and Sétra on every critical mode.

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
        density = [0.2, 1.0]          # persons/m²; or persons = 15, or classes = ["TC2", "TC4"]
        goal = "CL2"                  # worst comfort class that will do; or one per row
        [force]
        model = "zivanovic"           # or "young", or "harmonic" with factors = […]

    Exit code: 0 when it worked, also where an estimate has not settled or a goal is not met, which the table or a
    remark below it says; 1 when a trial failed; 2 for bad input; 130 when interrupted.
    """
    with refusing():
        case = options.described(file, frequency=frequency, damping=damping, modal_mass=modal_mass, density=density,
                                 seed=seed)
        quoted = "" if file is None else file.read_text(encoding="utf-8")
        rule = PercentileRule(percentile=percentile, tolerance=tolerance)
        one_form(as_json, as_csv)
        processes, book = checked_processes(processes), checked_ledger(ledger, resume)
        figure = None if figure is None else checked_figure(figure)
        report = None if report is None else checked_report(report)
        for flow in case.flows:
            assessment.check_assessable(case.bridge, flow, mode=mode)
    with failing(), workers(processes) as executor:
        study = partial(assessment.assess, case.bridge, force=case.force, rule=rule, mode=mode, seed=case.seed,
                        executor=executor, ledger=book)
        found = [study(flow, goal=goal) for flow, goal in case.aims]
    guides = guide_rows(found)
    Outcome(
        description=case, rows=[one.to_dict() for one in found], table=table(found, rule),
        settings={"percentile": percentile, "tolerance": tolerance, "confidence": rule.confidence, "mode": mode},
        further={"guides": (guide_table(guides), guides)}, notes=notes(case, rule, found),
    ).show(as_json=as_json, as_csv=as_csv)
    if figure is not None:
        _draw(figure, found, case)
    if report is not None:
        _report(report, found, title="the reference bridge" if file is None else file.name, description=quoted,
                command=options.as_typed(context, leave_out=ASIDE))


def _draw(path: Path, found: list[assessment.Assessment], case: Description) -> None:
    from hsictrl.cli.figure import draw  # only now: it loads matplotlib

    largest = max(found, key=lambda one: one.pmc.estimate)
    with whole_file(path) as draft:
        draw(draft, largest, case)


def _report(path: Path, found: list[assessment.Assessment], *, title: str, description: str, command: str) -> None:
    from hsictrl.report import report_page  # only now: it loads matplotlib

    page = report_page(found, title=f"Assessment of {title}", description=description, command=command)
    with whole_file(path) as draft:
        draft.write_text(page, encoding="utf-8")

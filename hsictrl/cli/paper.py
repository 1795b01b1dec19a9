"""``hsictrl paper``: tables, figures and claims of the paper."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import JustifyMethod
from rich.table import Table

from hsictrl import _checks as check
from hsictrl.cli import options
from hsictrl.cli.endings import failing, refusing
from hsictrl.cli.files import checked_folder, whole_file
from hsictrl.cli.outcome import print_json, print_table
from hsictrl.cli.tables import Column, Row, table
from hsictrl.cli.workers import checked_processes, workers

if TYPE_CHECKING:
    from hsictrl.paper import Report


def paper(
    name: Annotated[str, typer.Argument(metavar="NAME", help="table1, table2, readings, load_cycles, fig1, fig2, fig3, "
                                                             "fig4, fig8 or claims.")],
    recompute: Annotated[bool, typer.Option("--recompute", help="Compute anew, not from committed results.")] = False,
    processes: options.Processes = 1,
    output: Annotated[Path, typer.Option(metavar="FOLDER", help="Where the figure and its numbers go.")] = Path(),
    as_json: options.AsJson = False,
) -> None:
    """Tables, figures and claims of Van Nimmen et al. (2017).

    A figure is written as NAME.png; its numbers, or those of a study, as NAME.json. All numbers and claims are printed.
    "readings" compares what the paper leaves open with its table 2; "load_cycles" is SF over MF on longer spans.

    Exit code: 0 when it worked, 1 when a trial failed, 2 for bad input, 130 when interrupted.
    """
    from hsictrl import paper as results  # only now: no other command needs it

    with refusing():
        check.choice("name", name, results.names())
        processes = checked_processes(processes)
        checked_folder(output)
    with failing(), workers(processes) as executor:
        report = results.compute(name, recompute=recompute, executor=executor)
    _write(report, output)
    if as_json:
        print_json(report.rows)
    else:
        print_table(_table(report), [report.caption])


def _write(report: Report, folder: Path) -> None:
    """Write a figure, if there is one, and the numbers of a figure or study."""
    if report.draw is not None:
        from hsictrl.plots import save

        with whole_file(folder / f"{report.name}.png") as draft:
            save(report.draw(), draft)
    if report.draw is not None or report.study:
        with whole_file(folder / f"{report.name}.json") as draft:
            draft.write_text(json.dumps(report.rows, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def _table(report: Report) -> Table:
    columns = [Column(key, "", partial(_cell, key), _justify(report.rows[0][key])) for key in report.columns]
    return table(columns, report.rows)


def _justify(value: Any) -> JustifyMethod:
    return "left" if isinstance(value, str) else "right"


def _cell(key: str, row: Row) -> str:
    value = row[key]
    return f"{value:.4g}" if isinstance(value, float) else "–" if value is None else str(value)

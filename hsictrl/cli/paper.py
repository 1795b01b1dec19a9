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
from hsictrl.cli.files import checked_folder, checked_ledger, whole_file
from hsictrl.cli.outcome import print_json, print_table
from hsictrl.cli.tables import Column, Row, table
from hsictrl.cli.workers import checked_processes, workers

if TYPE_CHECKING:
    from hsictrl.paper import Report
    from hsictrl.study import Ledger


def paper(
    name: Annotated[str, typer.Argument(metavar="NAME", help="table1, table2, readings, load_cycles, fig1, fig2, fig3, "
                                                             "fig4 … fig8, maps, fig9, fig10, fig11, "
                                                             "stationary or claims.")],
    recompute: Annotated[bool, typer.Option("--recompute", help="Compute anew, not from committed results.")] = False,
    processes: options.Processes = 1,
    output: Annotated[Path, typer.Option(metavar="FOLDER", help="Where the figure and its numbers go.")] = Path(),
    ledger: Annotated[Path | None, typer.Option(
        metavar="FILE", show_default=False, help="Keep the trials of a study that runs anew in FILE "
                                                 "[default: NAME.ledger in FOLDER].")] = None,
    resume: options.Resume = False,
    grid: Annotated[str | None, typer.Option(
        metavar="coarse|paper", show_default=False, help="Cells of figures 9 to 11 [default: coarse].")] = None,
    as_json: options.AsJson = False,
) -> None:
    """Tables, figures and claims of Van Nimmen et al. (2017).

    A figure is written as NAME.png; its numbers, or those of a study, as NAME.json. All numbers and claims are printed.
    A study that runs anew keeps its trials in NAME.ledger; after it was stopped, --resume goes on with them.
    "readings" compares what the paper leaves open with its table 2; "load_cycles" is SF over MF on longer spans,
    "maps" the study behind figures 9 to 11, and "stationary" SF over MF in some of its cells.

    Exit code: 0 when it worked, 1 when a trial failed, 2 for bad input, 130 when interrupted.
    """
    from hsictrl import paper as results  # only now: no other command needs it

    with refusing():
        check.choice("name", name, results.names())
        processes = checked_processes(processes)
        checked_folder(output)
        grid = _checked_grid(name, grid, recompute)
        book = _checked_ledger(name, recompute, ledger, resume, output)
    with failing(), workers(processes) as executor:
        report = results.compute(name, recompute=recompute, executor=executor, ledger=book, grid=grid)
    _write(report, output)
    if as_json:
        print_json(report.rows)
    else:
        print_table(_table(report), [report.caption])


def _checked_grid(name: str, grid: str | None, recompute: bool) -> str:
    """Return the grid that a map takes; nothing else takes one."""
    from hsictrl.paper.recipes import ON_GRID, checked_grid

    if grid is not None and name not in ON_GRID:
        raise ValueError(f"--grid must come with one of {', '.join(ON_GRID)}, got {name}; leave it out")
    return checked_grid(grid or "coarse", recompute)


def _checked_ledger(name: str, recompute: bool, path: Path | None, resume: bool, folder: Path) -> Ledger | None:
    """Return the ledger of a study that runs anew, which always has one; nothing else has."""
    from hsictrl.paper.recipes import AT_ONCE

    if recompute and name not in AT_ONCE:
        return checked_ledger(path or folder / f"{name}.ledger", resume)
    if path is not None or resume:
        remedy = "leave them out" if name in AT_ONCE else "add --recompute, or leave them out"
        raise ValueError(f"--ledger and --resume must come with a study that runs anew, got {name}; {remedy}")
    return None


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

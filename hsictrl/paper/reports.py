"""What a reproduction hands out, and where its committed results lie."""

from __future__ import annotations

import json
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from importlib.resources import files
from typing import Any, final

import control as ct

from hsictrl.study import Ledger

Rows = list[dict[str, Any]]
# what was measured, whether the criterion holds (None: the interval does not tell), and why not if it does not
Finding = tuple[str, bool | None, str]


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """How a reproduction is made.

    Parameters
    ----------
    recompute : bool
        Whether to run studies anew rather than read their committed results.
    executor : concurrent.futures.Executor, optional
        Where trials run; in place if not given.
    ledger : Ledger, optional
        Keeps the trials of studies that run anew.
    grid : {"coarse", "paper"}
        Which cells the maps of figures 9 to 11 take.

    Examples
    --------
    >>> Run().recompute, Run(grid="paper").grid
    (False, 'paper')
    """

    recompute: bool = False
    executor: Executor | None = None
    ledger: Ledger | None = None
    grid: str = "coarse"


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """A figure or table of the paper, computed.

    Parameters
    ----------
    name : str
        What was asked for, "table1", "fig3" and so on.
    rows : list of dict
        The numbers, ready for JSON, with units in the keys.
    columns : list of str
        Keys worth a column of a printed table.
    caption : str
        What the numbers are, and under which assumptions.
    draw : callable, optional
        Draws the figure and returns a `control.ControlPlot`.
    study : bool
        Whether the numbers come from a study; they are worth a file even where there is no figure.

    Examples
    --------
    >>> from hsictrl.paper import compute
    >>> compute("fig3").rows[0]["persons"]
    71
    """

    name: str
    rows: Rows
    columns: list[str]
    caption: str
    draw: Callable[[], ct.ControlPlot] | None = None
    study: bool = False


def rounded(value: float) -> float:
    """Six digits, which is more than any study settles.

    Parameters
    ----------
    value : float
        A number of a row [any unit].

    Returns
    -------
    float

    Examples
    --------
    >>> rounded(1.23456789)
    1.23457
    """
    return float(f"{value:.6g}")


def committed(name: str) -> Rows:
    """Rows that were computed once and are shipped with the package.

    Parameters
    ----------
    name : str
        Name of the report.

    Returns
    -------
    list of dict

    Examples
    --------
    >>> len(committed("fig4"))
    612
    """
    rows: Rows = json.loads((files("hsictrl.paper") / "results" / f"{name}.json").read_text(encoding="utf-8"))
    return rows

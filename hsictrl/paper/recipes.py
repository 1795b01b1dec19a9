"""What can be reproduced, by name: from committed results in seconds, or computed anew."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor

from hsictrl import _checks as check
from hsictrl.paper import (
    claims,
    fig1,
    fig2,
    fig3,
    fig4,
    fig5,
    fig6,
    fig7,
    fig8,
    fig9,
    fig10,
    fig11,
    load_cycles,
    maps,
    readings,
    table1,
    table2,
)
from hsictrl.paper.maps import GRIDS
from hsictrl.paper.reports import Report, Run
from hsictrl.study import Ledger

RECIPES: dict[str, Callable[[Run], Report]] = {
    "table1": table1.report, "table2": table2.report, "readings": readings.report, "load_cycles": load_cycles.report,
    "fig1": fig1.report, "fig2": fig2.report, "fig3": fig3.report, "fig4": fig4.report, "fig5": fig5.report,
    "fig6": fig6.report, "fig7": fig7.report, "fig8": fig8.report,
    "maps": maps.report, "fig9": fig9.report, "fig10": fig10.report, "fig11": fig11.report,
    "stationary": maps.stationary, "claims": claims.report}
AT_ONCE = ("table1", "fig1", "fig2", "fig3", "fig5", "fig6")    # need no study
ON_GRID = ("maps", "fig9", "fig10", "fig11")    # maps, whose cells are a choice


def names() -> tuple[str, ...]:
    """What `compute` knows.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> names()
    ('table1', 'table2', 'readings', 'load_cycles', 'fig1', 'fig2', 'fig3', 'fig4', 'fig5', 'fig6', 'fig7', 'fig8',
     'maps', 'fig9', 'fig10', 'fig11', 'stationary', 'claims')
    """
    return tuple(RECIPES)


def compute(
    name: str, *, recompute: bool = False, executor: Executor | None = None, ledger: Ledger | None = None,
    grid: str = "coarse",
) -> Report:
    """Reproduce a table or figure of the paper, or evaluate its claims.

    Parameters
    ----------
    name : str
        One of `names()`.
    recompute : bool
        Whether to run studies anew rather than read their committed results.
    executor : concurrent.futures.Executor, optional
        Where trials run; in place if not given.
    ledger : Ledger, optional
        Keeps the trials of studies that run anew, and gives those that it holds in place of running them again.
    grid : {"coarse", "paper"}
        Which cells the maps of figures 9 to 11 take.

    Returns
    -------
    Report

    Examples
    --------
    >>> compute("fig3").columns[:2]
    ['mass_ratio', 'frequency_ratio']
    """
    recipe = RECIPES[check.choice("name", name, names())]
    return recipe(Run(recompute=recompute, executor=executor, ledger=ledger, grid=checked_grid(grid, recompute)))


def checked_grid(grid: str, recompute: bool) -> str:
    """Return the grid if there is one of that name, and results of it."""
    if check.choice("grid", grid, tuple(GRIDS)) != "coarse" and not recompute:
        raise ValueError(f"the grid must be coarse unless its cells are computed anew, got {grid}; add --recompute "
                         "(recompute=True), which takes hours")
    return grid

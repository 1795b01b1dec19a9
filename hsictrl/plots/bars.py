"""Estimates side by side, in groups."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.container import BarContainer
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.plots import _canvas as canvas

Groups = Mapping[str, Mapping[str, ArrayLike]]
FILLS: tuple[dict[str, Any], ...] = (
    {"facecolor": "0.35"}, {"facecolor": "white"}, {"facecolor": "0.75"}, {"facecolor": "white", "hatch": "////"})
WIDTH = 0.8     # of a group, where groups are 1 apart


def bars_plot(
    panels: Mapping[str, Groups], *, quantity: str = "Peak acceleration [m/s²]", columns: int = 1,
    ax: np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw estimates as bars in groups, with their intervals, a panel each; greys and hatches survive print.

    Parameters
    ----------
    panels : mapping of str to mapping
        For the title of each panel, its groups by name; for each group, estimate, low and high end of the interval
        by the name of the bar; the same bars in all groups [unit of the quantity].
    quantity : str
        What the vertical axes show, with its unit in brackets.
    columns : int
        Number of panels side by side [-].
    ax : array of matplotlib.axes.Axes, optional
        As many axes as there are panels; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Its lines are the intervals, one line per name of a bar, interrupted between groups.

    Raises
    ------
    ValueError
        If there is no panel, group or bar, bars have other names in another group or lack an end of the interval,
        or panels do not fill their rows.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> found = {"sparse": {"MF": [2.0, 1.9, 2.2], "PMC": [1.0, 0.9, 1.1]}}
    >>> plot = bars_plot({"2 Hz": found}, ax=Figure().subplots())
    >>> [float(patch.get_height()) for patch in plot.axes[0, 0].patches]
    [2.0, 1.0]
    """
    names = _bars(panels)
    found = {title: _values(title, groups, names) for title, groups in panels.items()}
    rows = canvas.rows(len(found), columns)
    axes = canvas.several_axes(ax, rows, figsize=(4.0 * columns, 3.4 * rows), columns=columns, sharey=False)
    canvas.head(axes.flat, found)
    drawn = [_panel(one, groups, panels[title]) for one, (title, groups) in zip(axes.flat, found.items(), strict=True)]
    for first in axes[:, 0]:
        first.set_ylabel(quantity)
    return canvas.control_plot([[line for _, line in panel] for panel in drawn], axes, _legends(axes, drawn))


def _panel(ax: Axes, values: dict[str, Array], groups: Groups) -> list[tuple[BarContainer, Line2D]]:
    canvas.grid(ax)
    ax.grid(axis="x", visible=False)
    ax.set_xticks(range(len(groups)), list(groups))
    ax.tick_params(axis="x", length=0)
    ax.margins(x=0.05)
    return [_series(ax, i, label, *one, share=WIDTH / len(values)) for i, (label, one) in enumerate(values.items())]


def _series(
    ax: Axes, index: int, label: str, middle: Array, low: Array, high: Array, *, share: float,
) -> tuple[BarContainer, Line2D]:
    """The bars of one name, and their intervals as one line with gaps."""
    x = np.arange(len(middle)) - WIDTH / 2 + (index + 0.5) * share
    bars = ax.bar(x, middle, width=share, edgecolor=canvas.INK, linewidth=0.8, label=label, **FILLS[index % len(FILLS)])
    gaps = np.full(len(x), np.nan)
    line, = ax.plot(np.column_stack([x, x, gaps]).ravel(), np.column_stack([low, high, gaps]).ravel(),
                    color=canvas.colour(4), linewidth=1.8, solid_capstyle="butt", label="95 % interval")
    return bars, line


def _legends(axes: np.ndarray, drawn: list[list[tuple[BarContainer, Line2D]]]) -> list[Legend | None]:
    """One for the figure, above the titles."""
    bars, lines = zip(*drawn[0], strict=True)
    handles = [*bars, lines[0]]
    legend = axes.flat[0].figure.legend(handles, [one.get_label() for one in handles], loc="outside upper center",
                                        ncols=len(handles), frameon=False, fontsize="small")
    return [legend, *[None] * (axes.size - 1)]


def _bars(panels: Mapping[str, Groups]) -> list[str]:
    """Names of the bars in a group."""
    held = check.entries("panels", panels, "panel", "give {title: {group: {bar: [estimate, low, high]}}}")
    names = [one for title, groups in held.items() for one in _of_groups(f"panels[{title!r}]", groups)]
    if any(one != names[0] for one in names):
        raise ValueError(f"every group must hold the same bars, got {names}; give all alike")
    return names[0]


def _of_groups(name: str, groups: Groups) -> list[list[str]]:
    """Names of the bars of every group of a panel."""
    held = check.entries(name, groups, "group", "give {group: {bar: [estimate, low, high]}}")
    return [list(check.entries(f"{name}[{group!r}]", bars, "bar", "give {bar: [estimate, low, high]}"))
            for group, bars in held.items()]


def _values(title: str, groups: Groups, names: list[str]) -> dict[str, Array]:
    """Estimates and ends of the intervals over the groups, shape (3, groups), by bar."""
    return {name: np.array([_three(f"panels[{title!r}][{group!r}][{name!r}]", bars[name])
                            for group, bars in groups.items()]).T for name in names}


def _three(name: str, values: ArrayLike) -> Array:
    ends = check.numbers(name, values, ndim=1, remedy="give estimate, low and high end")
    if len(ends) != 3:
        raise ValueError(f"{name} must hold 3 numbers, got {len(ends)}; give estimate, low and high end")
    return ends

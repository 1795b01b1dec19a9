"""What all plots share: axes, colours, names and legends."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain, product
from string import ascii_lowercase
from typing import Any, Literal

import control as ct
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.legend import Legend

from hsictrl import _checks as check

Handle = Artist | tuple[Artist, ...]   # a tuple is drawn as one entry, and named by its last
INK = "#222222"
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#000000")  # Okabe and Ito (2008)
DASHES: tuple[Any, ...] = ("solid", (0, (5, 1.5)), (0, (5, 1.5, 1, 1.5)), (0, (1, 1)))


def colour(index: int) -> str:
    """Colour of the curve with this index."""
    return COLOURS[index % len(COLOURS)]


def style(index: int) -> dict[str, Any]:
    """Colour and dashes of the curve with this index; 28 pairs differ."""
    return {"color": colour(index), "linestyle": DASHES[index % len(DASHES)]}


def one_or_several(name: str, given: Any, kind: type, remedy: str) -> list[Any]:
    """A list of what was given, alone or in a list or tuple; refuse other kinds."""
    items = list(given) if isinstance(given, list | tuple) else [given]
    if not items:
        raise ValueError(f"{name} must hold at least one {kind.__name__}, got none; {remedy}")
    return [check.instance(name, item, kind, remedy) for item in items]


def names(labels: str | Sequence[str] | None, defaults: Sequence[str | None]) -> list[str]:
    """One label per curve: those given, or the curves' own."""
    if labels is None:
        return [own or f"curve {i}" for i, own in enumerate(defaults)]
    given = [labels] if isinstance(labels, str) else list(labels)
    if len(given) != len(defaults):
        raise ValueError(f"labels must be one per curve, got {len(given)} for {len(defaults)}; give as many")
    return given


def one_axes(ax: Axes | None) -> Axes:
    """The axes given, or those of a new figure."""
    if ax is None:
        return plt.subplots(layout="constrained")[1]
    return check.instance("ax", ax, Axes, "make one with matplotlib.pyplot.subplots()")


def several_axes(
    ax: Sequence[Axes] | np.ndarray | None, rows: int, figsize: tuple[float, float], columns: int = 1,
    sharey: Literal["row"] | bool = "row",
) -> np.ndarray:
    """The axes given, or those of a new figure, shape (rows, columns)."""
    if ax is None:
        ax = plt.subplots(rows, columns, figsize=figsize, sharey=sharey, layout="constrained")[1]
    axes = [one_axes(one) for one in np.ravel(np.asarray(ax, dtype=object))]
    if len(axes) != rows * columns:
        raise ValueError(f"ax must hold {rows * columns} axes, got {len(axes)}; "
                         f"make them with matplotlib.pyplot.subplots({rows}, {columns})")
    return np.array(axes, dtype=object).reshape(rows, columns)


def rows(panels: int, columns: int) -> int:
    """Number of rows that so many panels fill."""
    check.whole("columns", columns, least=1, remedy="give the number of panels side by side")
    if panels % columns:
        raise ValueError(f"panels must fill their rows, got {panels} in {columns} columns; give a divisor of {panels}")
    return panels // columns


def head(axes: Iterable[Axes], titles: Iterable[str]) -> None:
    """Letter and title at the upper left of each panel, beside the legend."""
    letters = chain(ascii_lowercase, map("".join, product(ascii_lowercase, repeat=2)))
    for ax, letter, title in zip(axes, letters, titles, strict=False):
        ax.set_title(f"({letter}) {title}", loc="left", fontsize="medium")


def legend_above(ax: Axes, columns: Sequence[Sequence[Handle]], title: str | None = None) -> Legend:
    """A legend above the axes, where it covers no data; what belongs to one curve stands in one row."""
    handles = [handle for column in columns for handle in column]
    labels = [str((handle[-1] if isinstance(handle, tuple) else handle).get_label()) for handle in handles]
    used = sum(bool(column) for column in columns)
    return ax.legend(handles, labels, ncols=used, loc="lower right", bbox_to_anchor=(1.0, 1.0), frameon=False,
                     fontsize="small", borderaxespad=0.2, columnspacing=1.5, title=title, title_fontsize="small")


def grid(ax: Axes) -> None:
    """Faint lines behind the data, and no margin at the left and right."""
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.margins(x=0)


def control_plot(
    lines: Sequence[Sequence[Artist]], axes: np.ndarray, legends: Sequence[Legend | None],
) -> ct.ControlPlot:
    """The host's container; its lines and legends have the shape of the axes, filled row by row."""
    held, legend = np.empty(axes.size, dtype=object), np.empty(axes.size, dtype=object)
    for i, panel in enumerate(lines):
        held[i], legend[i] = list(panel), legends[i]
    return ct.ControlPlot(held.reshape(axes.shape), axes, axes.flat[0].figure, legend=legend.reshape(axes.shape))

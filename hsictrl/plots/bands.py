"""Effective properties over the number of people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import control as ct
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.legend import Legend
from matplotlib.lines import Line2D

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.plots import _canvas as canvas

Drawn = tuple[Artist, Line2D]        # a band or bars, and the means
LOOKS = ("filled", "hatched", "bars")
Crowds = Mapping[str, Mapping[str, Any]]
KEYS = ("persons", "frequency", "damping", "look")
REMEDY = "give {'persons': ..., 'frequency': ..., 'damping': ..., 'look': ...}"


def bands_plot(panels: Mapping[str, Crowds], *, ax: np.ndarray | None = None) -> ct.ControlPlot:
    """Draw effective properties over the number of people: means, and 5 % to 95 % as bands or bars (fig. 7).

    Parameters
    ----------
    panels : mapping of str to mapping
        For the title of each column, its crowds by label; for each crowd "persons", shape (n,), "frequency" and
        "damping", shape (3, n), mean, 5 % and 95 % percentile of f_eff and ξ_eff, and "look": "filled" or
        "hatched" for a band, "bars" for what was identified at single head counts [-, Hz, -].
    ax : array of matplotlib.axes.Axes, optional
        Two rows of axes, a column per panel; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Two rows, a column per panel; its lines are the means.

    Raises
    ------
    ValueError
        If a key is missing, a statistic has another shape, or `ax` holds more or fewer axes.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> found = {"persons": [3, 9], "frequency": [[2.97, 2.94], [2.96, 2.93], [2.98, 2.95]],
    ...          "damping": [[0.003, 0.004], [0.002, 0.003], [0.004, 0.005]], "look": "filled"}
    >>> plot = bands_plot({"vertical": {"upright": found}}, ax=Figure().subplots(2, 1))
    >>> [line.get_ydata().tolist() for line in plot.lines[1, 0]]     # ξ_eff [%]
    [[0.3, 0.4]]
    """
    held = check.entries("panels", panels, "panel", "give {title: {label: {...}}}")
    crowds = [_checked(f"panels[{title!r}]", each) for title, each in held.items()]
    axes = canvas.several_axes(ax, 2, figsize=(5.5 * len(crowds), 7.0), columns=len(crowds), sharey=False)
    above = [_panel(one, each, "frequency", 1.0) for one, each in zip(axes[0], crowds, strict=True)]
    below = [_panel(one, each, "damping", 100.0) for one, each in zip(axes[1], crowds, strict=True)]
    _name(axes, list(held))
    legends = [_legend(one, drawn) for one, drawn in zip(axes[0], above, strict=True)]
    return canvas.control_plot([[mean for _, mean in panel] for panel in above + below], axes,
                               [*legends, *[None] * len(crowds)])


def _name(axes: np.ndarray, titles: list[str]) -> None:
    """Titles of the columns; names of the axes at the outer ones."""
    canvas.head(axes[0], titles)
    axes[0, 0].set_ylabel(r"$f_\mathrm{eff}$ [Hz]")
    axes[1, 0].set_ylabel(r"$\xi_\mathrm{eff}$ [%]")
    for ax in axes[1]:
        ax.set_xlabel("Number of persons")


def _legend(ax: Axes, drawn: list[Drawn]) -> Legend:
    return ax.legend(drawn, [str(mean.get_label()) for _, mean in drawn], frameon=False, fontsize="small",
                     title="mean, and 5 % to 95 % as a band or bar", title_fontsize="small", alignment="left")


def _panel(ax: Axes, crowds: dict[str, dict[str, Any]], key: str, scale: float) -> list[Drawn]:
    canvas.grid(ax)
    ax.margins(x=0.03)
    ax.ticklabel_format(useOffset=False)
    return [_draw(ax, i, one["persons"], scale * one[key], label, one["look"])
            for i, (label, one) in enumerate(crowds.items())]


def _draw(ax: Axes, index: int, persons: Array, rows: Array, label: str, look: str) -> Drawn:
    colour = canvas.colour(index)
    if look == "bars":
        bars = ax.vlines(persons, rows[1], rows[2], color=colour, linewidth=1.2)
        line, = ax.plot(persons, rows[0], marker="x", markersize=5, linestyle="none", label=label, color=colour)
        return bars, line
    faces: dict[str, Any] = ({"facecolor": "none", "edgecolor": colour, "hatch": "////", "linewidth": 0.6}
                             if look == "hatched" else {"color": colour, "alpha": 0.35, "linewidth": 0})
    band = ax.fill_between(persons, rows[1], rows[2], **faces)
    line, = ax.plot(persons, rows[0], marker="o", markersize=3.5, label=label, **canvas.style(index))
    return band, line


def _checked(name: str, crowds: Crowds) -> dict[str, dict[str, Any]]:
    held = check.entries(name, crowds, "crowd", "give {label: {...}}")
    return {label: _crowd(f"{name}[{label!r}]", one) for label, one in held.items()}


def _crowd(name: str, crowd: Mapping[str, Any]) -> dict[str, Any]:
    for key in KEYS:
        if key not in check.instance(name, crowd, Mapping, REMEDY):
            raise ValueError(f"{name} must hold {', '.join(map(repr, KEYS))}, got no {key!r}; give all")
    persons = check.numbers(f"{name}['persons']", crowd["persons"], least=0, ndim=1, remedy="give a head count each")
    found = {key: check.numbers(f"{name}[{key!r}]", crowd[key], remedy="give mean, 5 % and 95 %")
             for key in ("frequency", "damping")}
    for key, rows in found.items():
        if rows.shape != (3, len(persons)):
            raise ValueError(f"{name}[{key!r}] must have shape (3, {len(persons)}), got {rows.shape}; give mean, 5 % "
                             "and 95 % per head count")
    return {"persons": persons, "look": check.choice(f"{name}['look']", crowd["look"], LOOKS), **found}

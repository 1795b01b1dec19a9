"""Effective properties over the frequency of the empty bridge."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.plots import _canvas as canvas

BandAndMean = tuple[PolyCollection, Line2D]
Found = dict[str, tuple[Array, Array]]      # by label


def effective_map_plot(
    frequencies: ArrayLike, statistics: Mapping[str, Mapping[str, ArrayLike]], *,
    ax: Sequence[Axes] | np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw effective properties over the empty bridge's frequency: means as lines, 5 % to 95 % as bands (fig. 4).

    Parameters
    ----------
    frequencies : array_like, shape (n,)
        Frequencies of the empty bridge f_B [Hz].
    statistics : mapping of str to mapping
        For each label, "frequency" f_eff/f_B and "damping" ξ_eff, arrays of shape (3, n): mean, 5 % and
        95 % percentile [-].
    ax : array or sequence of matplotlib.axes.Axes, optional
        Two axes, for f_eff/f_B and for ξ_eff; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        One row per panel.

    Raises
    ------
    ValueError
        If a statistic is missing or has another shape, or `ax` holds more or fewer than two axes.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> found = {"μ = 0.1": {"frequency": [[0.95, 0.95], [0.94, 0.90], [0.96, 1.00]],
    ...                      "damping": [[0.005, 0.012], [0.005, 0.010], [0.006, 0.014]]}}
    >>> plot = effective_map_plot([1.0, 2.0], found, ax=Figure().subplots(2, 1))
    >>> [line.get_ydata().tolist() for line in plot.lines[:, 0][1]]     # ξ_eff [%]
    [[0.5, 1.2]]
    """
    hertz = _hertz(frequencies)
    found = _checked("statistics", statistics, len(hertz))
    return _maps(hertz, [found], canvas.several_axes(ax, 2, figsize=(8.0, 7.0)))


def effective_panels(
    frequencies: ArrayLike, panels: Mapping[str, Mapping[str, Mapping[str, ArrayLike]]], *,
    ax: np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw several maps as `effective_map_plot` does, side by side: the whole of figure 4.

    Parameters
    ----------
    frequencies : array_like, shape (n,)
        Frequencies of the empty bridge f_B [Hz].
    panels : mapping of str to mapping
        For the title of each column, the statistics that `effective_map_plot` takes [-].
    ax : array of matplotlib.axes.Axes, optional
        Two rows of axes, a column per map; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Two rows, a column per map; the legend is that of the last map.

    Raises
    ------
    ValueError
        If a statistic is missing or has another shape, or `ax` holds more or fewer axes.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> rows = [[0.95, 0.95], [0.94, 0.90], [0.96, 1.0]]
    >>> found = {"μ = 0.1": {"frequency": rows, "damping": rows}}
    >>> plot = effective_panels([1.0, 2.0], {"ξ_B = 0.2 %": found, "ξ_B = 2 %": found}, ax=Figure().subplots(2, 2))
    >>> [ax.get_title("left") for ax in plot.axes[0]]
    ['(a) ξ_B = 0.2 %', '(b) ξ_B = 2 %']
    """
    hertz, held = _hertz(frequencies), check.entries("panels", panels, "panel", "give {title: {label: {...}}}")
    found = {title: _checked(f"panels[{title!r}]", each, len(hertz)) for title, each in held.items()}
    axes = canvas.several_axes(ax, 2, figsize=(4.0 * len(found), 7.0), columns=len(found))
    canvas.head(axes[0], found)
    return _maps(hertz, list(found.values()), axes)


def _maps(hertz: Array, found: list[Found], axes: np.ndarray) -> ct.ControlPlot:
    ratios = [_panel(ax, hertz, {label: one for label, (one, _) in each.items()})
              for ax, each in zip(axes[0], found, strict=True)]
    percents = [_panel(ax, hertz, {label: 100 * one for label, (_, one) in each.items()})
                for ax, each in zip(axes[1], found, strict=True)]
    axes[0, 0].set_ylabel(r"$f_\mathrm{eff}/f_B$ [-]")
    axes[1, 0].set_ylabel(r"$\xi_\mathrm{eff}$ [%]")
    for ax in axes[1]:
        ax.set_xlabel("Frequency of the empty bridge $f_B$ [Hz]")
    legends: list[Legend | None] = [None] * axes.size
    legends[axes.shape[1] - 1] = _legend(axes[0, -1], ratios[-1])
    return canvas.control_plot([[mean for _, mean in panel] for panel in ratios + percents], axes, legends)


def _legend(ax: Axes, drawn: list[BandAndMean]) -> Legend:
    """Two columns, so that a title has room beside it."""
    half = (len(drawn) + 1) // 2
    return canvas.legend_above(ax, [drawn[:half], drawn[half:]], title="mean, and 5 % to 95 % as a band")


def _panel(ax: Axes, hertz: Array, found: dict[str, Array]) -> list[BandAndMean]:
    canvas.grid(ax)
    return [_draw(ax, i, hertz, rows, label) for i, (label, rows) in enumerate(found.items())]


def _draw(ax: Axes, index: int, hertz: Array, rows: Array, label: str) -> BandAndMean:
    mean, low, high = rows
    band = ax.fill_between(hertz, low, high, color=canvas.colour(index), alpha=0.35, linewidth=0)
    line, = ax.plot(hertz, mean, color=_dark(index), linestyle=canvas.style(index)["linestyle"], label=label)
    return band, line


def _dark(index: int) -> tuple[float, ...]:
    """Nearly black, with a cast of the band's colour."""
    return tuple(0.4 * part for part in to_rgb(canvas.colour(index)))


def _hertz(frequencies: ArrayLike) -> Array:
    return check.numbers("frequencies", frequencies, above=0, ndim=1, remedy="give f_B in Hz")


def _checked(name: str, statistics: Mapping[str, Mapping[str, ArrayLike]], n: int) -> Found:
    """Both quantities of every label, each of shape (3, n)."""
    held = check.entries(name, statistics, "label", "give {label: {'frequency': ..., 'damping': ...}}")
    return {label: _both(f"{name}[{label!r}]", one, n) for label, one in held.items()}


def _both(name: str, statistic: Mapping[str, ArrayLike], n: int) -> tuple[Array, Array]:
    check.instance(name, statistic, Mapping, "give {'frequency': ..., 'damping': ...}")
    for key in ("frequency", "damping"):
        if key not in statistic:
            raise ValueError(f"{name} must hold 'frequency' and 'damping', got no {key!r}; give both")
    return (_three_rows(f"{name}['frequency']", statistic["frequency"], n),
            _three_rows(f"{name}['damping']", statistic["damping"], n))


def _three_rows(name: str, values: ArrayLike, n: int) -> Array:
    rows = check.numbers(name, values, remedy="give mean, 5 % and 95 %")
    if rows.shape != (3, n):
        raise ValueError(f"{name} must have shape (3, {n}), got {rows.shape}; give mean, 5 % and 95 % per frequency")
    return rows

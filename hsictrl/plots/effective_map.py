"""Effective properties over the frequency of the empty bridge."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.plots import _canvas as canvas

BandAndMean = tuple[PolyCollection, Line2D]


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
        For each label, "frequency" f_eff [Hz] and "damping" ξ_eff [-], arrays of shape (3, n): mean, 5 % and
        95 % percentile.
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
    >>> found = {"μ = 0.1": {"frequency": [[0.95, 1.9], [0.94, 1.8], [0.96, 2.0]],
    ...                      "damping": [[0.005, 0.012], [0.005, 0.010], [0.006, 0.014]]}}
    >>> plot = effective_map_plot([1.0, 2.0], found, ax=Figure().subplots(2, 1))
    >>> [line.get_ydata().tolist() for line in plot.lines[:, 0][1]]     # ξ_eff [%]
    [[0.5, 1.2]]
    """
    hertz = check.numbers("frequencies", frequencies, above=0, ndim=1, remedy="give f_B in Hz")
    found = {label: _checked(label, one, len(hertz)) for label, one in statistics.items()}
    axes = canvas.several_axes(ax, 2, figsize=(8.0, 7.0))
    ratios = _panel(axes[0], hertz, {label: frequency / hertz for label, (frequency, _) in found.items()})
    percents = _panel(axes[1], hertz, {label: 100 * damping for label, (_, damping) in found.items()})
    axes[0].set_ylabel(r"$f_\mathrm{eff}/f_B$ [-]")
    axes[1].set(xlabel="Natural frequency of the empty bridge $f_B$ [Hz]", ylabel=r"$\xi_\mathrm{eff}$ [%]")
    legend = canvas.legend_above(axes[0], [[pair] for pair in ratios], title="mean, and 5 % to 95 % as a band")
    return canvas.control_plot([[mean for _, mean in panel] for panel in (ratios, percents)], axes, [legend, None])


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


def _checked(label: str, statistic: Mapping[str, ArrayLike], n: int) -> tuple[Array, Array]:
    """Both quantities of one label, each of shape (3, n)."""
    if missing := {"frequency", "damping"} - set(statistic):
        raise ValueError(f"statistics[{label!r}] must hold 'frequency' and 'damping', got none of {sorted(missing)}; "
                         "give both")
    frequency, damping = (_three_rows(f"statistics[{label!r}][{key!r}]", statistic[key], n)
                          for key in ("frequency", "damping"))
    return frequency, damping


def _three_rows(name: str, values: ArrayLike, n: int) -> Array:
    rows = check.numbers(name, values, remedy="give mean, 5 % and 95 %")
    if rows.shape != (3, n):
        raise ValueError(f"{name} must have shape (3, {n}), got {rows.shape}; give mean, 5 % and 95 % per frequency")
    return rows

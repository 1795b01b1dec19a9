"""Poles as frequency over damping: along a locus, and scattered over crowds."""

from __future__ import annotations

from collections.abc import Sequence

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.loop import PoleScatter, RootLocus
from hsictrl.plots import _canvas as canvas

UNITS = {"mass": " kg", "frequency": " Hz", "damping": "", "sprung_ratio": "", "people": " people"}


def root_locus_plot(locus: RootLocus, *, ax: Axes | None = None) -> ct.ControlPlot:
    """Draw a root locus as frequencies over damping ratios, the bridge's branches before those of the bodies.

    Damping is on a logarithmic scale, since that of the bridge and of the bodies are far apart: poles without
    damping are left out. For the complex plane in the style of the host, use ``locus.to_map().plot()``.

    Parameters
    ----------
    locus : RootLocus
        As `hsictrl.root_locus` returns it [Hz, -].
    ax : matplotlib.axes.Axes, optional
        Where to draw; on a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Branches of the modes, with their first and last poles marked, and those of the bodies.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> locus = hsi.root_locus(hsi.reference_bridge(frequency=2.0), hsi.Pedestrian(), np.linspace(1, 49, 75))
    >>> plot = root_locus_plot(locus, ax=Figure().subplots())
    >>> plot.axes[0, 0].get_ylabel()
    'Frequency |p|/2π [Hz]'
    """
    check.instance("locus", locus, RootLocus, "compute it with hsictrl.root_locus")
    ax = canvas.one_axes(ax)
    canvas.grid(ax)
    upper = np.where(locus.poles.imag >= 0, 1.0, np.nan)
    percent = np.where(locus.damping > 0, 100 * locus.damping, np.nan) * upper
    n = 2 * locus.n_modes
    bodies = ax.plot(percent[:, n:], locus.frequency[:, n:], color=canvas.colour(1), linewidth=1.2, label="bodies",
                     marker=".", markevery=[len(locus.values) - 1])
    modes = ax.plot(percent[:, :n], locus.frequency[:, :n], color=canvas.colour(0), linewidth=2.0, label="bridge")
    unit = UNITS[locus.parameter]
    marks = [_mark(ax, percent[i, :n], locus.frequency[i, :n], sign, f"{locus.values[i]:.4g}{unit}")
             for i, sign in ((0, "x"), (-1, "o"))]
    ax.set(xlabel="Damping ratio −Re p/|p| [%]", ylabel="Frequency |p|/2π [Hz]", xscale="log")
    ax.margins(x=0.05)
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    legend = canvas.legend_above(ax, [modes[:1], bodies[:1], *([mark] for mark in marks)])
    return canvas.control_plot([[*modes, *marks, *bodies]], np.array([[ax]]), [legend])


def pole_scatter_plot(
    scatters: PoleScatter | Sequence[PoleScatter], *, labels: str | Sequence[str] | None = None,
    share: float = 0.95, ax: Axes | None = None,
) -> ct.ControlPlot:
    """Draw scattered poles as frequencies over damping ratios, with an ellipse that holds a share of them.

    Parameters
    ----------
    scatters : PoleScatter or sequence of PoleScatter
        As `hsictrl.pole_scatter` returns them [Hz, -].
    labels : str or sequence of str, optional
        One per scatter; their numbers of people if not given.
    share : float
        Share of the poles inside each ellipse, in (0, 1) [-].
    ax : matplotlib.axes.Axes, optional
        Where to draw; on a new figure if not given.

    Returns
    -------
    control.ControlPlot
        For each scatter its poles and its ellipse; the empty bridge comes last.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> found = hsi.pole_scatter(hsi.reference_bridge(), hsi.CrowdFlow(persons=15), trials=100,
    ...                          rng=np.random.default_rng(1))
    >>> plot = pole_scatter_plot(found, ax=Figure().subplots())
    >>> [line.get_label() for line in plot.lines[0, 0]]
    ['15 people', '95 %', 'empty bridge']
    """
    found = canvas.one_or_several("scatters", scatters, PoleScatter, "compute them with hsictrl.pole_scatter")
    names = canvas.names(labels, [f"{one.persons} people" for one in found])
    ax = canvas.one_axes(ax)
    canvas.grid(ax)
    ax.margins(0.05)
    pairs = [_cloud(ax, i, one, name, share) for i, (one, name) in enumerate(zip(found, names, strict=True))]
    empty, = ax.plot(*_place(np.array([found[0].empty])), "x", color=canvas.INK, label="empty bridge")
    ax.set(xlabel="Damping ratio −Re p/|p| [%]", ylabel="Frequency |p|/2π [Hz]")
    legend = canvas.legend_above(ax, [[cloud] for cloud, _ in pairs] + [[pairs[0][1]], [empty]])
    return canvas.control_plot([[line for pair in pairs for line in pair] + [empty]], np.array([[ax]]), [legend])


def _mark(ax: Axes, percent: Array, hertz: Array, sign: str, label: str) -> Line2D:
    return ax.plot(percent, hertz, sign, color=canvas.colour(0), markersize=6, label=label, zorder=5)[0]


def _cloud(ax: Axes, index: int, scatter: PoleScatter, label: str, share: float) -> tuple[Line2D, Line2D]:
    cloud, = ax.plot(*_place(scatter.poles), ".", markersize=3, alpha=0.5, color=canvas.colour(index), label=label)
    ellipse, = ax.plot(*_place(scatter.region(share)), linewidth=1.6, label=f"{100 * share:.3g} %",
                       **canvas.style(index))
    return cloud, ellipse


def _place(poles: np.ndarray) -> tuple[Array, Array]:
    size = np.abs(poles)
    return -100 * poles.real / size, size / (2 * np.pi)

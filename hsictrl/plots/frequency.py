"""Accelerances over frequency, with effective properties marked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.plots import _canvas as canvas
from hsictrl.resonance import EffectiveProperties


def frf_plot(
    responses: ct.FrequencyResponseData | Sequence[ct.FrequencyResponseData], *,
    labels: str | Sequence[str] | None = None,
    effective: EffectiveProperties | Sequence[EffectiveProperties] | None = None, ax: Axes | None = None,
) -> ct.ControlPlot:
    """Draw accelerances over frequency, and mark effective properties on them.

    Parameters
    ----------
    responses : control.FrequencyResponseData or sequence of them
        From one force to one acceleration each, as `hsictrl.frf` returns them [m/s² per N].
    labels : str or sequence of str, optional
        One per response; the names of their systems if not given.
    effective : EffectiveProperties or sequence of them, optional
        Marked in the colours of the responses if there is one for each, otherwise in black; competing peaks
        within the frequencies drawn are hollow [Hz, m/s² per N].
    ax : matplotlib.axes.Axes, optional
        Where to draw; on a new figure if not given.

    Returns
    -------
    control.ControlPlot

    Raises
    ------
    ValueError
        If a response has several inputs or outputs, or labels are not one per response.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> bridge, hertz = hsi.reference_bridge(frequency=2.0), np.linspace(1.5, 2.5, 201)
    >>> plot = frf_plot(hsi.frf(bridge, hertz), effective=hsi.effective(bridge), ax=Figure().subplots())
    >>> plot.axes[0, 0].get_xlabel()
    'Frequency [Hz]'
    """
    curves = _checked(responses)
    labels = canvas.names(labels, [curve.sysname for curve in curves])
    found = [] if effective is None else canvas.one_or_several(
        "effective", effective, EffectiveProperties, "compute them with hsictrl.effective")
    ax = canvas.one_axes(ax)
    canvas.grid(ax)
    lines = [_curve(ax, i, *pair) for i, pair in enumerate(zip(curves, labels, strict=True))]
    paired = len(found) == len(curves)
    span = ax.dataLim.intervalx
    marks = [_mark(ax, one, canvas.colour(i) if paired else canvas.INK, span) for i, one in enumerate(found)]
    ax.set(xlabel="Frequency [Hz]", ylabel="Accelerance |H| [m/s² per N]", yscale="log")
    return canvas.control_plot([[*lines, *marks]], np.array([[ax]]), [canvas.legend_above(ax, [lines, marks])])


def normalised_frf_plot(
    ratios: ArrayLike, panels: Mapping[str, Mapping[str, ct.FrequencyResponseData]], *,
    empty: ct.FrequencyResponseData, ax: Sequence[Axes] | np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw accelerances of several bridges, each over multiples of its own frequency, in panels (fig. 3).

    Parameters
    ----------
    ratios : array_like, shape (n,)
        Frequency over that of the empty bridge, f/f_B [-].
    panels : mapping of str to mapping
        For the title of each panel, responses by their labels, taken at these multiples [m/s² per N].
    empty : control.FrequencyResponseData
        Of the empty bridge, taken at the same multiples; drawn in black in every panel [m/s² per N].
    ax : array or sequence of matplotlib.axes.Axes, optional
        One axes per panel; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        One row per panel; the line of the empty bridge comes last, the legend is that of the first panel.

    Raises
    ------
    ValueError
        If there is no panel, a response has another length than the ratios, or `ax` holds more or fewer axes.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> bridge, ratios = hsi.reference_bridge(frequency=2.0), np.linspace(0.5, 1.5, 201)
    >>> occupied = hsi.frf(hsi.couple(bridge, hsi.Pedestrian(), np.linspace(0, 50, 75)), 2.0 * ratios)
    >>> panels = {"mass ratio 0.1": {"occupied": occupied}}
    >>> plot = normalised_frf_plot(ratios, panels, empty=hsi.frf(bridge, 2.0 * ratios), ax=Figure().subplots())
    >>> plot.axes[0, 0].get_xlabel()
    'Frequency ratio f/f_B [-]'
    """
    beta = check.numbers("ratios", ratios, above=0, ndim=1, remedy="give f/f_B")
    check.entries("panels", panels, "panel", "give {title: {label: response}}")
    curves = {title: _aligned([*each.values(), empty], len(beta)) for title, each in panels.items()}
    axes = canvas.several_axes(ax, len(panels), figsize=(8.0, 1.0 + 3.0 * len(panels)))
    lines = [_normalised(one, beta, each, [*panels[title], "empty bridge"])
             for one, (title, each) in zip(axes.flat, curves.items(), strict=True)]
    canvas.head(axes.flat, panels)
    axes[-1, 0].set_xlabel("Frequency ratio f/f_B [-]")
    legend = canvas.legend_above(axes[0, 0], [lines[0][i:i + 2] for i in range(0, len(lines[0]), 2)])
    return canvas.control_plot(lines, axes, [legend, *[None] * (len(lines) - 1)])


def _normalised(ax: Axes, beta: Array, curves: list[ct.FrequencyResponseData], labels: list[str]) -> list[Line2D]:
    """All but the last in colours, the last in black."""
    canvas.grid(ax)
    ax.set(ylabel="Accelerance |H| [m/s² per N]", yscale="log")
    looks = [*map(canvas.style, range(len(curves) - 1)), {"color": canvas.INK, "linestyle": "solid"}]
    return [ax.plot(beta, np.abs(curve.frdata[0, 0]), label=label, linewidth=1.6, **look)[0]
            for curve, label, look in zip(curves, labels, looks, strict=True)]


def _aligned(responses: list[ct.FrequencyResponseData], n: int) -> list[ct.FrequencyResponseData]:
    for curve in _checked(responses):
        if len(curve.omega) != n:
            raise ValueError(f"each response must have {n} frequencies, one per ratio, got {len(curve.omega)}; "
                             "compute it with hsictrl.frf at ratios times f_B")
    return responses


def _curve(ax: Axes, index: int, response: ct.FrequencyResponseData, label: str) -> Line2D:
    hertz, size = response.omega / (2 * np.pi), np.abs(response.frdata[0, 0])
    return ax.plot(hertz, size, label=label, linewidth=1.6, **canvas.style(index))[0]


def _mark(ax: Axes, found: EffectiveProperties, colour: str, span: np.ndarray) -> Line2D:
    """The peak, and those of its rivals that lie where curves are drawn."""
    rivals = [pair for pair in found.competing if span[0] <= pair[0] <= span[1]]
    for frequency, size in rivals:
        ax.plot(frequency, size, "o", color=colour, markerfacecolor="white", label="_competing", zorder=4)
    label = _effective_label(found) + ("; hollow: competing" if rivals else "")
    return ax.plot(found.frequency, found.peak, "o", color=colour, label=label, zorder=5)[0]


def _effective_label(found: EffectiveProperties) -> str:
    return (rf"$f_\mathrm{{eff}}$ = {found.frequency:.3f} Hz, "
            rf"$\xi_\mathrm{{eff}}$ = {100 * found.damping:.2f} %")


def _checked(responses: object) -> list[ct.FrequencyResponseData]:
    curves = canvas.one_or_several("responses", responses, ct.FrequencyResponseData, "compute them with hsictrl.frf")
    for curve in curves:
        if curve.frdata.shape[:2] != (1, 1):
            p, m = curve.frdata.shape[:2]
            raise ValueError(f"responses must have one input and one output, got {m} and {p}; "
                             "choose a pair with response[output, input]")
    return curves

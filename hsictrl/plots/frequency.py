"""Accelerances over frequency, with effective properties marked."""

from __future__ import annotations

from collections.abc import Sequence

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

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
    return canvas.control_plot([[*lines, *marks]], [ax], [canvas.legend_above(ax, [lines, marks])])


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

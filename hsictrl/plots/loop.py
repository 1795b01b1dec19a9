"""The crowd as a controller: the loop gain around −1, and where it helps."""

from __future__ import annotations

from collections.abc import Sequence

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from matplotlib.ticker import FuncFormatter

from hsictrl import _checks as check
from hsictrl.loop import LoopGain, Sensitivity
from hsictrl.plots import _canvas as canvas

HELPS, HARMS = 2, 4         # colours


def nyquist_plot(
    gain: LoopGain, *, band: tuple[float, float] | None = None, ax: Axes | None = None,
) -> ct.ControlPlot:
    """Draw the loop gain in the complex plane, with the disc about −1 inside which the crowd amplifies.

    The host's own `control.nyquist_plot` takes one mode only, and too few frequencies near a resonance of half a
    percent of damping. Of several modes, det(I + L) − 1 is drawn, which encircles −1 as often as L itself does.

    Parameters
    ----------
    gain : LoopGain
        As `hsictrl.loop_gain` returns it.
    band : (float, float), optional
        Frequencies that are drawn; as `LoopGain.frequencies` chooses if not given [Hz].
    ax : matplotlib.axes.Axes, optional
        Where to draw; on a new figure if not given.

    Returns
    -------
    control.ControlPlot

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> occupied = hsi.couple(hsi.reference_bridge(), hsi.Pedestrian(), np.linspace(0, 50, 15))
    >>> plot = nyquist_plot(hsi.loop_gain(occupied), ax=Figure().subplots())
    >>> [line.get_label() for line in plot.lines[0, 0]]
    ['L(iω)', 'L(−iω)', '−1']
    """
    check.instance("gain", gain, LoopGain, "make one with hsictrl.loop_gain(occupied)")
    response = np.moveaxis(gain.horner(2j * np.pi * gain.frequencies(band), warn_infinite=False), -1, 0)
    curve = np.linalg.det(np.eye(gain.ninputs) + response) - 1
    name = "L({}iω)" if gain.ninputs == 1 else "det(I + L({}iω)) − 1"
    ax = canvas.one_axes(ax)
    canvas.grid(ax)
    lines = [ax.plot(curve.real, sign * curve.imag, linewidth=1.6, label=name.format(sense), color=canvas.colour(0),
                     linestyle=dash)[0] for sign, sense, dash in ((1, "", "solid"), (-1, "−", (0, (5, 1.5))))]
    point, = ax.plot(-1, 0, "+", color=canvas.INK, markersize=9, label="−1")
    disc = ax.add_patch(Circle((-1, 0), 1, color=canvas.colour(HARMS), alpha=0.25, linewidth=0, label="amplifies"))
    ax.set(xlabel="Real part [-]", ylabel="Imaginary part [-]")
    ax.margins(0.05)
    ax.set_aspect("equal", adjustable="datalim")
    legend = canvas.legend_above(ax, [lines[:1], lines[1:], [point], [disc]])
    return canvas.control_plot([[*lines, point]], np.array([[ax]]), [legend])


def sensitivity_plot(
    sensitivities: Sensitivity | Sequence[Sensitivity], *, mode: int = 0, band: tuple[float, float] | None = None,
    labels: str | Sequence[str] | None = None, ax: Axes | None = None,
) -> ct.ControlPlot:
    """Draw sensitivities of a mode over frequency; above one the crowd amplifies, below one it helps.

    Parameters
    ----------
    sensitivities : Sensitivity or sequence of Sensitivity
        As `hsictrl.sensitivity` returns them [-].
    mode : int
        Which mode's own coordinate, from 0 [-].
    band : (float, float), optional
        Frequencies that are drawn; as `LoopGain.frequencies` chooses for the first if not given [Hz].
    labels : str or sequence of str, optional
        One per sensitivity; the names of their systems if not given.
    ax : matplotlib.axes.Axes, optional
        Where to draw; on a new figure if not given.

    Returns
    -------
    control.ControlPlot

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> occupied = hsi.couple(hsi.reference_bridge(), hsi.Pedestrian(), np.linspace(0, 50, 15))
    >>> plot = sensitivity_plot(hsi.sensitivity(occupied), band=(1.0, 5.0), ax=Figure().subplots())
    >>> plot.axes[0, 0].get_ylabel()
    'Sensitivity |S| [-]'
    """
    remedy = "compute them with hsictrl.sensitivity"
    systems = canvas.one_or_several("sensitivities", sensitivities, Sensitivity, remedy)
    names = canvas.names(labels, [system.name for system in systems])
    for system in systems:
        system.gain.occupied.bridge.mode(mode)
    hertz = systems[0].gain.frequencies(band)
    sizes = [np.abs(one.horner(2j * np.pi * hertz, warn_infinite=False)[mode, mode]) for one in systems]
    ax = canvas.one_axes(ax)
    canvas.grid(ax)
    lines = [ax.plot(hertz, size, label=name, linewidth=1.6, **canvas.style(i))[0]
             for i, (size, name) in enumerate(zip(sizes, names, strict=True))]
    ax.set(xlabel="Frequency [Hz]", ylabel="Sensitivity |S| [-]", xscale="log", yscale="log")
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.axhline(1.0, color=canvas.INK, linewidth=0.8)
    shades = []
    if len(sizes) == 1:
        shades = [ax.fill_between(hertz, 1.0, sizes[0], where=where, interpolate=True, alpha=0.3, linewidth=0,
                                  color=canvas.colour(colour), label=name)
                  for where, colour, name in ((sizes[0] >= 1, HARMS, "amplifies"), (sizes[0] <= 1, HELPS, "helps"))]
    legend = canvas.legend_above(ax, [[line] for line in lines] + [[shade] for shade in shades])
    return canvas.control_plot([lines], np.array([[ax]]), [legend])

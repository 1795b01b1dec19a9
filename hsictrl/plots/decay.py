"""What a free decay was read from, and the line through it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.legend import Legend
from matplotlib.lines import Line2D

from hsictrl import _checks as check
from hsictrl.identify import FreeDecay
from hsictrl.plots import _canvas as canvas


def decay_plot(
    decay: FreeDecay | Mapping[str, FreeDecay], *, quantity: str = "Acceleration [m/s²]",
    ax: Sequence[Axes] | np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw a free decay in two panels: the record with its fitted envelope, and the logarithms of its extremes.

    Parameters
    ----------
    decay : FreeDecay, or mapping of str to FreeDecay
        As `hsictrl.free_decay` returns it; several, each in a column of its own, by their titles [unit of the record,
        s].
    quantity : str
        What was recorded, with its unit in brackets.
    ax : array or sequence of matplotlib.axes.Axes, optional
        Two axes for each decay; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Two rows, a column per decay: record, extremes, envelope above and below; logarithms, fitted line.

    Raises
    ------
    ValueError
        If `ax` holds more or fewer axes than that.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> time = np.linspace(0.0, 20.0, 2001)
    >>> decay = hsi.free_decay(np.exp(-0.1 * time) * np.cos(4 * np.pi * time), timepts=time)
    >>> plot = decay_plot(decay, ax=Figure().subplots(2))
    >>> [line.get_label() for line in plot.lines[1, 0]]
    ['extremes', 'slope −0.05, R² = 1.0000']
    """
    decays = _by_title(decay)
    axes = canvas.several_axes(ax, 2, figsize=(4.0 + 4.0 * len(decays), 6.0), columns=len(decays))
    for axis in axes.flat:
        canvas.grid(axis)
    drawn = [_record(axis, one, quantity) for axis, one in zip(axes[0], decays.values(), strict=True)]
    drawn += [_logarithms(axis, one) for axis, one in zip(axes[1], decays.values(), strict=True)]
    canvas.head(axes.flat, [*decays, *["Logarithms"] * len(decays)])
    return canvas.control_plot([lines for lines, _ in drawn], axes, [legend for _, legend in drawn])


def _by_title(given: Any) -> dict[str, FreeDecay]:
    remedy = "give what hsictrl.free_decay returns"
    decays = check.entries("decay", given, "decay", remedy) if isinstance(given, Mapping) else {"Free decay": given}
    return {title: check.instance("decay", one, FreeDecay, remedy) for title, one in decays.items()}


def _record(ax: Axes, decay: FreeDecay, quantity: str) -> tuple[list[Line2D], Legend]:
    trace, = ax.plot(decay.record.time, decay.record.outputs, color=canvas.colour(0), linewidth=0.8, alpha=0.7,
                     label="record")
    extremes = _extremes(ax, decay.times, decay.values)
    times = np.linspace(decay.times[0], decay.times[-1], 201)
    label = f"{decay.frequency:.3f} Hz, {100 * decay.damping:.2f} %"
    envelope = [ax.plot(times, decay.offset + sign * decay.envelope(times), linewidth=1.8, zorder=5, label=label,
                        **canvas.style(4))[0] for sign in (1, -1)]
    ax.set(xlabel="Time [s]", ylabel=quantity)
    return [trace, extremes, *envelope], canvas.legend_above(ax, [[trace], [extremes], envelope[:1]])


def _logarithms(ax: Axes, decay: FreeDecay) -> tuple[list[Line2D], Legend]:
    extremes = _extremes(ax, decay.cycles, np.log(decay.amplitudes))
    ends = decay.cycles[[0, -1]]
    label = f"slope −{decay.decrement:.3g}, R² = {decay.r_squared:.4f}"
    line, = ax.plot(ends, np.log(decay.amplitude) - decay.decrement * ends, linewidth=1.8, zorder=5, label=label,
                    **canvas.style(4))
    ax.set(xlabel="Cycles [-]", ylabel="ln amplitude [-]")
    return [extremes, line], canvas.legend_above(ax, [[extremes], [line]])


def _extremes(ax: Axes, x: np.ndarray, y: np.ndarray) -> Line2D:
    return ax.plot(x, y, "o", markersize=3.5, color=canvas.INK, markerfacecolor="white", zorder=4, clip_on=False,
                   label="extremes")[0]

"""Accelerations and people over time."""

from __future__ import annotations

from collections.abc import Sequence

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.plots import _canvas as canvas
from hsictrl.records import running_rms


def response_plot(
    responses: ct.TimeResponseData | Sequence[ct.TimeResponseData], *, labels: str | Sequence[str] | None = None,
    ax: Axes | None = None,
) -> ct.ControlPlot:
    """Draw accelerations over time: thin traces, their running 1-s RMS in bold, and their peaks.

    Parameters
    ----------
    responses : control.TimeResponseData or sequence of them
        One acceleration each, as ``predict(...).response`` [m/s², s].
    labels : str or sequence of str, optional
        One per response; the names of their systems if not given.
    ax : matplotlib.axes.Axes, optional
        Where to draw; on a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Its lines are all traces, then all running RMS, then all peaks.

    Raises
    ------
    ValueError
        If a response has several outputs, or labels are not one per response.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> bridge = hsi.reference_bridge(frequency=2.0)
    >>> walker = hsi.Walker(force=hsi.HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> found = hsi.predict("MF", bridge, hsi.Traffic([walker]))
    >>> plot = response_plot(found.response, ax=Figure().subplots())
    >>> [line.get_label() for line in plot.lines[0, 0]]
    ['MF', 'running 1-s RMS', 'peak 0.84 m/s² at 30.1 s']
    """
    records = _checked(responses)
    labels = canvas.names(labels, [record.sysname for record in records])
    ax = canvas.one_axes(ax)
    canvas.grid(ax)
    drawn = [_record(ax, i, *pair) for i, pair in enumerate(zip(records, labels, strict=True))]
    columns = list(zip(*drawn, strict=True))
    ax.set(xlabel="Time [s]", ylabel="Acceleration [m/s²]")
    lines = [line for column in columns for line in column]
    return canvas.control_plot([lines], np.array([[ax]]), [canvas.legend_above(ax, columns)])


def persons_plot(times: ArrayLike, persons: ArrayLike, *, ax: Axes | None = None) -> ct.ControlPlot:
    """Draw how many people are on the deck, as steps.

    Parameters
    ----------
    times : array_like, shape (m,)
        Times [s].
    persons : array_like, shape (m,)
        People on the deck at these times, as `Traffic.persons_on` counts them [-].
    ax : matplotlib.axes.Axes, optional
        Where to draw; on a new figure if not given.

    Returns
    -------
    control.ControlPlot

    Raises
    ------
    ValueError
        If there is no time, or people are not counted once for each.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> plot = persons_plot([0.0, 1.0, 2.0], [3, 4, 4], ax=Figure().subplots())
    >>> plot.axes[0, 0].get_ylabel()
    'People on the deck [-]'
    """
    times = check.numbers("times", times, ndim=1, count=1, remedy="give a list of seconds")
    persons = check.numbers("persons", persons, least=0, ndim=1, remedy="count them with traffic.persons_on")
    if len(persons) != len(times):
        raise ValueError(f"persons must be one number per time, got {len(persons)} for {len(times)}; "
                         "count them with traffic.persons_on(bridge, times)")
    ax = canvas.one_axes(ax)
    canvas.grid(ax)
    line, = ax.plot(times, persons, drawstyle="steps-post", color=canvas.INK, linewidth=1.4, label="people")
    ax.set(xlabel="Time [s]", ylabel="People on the deck [-]")
    ax.set_ylim(0, 1.1 * max(float(np.max(persons)), 1.0))
    ax.yaxis.set_major_locator(MaxNLocator(integer=True))
    return canvas.control_plot([[line]], np.array([[ax]]), [None])


def _record(ax: Axes, index: int, record: ct.TimeResponseData, label: str) -> tuple[Line2D, Line2D, Line2D]:
    """The trace, its running RMS and its peak."""
    time, signal = record.time, np.ravel(record.outputs)
    trace, = ax.plot(time, signal, color=canvas.colour(index), linewidth=0.8, alpha=0.7, label=label)
    bold, = ax.plot(time, np.ravel(running_rms(record)), linewidth=2.2, zorder=4, label="running 1-s RMS",
                    **canvas.style(index))
    return trace, bold, _peak(ax, index, time, signal)


def _peak(ax: Axes, index: int, time: Array, signal: Array) -> Line2D:
    top = int(np.argmax(np.abs(signal)))
    size = f"{abs(signal[top]):#.2g}".rstrip(".")   # a sample misses the peak by up to 0.3 %
    label = f"peak {size} m/s² at {time[top]:.1f} s"
    return ax.plot(time[top], signal[top], "o", color=canvas.colour(index), markeredgecolor=canvas.INK, zorder=5,
                   clip_on=False, label=label)[0]


def _checked(responses: object) -> list[ct.TimeResponseData]:
    records = canvas.one_or_several("responses", responses, ct.TimeResponseData, "give predict(...).response")
    return [one_output("responses", record) for record in records]


def one_output(name: str, response: ct.TimeResponseData) -> ct.TimeResponseData:
    """Return the response if it has one output."""
    check.instance(name, response, ct.TimeResponseData, "give predict(...).response")
    if np.ndim(response.outputs) > 1 and len(response.outputs) != 1:
        raise ValueError(f"{name} must have one output, got {len(response.outputs)}; "
                         "predict with one point in sense_at")
    return response

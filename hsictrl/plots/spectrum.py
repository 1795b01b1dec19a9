"""What an acceleration is made of, by frequency."""

from __future__ import annotations

from collections.abc import Mapping

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.plots import _canvas as canvas
from hsictrl.plots.history import one_output
from hsictrl.records import amplitude_spectrum

DECADES = 4.0   # drawn below the largest amplitude


def spectrum_plot(
    response: ct.TimeResponseData, *, marks: Mapping[str, ArrayLike] | None = None, ax: Axes | None = None,
) -> ct.ControlPlot:
    """Draw the amplitude spectrum of an acceleration, and mark frequencies on it.

    Parameters
    ----------
    response : control.TimeResponseData
        One acceleration, evenly sampled, as ``predict(...).response`` [m/s², s].
    marks : mapping of str to float or array_like, optional
        Frequencies by their labels; the spectrum is drawn a little beyond the highest of them, whole if there are
        none [Hz].
    ax : matplotlib.axes.Axes, optional
        Where to draw; on a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Its lines are the spectrum, then the marks.

    Raises
    ------
    ValueError
        If the response has several outputs or uneven times, or marks are none or not above zero.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> walker = hsi.Walker(force=hsi.HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> found = hsi.predict("MF", hsi.reference_bridge(frequency=2.0), hsi.Traffic([walker]))
    >>> plot = spectrum_plot(found.response, marks={"steps": [2.0, 4.0]}, ax=Figure().subplots())
    >>> [line.get_label() for line in plot.lines[0, 0]]
    ['amplitude', 'steps']
    """
    frequencies, amplitudes = amplitude_spectrum(one_output("response", response))
    at = {} if marks is None else _marks(marks)
    ax = canvas.one_axes(ax)
    canvas.grid(ax)
    line, = ax.plot(frequencies, np.ravel(amplitudes), color=canvas.INK, linewidth=1.2, zorder=4, label="amplitude")
    lines = [_drawn(ax, i, *mark) for i, mark in enumerate(at.items())]
    top = float(np.max(amplitudes)) or 1.0
    highest = max((1.1 * float(np.max(each)) for each in at.values()), default=frequencies[-1])
    ax.set(xlabel="Frequency [Hz]", ylabel="Amplitude [m/s²]", xlim=(0, highest), ylim=(top * 10**-DECADES, 2 * top))
    ax.set_yscale("log")    # last: without limits it would warn of silence
    return canvas.control_plot([[line, *lines]], np.array([[ax]]), [canvas.legend_above(ax, [[one] for one in lines])])


def _marks(marks: Mapping[str, ArrayLike]) -> dict[str, Array]:
    check.instance("marks", marks, Mapping, "give {label: frequencies in Hz}")
    return {label: _mark(f"marks[{label!r}]", given) for label, given in marks.items()}


def _mark(name: str, frequencies: ArrayLike) -> Array:
    remedy = "give Hz, one number or a list"
    given = check.numbers(name, frequencies, above=0, count=1, remedy=remedy)
    return check.numbers(name, np.atleast_1d(given), ndim=1, remedy=remedy)


def _drawn(ax: Axes, index: int, label: str, frequencies: Array) -> Line2D:
    """Upright lines at frequencies, as one; later ones are narrower and darker, so that they show on earlier ones."""
    x = np.repeat(frequencies, 3)
    y = np.tile([0.0, 1.0, np.nan], len(frequencies))
    return ax.plot(x, y, transform=ax.get_xaxis_transform(), linewidth=max(4.0 - 1.3 * index, 1.4), label=label,
                   alpha=min(0.4 + 0.3 * index, 1.0), **canvas.style(index))[0]

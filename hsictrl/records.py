"""What is read from a record: its running root-mean-square and its amplitude spectrum."""

from __future__ import annotations

import control as ct
import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array


def running_rms(response: ct.TimeResponseData, *, duration: float = 1.0) -> Array:
    """Root-mean-square over the last `duration` seconds, at every time of a record.

    Parameters
    ----------
    response : control.TimeResponseData
        The record; its times may be uneven [unit of the outputs, s].
    duration : float
        Length of the window that trails each time; where the record is younger, what there is of it [s].

    Returns
    -------
    array, shape of ``response.outputs``
        Running RMS of every output [unit of the outputs].

    Raises
    ------
    ValueError
        If the duration is not above zero, the times do not increase, or a value is not finite.

    Notes
    -----
    Source: the running RMS of ISO 2631-1:1997, eq. (2), of the signal as it is, without frequency
    weighting; its greatest value is the MTVV of eq. (4). The square is integrated by the trapezoidal rule, in one
    running sum: what is a million times quieter than what came before is lost in rounding.

    Examples
    --------
    >>> time = np.linspace(0.0, 5.0, 501)
    >>> wave = ct.TimeResponseData(time, np.sin(2 * np.pi * 2.0 * time), issiso=True)
    >>> print(running_rms(wave)[100:].round(6))     # 1/√2
    [0.707107 0.707107 ... 0.707107]
    """
    check.instance("response", response, ct.TimeResponseData, "give predict(...).response, or make one of a record")
    window = check.number("duration", duration, above=0, remedy="give seconds; ISO 2631-1 recommends 1")
    time = _increasing(response.time)
    square = _outputs(response)**2
    length = np.minimum(window, time - time[0])[1:]
    mean = _energy_of_last(time, square, window)[..., 1:] / length
    return np.sqrt(np.concatenate([square[..., :1], mean], axis=-1))


def amplitude_spectrum(response: ct.TimeResponseData) -> tuple[Array, Array]:
    """One-sided amplitude spectrum of a record under a Hann window.

    Parameters
    ----------
    response : control.TimeResponseData
        The record, evenly sampled [unit of the outputs, s].

    Returns
    -------
    frequencies : array, shape (n // 2 + 1,)
        Bins, one over the duration of the n samples apart [Hz].
    amplitudes : array
        Amplitude of every output in every bin [unit of the outputs].

    Raises
    ------
    ValueError
        If the times do not increase evenly, or a value is not finite.

    Notes
    -----
    A sine at the centre of a bin shows its amplitude there and half of it in both neighbours; halfway between two
    bins it shows 0.85 of it in both. A mean shows in the first two bins.

    Examples
    --------
    >>> time = np.arange(1000) / 100
    >>> wave = ct.TimeResponseData(time, 3.0 * np.sin(2 * np.pi * 2.0 * time), issiso=True)
    >>> frequencies, amplitudes = amplitude_spectrum(wave)
    >>> print(frequencies[19:22], amplitudes[19:22].round(6))
    [1.9 2.  2.1] [1.5 3.  1.5]
    """
    check.instance("response", response, ct.TimeResponseData, "give predict(...).response, or make one of a record")
    time = check.even_times("times of a record", response.time)
    n = len(time)
    window = np.sin(np.pi * np.arange(n) / n)**2   # periodic, so that whole periods leak into two bins and no more
    lines = np.fft.rfft(window * _outputs(response), axis=-1)
    bins = np.arange(n // 2 + 1)
    sides = np.where((bins == 0) | (2 * bins == n), 1.0, 2.0)
    return bins * (n - 1) / (n * (time[-1] - time[0])), sides * np.abs(lines) / np.sum(window)


def _energy_of_last(time: Array, square: Array, window: float) -> Array:
    """Integral of the square over the window that ends at each time."""
    pieces = 0.5 * (square[..., 1:] + square[..., :-1]) * np.diff(time)
    energy = np.concatenate([np.zeros_like(square[..., :1]), np.cumsum(pieces, axis=-1)], axis=-1)
    before, part = _place(time, np.maximum(time - window, time[0]))
    steps = np.diff(energy, append=energy[..., -1:])
    # a rounded difference may fall below the zero that it stands for
    return np.maximum(energy - energy[..., before] - part * steps[..., before], 0.0)


def _place(time: Array, moments: Array) -> tuple[np.ndarray, Array]:
    """Index of the sample at or before each moment, and how far on to the next one it lies."""
    before = np.searchsorted(time, moments, side="right") - 1
    after = np.minimum(before + 1, len(time) - 1)
    gap = time[after] - time[before]
    return before, np.divide(moments - time[before], gap, out=np.zeros_like(gap), where=gap > 0)


def _outputs(response: ct.TimeResponseData) -> Array:
    return check.numbers("outputs of a record", response.outputs, remedy="cut or fill what was not measured")


def _increasing(given: Array) -> Array:
    time = check.numbers("times of a record", given, ndim=1, count=1, remedy="give seconds")
    steps = np.diff(time)
    if np.any(steps <= 0):
        i = int(np.argmax(steps <= 0))
        raise ValueError(f"times of a record must increase, got {time[i]:g} s and then {time[i + 1]:g} s; "
                         "sort the record")
    return time

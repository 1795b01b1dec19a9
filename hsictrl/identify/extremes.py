"""Extremes of a vibration between the samples: one in every half cycle, whatever the noise."""

from __future__ import annotations

import numpy as np
from scipy.signal import find_peaks

from hsictrl._checks import Array

FEWEST = 8              # samples a period, below which a parabola is no picture of a peak
APART = 0.7             # extremes of one sign lie at least so far apart [periods]
WINDOW = 1 / 6          # a parabola is fitted so far to either side of an extreme [periods]


def extremes(time: Array, signal: Array) -> tuple[Array, Array, Array]:
    """Times, values and signs of the maxima (+1) and minima (-1) of an evenly sampled vibration, in order."""
    period = _samples_a_period(signal)
    if period < FEWEST:
        raise ValueError(f"record must hold at least {FEWEST} samples a period, got {period:.3g}; sample it faster, "
                         "or filter out what vibrates faster")
    found = [_refined(sign * signal, period) for sign in (1, -1)]
    at = np.concatenate([each[0] for each in found])
    values = np.concatenate([found[0][1], -found[1][1]])
    signs = np.repeat([1.0, -1.0], [len(each[0]) for each in found])
    order = np.argsort(at)
    return time[0] + at[order] * (time[-1] - time[0]) / (len(time) - 1), values[order], signs[order]


def _samples_a_period(signal: Array) -> float:
    """Period of the largest line of the spectrum [samples]."""
    n = 4 * len(signal)
    lines = np.abs(np.fft.rfft(signal - np.mean(signal), n))
    return n / max(int(np.argmax(lines)), 1)


def _refined(signal: Array, period: float) -> tuple[Array, Array]:
    """Places [samples] and heights of the maxima: vertices, within their windows, of parabolas fitted about them."""
    half = int(WINDOW * period)
    peaks = find_peaks(signal, distance=APART * period)[0]
    peaks = peaks[(peaks >= half) & (peaks < len(signal) - half)]
    u = np.arange(-half, half + 1)
    curve, slope, level = np.polyfit(u, signal[peaks[:, None] + u].T, 2)
    inside = np.abs(slope) < -2 * half * curve
    shift = -slope[inside] / (2 * curve[inside])
    return peaks[inside] + shift, level[inside] + slope[inside] * shift / 2

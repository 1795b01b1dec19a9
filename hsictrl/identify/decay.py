"""Free decay: the envelope of a vibration that nothing drives gives its damping."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple, final

import control as ct
import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import t as student

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.identify.extremes import extremes
from hsictrl.identify.reading import signals

FEWEST = 3              # two extremes give a slope and no scatter
CONFIDENCE = 0.95
UNEVEN = 0.3            # of the time between extremes, by which it may differ from the median


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FreeDecay:
    """Frequency and damping read from a free decay, and what they were read from; unpacks into these two.

    Parameters
    ----------
    frequency : float
        Natural frequency, that of the same mode without damping [Hz].
    damping : float
        Damping ratio [-].
    frequency_interval, damping_interval : (float, float)
        95 % intervals from the scatter about the fitted lines [Hz, -].
    frequency_error, damping_error : float
        Standard errors from that scatter [Hz, -].
    damped_frequency : float
        Cycles a second of the decay itself [Hz].
    decrement : float
        Logarithmic decrement δ, by which the logarithm of the amplitude falls in a cycle [-].
    r_squared : float
        Share of the variance of the logarithms that the line explains [-].
    amplitude : float
        Fitted amplitude at the first extreme [unit of the record].
    offset : float
        Level about which the record vibrates [unit of the record].
    times : array, shape (n,)
        When the extremes come that were used, every half cycle [s].
    values : array, shape (n,)
        The record there, between its samples [unit of the record].
    record : control.TimeResponseData
        The one signal that was read [any, s].

    Examples
    --------
    >>> time = np.linspace(0.0, 20.0, 2001)
    >>> decay = free_decay(np.exp(-0.1 * time) * np.cos(4 * np.pi * time), timepts=time)
    >>> print(decay)
    2.0001 Hz [2.0001, 2.0001], 0.796 % [0.796, 0.796] (free decay, 60 extremes, R² = 1.00000)
    >>> frequency, damping = decay
    """

    frequency: float
    damping: float
    frequency_interval: tuple[float, float]
    damping_interval: tuple[float, float]
    frequency_error: float
    damping_error: float
    damped_frequency: float
    decrement: float
    r_squared: float
    amplitude: float
    offset: float
    times: Array
    values: Array
    record: ct.TimeResponseData

    def __post_init__(self) -> None:
        check.freeze(self.times, self.values)

    @property
    def cycles(self) -> Array:
        """Cycles since the first extreme, in halves [-]."""
        return _halves(self.times)

    @property
    def amplitudes(self) -> Array:
        """Distances of the extremes from the offset [unit of the record]."""
        return np.abs(self.values - self.offset)

    def envelope(self, timepts: ArrayLike) -> Array:
        """Fitted amplitude, which falls exponentially.

        Parameters
        ----------
        timepts : array_like
            When [s].

        Returns
        -------
        array, shape of `timepts`
            Amplitudes about the offset [unit of the record].

        Examples
        --------
        >>> time = np.linspace(0.0, 20.0, 2001)
        >>> decay = free_decay(np.exp(-0.1 * time) * np.cos(4 * np.pi * time), timepts=time)
        >>> print(decay.envelope([0.0, 10.0]).round(2))
        [1.   0.37]
        """
        time = check.numbers("timepts", timepts, remedy="give seconds")
        return self.amplitude * np.exp(-self.decrement * self.damped_frequency * (time - self.times[0]))

    def __iter__(self) -> Iterator[float]:
        return iter((self.frequency, self.damping))

    def __str__(self) -> str:
        (slow, fast), (low, high) = self.frequency_interval, self.damping_interval
        return (f"{self.frequency:.4f} Hz [{slow:.4f}, {fast:.4f}], {100 * self.damping:.3f} % [{100 * low:.3f}, "
                f"{100 * high:.3f}] (free decay, {len(self.times)} extremes, R² = {self.r_squared:.5f})")

    def to_dict(self) -> dict[str, Any]:
        """Export with the units in the keys, without the record.

        Returns
        -------
        dict
            Plain numbers and lists, ready for JSON or a data frame.

        Examples
        --------
        >>> time = np.linspace(0.0, 20.0, 2001)
        >>> decay = free_decay(np.exp(-0.1 * time) * np.cos(4 * np.pi * time), timepts=time)
        >>> round(decay.to_dict()["decrement"], 6)
        0.05
        """
        return {"frequency_hz": self.frequency, "damping": self.damping,
                "frequency_interval_hz": list(self.frequency_interval), "damping_interval": list(self.damping_interval),
                "frequency_error_hz": self.frequency_error, "damping_error": self.damping_error,
                "damped_frequency_hz": self.damped_frequency, "decrement": self.decrement,
                "r_squared": self.r_squared, "amplitude": self.amplitude, "offset": self.offset,
                "times_s": self.times.tolist(), "values": self.values.tolist()}


def free_decay(
    record: ct.TimeResponseData | ArrayLike, *, timepts: ArrayLike | None = None, output: int = 0,
    highest: float = 0.9, lowest: float = 0.2,
) -> FreeDecay:
    """Frequency and damping of the mode that dominates a free decay.

    Parameters
    ----------
    record : control.TimeResponseData or array_like, shape (m,)
        An acceleration, velocity or displacement, evenly sampled [any, s].
    timepts : array_like, shape (m,), optional
        Times of a record given as an array [s].
    output : int
        Which output of a record that has several, from 0 [-].
    highest, lowest : float
        Extremes between these shares of the largest are used [-].

    Returns
    -------
    FreeDecay

    Raises
    ------
    ValueError
        If the record is uneven, has holes or too few samples a period, does not decay, is not dominated by one mode,
        or has fewer than three extremes between the shares.

    Notes
    -----
    The recipe is that of Van Nimmen et al. (2017), section 3.4: a line through the logarithms of the peaks, over the
    number of cycles, has the slope -δ, and ξ = δ/√(4π² + δ²). Here peaks of both signs serve, one every half cycle:
    a decaying sinusoid has its extremes at the same phase, so that their ratios, and with them δ, are exact at any
    damping. Extremes are vertices of parabolas, fitted over a third of a period; all come out 0.4 % low alike. A line
    through their times, over the number of cycles, gives the damped frequency f_d, and f = f_d/√(1 - ξ²).

    Used are the extremes after the largest: from the last above ``highest`` on, until the first below ``lowest``. So
    what drove the bridge may stand in the record, as long as it left the largest extreme.

    The record's offset is removed: three extremes in a geometric series about c in turn give c.

    Noise is not filtered. The standard errors allow for its greater share in small amplitudes (HC3 of MacKinnon and
    White, 1985) and take it as independent from one extreme to the next.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> bridge = hsi.reference_bridge(frequency=2.0, damping=0.005)
    >>> time = np.linspace(0.0, 60.0, 6001)
    >>> response = ct.initial_response(bridge.ss(at=[25.0]), time, [1e-3, 0.0])
    >>> print(free_decay(response, output=2))       # the acceleration
    2.0000 Hz [2.0000, 2.0000], 0.500 % [0.500, 0.500] (free decay, 96 extremes, R² = 1.00000)
    """
    band = _band(highest, lowest)
    time, signal = _read(record, timepts, output)
    moments, values, signs = extremes(time, signal)
    if len(values) < FEWEST:
        raise ValueError(f"record must hold at least {FEWEST} extremes, got {len(values)}; give one that vibrates")
    offset = _offset(values)
    used = _used(moments, signs * (values - offset), band, float(time[-1]))
    return _decay(moments[used], values[used], offset, ct.TimeResponseData(time, signal, issiso=True))


def _decay(moments: Array, values: Array, offset: float, record: ct.TimeResponseData) -> FreeDecay:
    """Two lines over cycles, through logarithms of amplitudes and through times, and what they say."""
    _check_steadiness(moments)
    cycles, logarithms = _halves(moments), np.log(np.abs(values - offset))
    fall, pace = _line(cycles, logarithms), _line(cycles, moments)
    if fall.slope >= 0:
        raise ValueError(f"record must decay, got a logarithmic decrement of {-fall.slope:.2g}; "
                         "cut it to begin where nothing drives it any more")
    quantile = float(student.ppf((1 + CONFIDENCE) / 2, len(cycles) - 2))
    damping = _ratio(-fall.slope)
    share = 1 - damping**2
    error = share**1.5 / (2 * np.pi) * fall.error
    frequency = 1 / (pace.slope * share**0.5)
    spread = frequency * float(np.hypot(pace.error / pace.slope, damping * error / share))
    return FreeDecay(
        frequency=frequency, frequency_error=spread,
        frequency_interval=(frequency - quantile * spread, frequency + quantile * spread),
        damping=damping, damping_error=error,
        damping_interval=(_ratio(-fall.slope - quantile * fall.error), _ratio(-fall.slope + quantile * fall.error)),
        damped_frequency=1 / pace.slope, decrement=-fall.slope, amplitude=float(np.exp(fall.level)), offset=offset,
        r_squared=float(np.corrcoef(cycles, logarithms)[0, 1])**2, times=moments, values=values, record=record)


class _Line(NamedTuple):
    """A line fitted by least squares."""

    slope: float
    level: float            # where x is 0
    error: float            # standard error of the slope


def _line(x: Array, y: Array) -> _Line:
    centred = x - np.mean(x)
    square = float(centred @ centred)
    slope = float(centred @ y) / square
    level = float(np.mean(y) - slope * np.mean(x))
    leverage = 1 / len(x) + centred**2 / square
    error = float(np.linalg.norm(centred * (y - level - slope * x) / (1 - leverage))) / square   # HC3
    return _Line(slope, level, error)


def _ratio(decrement: float) -> float:
    """Damping ratio of a logarithmic decrement."""
    return decrement / float(np.hypot(2 * np.pi, decrement))


def _halves(moments: Array) -> Array:
    return np.arange(len(moments)) / 2


def _offset(values: Array) -> float:
    """The level c about which successive values form a geometric series: (a - c)(e - c) = (b - c)².

    Every three in turn give (a - 2b + e) c = ae - b²; least squares gives the weight to the large.
    """
    a, b, e = values[:-2], values[1:-1], values[2:]
    factor = a - 2 * b + e
    return float(factor @ (a * e - b**2) / (factor @ factor))


def _used(moments: Array, amplitudes: Array, band: tuple[float, float], end: float) -> slice:
    """From the last above the band on, until the first below it, after the largest."""
    highest, lowest = band
    top = int(np.argmax(amplitudes))
    shares = amplitudes[top:] / amplitudes[top]
    stop = int(np.argmax(np.append(shares < lowest, True)))
    start = int(np.max(np.flatnonzero(shares[:stop] > highest), initial=-1)) + 1
    if stop - start < FEWEST:
        raise ValueError(f"record must hold at least {FEWEST} extremes between {highest:.0%} and {lowest:.0%} of the "
                         f"largest, after it, got {stop - start} from {moments[top]:.4g} to {end:.4g} s; give a longer "
                         "record, cut what drove it, or widen highest= and lowest=")
    return slice(top + start, top + stop)


def _check_steadiness(moments: Array) -> None:
    gaps = np.diff(moments)
    middle = float(np.median(gaps))
    if np.any(np.abs(gaps - middle) > UNEVEN * middle):
        raise ValueError(f"record must be dominated by one mode, got extremes {gaps.min():.3g} to {gaps.max():.3g} s "
                         "apart; filter it about the mode, or excite that mode alone")


def _band(highest: float, lowest: float) -> tuple[float, float]:
    remedy = "give shares of the largest, as 0.9 and 0.2"
    most = check.number("highest", highest, above=0, most=1, remedy=remedy)
    return most, check.number("lowest", lowest, above=0, below=most, remedy=remedy)


def _read(record: ct.TimeResponseData | ArrayLike, timepts: ArrayLike | None, output: int) -> tuple[Array, Array]:
    """Times and the one signal of a record."""
    index = check.whole("output", output, least=0, remedy="count from 0")
    time, rows = signals(record, timepts)
    if index >= len(rows):
        raise ValueError(f"output must be below {len(rows)}, got {index}; the record has no more")
    return time, rows[index]

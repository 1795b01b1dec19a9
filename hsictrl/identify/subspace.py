"""Subspace identification: modes of a structure from its response alone, with intervals; pyOMA-2 does it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import decimate, detrend
from scipy.stats import t as student

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.identify.oma import Poles, poles
from hsictrl.identify.reading import signals

BLOCKS = 50             # of a record, between which covariances scatter
FEWEST_ROWS = 10        # block rows of the Hankel matrix
MARGIN = 3.0            # samples, after decimation, in a period of the highest frequency that is asked for
STILL = 1e-12           # of the largest value, which rounding leaves of a straight line
QUANTILE = float(student.ppf(0.975, BLOCKS - 1))


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SubspaceMode:
    """A mode that was identified, with intervals; unpacks into frequency and damping.

    Parameters
    ----------
    frequency : float
        Natural frequency ``|λ|/2π`` of the pole [Hz].
    damping : float
        Damping ratio ``-Re λ/|λ|`` [-].
    frequency_error, damping_error : float
        Standard errors, from the scatter between blocks of the record [Hz, -].
    shape : array, shape (p,)
        Complex mode shape at the sensors, 1 where it is largest [-].
    order : int
        Order of the model that knows the mode best [-].

    Examples
    --------
    >>> mode = SubspaceMode(frequency=2.0, damping=0.01, frequency_error=0.002, damping_error=0.001,
    ...                     shape=np.ones(1, dtype=complex), order=2)
    >>> print(mode)
    2.0000 Hz [1.9960, 2.0040], 1.000 % [0.799, 1.201] (subspace, order 2)
    >>> frequency, damping = mode
    """

    frequency: float
    damping: float
    frequency_error: float
    damping_error: float
    shape: NDArray[np.complex128]
    order: int

    def __post_init__(self) -> None:
        check.freeze(self.shape)

    @property
    def frequency_interval(self) -> tuple[float, float]:
        """95 % interval of the frequency [Hz]."""
        return _interval(self.frequency, self.frequency_error)

    @property
    def damping_interval(self) -> tuple[float, float]:
        """95 % interval of the damping ratio [-]."""
        return _interval(self.damping, self.damping_error)

    def __iter__(self) -> Iterator[float]:
        return iter((self.frequency, self.damping))

    def __str__(self) -> str:
        (slow, fast), (low, high) = self.frequency_interval, self.damping_interval
        return (f"{self.frequency:.4f} Hz [{slow:.4f}, {fast:.4f}], {100 * self.damping:.3f} % [{100 * low:.3f}, "
                f"{100 * high:.3f}] (subspace, order {self.order})")

    def to_dict(self) -> dict[str, Any]:
        """Export with the units in the keys; the shape by its real and imaginary parts.

        Returns
        -------
        dict
            Plain numbers and lists, ready for JSON or a data frame.

        Examples
        --------
        >>> mode = SubspaceMode(frequency=2.0, damping=0.01, frequency_error=0.002, damping_error=0.001,
        ...                     shape=np.ones(1, dtype=complex), order=2)
        >>> mode.to_dict()["frequency_error_hz"]
        0.002
        """
        return {"frequency_hz": self.frequency, "damping": self.damping,
                "frequency_interval_hz": list(self.frequency_interval), "damping_interval": list(self.damping_interval),
                "frequency_error_hz": self.frequency_error, "damping_error": self.damping_error,
                "shape_real": self.shape.real.tolist(), "shape_imag": self.shape.imag.tolist(),
                "order": self.order}


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SubspaceIdentification:
    """Modes that were identified from one record, by frequency. Made by `subspace_identification`.

    Parameters
    ----------
    modes : tuple of SubspaceMode
        What was found, slowest first.

    Examples
    --------
    >>> mode = SubspaceMode(frequency=2.0, damping=0.01, frequency_error=0.002, damping_error=0.001,
    ...                     shape=np.ones(1, dtype=complex), order=2)
    >>> print(SubspaceIdentification(modes=(mode,)))
    2.0000 Hz [1.9960, 2.0040], 1.000 % [0.799, 1.201] (subspace, order 2)
    """

    modes: tuple[SubspaceMode, ...]

    def __str__(self) -> str:
        return "\n".join(map(str, self.modes)) or "no mode"

    def nearest(self, frequency: float) -> SubspaceMode:
        """The mode that is nearest to a frequency.

        Parameters
        ----------
        frequency : float
            Where a mode is expected [Hz].

        Returns
        -------
        SubspaceMode

        Raises
        ------
        ValueError
            If no mode was found at all.

        Examples
        --------
        >>> mode = SubspaceMode(frequency=2.0, damping=0.01, frequency_error=0.002, damping_error=0.001,
        ...                     shape=np.ones(1, dtype=complex), order=2)
        >>> SubspaceIdentification(modes=(mode,)).nearest(1.9).frequency
        2.0
        """
        aim = check.number("frequency", frequency, above=0, remedy="give Hz")
        if not self.modes:
            raise ValueError("a mode must have been found, got none; give a longer record, or another highest=")
        return min(self.modes, key=lambda mode: abs(mode.frequency - aim))


def subspace_identification(
    record: ct.TimeResponseData | ArrayLike, *, highest: float, timepts: ArrayLike | None = None,
    references: Sequence[int] | None = None, order: int = 10,
) -> SubspaceIdentification:
    """Frequencies, damping ratios and shapes of modes from the response to forces that nobody measured.

    Parameters
    ----------
    record : control.TimeResponseData or array_like, shape (m,) or (p, m)
        Accelerations, velocities or displacements at p sensors, evenly sampled [any, s].
    highest : float
        Modes up to this frequency are sought; the record is filtered and decimated to three to six times it [Hz].
    timepts : array_like, shape (m,), optional
        Times of a record given as an array [s].
    references : sequence of int, optional
        Outputs that serve as reference channels, from 0; all of them if not given [-].
    order : int
        Highest order of the models, twice the number of modes and more [-].

    Returns
    -------
    SubspaceIdentification

    Raises
    ------
    ImportError
        If pyOMA-2 is not installed: ``pip install 'hsictrl[oma]'``.
    ValueError
        If the record is uneven, has holes, is sampled too slowly, or is too short.

    Notes
    -----
    Covariance-driven stochastic subspace identification with reference channels (Peeters and De Roeck, 1999), with
    the uncertainty of Döhler and Mevel (2013): pyOMA-2 does both. The forces are taken as white up to `highest`; a
    harmonic of walking shows as a mode of its own.

    Models of order 2, 4, … are fitted. Of all their poles the one with the smallest relative standard error of
    damping is a mode; those whose frequency intervals overlap with its own are the same one, and leave; then the next
    is taken, as long as its damping is known to lie above zero.

    Standard errors come from 50 blocks of the record, each of which must hold the time that the covariances span;
    intervals are those of Student's t.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> occupied = hsi.couple(hsi.reference_bridge(), hsi.Pedestrian(), np.linspace(0, 50, 15),
    ...                       sense_at=[12.5, 25.0, 37.5])
    >>> record = hsi.virtual_measurement(occupied, rng=np.random.default_rng(1))
    >>> print(subspace_identification(record, highest=3.0))
    1.9740 Hz [1.9700, 1.9780], 0.624 % [0.447, 0.801] (subspace, order 2)
    >>> print(hsi.effective(occupied, method="pole"))
    1.9726 Hz, 0.716 % (pole), |H| = 0.002696 m/s² per N
    """
    time, outputs = signals(record, timepts)
    most = check.whole("order", order, least=4, remedy="give twice the number of modes that you expect, and more")
    channels = _references(references, len(outputs))
    reduced, rate = _reduced(outputs, time, highest)
    rows = max(FEWEST_ROWS, most + 1)
    _check_length(reduced.shape[1], rate, rows)
    return SubspaceIdentification(modes=tuple(_modes(poles(
        reduced, rate, channels, highest_order=most, rows=rows, blocks=BLOCKS), highest)))


def _modes(found: Poles, highest: float) -> list[SubspaceMode]:
    """The best known of the poles that belong together, by frequency."""
    relative = found.damping_error / found.damping
    known = (QUANTILE * relative < 1) & (found.frequency <= highest)
    left = np.full(len(relative), True)
    modes = []
    while np.any(left & known):
        best = int(np.argmin(np.where(left & known, relative, np.inf)))
        modes.append(_mode(found, best))
        reach = QUANTILE * (found.frequency_error + found.frequency_error[best])
        left &= np.abs(found.frequency - found.frequency[best]) > reach
    return sorted(modes, key=lambda mode: mode.frequency)


def _mode(found: Poles, index: int) -> SubspaceMode:
    return SubspaceMode(
        frequency=float(found.frequency[index]), frequency_error=float(found.frequency_error[index]),
        damping=float(found.damping[index]), damping_error=float(found.damping_error[index]),
        shape=found.shape[index], order=int(found.order[index]))


def _reduced(outputs: Array, time: Array, highest: float) -> tuple[Array, float]:
    """Signals without trend and without what is faster than asked for, and their sampling frequency [Hz]."""
    given = (len(time) - 1) / float(time[-1] - time[0])
    most = check.number("highest", highest, above=0, remedy="give the frequency [Hz] up to which modes are sought")
    if given < MARGIN * most:
        raise ValueError(f"record must be sampled at {MARGIN:g} times highest={most:g} Hz at least, got {given:.4g} "
                         "Hz; sample it faster, or seek slower modes")
    factor = int(given / (MARGIN * most) + 1e-9)
    level = detrend(outputs, axis=1)
    still = np.flatnonzero(np.std(level, axis=1) <= STILL * np.max(np.abs(outputs)))
    if still.size:
        raise ValueError(f"every output must vibrate, got none in {still[0]}; leave it out")
    return (decimate(level, factor, ftype="fir", axis=1) if factor > 1 else level), given / factor


def _check_length(samples: int, rate: float, rows: int) -> None:
    least = 2 * rows * BLOCKS
    if samples < least:
        raise ValueError(f"record must be at least {least / rate:.4g} s long for these highest= and order=, got "
                         f"{samples / rate:.4g} s; measure longer, or lower order=")


def _references(given: Sequence[int] | None, outputs: int) -> list[int]:
    """Indices of the reference channels."""
    if given is None:
        return list(range(outputs))
    chosen = [check.whole("references", index, least=0, remedy="count from 0")
              for index in check.several("references", given)]
    if max(chosen) >= outputs or len(set(chosen)) < len(chosen):
        raise ValueError(f"references must be different outputs below {outputs}, got {chosen}; count from 0")
    return chosen


def _interval(estimate: float, error: float) -> tuple[float, float]:
    return estimate - QUANTILE * error, estimate + QUANTILE * error

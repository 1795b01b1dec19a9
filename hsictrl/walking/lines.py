"""Forces of walkers as lines of a comb of multiples of the step frequency, evaluated at any time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import ArrayLike, NDArray
from scipy.fft import irfft

from hsictrl import _checks as check
from hsictrl._checks import Array

Complex = NDArray[np.complex128]
Whole = NDArray[np.intp]

OVERSAMPLING = 14       # fewest table points per period of the highest line, for an error of 2e-5
SMALLEST_TABLE = 1024   # few-line models reach 1e-10 at hardly any cost
WALKERS_AT_ONCE = 8     # tables and samples of so many walkers stay in cache


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ForceLines:
    """Forces of n walkers as lines of a comb: F_k(t) = Re Σ_l c_kl exp(2πi l d f_k t), l = first, ….

    Parameters
    ----------
    coefficients : array_like of complex, shape (n, L)
        Amplitude times exp(i phase at t = 0) of each line [N].
    first : int
        Index l of the first line, at least 1: the static weight is no line [-].
    spacing : float
        Distance d between lines, as a fraction of the step frequency [-].
    step_frequency : array_like, shape (n,)
        Step frequency f_k of each walker [Hz].

    Examples
    --------
    A first harmonic of 301 N and a second of 56 N, as cosines:

    >>> force = ForceLines(coefficients=[[301.0, 56.0]], first=1, spacing=1.0, step_frequency=[2.0])
    >>> force.at([0.0, 0.25])
    array([[ 357., -245.]])
    """

    coefficients: Complex
    first: int
    spacing: float
    step_frequency: Array

    def __post_init__(self) -> None:
        coefficients = _coefficients(self.coefficients)
        frequency = check.numbers("step_frequency", self.step_frequency, above=0, remedy="give Hz")
        shaped("step_frequency", frequency, coefficients.shape[:1], "give one per row of coefficients")
        check.store(
            self, coefficients=coefficients, step_frequency=frequency,
            first=check.whole("first", self.first, least=1, remedy="leave the static weight out"),
            spacing=check.number("spacing", self.spacing, above=0, remedy="give a fraction of a step"))

    @property
    def n_walkers(self) -> int:
        """Number of walkers [-].

        Examples
        --------
        >>> ForceLines(coefficients=[[301.0]], first=1, spacing=1.0, step_frequency=[2.0]).n_walkers
        1
        """
        return len(self.coefficients)

    @property
    def frequencies(self) -> Array:
        """Frequency of every line, shape (n, L) [Hz].

        Examples
        --------
        >>> ForceLines(coefficients=[[301.0, 56.0]], first=1, spacing=1.0, step_frequency=[2.0]).frequencies
        array([[2., 4.]])
        """
        return np.multiply.outer(self.step_frequency, self.spacing * self.indices)

    @property
    def highest_frequency(self) -> float:
        """Frequency of the highest line that is not zero; 0 when there is none [Hz].

        Examples
        --------
        >>> force = ForceLines(coefficients=[[301.0, 0.0]], first=1, spacing=1.0, step_frequency=[2.0])
        >>> force.highest_frequency
        2.0
        """
        return float(np.max(self.frequencies, where=self.coefficients != 0, initial=0.0))

    def at(self, times: ArrayLike) -> Array:
        """Evaluate the forces at any times, line by line.

        The sum is a polynomial in exp(2πi d f_k t), taken by Horner's rule: memory stays a few times the
        result's.

        Parameters
        ----------
        times : array_like, shape (m,)
            Times on the clock on which the phases hold at 0 [s].

        Returns
        -------
        array, shape (n, m)
            Force of every walker [N].

        Examples
        --------
        >>> force = ForceLines(coefficients=[[301.0]], first=1, spacing=1.0, step_frequency=[2.0])
        >>> force.at([0.0, 0.25, 0.5])
        array([[ 301., -301.,  301.]])
        """
        times = check.numbers("times", times, ndim=1, remedy="give a list of seconds")
        cycles = np.multiply.outer(self.spacing * self.step_frequency, times)
        turn = np.exp(2j * np.pi * (cycles - np.floor(cycles)))
        return np.real(turn**self.first * polyval(turn, self.coefficients.T[:, :, np.newaxis], tensor=False))

    def on_grid(self, start: ArrayLike, count: int, step: float) -> Array:
        """Sample the forces at even steps, each walker over a stretch of its own.

        One inverse FFT per walker tabulates a period of the comb, a cubic B-spline with exact prefilter
        reads the table at the sample times: the work per sample does not grow with the number of lines. The
        largest error measured against `at`, relative to each walker's peak, is 1e-5 for the narrow-band model
        of spacing 0.01 (2e-5 at any other) and 1e-10 for up to four harmonics. The digits of a walker do not
        depend on the others.

        Parameters
        ----------
        start : array_like, shape (n,)
            Time of each walker's first sample [s].
        count : int
            Number of samples of every walker [-].
        step : float
            Time step [s].

        Returns
        -------
        array, shape (n, count)
            Force of walker k at start[k] + (0, 1, …, count − 1) step [N].

        Examples
        --------
        >>> force = ForceLines(coefficients=[[301.0]], first=1, spacing=1.0, step_frequency=[2.0])
        >>> force.on_grid([0.25], count=3, step=0.125).round(6)
        array([[-301.,    0.,  301.]])
        """
        starts = check.numbers("start", start, remedy="give s")
        shaped("start", starts, self.step_frequency.shape, "give one time per walker")
        offsets = np.arange(check.whole("count", count, least=0, remedy="give the number of samples"))
        step = check.number("step", step, above=0, remedy="give s")
        samples = np.empty((self.n_walkers, len(offsets)))
        periods = self.spacing * self.step_frequency
        for block in _blocks(self.n_walkers):
            cycles = (starts[block, np.newaxis] + offsets * step) * periods[block, np.newaxis]
            samples[block] = _read(tabulated(self.coefficients[block], self.indices), cycles)
        return samples

    def tables(self, finer: int = 1) -> Array:
        """Tabulate one period of each walker's force, for readers of their own.

        Parameters
        ----------
        finer : int
            How many times as many places as `on_grid` takes, for an error that falls with its fourth power [-].

        Returns
        -------
        array, shape (n, size + 4)
            Cubic B-spline coefficients over six at `size` even places of the period that begins at t = 0, which
            repeats after 1/(spacing · step_frequency); one more in front and three more at the end, so that the
            four at place i stand in columns i to i + 3 [N].

        Examples
        --------
        >>> force = ForceLines(coefficients=[[301.0]], first=1, spacing=1.0, step_frequency=[2.0])
        >>> table = force.tables()
        >>> table.shape, float((table[0, 0] + 4 * table[0, 1] + table[0, 2]).round(6))    # F(0)
        ((1, 1028), 301.0)
        """
        return tabulated(self.coefficients, self.indices, check.whole("finer", finer, least=1, remedy="give 1, 2, …"))

    @property
    def indices(self) -> Whole:
        """Indices l of the lines, shape (L,) [-].

        Examples
        --------
        >>> ForceLines(coefficients=[[301.0, 56.0]], first=1, spacing=1.0, step_frequency=[2.0]).indices
        array([1, 2])
        """
        return np.arange(self.first, self.first + self.coefficients.shape[1])


def tabulated(coefficients: Complex, lines: Whole, finer: int = 1) -> Array:
    """B-spline coefficients over 6 of one period of combs (…, L), continued by 1 and 3 points, (…, size + 4)."""
    size = finer * max(SMALLEST_TABLE, 1 << int(OVERSAMPLING * lines[-1] - 1).bit_length())
    spectrum = np.zeros((*coefficients.shape[:-1], size // 2 + 1), dtype=complex)
    np.multiply(coefficients, 1 / (12 * np.sinc(lines / size) ** 4), out=spectrum[..., lines[0]:lines[-1] + 1])
    table = np.empty((*coefficients.shape[:-1], size + 4))
    table[..., 1:-3] = irfft(spectrum, size, norm="forward")      # of scipy, which transforms several at once
    table[..., 0] = table[..., -4]
    table[..., -3:] = table[..., 1:4]
    return table


def _read(table: Array, cycles: Array) -> Array:
    """Cubic B-spline of each row of `table` at a row of times, in periods of the comb."""
    place = (cycles - np.floor(cycles)) * (table.shape[1] - 4)
    knot = place.astype(np.intp)
    place -= knot
    knot += table.shape[1] * np.arange(len(table))[:, np.newaxis]
    a, b, c, d = (table.ravel()[tap:].take(knot) for tap in range(4))
    return spline(a, b, c, d, place)


def spline(a: Array, b: Array, c: Array, d: Array, x: Array) -> Array:
    """Six times the cubic B-spline at x in [0, 1) between the knots of b and c, by Horner's rule."""
    value = d - a + 3 * (b - c)
    value *= x
    value += 3 * (a - 2 * b + c)
    value *= x
    value += 3 * (c - a)
    value *= x
    value += a + 4 * b + c
    return value


def _blocks(n: int) -> list[slice]:
    return [slice(start, start + WALKERS_AT_ONCE) for start in range(0, n, WALKERS_AT_ONCE)]


def _coefficients(values: Any) -> Complex:
    array = np.array(values)
    if array.dtype.kind not in "iufc" or array.ndim != 2 or not array.shape[1]:
        raise ValueError(f"coefficients must be numbers of shape (n, L), L > 0, got {array.dtype} of shape "
                         f"{array.shape}; give one row per walker")
    if not np.all(np.isfinite(array)):
        raise ValueError("coefficients must be finite, got nan or inf; give N")
    array = array.astype(complex, copy=False)
    array.flags.writeable = False
    return array


def shaped(name: str, array: NDArray[Any], shape: tuple[int, ...], remedy: str) -> None:
    if array.shape != shape:
        raise ValueError(f"{name} must have shape {shape}, got {array.shape}; {remedy}")

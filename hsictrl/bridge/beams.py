"""Mode shapes of uniform Euler-Bernoulli beams on several spans."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import final

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from hsictrl import _checks as check
from hsictrl._checks import Array, Direction
from hsictrl.bridge.shapes import UniformShape

# The derivative that vanishes with the deflection at such an end.
_FREE_OF = {"pinned": 2, "clamped": 1}
# On shorter spans 1 - cos βl cosh βl, about (βl)⁴/6, drowns in rounding.
_SHORTEST = 1e-3
# Closer wavenumbers leave no digits to tell the two shapes apart.
_CLOSEST = 1e-12
_GAUSS = np.polynomial.legendre.leggauss(24)


@final
@dataclass(frozen=True, slots=True, eq=False)
class BeamShape(UniformShape):
    """Mode shape of a uniform Euler-Bernoulli beam on several spans.

    It solves φ'''' = β⁴φ; natural frequencies are proportional to β². The inner supports are pinned.

    Parameters
    ----------
    spans : array_like
        Lengths of the spans, from left to right [m].
    ends : (str, str)
        How the left and the right end are held, each "pinned" or "clamped".
    number : int
        Number of the mode, in the order of frequency, from one [-].
    direction : {"vertical", "lateral"}
        The direction in which the shape moves; it is zero in the other.

    Attributes
    ----------
    wavenumber : float
        β of this mode [1/m].
    coefficients : ndarray
        Of sin βξ, cos βξ, exp(-βξ) and exp(-β(l-ξ)), one row for each span, ξ from its left support [-].

    References
    ----------
    W.H. Wittrick, F.W. Williams, Q. J. Mech. Appl. Math. 24 (1971) 263-284: the count by which no mode is
    missed. Y. Tang, J. Eng. Mech. 129 (2003) 1475-1477: a basis in which no high mode overflows.

    Examples
    --------
    >>> from hsictrl.bridge.beams import BeamShape
    >>> shape = BeamShape([20.0, 30.0, 20.0])
    >>> x, y = shape.antinode
    >>> round(x, 6), round(float(shape(x)), 12)
    (35.0, 1.0)
    >>> round(shape.wavenumber * 30.0, 4)
    3.734
    """

    spans: Array
    ends: tuple[str, str] = ("pinned", "pinned")
    number: int = 1
    direction: Direction = "vertical"
    length: float = field(init=False)
    wavenumber: float = field(init=False)
    coefficients: Array = field(init=False, repr=False)
    _antinode: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        check.store(self, spans=_checked_spans(self.spans), ends=_checked_ends(self.ends))
        check.store(self, number=check.whole("number", self.number, least=1, remedy="count the modes from one"))
        check.choice("direction", self.direction, check.DIRECTIONS)
        check.store(self, length=float(np.sum(self.spans)))
        check.store(self, wavenumber=_wavenumber(self.spans, self.ends, self.number))
        null_vector = np.linalg.svd(_boundary(self.wavenumber, self.spans, self.ends))[2][-1]
        check.store(self, coefficients=null_vector.reshape(-1, 4))
        self._normalise()

    @property
    def supports(self) -> Array:
        """Places of the supports, the ends among them [m]."""
        return np.concatenate([[0.0], np.cumsum(self.spans)])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, BeamShape) and self._beam == other._beam

    def __hash__(self) -> int:
        return hash(self._beam)

    @property
    def _beam(self) -> tuple[object, ...]:
        return (*self.spans.tolist(), self.ends, self.number, self.direction)

    @property
    def antinode(self) -> tuple[float, float]:
        return self._antinode, 0.0

    @property
    def mean_square(self) -> float:
        return self._mean(np.square)

    @property
    def mean_absolute(self) -> float:
        return self._mean(np.abs)

    def _along(self, x: Array, order: int = 0) -> Array:
        starts = self.supports[:-1]
        span = np.searchsorted(starts, x, side="right") - 1
        waves = _basis(self.wavenumber * (x - starts[span]), self.wavenumber * self.spans[span], order)
        return np.einsum("...k,...k->...", waves, self.coefficients[span])

    def _stationary(self) -> Array:
        """Supports and places of zero slope: φ is monotonic between neighbours."""
        longest = self.wavenumber * np.max(self.spans)
        within = np.linspace(0.0, 1.0, 8 * int(np.ceil(longest / np.pi)) + 1)
        samples = (self.supports[:-1, None] + self.spans[:, None] * within).ravel()
        return np.union1d(self.supports, _crossings(lambda x: self._along(x, order=1), samples))

    def _normalise(self) -> None:
        places = self._stationary()
        values = self._along(places)
        largest = np.max(np.abs(values))
        first = np.flatnonzero(np.abs(values) > (1 - 1e-9) * largest)[0]
        coefficients = self.coefficients / values[first]
        coefficients.flags.writeable = False
        check.store(self, coefficients=coefficients, _antinode=float(places[first]))

    def _mean(self, of: Callable[[Array], Array]) -> float:
        """Gauss-Legendre quadrature between supports and sign changes, where |φ| is smooth."""
        edges = np.union1d(self.supports, _crossings(self._along, self._stationary()))
        nodes, weights = _GAUSS
        half = np.diff(edges)[:, None] / 2
        values = of(self._along(edges[:-1, None] + half * (1 + nodes)))
        return float(np.sum(half * weights * values) / self.length)


def beam_modes(
    spans: ArrayLike, ends: tuple[str, str] = ("pinned", "pinned"), n_modes: int = 1,
) -> list[tuple[float, BeamShape]]:
    """Return the lowest modes of a uniform Euler-Bernoulli beam on several spans.

    Parameters
    ----------
    spans : array_like
        Lengths of the spans, from left to right [m].
    ends : (str, str)
        How the left and the right end are held, each "pinned" or "clamped".
    n_modes : int
        Number of modes [-].

    Returns
    -------
    list of (float, BeamShape)
        The frequency relative to that of the first mode [-], and the shape.

    Examples
    --------
    >>> from hsictrl.bridge.beams import beam_modes
    >>> [round(ratio, 4) for ratio, shape in beam_modes([25.0, 25.0], n_modes=4)]
    [1.0, 1.5622, 4.0, 5.0625]
    """
    n_modes = check.whole("n_modes", n_modes, least=1, remedy="ask for one mode or more")
    lengths = _checked_spans(spans)
    shapes = [BeamShape(lengths, ends, j) for j in range(1, n_modes + 1)]
    return [((shape.wavenumber / shapes[0].wavenumber) ** 2, shape) for shape in shapes]


def _checked_spans(spans: ArrayLike) -> Array:
    remedy = "give a list with the length of each span in metres"
    lengths = check.numbers("spans", spans, above=0.0, ndim=1, remedy=remedy)
    check.whole("the number of spans", lengths.size, least=1, remedy=remedy)
    remedy = f"leave out spans below {_SHORTEST:g} of the longest and clamp the beam there"
    return check.numbers("spans", lengths, least=_SHORTEST * np.max(lengths), remedy=remedy)


def _checked_ends(ends: tuple[str, str]) -> tuple[str, str]:
    remedy = "give one word for each end, as in ('pinned', 'clamped')"
    if len(check.instance("ends", ends, (tuple, list), remedy)) != 2:
        raise ValueError(f"ends must be two, got {len(ends)}; {remedy}")
    for end in ends:
        check.choice("each of the ends", end, tuple(_FREE_OF))
    return ends[0], ends[1]


def _crossings(f: Callable[[Array], Array], samples: Array) -> Array:
    """Roots of f between samples of unlike sign, by bisection of all at once."""
    positive = f(samples) >= 0
    at = np.flatnonzero(positive[1:] != positive[:-1])
    low, high = samples[at], samples[at + 1]
    for _ in range(54):
        middle = (low + high) / 2
        below = (f(middle) >= 0) == positive[at]
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return high


def _basis(phase: Array, total: Array, order: int) -> Array:
    """Derivatives with respect to the phase βξ of sin, cos and the exponentials from either support."""
    turned = phase + order * np.pi / 2
    falling = (-1) ** order * np.exp(-phase)
    return np.stack([np.sin(turned), np.cos(turned), falling, np.exp(phase - total)], axis=-1)


def _boundary(wavenumber: float, spans: Array, ends: tuple[str, str]) -> Array:
    """Conditions at all supports on the coefficients of all spans, one a row; singular at a mode."""
    n, phase = len(spans), wavenumber * spans
    each = np.eye(n)[:, :, None]
    start = [each * _basis(np.zeros(n), phase, order) for order in range(3)]
    stop = [each * _basis(phase, phase, order) for order in range(3)]
    joints = [stop[order][:-1] - start[order][1:] for order in (1, 2)]
    left, right = _FREE_OF[ends[0]], _FREE_OF[ends[1]]
    rows = [start[0], stop[0], *joints, start[left][:1], stop[right][-1:]]
    return np.concatenate(rows).reshape(4 * n, 4 * n)


def _wavenumber(spans: Array, ends: tuple[str, str], number: int) -> float:
    def determinant(beta: float) -> float:
        return float(np.linalg.det(_boundary(beta, spans, ends)))

    low, high = _bracket(spans, ends, number)
    return brentq(determinant, low, high, xtol=1e-16 * high, rtol=1e-15)


def _bracket(spans: Array, ends: tuple[str, str], number: int) -> tuple[float, float]:
    """Interval that holds the wavenumber of mode `number` and no other."""
    low = 3.0 / np.sum(spans)  # supports can only raise the lowest above π/L
    high = 2 * low
    while _count(high, spans, ends) < number:
        low, high = high, 2 * high
    while _count(low, spans, ends) < number - 1 or _count(high, spans, ends) > number:
        middle = (low + high) / 2
        low, high = (low, middle) if _count(middle, spans, ends) >= number else (middle, high)
        if high - low < _CLOSEST * high:
            raise ValueError(f"neighbouring wavenumbers must differ by {_CLOSEST:g}, got two at {high:g}/m; "
                             "vary the lengths of equal spans a little")
    return low, high


def _count(wavenumber: float, spans: Array, ends: tuple[str, str]) -> int:
    """Number of modes below a wavenumber (Wittrick and Williams 1971)."""
    phase = wavenumber * spans
    sin, cos, small = np.sin(phase), np.cos(phase), np.exp(-phase)
    sinh, cosh = 1 - small**2, 1 + small**2  # these and all below times 2exp(-βl), against overflow
    gap = 2 * small - cos * cosh
    stiffness = _joined((sin * cosh - cos * sinh) / gap, (sinh - 2 * small * sin) / gap)
    free = slice(int(ends[0] == "clamped"), len(spans) + (ends[1] == "pinned"))
    negative = np.count_nonzero(np.linalg.eigvalsh(stiffness[free, free]) < 0)
    half_waves = np.floor(phase / np.pi)
    clamped = half_waves - (1 - (-1) ** half_waves * np.sign(gap)) / 2
    return int(np.sum(clamped)) + int(negative)


def _joined(near: Array, far: Array) -> Array:
    """Dynamic stiffness of the rotations of all supports, EIβ = 1."""
    own = np.concatenate([near, [0.0]]) + np.concatenate([[0.0], near])
    return np.diag(own) + np.diag(far, 1) + np.diag(far, -1)

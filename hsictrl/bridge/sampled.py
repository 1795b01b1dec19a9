"""Mode shapes known at the nodes of a grid, as finite-element models give them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline, PPoly, make_interp_spline

from hsictrl import _checks as check
from hsictrl._checks import DIRECTIONS, Array, Direction
from hsictrl.bridge.shapes import Shape

# Odd, and high enough that φ″, too, meets that of a sine over ten nodes.
_DEGREE = 5
# Between closer nodes the spline swings, and enlarges what an export has rounded.
_CLOSEST = 1 / 20
# Antinodes that differ by less are equals: the spline errs as much.
_EQUAL = 1e-6
# Exact for the square of a piece of the spline.
_GAUSS = np.polynomial.legendre.leggauss(_DEGREE + 1)


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SampledShape(Shape):
    """Mode shape through values at nodes: quintic splines along the deck, straight lines across it.

    The values may be scaled anyhow; the shape is scaled to one at its antinode.

    Parameters
    ----------
    x : array_like, shape (n,)
        Places of the nodes along the deck, from 0 to its length, six or more [m].
    y : array_like, shape (m,)
        Places across the deck, each of a line of nodes along it; a single line stands for the whole width [m].
    vertical, lateral : array_like, shape (n, m), (n,) or ()
        The shape's components at the nodes; (n,) is the same on all lines [-].

    Attributes
    ----------
    length : float
        Length of the deck [m].
    scale : float
        What the values were divided by, their value at the antinode [-].

    Examples
    --------
    >>> x = np.linspace(0.0, 50.0, 51)
    >>> shape = SampledShape(x=x, vertical=-3 * np.sin(np.pi * x / 50))
    >>> round(shape.scale, 9), float(shape(12.5).round(6)), float(shape.derivative(0.0).round(6)) # π/50
    (-3.0, 0.707107, 0.062832)

    Torsion, and a swaying of a tenth:

    >>> wave = np.sin(np.pi * x / 50)
    >>> shape = SampledShape(x=x, y=[-1.5, 1.5], vertical=np.outer(wave, [-1, 1]), lateral=0.1 * wave)
    >>> shape([25.0, 25.0], [0.75, -1.5]).round(6), shape.antinode[1], float(shape(25.0, 0.0, "lateral").round(6))
    (array([-0.5,  1. ]), -1.5, -0.1)
    """

    x: Array
    y: ArrayLike = (0.0,)
    vertical: ArrayLike = 0.0
    lateral: ArrayLike = 0.0
    length: float = field(init=False)
    scale: float = field(init=False)
    _antinode: tuple[float, float] = field(init=False, repr=False)
    _splines: dict[str, BSpline] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        check.store(self, x=_checked_places(self.x), y=_checked_lines(self.y))
        values = {one: self._at_nodes(one) for one in DIRECTIONS}
        check.store(self, length=float(self.x[-1]),
                    _splines={one: make_interp_spline(self.x, values[one], k=_DEGREE) for one in DIRECTIONS})
        scale, antinode = self._largest()
        if not scale:
            raise ValueError("a shape must move somewhere, got zeros alone; give one of its components")
        check.store(self, scale=scale, _antinode=antinode,
                    _splines={one: make_interp_spline(self.x, values[one] / scale, k=_DEGREE) for one in DIRECTIONS},
                    **{one: values[one] / scale for one in DIRECTIONS})
        check.freeze(self.vertical, self.lateral)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SampledShape) and self._nodes == other._nodes

    def __hash__(self) -> int:
        return hash(self._nodes)

    def __call__(self, x: ArrayLike, y: ArrayLike = 0.0, direction: Direction = "vertical") -> Array:
        return self.derivative(x, y, direction, order=0)

    def derivative(self, x: ArrayLike, y: ArrayLike = 0.0, direction: Direction = "vertical", order: int = 1) -> Array:
        order = check.whole("order", order, least=0, remedy="give 0, 1 or 2")
        if order > _DEGREE:
            raise ValueError(f"order must be at most {_DEGREE}, the degree of the splines, got {order}; give 0, 1 or 2")
        spline = self._splines[check.choice("direction", direction, DIRECTIONS)]
        x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
        along = spline(np.clip(x, 0.0, self.length), nu=order)
        on_deck = (x >= 0) & (x <= self.length) & self._between_lines(y)
        return np.where(on_deck, np.sum(along * self._weights(y), axis=-1), 0.0)

    @property
    def antinode(self) -> tuple[float, float]:
        return self._antinode

    @property
    def mean_square(self) -> float:
        return self._mean(lambda vertical, lateral: vertical**2 + lateral**2)

    @property
    def mean_absolute(self) -> float:
        return self._mean(np.hypot)

    @property
    def _nodes(self) -> tuple[bytes, ...]:
        return tuple(np.asarray(values).tobytes() for values in (self.x, self.y, self.vertical, self.lateral))

    def _at_nodes(self, component: str) -> Array:
        remedy = "give a row for each x, and a column for each y"
        values = check.numbers(component, getattr(self, component), remedy=remedy)
        nodes = (len(self.x), np.size(self.y))
        if values.shape not in ((), nodes[:1], nodes):
            raise ValueError(f"{component} must have shape {nodes} or {nodes[:1]}, got {values.shape}; {remedy}")
        return np.broadcast_to(values[:, None] if values.ndim == 1 else values, nodes)

    def _between_lines(self, y: Array) -> Any:
        lines = np.asarray(self.y)
        return (len(lines) == 1) | ((y >= lines[0]) & (y <= lines[-1]))

    def _weights(self, y: Array) -> Array:
        """Of the lines in a place y, (..., m)."""
        return np.stack([np.interp(y, np.asarray(self.y), line) for line in np.eye(np.size(self.y))], axis=-1)

    def _largest(self) -> tuple[float, tuple[float, float]]:
        """The largest value, by its absolute, and the place that has it: the first on the line next to the centre."""
        found: list[tuple[float, float, float]] = []
        lines = np.asarray(self.y)
        for j in np.argsort(np.abs(lines), kind="stable"):
            for spline in self._splines.values():
                x = np.union1d(self.x, _roots(spline.derivative(), j))
                found += [(value, place, float(lines[j])) for value, place in zip(spline(x)[:, j], x, strict=True)]
        most = (1 - _EQUAL) * max(abs(value) for value, _, _ in found)
        scale, *antinode = next(one for one in found if abs(one[0]) >= most)
        return float(scale), (float(antinode[0]), antinode[1])

    def _mean(self, of: Callable[[Array, Array], Array]) -> float:
        """Gauss-Legendre quadrature along the centre line, between nodes and sign changes."""
        centre = [BSpline(one.t, one.c @ self._weights(np.zeros(1)).T, _DEGREE) for one in self._splines.values()]
        edges = np.unique(np.concatenate([self.x, *(_roots(one, 0) for one in centre)]))
        half = np.diff(edges)[:, None] / 2
        places = edges[:-1, None] + half * (1 + _GAUSS[0])
        vertical, lateral = (one(places)[..., 0] for one in centre)
        return float(np.sum(half * _GAUSS[1] * of(vertical, lateral)) / self.length)


def _checked_places(x: ArrayLike) -> Array:
    places = check.numbers("x", x, ndim=1, count=_DEGREE + 1, remedy="give six places along the deck or more")
    check.increasing("x", places, remedy="sort the nodes along the deck, and give each place once")
    if places[0]:
        raise ValueError(f"x must begin at 0, got {places[0]:g}; count it from the end of the deck")
    gaps = np.diff(places)
    i = int(np.argmin(gaps))
    if gaps[i] < _CLOSEST * np.max(gaps):
        raise ValueError(f"x must keep a distance of {_CLOSEST:g} of the longest, {np.max(gaps):g} m, got "
                         f"{places[i]:.9g} and {places[i + 1]:.9g}; leave the nodes of one of them out")
    return places


def _checked_lines(y: ArrayLike) -> Array:
    remedy = "give one or more lines of nodes, from one edge of the deck to the other"
    lines = check.numbers("y", y, ndim=1, count=1, remedy=remedy)
    if len(lines) == 1:
        return lines
    check.increasing("y", lines, remedy=remedy)
    if lines[0] > 0 or lines[-1] < 0:
        raise ValueError(f"y must hold lines on both sides of the centre line, got {lines[0]:g} to {lines[-1]:g}; "
                         "count it from the centre line")
    return lines


def _roots(spline: BSpline, column: int) -> Array:
    """Where a column of a spline vanishes, but for pieces that vanish as a whole."""
    pieces = PPoly.from_spline(BSpline(spline.t, spline.c[:, column], spline.k))
    roots = pieces.roots(extrapolate=False)
    return np.asarray(roots[np.isfinite(roots)], dtype=float)

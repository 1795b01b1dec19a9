"""How much of a deck a mode moves, in one direction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import DIRECTIONS, Array, Direction
from hsictrl.bridge.modal import Footbridge
from hsictrl.bridge.shapes import Shape

_ALONG, _ACROSS = (256, 4), (4, 2)    # pieces and points in each: |φ| has a bend where φ changes its sign


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Extent:
    """What a load of one direction meets of a mode shape.

    Parameters
    ----------
    largest : float
        Largest absolute value in the direction [-].
    mean_absolute : float
        Mean over the deck of the absolute value in the direction [-].
    mean_square : float
        Mean over the deck of the square, of both directions together, since people's mass moves in both [-].

    Examples
    --------
    >>> from hsictrl.bridge import eeklo_bridge
    >>> sway = Extent.of(eeklo_bridge(), 0, "vertical")         # a half sine that twists by half as much as it sways
    >>> sway.largest, round(sway.mean_absolute * np.pi, 6), round(sway.mean_square, 6)
    (0.5, 0.5, 0.541667)
    """

    largest: float
    mean_absolute: float
    mean_square: float

    @classmethod
    def of(cls, bridge: Footbridge, mode: int, direction: Direction) -> Extent:
        """Integrate a mode shape over the deck, by Gauss-Legendre quadrature in pieces."""
        shape = bridge.mode(mode).shape
        check.choice("direction", direction, DIRECTIONS)
        (x, along), (y, across) = _points(0.0, bridge.length, *_ALONG), _points(-0.5, 0.5, *_ACROSS)
        values = {one: shape(x[:, None], bridge.width * y[None, :], one) for one in DIRECTIONS}
        square = np.sum([value**2 for value in values.values()], axis=0)
        return cls(largest=_largest(shape, bridge.width, direction),
                   mean_absolute=float(along @ np.abs(values[direction]) @ across / bridge.length),
                   mean_square=float(along @ square @ across / bridge.length))


def _points(start: float, end: float, pieces: int, points: int) -> tuple[Array, Array]:
    """Places and weights of a quadrature from start to end."""
    places, weights = np.polynomial.legendre.leggauss(points)
    edges = np.linspace(start, end, pieces + 1)
    half = (edges[1] - edges[0]) / 2
    return np.add.outer(edges[:-1] + half, half * places).ravel(), np.tile(half * weights, pieces)


def _largest(shape: Shape, width: float, direction: Direction) -> float:
    """At the antinode, or on a grid from edge to edge."""
    x, y = np.linspace(0.0, shape.length, 401), width * np.linspace(-0.5, 0.5, 9)
    return float(np.max(np.abs([*shape(x[:, None], y, direction).flat, shape(*shape.antinode, direction)])))

"""The shape of a deck that sways and twists together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array, Direction
from hsictrl.bridge.shapes import Shape, SineShape


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class LateralTorsionShape(Shape):
    """Half sine along the deck, of which every cross section sways sideways and turns about its centre.

    The lateral motion is sin(πx/L) all over the width B, and the vertical one r · 2y/B · sin(πx/L).

    Parameters
    ----------
    length : float
        Length L of the deck [m].
    width : float
        Width B of the deck [m].
    ratio : float
        Vertical motion of the edge y = B/2 over the lateral motion, r, from -1 to 1 [-].

    Examples
    --------
    >>> shape = LateralTorsionShape(length=42.0, width=3.0, ratio=0.5)
    >>> float(shape(21.0, 0.75, "lateral")), shape(21.0, [-1.5, 0.0, 0.75]).tolist()
    (1.0, [-0.5, 0.0, 0.25])
    """

    length: float
    width: float
    ratio: float

    def __post_init__(self) -> None:
        for name in ("length", "width"):
            remedy = f"give the {name} of the deck in metres"
            check.store(self, **{name: check.number(name, getattr(self, name), above=0, remedy=remedy)})
        remedy = "scale the shape to its lateral motion, which is the larger one"
        check.store(self, ratio=check.number("ratio", self.ratio, least=-1, most=1, remedy=remedy))

    def __call__(self, x: ArrayLike, y: ArrayLike = 0.0, direction: Direction = "vertical") -> Array:
        return self.derivative(x, y, direction, 0)

    def derivative(self, x: ArrayLike, y: ArrayLike = 0.0, direction: Direction = "vertical", order: int = 1) -> Array:
        check.choice("direction", direction, check.DIRECTIONS)
        along = self._sine.derivative(x, y, "vertical", order)
        return along if direction == "lateral" else self.ratio * 2 * np.asarray(y, dtype=float) / self.width * along

    @property
    def antinode(self) -> tuple[float, float]:
        return self._sine.antinode

    @property
    def mean_square(self) -> float:
        return self._sine.mean_square

    @property
    def mean_absolute(self) -> float:
        return self._sine.mean_absolute

    @property
    def _sine(self) -> SineShape:
        return SineShape(self.length)

"""Mode shapes: what each can be asked, and the sine of a simple span."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array, Direction


class Shape(ABC):
    """A mode shape [-]: its largest absolute value on the deck is one, and it is zero off the deck.

    Attributes
    ----------
    length : float
        Length of the deck, from x = 0 [m].

    Examples
    --------
    >>> from hsictrl.bridge.shapes import Shape, SineShape
    >>> shape: Shape = SineShape(50.0)
    >>> x, y = shape.antinode
    >>> float(shape(x, y)), float(shape(x, y, "lateral")), float(shape(51.0))
    (1.0, 0.0, 0.0)
    """

    __slots__ = ()
    length: float

    @abstractmethod
    def __call__(self, x: ArrayLike, y: ArrayLike = 0.0, direction: Direction = "vertical") -> Array:
        """Return the shape at the points (x, y).

        Parameters
        ----------
        x : array_like
            Places along the deck; those off the deck give exactly zero [m].
        y : array_like
            Places across the deck, from its centre line; broadcast against `x` [m].
        direction : {"vertical", "lateral"}
            The direction in which the deck moves.

        Returns
        -------
        ndarray
            The shape, as large as `x` and `y` broadcast [-].
        """

    def derivative(self, x: ArrayLike, y: ArrayLike = 0.0, direction: Direction = "vertical", order: int = 1) -> Array:
        """Return a derivative of the shape along the deck, which convective terms need.

        Parameters
        ----------
        x, y, direction
            As where the shape itself is called.
        order : int
            Order of the derivative; 0 is the shape [-].

        Returns
        -------
        ndarray
            As large as `x` and `y` broadcast [1/m^order].

        Examples
        --------
        >>> from hsictrl.bridge.shapes import SineShape
        >>> SineShape(np.pi).derivative([0.0, np.pi / 2, np.pi]).round(12)
        array([ 1.,  0., -1.])
        """
        if check.whole("order", order, least=0, remedy="give 0, 1 or 2") == 0:
            return self(x, y, direction)
        raise ValueError(f"convective terms need the derivatives of every shape, got none of {type(self).__name__}; "
                         "give it a method derivative(x, y, direction, order), or leave convective terms out")

    @property
    @abstractmethod
    def antinode(self) -> tuple[float, float]:
        """Point (x, y) of the largest absolute value, the first of equals [m]."""

    @property
    @abstractmethod
    def mean_square(self) -> float:
        """Mean of the squared shape along the centre line, (1/L) ∫ φ² dx [-]."""

    @property
    @abstractmethod
    def mean_absolute(self) -> float:
        """Mean of the absolute shape along the centre line, ``(1/L) ∫ |φ| dx`` [-]."""


class UniformShape(Shape):
    """A mode shape in one direction, uniform across the deck, that is known along it by its phase βx."""

    direction: Direction
    wavenumber: float

    def __call__(self, x: ArrayLike, y: ArrayLike = 0.0, direction: Direction = "vertical") -> Array:
        return self.derivative(x, y, direction, 0)

    def derivative(self, x: ArrayLike, y: ArrayLike = 0.0, direction: Direction = "vertical", order: int = 1) -> Array:
        check.whole("order", order, least=0, remedy="give 0, 1 or 2")
        x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
        both = np.broadcast_shapes(x.shape, y.shape)
        if check.choice("direction", direction, check.DIRECTIONS) != self.direction:
            return np.zeros(both)
        off = (x < 0) | (x > self.length)
        along = self.wavenumber**order * self._along(np.clip(x, 0.0, self.length), order)
        return np.broadcast_to(np.where(off, 0.0, along), both).copy()

    @abstractmethod
    def _along(self, x: Array, order: int = 0) -> Array:
        """φ or one of its derivatives with respect to βx, on the deck."""


@final
@dataclass(frozen=True, slots=True)
class SineShape(UniformShape):
    """Mode shape sin(jπx/L) of a simply supported beam.

    Parameters
    ----------
    length : float
        Length L of the deck [m].
    number : int
        Number j of half waves [-].
    direction : {"vertical", "lateral"}
        The direction in which the shape moves; it is zero in the other.

    Examples
    --------
    >>> from hsictrl.bridge.shapes import SineShape
    >>> shape = SineShape(50.0, number=2)
    >>> shape([12.5, 37.5, 60.0])
    array([ 1., -1.,  0.])
    >>> shape.antinode, shape.mean_square
    ((12.5, 0.0), 0.5)
    """

    length: float
    number: int = 1
    direction: Direction = "vertical"

    def __post_init__(self) -> None:
        remedy = "give the length of the deck in metres"
        check.store(self, length=check.number("length", self.length, above=0.0, remedy=remedy))
        check.store(self, number=check.whole("number", self.number, least=1, remedy="count the half waves"))
        check.choice("direction", self.direction, check.DIRECTIONS)

    @property
    def antinode(self) -> tuple[float, float]:
        return self.length / (2 * self.number), 0.0

    @property
    def mean_square(self) -> float:
        return 0.5

    @property
    def mean_absolute(self) -> float:
        return 2 / np.pi

    @property
    def wavenumber(self) -> float:  # type: ignore[override]
        """β = jπ/L [1/m]."""
        return self.number * np.pi / self.length

    def _along(self, x: Array, order: int = 0) -> Array:
        return np.sin(self.wavenumber * x + order * np.pi / 2)

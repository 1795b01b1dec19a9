"""The deck of a footbridge: which places lie on it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array


class Deck:
    """What follows from length and width: the deck reaches from x = 0 to L and over half its width to either side."""

    __slots__ = ()
    length: float
    width: float

    @property
    def area(self) -> float:
        """Walkable surface of the deck, A [m²]."""
        return self.length * self.width

    def carries(self, positions: Any) -> NDArray[np.bool_]:
        """Which places lie on the deck.

        Parameters
        ----------
        positions : array_like, shape (n,) or (n, 2)
            Places x, or (x, y) [m].

        Returns
        -------
        array of bool, shape (n,)

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> reference_bridge(frequency=2.0).carries([-1.0, 25.0])
        array([False,  True])
        """
        x, y = check.points("positions", positions).T
        return np.asarray((x >= 0) & (x <= self.length) & (np.abs(y) <= self.width / 2))

    def carries_across(self, offsets: Any) -> NDArray[np.bool_]:
        """Which offsets from the centre line lie on the deck, so that a walker who keeps one is on it all along.

        Parameters
        ----------
        offsets : array_like, shape (n,)
            Places y across the deck [m].

        Returns
        -------
        array of bool, shape (n,)

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> reference_bridge(frequency=2.0).carries_across([-1.0, 2.0])      # 3 m wide
        array([ True, False])
        """
        y = check.numbers("offsets", offsets, ndim=1, remedy="give one place y in m per walker")
        return self.carries(np.column_stack([np.zeros_like(y), y]))

    def on_deck(self, name: str, positions: Any) -> Array:
        """Places on the deck as (n, 2) coordinates; refuse any that lie off it.

        Parameters
        ----------
        name : str
            What to call the places in a refusal.
        positions : array_like, shape (n,) or (n, 2)
            Places x, or (x, y) [m].

        Returns
        -------
        array, shape (n, 2)
            Coordinates x, y [m].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> reference_bridge(frequency=2.0).on_deck("positions", [10.0, 25.0]).shape
        (2, 2)
        """
        places = check.points(name, positions)
        carried = self.carries(places)
        if not np.all(carried):
            i = int(np.argmin(carried))
            raise ValueError(f"{name} must lie on the deck, 0 ≤ x ≤ {self.length:g} and |y| ≤ {self.width / 2:g} m, "
                             f"got {name}[{i}] = ({places[i, 0]:g}, {places[i, 1]:g}); move it, or leave it out")
        return places

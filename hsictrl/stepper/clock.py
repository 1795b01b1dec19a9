"""Times of a simulation: steps before the window, and steps within it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hsictrl._checks import Array

BLOCKS_IN_A_CROSSING = 8     # seats are taken and left so many times while somebody crosses


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Clock:
    """Even steps, in pairs, from an early start through evenly spaced times.

    Parameters
    ----------
    times : array, shape (m,)
        Evenly spaced times at which the response is given [s].
    start : float
        No force acts, and nothing moves, before this time [s].
    substeps : int
        Steps between two times [-].
    """

    times: Array
    start: float
    substeps: int

    @property
    def step(self) -> float:
        """Length of a step [s]."""
        return float((self.times[-1] - self.times[0]) / (len(self.times) - 1) / self.substeps)

    @property
    def pairs_before(self) -> int:
        """Pairs of steps from the start to the first of the times [-]."""
        return int(np.ceil(max(0.0, self.times[0] - self.start) / (2 * self.step)))

    @property
    def pairs(self) -> int:
        """Pairs of steps from the first of the times through the last [-]."""
        return -(-self.substeps * (len(self.times) - 1) // 2)

    def blocks(self, crossing: float) -> Array:
        """Ends of blocks of pairs, counted from the first of the times, one of which ends there, (b + 1,)."""
        longest = max(1, int(crossing / BLOCKS_IN_A_CROSSING / (2 * self.step)))
        early = np.arange(-self.pairs_before, 0, longest)
        late = np.append(np.arange(0, self.pairs, longest), self.pairs)
        return np.concatenate([early, late])

    def time(self, pairs: Array) -> Array:
        """Time so many pairs after the first of the times [s]."""
        return self.times[0] + 2 * self.step * pairs

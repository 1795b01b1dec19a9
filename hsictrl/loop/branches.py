"""Which pole is which, from one set of poles to the next."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

Complex = NDArray[np.complex128]


def followed(poles: Complex, before: Complex) -> Complex:
    """The poles in the order of those before them, with the least way in all."""
    return np.asarray(poles[linear_sum_assignment(np.abs(np.subtract.outer(before, poles)))[1]])


def all_followed(sets: Complex, start: Complex) -> Complex:
    """Sets of poles, shape (b, m), each in the order of the set before it, the first in that of the start.

    Where the nearest poles of all are different ones, they are the least way in all; elsewhere that is solved for.
    """
    apart = np.abs(np.concatenate([start[None], sets])[:-1, :, None] - sets[:, None, :])
    steps, same = apart.argmin(axis=2), np.arange(len(start))
    for i in np.flatnonzero(np.any(np.sort(steps, axis=1) != same, axis=1)):
        steps[i] = linear_sum_assignment(apart[i])[1]
    orders = np.tile(same, (len(sets), 1))
    for i in np.flatnonzero(np.any(steps != same, axis=1)):     # few: the host keeps an order as long as it can
        orders[i:] = steps[i][orders[i - 1] if i else same]
    return np.take_along_axis(sets, orders, axis=1)

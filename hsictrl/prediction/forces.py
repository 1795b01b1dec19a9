"""The modal force of a crowd that walks over the deck: Φᵀ(t) p_F(t) on a time grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.crowd import Walkers
from hsictrl.prediction.grid import Grid
from hsictrl.walking import ForceLines

Lines = list[tuple[NDArray[np.intp], ForceLines]]


def modal_force(bridge: Footbridge, walkers: Walkers, lines: Lines, grid: Grid) -> Array:
    """Sum of φ_j(x_k(t), y_k) F_k(t) over the walkers (eqs. 1–3), zero for those off the deck, along it or across.

    Parameters
    ----------
    bridge : Footbridge
        The bridge.
    walkers : Walkers
        Who walks, where and when.
    lines : list of (array of int, ForceLines)
        Their forces, ``walkers.lines()`` [N].
    grid : Grid
        Times [s].

    Returns
    -------
    array, shape (n_m, count)
        Modal forces in mass-normalised coordinates [N/√kg].
    """
    total = np.zeros((bridge.n_modes, grid.count))
    for who, force in lines:
        _add(total, bridge, walkers, who, force, grid)
    return total * grid.taper


def _add(
    total: Array, bridge: Footbridge, walkers: Walkers, who: NDArray[np.intp], force: ForceLines, grid: Grid,
) -> None:
    """Add the walkers of one force model, each over the samples of their own crossing."""
    arrival, speed, y = walkers.arrival[who], walkers.speed[who], walkers.offset[who]
    first = np.ceil((arrival - grid.first) / grid.step).astype(np.intp)
    count = int(np.ceil(bridge.length / speed.min() / grid.step))
    time = grid.first + grid.step * (first[:, None] + np.arange(count))
    x = speed[:, None] * (time - arrival[:, None])
    sample = force.on_grid(grid.first + grid.step * first, count, grid.step)
    start, stop = np.clip(-first, 0, count), np.clip(grid.count - first, 0, count)
    on_deck = np.flatnonzero((start < stop) & bridge.carries_across(y))
    for modal, mode in zip(total, bridge.modes, strict=True):
        share = mode.shape(x, y[:, None], "vertical")
        share *= sample
        share /= np.sqrt(mode.modal_mass)
        for k in on_deck:
            modal[first[k] + start[k]:first[k] + stop[k]] += share[k, start[k]:stop[k]]

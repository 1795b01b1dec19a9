"""The modal force of a crowd that walks over the deck: Φᵀ(t) p_F(t) on a time grid."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.crowd import Walkers
from hsictrl.prediction.grid import Grid
from hsictrl.walking import ForceLines, ForceParts
from hsictrl.walking.lines import WALKERS_AT_ONCE, Complex, tabulated

SHAPES_AT_ONCE = 64     # walkers

Indices = NDArray[np.intp]
Flags = NDArray[np.bool_]
Lines = list[tuple[Indices, ForceLines]]
Parts = list[tuple[Indices, ForceParts]]


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
    total = np.zeros((1, bridge.n_modes, grid.count))
    for who, force in lines:
        _add(total, bridge, walkers, who, (force.spacing * force.step_frequency)[None], np.ones((1, 1, len(who))),
             np.ones((1, len(who)), dtype=bool), partial(_tables, force.coefficients[None], force.indices), grid)
    return total[0] * grid.taper


def modal_forces(
    bridge: Footbridge, walkers: Walkers, parts: Parts, step_frequencies: Array, steps_on: Flags, grid: Grid,
) -> Array:
    """Modal forces of walkers who step at several frequencies, as `modal_force` gives them one by one.

    Parameters
    ----------
    bridge : Footbridge
        The bridge.
    walkers : Walkers
        Who walks, where and when; their step frequencies do not matter.
    parts : list of (array of int, ForceParts)
        What their forces are made of, ``walkers.parts()`` [N].
    step_frequencies : array, shape (u, n)
        Step frequencies of all walkers, u times [Hz].
    steps_on : array of bool, shape (u, n)
        Whether a walker comes at all.
    grid : Grid
        Times [s].

    Returns
    -------
    array, shape (u, n_m, count)
        Modal forces in mass-normalised coordinates [N/√kg].
    """
    total = np.zeros((len(step_frequencies), bridge.n_modes, grid.count))
    for who, force in parts:
        frequencies = step_frequencies[:, who]
        factors = np.stack([force.factors(one) for one in frequencies])
        _add(total, bridge, walkers, who, force.spacing * frequencies, factors,
             steps_on[:, who], partial(_tables, force.coefficients, force.indices), grid)
    return total * grid.taper


def _add(
    total: Array, bridge: Footbridge, walkers: Walkers, who: Indices, periods: Array, factors: Array, steps_on: Flags,
    tables: Callable[[Indices], Array], grid: Grid,
) -> None:
    """Add the walkers of one force model, some at a time: shapes and tables stay in cache."""
    from hsictrl.prediction.deposit import deposit  # only now: it loads the compiler

    first = np.ceil((walkers.arrival[who] - grid.first) / grid.step).astype(np.intp)
    count = min(int(np.ceil(np.max(walkers.stay(bridge.length)[who]) / grid.step)), grid.count - int(np.min(first)))
    present = np.flatnonzero((first > -count) & (first < grid.count) & walkers.carried(bridge)[who])
    for rows in _blocks(present, SHAPES_AT_ONCE):
        begin = grid.first + grid.step * first[rows]
        shapes = _shapes(bridge, walkers, who[rows], begin[:, None] + grid.step * np.arange(count))
        for part in _blocks(np.arange(len(rows)), WALKERS_AT_ONCE):
            chosen = rows[part]
            deposit(total, first[chosen], *map(np.ascontiguousarray, (
                shapes[:, part], tables(chosen), factors[:, :, chosen], steps_on[:, chosen],
                begin[part] * periods[:, chosen], grid.step * periods[:, chosen])))


def _tables(coefficients: Complex, lines: Indices, rows: Indices) -> Array:
    return tabulated(coefficients[:, rows], lines)


def _blocks(indices: Indices, size: int) -> list[Indices]:
    return [indices[start:start + size] for start in range(0, len(indices), size)]


def _shapes(bridge: Footbridge, walkers: Walkers, who: Indices, times: Array) -> Array:
    """Mass-normalised modes under some walkers, each at times of its own, shape (n_m, n, m) [1/√kg]."""
    x, y = walkers.along(times, who)
    return np.stack([mode.shape(x, y, "vertical") / np.sqrt(mode.modal_mass) for mode in bridge.modes])

"""The compiled kernel that lets walkers step over the deck: forces times shapes, sample by sample."""

from __future__ import annotations

import numpy as np
from numba import njit

from hsictrl._compiled import BORROWING, COMPILED, ONE, THREE, TWO
from hsictrl.walking.lines import spline


@njit(cache=True, **COMPILED)     # its parts are inlined into it
def deposit(total, first, shapes, tables, factors, steps_on, cycles, pace):  # type: ignore[no-untyped-def]
    """Add the modal forces of n walkers, each over samples of its own crossing, at u step frequencies at once.

    total : (u, n_m, count), modal forces to which is added
    first : (n), index in total of each walker's first sample, which may lie before the beginning
    shapes : (n_m, n, samples), modes under each walker, zero off the deck
    tables : (p, n, size + 4), `tabulated` parts of the forces
    factors : (u, p, n), what they are multiplied by
    steps_on : (u, n), whether a walker comes at all
    cycles, pace : (u, n), periods of the comb that have gone by at the first sample, and from one to the next
    """
    samples, knots = shapes.shape[2], np.empty(shapes.shape[2], np.int64)
    table, force, between = np.empty(tables.shape[2]), np.empty(samples), np.empty(samples)
    for k in range(len(first)):
        start, stop = max(0, -first[k]), max(0, min(samples, total.shape[2] - first[k]))
        for u in range(len(total)):
            if not steps_on[u, k]:
                continue
            _blend(tables, factors, u, k, table)
            _read(table, cycles[u, k], pace[u, k], force, knots, between)
            for j in range(total.shape[1]):
                _add(total[u, j, first[k] + start:first[k] + stop], shapes[j, k, start:stop], force[start:stop])


@njit(**BORROWING)
def _blend(tables, factors, u, k, table):  # type: ignore[no-untyped-def]
    """The force of walker k at its step frequency u."""
    for i in range(len(table)):
        table[i] = factors[u, 0, k] * tables[0, k, i]
    for p in range(1, len(tables)):
        for i in range(len(table)):
            table[i] += factors[u, p, k] * tables[p, k, i]


@njit(**BORROWING)
def _read(table, cycle, pace, force, knots, between):  # type: ignore[no-untyped-def]
    """Samples of a table; loops of their own, since the first one runs several samples at once."""
    for i in range(len(force)):
        now = cycle + i * pace
        place = (now - np.floor(now)) * (len(table) - 4)
        knots[i] = int(place)
        between[i] = place - knots[i]
    for i in range(len(force)):
        knot = np.uint64(knots[i])
        force[i] = _spline(table[knot], table[knot + ONE], table[knot + TWO], table[knot + THREE], between[i])


@njit(**BORROWING)
def _add(total, shapes, force):  # type: ignore[no-untyped-def]
    for i in range(len(total)):
        total[i] += shapes[i] * force[i]


_spline = njit(**BORROWING)(spline)

"""From block to block: a moving crowd on one clock."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from hsictrl._checks import Array
from hsictrl.coupling import MovingCrowd
from hsictrl.stepper import kernel
from hsictrl.stepper.clock import BLOCKS_IN_A_CROSSING, Clock
from hsictrl.stepper.deck import POINTS, Deck

TRACKED = 0.01     # s between the points of a table along a trajectory
LONGEST_CROSSING = BLOCKS_IN_A_CROSSING * POINTS * TRACKED


def march(crowd: MovingCrowd, clock: Clock, drive: Array, initial: Array) -> tuple[Array, Array]:
    """Step a bridge and those who walk over it; memory holds the window, and those on the deck.

    Parameters
    ----------
    crowd : MovingCrowd
        The time-varying system.
    clock : Clock
        Its times [s].
    drive : array, shape (m, n_m)
        Further modal forces at the times of the clock, linear in between; none before [N/√kg].
    initial : array, shape (2, n_m)
        Modal displacements and velocities at the start [m √kg, m √kg/s].

    Returns
    -------
    fine : array, shape (2 pairs + 1, 3, n_m)
        z, ż and z̈ at every step from the first of the times on.
    coarse : array, shape (pairs + 1, 3, n_m)
        Likewise at every second step, by steps twice as long.
    """
    n_m = crowd.bridge.n_modes
    blocks = clock.blocks(_crossing(crowd))
    deck = Deck(crowd, clock.step, clock.time(blocks))
    deck.fine[:, :n_m] = deck.coarse[:, :n_m] = initial
    fine, coarse = _empty_record(clock.pairs, n_m)
    for i, (first, last) in enumerate(pairwise(blocks)):
        deck.enter(i)
        record = (fine[2 * first:2 * last + 1], coarse[first:last + 1])
        kernel.march(
            clock.time(first), clock.step, deck.bridge, deck.contacts, _at_half_steps(clock, drive, first, last),
            deck.fine, deck.coarse, *(record if first >= 0 else _empty_record(last - first, n_m)))
    return fine, coarse


def _crossing(crowd: MovingCrowd) -> float:
    """Time in which the fastest cross the deck; so short that tables over a block resolve trajectories [s]."""
    walkers = crowd.traffic.walkers
    crossing = crowd.bridge.length / float(np.max(walkers.top_speed(), initial=0.1))
    return min(crossing, LONGEST_CROSSING) if walkers.trajectories else crossing


def _empty_record(pairs: int, n_m: int) -> tuple[Array, Array]:
    return np.empty((2 * pairs + 1, 3, n_m)), np.empty((pairs + 1, 3, n_m))


def _at_half_steps(clock: Clock, drive: Array, first: int, last: int) -> Array:
    """Further modal forces at every half step of a block of pairs."""
    half_steps = np.arange(4 * first, 4 * last + 1)
    if first < 0:
        return np.zeros((len(half_steps), drive.shape[1]))
    samples = np.arange(len(drive))
    return np.stack([np.interp(half_steps / (2 * clock.substeps), samples, column) for column in drive.T], axis=1)

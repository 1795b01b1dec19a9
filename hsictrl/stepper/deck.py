"""Who meets the deck, where and when: seats for those on it, which others take when they have left."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import DIRECTIONS, Array
from hsictrl.coupling import MovingCrowd
from hsictrl.stepper.kernel import Bridge, Contacts

POINTS = 513     # of a shape along the deck: the cubic between them loses 3e-11 of a half wave
TABLES_SUFFICE = 0.01     # s; at shorter steps the tables of the forces are to be finer, too

Indices = NDArray[np.intp]


class Deck:
    """Arrays of the kernel with as many seats as are needed at once, taken and left between blocks of time.

    A walker whose body moves laterally takes two seats: one for the body, one for the force, which is vertical.

    Parameters
    ----------
    crowd : MovingCrowd
        The bridge, and all who will walk over it.
    step : float
        Step of the kernel [s].
    blocks : array, shape (b + 1,)
        Times between which nobody takes a seat or leaves it [s].
    """

    def __init__(self, crowd: MovingCrowd, step: float, blocks: Array) -> None:
        walkers = crowd.traffic.walkers
        self._crowd, self._step = crowd, step
        self._finer = 1 << max(0, int(np.log2(TABLES_SUFFICE / step)))
        self._walkers = walkers.part(crowd.bridge.carries(np.column_stack([0 * walkers.offset, walkers.offset])))
        lateral = self._walkers.bodies.direction != "vertical"
        self._who = np.concatenate([np.arange(len(lateral)), np.flatnonzero(lateral)])
        self._embodied = np.arange(len(self._who)) < len(lateral)
        self._driven = ~(self._embodied & lateral[self._who])
        self._direction = np.where(self._embodied, self._walkers.bodies.direction[self._who], "vertical")
        self._arrival = self._walkers.arrival[self._who]
        self._departure = self._arrival + crowd.bridge.length / self._walkers.speed[self._who]
        self._first = np.maximum(np.searchsorted(blocks, self._arrival, side="right") - 1, 0)
        self._last = np.searchsorted(blocks, self._departure) - 1
        self._furnish(_most_at_once(self._first, self._last, len(blocks) - 1))

    def _furnish(self, seats: int) -> None:
        """Make empty seats."""
        bridge, orders = self._crowd.bridge, 3 if self._crowd.convective else 1
        n_m = bridge.n_modes
        self._seat = np.full(len(self._who), -1)
        self._free = np.ones(seats, dtype=bool)
        self.contacts = Contacts(
            paths=np.full((3, seats), np.inf), shapes=np.zeros((seats, orders, n_m, POINTS)),
            bodies=np.zeros((4, seats)), combs=np.zeros((seats, 4)), periods=np.zeros((2, seats)))
        modes = np.stack([bridge.omega**2, 2 * bridge.damping * bridge.omega])
        alone = self._propagators(*modes)
        self.bridge = Bridge(bridge.length, modes, np.concatenate([alone, np.zeros((3, 4, seats))], axis=2))
        self.fine, self.coarse = np.zeros((2, n_m + seats)), np.zeros((2, n_m + seats))

    def enter(self, block: int) -> None:
        """Let those go who have left, and seat those who come during a block, at rest."""
        gone = self._seat[(self._last == block - 1) & (self._seat >= 0)]
        self._free[gone] = True
        self.contacts.paths[:2, gone] = np.inf
        new = np.flatnonzero((self._first == block) & (self._last >= block))
        self._seat[new] = seats = np.flatnonzero(self._free)[:len(new)]
        self._free[seats] = False
        if len(new):
            self._seat_paths(new, seats)
            self._seat_bodies(new, seats)
            self._seat_forces(new[self._driven[new]])

    def _seat_paths(self, new: Indices, seats: Indices) -> None:
        speed, contacts = self._walkers.speed[self._who[new]], self.contacts
        contacts.paths[:, seats] = self._arrival[new], self._departure[new], speed
        x, y = np.linspace(0, self._crowd.bridge.length, POINTS), self._walkers.offset[self._who[new], None]
        for direction in DIRECTIONS:
            moves = self._direction[new] == direction
            for j, mode in enumerate(self._crowd.bridge.modes):
                for order in range(contacts.shapes.shape[1]):
                    shapes = mode.shape.derivative(x, y[moves], direction, order) / np.sqrt(mode.modal_mass)
                    contacts.shapes[seats[moves], order, j] = shapes * speed[moves, None] ** order

    def _seat_bodies(self, new: Indices, seats: Indices) -> None:
        people, n_m = self._walkers.bodies.part(self._who[new]), self._crowd.bridge.n_modes
        alone = people.stiffness / people.sprung_mass, people.damping_coefficient / people.sprung_mass
        share = self._embodied[new]
        self.contacts.bodies[:, seats] = *alone, share * people.sprung_mass, share * people.unsprung_mass
        self.bridge.propagators[:, :, n_m + seats] = self._propagators(*alone)
        self.fine[:, n_m + seats] = self.coarse[:, n_m + seats] = 0.0

    def _seat_forces(self, new: Indices) -> None:
        for row, force in self._walkers.part(self._who[new]).lines():
            tables, seats = force.tables(self._finer), self._seat[new[row]]
            missing = tables.shape[1] - self.contacts.combs.shape[1]
            if missing > 0:
                self.contacts = self.contacts._replace(combs=np.pad(self.contacts.combs, ((0, 0), (0, missing))))
            self.contacts.combs[seats, :tables.shape[1]] = tables
            self.contacts.periods[0, seats] = force.spacing * force.step_frequency
            self.contacts.periods[1, seats] = tables.shape[1] - 4

    def _propagators(self, stiffness: Array, damping: Array) -> Array:
        return np.stack([propagator(stiffness, damping, factor * self._step) for factor in (0.5, 1.0, 2.0)])


def propagator(stiffness: Array, damping: Array, time: float) -> Array:
    """Exact motion of free oscillators ẍ = −stiffness x − damping ẋ over some time, rows [xx, xẋ, ẋx, ẋẋ]."""
    root = np.sqrt(stiffness - damping**2 / 4 + 0j)      # imaginary where overdamped
    falls = np.exp(-damping * time / 2)
    cosine, sine = falls * np.cos(root * time).real, falls * time * np.sinc(root * time / np.pi).real
    return np.stack([cosine + damping / 2 * sine, sine, -stiffness * sine, cosine - damping / 2 * sine])


def _most_at_once(first: Indices, last: Indices, blocks: int) -> int:
    """Most seats taken in any block."""
    change = np.zeros(blocks + 1, dtype=np.intp)
    np.add.at(change, first[last >= first], 1)
    np.add.at(change, np.minimum(last[last >= first], blocks - 1) + 1, -1)
    return int(np.max(np.cumsum(change), initial=0))

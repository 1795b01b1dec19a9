"""Who meets the deck, where and when: seats for those on it, which others take when they have left."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import DIRECTIONS, Array
from hsictrl.coupling import MovingCrowd
from hsictrl.pedestrian import Crowd
from hsictrl.stepper.kernel import Bridge, Contacts

POINTS = 513     # of a shape along the deck: the cubic between them loses 3e-11 of a half wave
TABLES_SUFFICE = 0.01     # s; at shorter steps the tables of the forces are to be finer, too,
FINEST = 5                # but not more than 2^5 times, which leaves an error of 1e-11

# quadrature over (0, 1), exact for polynomials of degree 11
NODES, WEIGHTS = (1 + np.polynomial.legendre.leggauss(6)[0]) / 2, np.polynomial.legendre.leggauss(6)[1] / 2

Indices = NDArray[np.intp]


class Deck:
    """Arrays of the kernel with as many seats as are needed at once, taken and left between blocks of time.

    A walker whose body moves laterally takes two seats: one for the body, one for the force, which is vertical.
    Absorbers of the bridge have come before anybody, and stay.

    Parameters
    ----------
    crowd : MovingCrowd
        The bridge, and all who will walk over it.
    step : float
        Step of the kernel [s].
    blocks : array, shape (b + 1,)
        Times between which nobody takes a seat or leaves it [s].

    Notes
    -----
    The kernel knows straight ways only: it reads a table of shapes at a constant pace. Whoever follows a trajectory
    gets tables for one block at a time, which are read in proportion to time.
    """

    def __init__(self, crowd: MovingCrowd, step: float, blocks: Array) -> None:
        walkers = crowd.traffic.walkers
        self._crowd, self._step, self._blocks = crowd, step, blocks
        self._finer = 1 << min(max(0, int(np.log2(TABLES_SUFFICE / step))), FINEST)
        self._walkers = walkers.part(walkers.carried(crowd.bridge))
        fixed, places = crowd.bridge.fixed
        bodies, self._n_fixed = fixed + self._walkers.bodies, len(fixed)
        lateral = (bodies.direction != "vertical") & (np.arange(len(bodies)) >= self._n_fixed)
        self._who = np.concatenate([np.arange(len(lateral)), np.flatnonzero(lateral)])
        self._embodied = np.arange(len(self._who)) < len(lateral)
        self._driven = (self._who >= self._n_fixed) & ~(self._embodied & lateral[self._who])
        self._direction = np.where(self._embodied, bodies.direction[self._who], "vertical")
        self._enlist(places, blocks[0] - 1.0, blocks[-1] + 1.0)
        self._bodies = _alone(bodies)[:, self._who]
        self._bodies[2:] *= self._embodied
        self._first = np.maximum(np.searchsorted(blocks, self._arrival, side="right") - 1, 0)
        self._last = np.searchsorted(blocks, self._departure) - 1
        self._furnish(_most_at_once(self._first, self._last, len(blocks) - 1))

    def _enlist(self, places: Array, before: float, after: float) -> None:
        """From where, when, how fast and until when all go; absorbers stay from before to after all times."""
        walkers, still = self._walkers, np.zeros(self._n_fixed)
        left = walkers.departure(self._crowd.bridge.length)
        self._follows = np.append(still > 0, walkers.followed)[self._who]
        everybody = (np.append(places[:, 0], 0 * left), np.append(still + before, walkers.arrival),
                     np.append(still, walkers.speed), np.append(places[:, 1], walkers.offset),
                     np.append(still + after, left))
        self._start, self._arrival, self._speed, self._offset, self._departure = (one[self._who] for one in everybody)

    def _furnish(self, seats: int) -> None:
        """Make empty seats."""
        bridge, orders = self._crowd.bridge, 3 if self._crowd.convective else 1
        n_m = bridge.n_modes
        self._seat = np.full(len(self._who), -1)
        self._free = np.ones(seats, dtype=bool)
        self.contacts = Contacts(
            used=0, paths=np.full((3, seats), np.inf), shapes=np.zeros((seats, orders, n_m, POINTS)),
            bodies=np.zeros((4, seats)), combs=np.zeros((seats, 4)), periods=np.zeros((2, seats)))
        modes = np.stack([bridge.omega**2, 2 * bridge.damping * bridge.omega])
        alone = self._motions(*modes)
        self.bridge = Bridge(bridge.length, modes, np.concatenate([alone, np.zeros((3, 7, seats))], axis=2))
        self.fine, self.coarse = np.zeros((2, n_m + seats)), np.zeros((2, n_m + seats))

    def enter(self, block: int) -> None:
        """Let those go who have left, and seat those who come during a block, at rest."""
        gone = self._seat[(self._last == block - 1) & (self._seat >= 0)]
        self._free[gone] = True
        self.contacts.paths[:2, gone], self.contacts.combs[gone] = np.inf, 0.0    # a body may come that has no force
        new = np.flatnonzero((self._first == block) & (self._last >= block))
        self._seat[new] = seats = np.flatnonzero(self._free)[:len(new)]
        self._free[seats] = False
        self.contacts = self.contacts._replace(used=int(np.max(np.flatnonzero(~self._free), initial=-1)) + 1)
        if len(new):
            self._seat_paths(new[~self._follows[new]])
            self._seat_bodies(new, seats)
            self._seat_forces(new[self._driven[new]])
        self._lead(np.flatnonzero(self._follows & (self._seat >= 0) & (self._last >= block)), block)

    def _seat_paths(self, new: Indices) -> None:
        contacts, along = self.contacts, np.linspace(0, self._crowd.bridge.length, POINTS)
        contacts.paths[:, self._seat[new]] = self._arrival[new], self._departure[new], self._speed[new]
        self._tabulate(new, self._start[new, None] + along * (self._speed[new, None] > 0), self._offset[new, None])

    def _lead(self, who: Indices, block: int) -> None:
        """Tables of those who follow a trajectory, over a block and a bit: its ends are no events."""
        if not len(who):
            return
        bit, length = 2 * self._step, self._crowd.bridge.length
        start = np.maximum(self._arrival[who], self._blocks[block] - bit)
        stop = np.minimum(self._departure[who], self._blocks[block + 1] + bit)
        self.contacts.paths[:, self._seat[who]] = start, stop, length / (stop - start)
        times = start[:, None] + (stop - start)[:, None] * np.linspace(0, 1, POINTS)
        times[:, -1] = stop
        self._tabulate(who, *self._walkers.along(times, self._who[who] - self._n_fixed))

    def _tabulate(self, who: Indices, x: Array, y: Array) -> None:
        """Shapes under some of those with seats, at places of their own."""
        contacts, seats = self.contacts, self._seat[who]
        for direction in DIRECTIONS:
            moves = self._direction[who] == direction
            if not np.any(moves):
                continue
            speed = self._speed[who][moves, None]
            for j, mode in enumerate(self._crowd.bridge.modes):
                for order in range(contacts.shapes.shape[1]):
                    shapes = mode.shape.derivative(x[moves], y[moves], direction, order)
                    contacts.shapes[seats[moves], order, j] = shapes * speed**order / np.sqrt(mode.modal_mass)

    def _seat_bodies(self, new: Indices, seats: Indices) -> None:
        self.contacts.bodies[:, seats] = self._bodies[:, new]
        places = self._crowd.bridge.n_modes + seats
        self.bridge.motions[:, :, places] = self._motions(*self._bodies[:2, new])
        self.fine[:, places] = self.coarse[:, places] = 0.0

    def _seat_forces(self, new: Indices) -> None:
        for row, force in self._walkers.part(self._who[new] - self._n_fixed).lines():
            tables, seats = force.tables(self._finer), self._seat[new[row]]
            missing = tables.shape[1] - self.contacts.combs.shape[1]
            if missing > 0:
                self.contacts = self.contacts._replace(combs=np.pad(self.contacts.combs, ((0, 0), (0, missing))))
            self.contacts.combs[seats, :tables.shape[1]] = tables
            self.contacts.periods[0, seats] = force.spacing * force.step_frequency
            self.contacts.periods[1, seats] = tables.shape[1] - 4

    def _motions(self, stiffness: Array, damping: Array) -> Array:
        return motion(stiffness, damping, self._step * np.array([0.5, 1.0, 2.0]))


def motion(stiffness: Array, damping: Array, times: Array) -> Array:
    """Exact motion of oscillators ẍ = −stiffness x − damping ẋ + n over some times, (times, 7, n).

    Rows xx, xẋ, ẋx and ẋẋ of free motion, and the places to which forcings n = 1, τ and τ² take them from rest, τ
    being the part of the time that has gone by.
    """
    left = times[:, None, None] * np.append(1 - NODES, 1.0)[:, None]     # after a kick at each node, and at the start
    free = _free(stiffness, damping, left)
    forced = times[:, None, None] * ((WEIGHTS * NODES ** np.arange(3)[:, None]) @ free[1, :, :-1])
    return np.concatenate([np.moveaxis(free[:, :, -1], 0, 1), forced], axis=1)


def _free(stiffness: Array, damping: Array, time: Any) -> Array:
    root = np.sqrt(stiffness - damping**2 / 4 + 0j)      # imaginary where overdamped
    falls = np.exp(-damping * time / 2)
    cosine, sine = falls * np.cos(root * time).real, falls * time * np.sinc(root * time / np.pi).real
    return np.stack([cosine + damping / 2 * sine, sine, -stiffness * sine, cosine - damping / 2 * sine])


def _alone(people: Crowd) -> Array:
    """K = k/m₁, C = c/m₁, m₁ and m₀, shape (4, n)."""
    own = people.stiffness / people.sprung_mass, people.damping_coefficient / people.sprung_mass
    return np.stack([*own, people.sprung_mass, people.unsprung_mass])


def _most_at_once(first: Indices, last: Indices, blocks: int) -> int:
    """Most seats taken in any block."""
    change = np.zeros(blocks + 1, dtype=np.intp)
    np.add.at(change, first[last >= first], 1)
    np.add.at(change, np.minimum(last[last >= first], blocks - 1) + 1, -1)
    return int(np.max(np.cumsum(change), initial=0))

"""Poles of a bridge under bodies that differ, as zeros of det D(s), all at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.loop.determinant import determinant
from hsictrl.loop.merged import own_poles
from hsictrl.pedestrian import Crowd, Pedestrian

Complex = NDArray[np.complex128]
ROUNDS = 60
SETTLED = 1e-12         # of a pole's size; the order is three, so that the next step would be nothing
FAR = 0.1               # of a pole's size, further than which no first guess may lie from it
APART = 1e-14           # mass ratio below which a body's pole is its own, to rounding


class Secular:
    """det D(s) of a bridge and the bodies that couple to it, D its condensed dynamic stiffness.

    Bodies of one frequency and damping are felt through the Gram matrix of their rows: as many
    combinations as it has rank couple, the others keep the poles of a body on rigid ground.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    people : Crowd
        The n bodies.
    rows : array, shape (n, n_m)
        Their participation in the modes [1/√kg].
    """

    def __init__(self, bridge: Footbridge, people: Crowd, rows: Array) -> None:
        self.square, self.viscous = np.diag(bridge.omega**2), np.diag(2 * bridge.damping * bridge.omega)
        self.mass = np.eye(bridge.n_modes) + rows.T * people.unsprung_mass @ rows
        kinds, kind = np.unique(np.column_stack([people.omega, people.damping]), axis=0, return_inverse=True)
        weighted, count = np.sqrt(people.sprung_mass)[:, None] * rows, np.bincount(kind, minlength=len(kinds))
        combined = [_combinations(weighted[kind == i]) for i in range(len(kinds))]
        self.rows = np.concatenate([np.zeros((0, bridge.n_modes)), *combined])
        coupled = np.array([len(one) for one in combined], dtype=int)
        self.spring, self.dashpot = np.repeat(kinds[:, 0]**2, coupled), np.repeat(2 * kinds.prod(axis=1), coupled)
        own = own_poles(*kinds.T)
        self.poles = np.repeat(own, coupled, axis=0)
        self.exact = np.repeat(own, count - coupled, axis=0).ravel()

    def stiffness(self, s: Complex) -> tuple[Complex, Complex, Complex]:
        """D(s), its derivative, and the logarithmic derivative of the bodies' denominators."""
        line = np.multiply.outer(s, self.dashpot) + self.spring
        upper, lower = (s[:, None] - self.poles[:, i] for i in (0, 1))
        denominator = upper * lower         # not s² + 2ξω s + ω², which loses the distance to a pole nearby
        lagging = line / denominator
        slopes = -s[:, None] * (line + self.spring) / denominator**2
        z = s[:, None, None]
        mass = self.mass + self._summed(lagging)
        grown = 2 * z * mass + z**2 * self._summed(slopes) + self.viscous
        poles = np.sum(1 / upper + 1 / lower, axis=1)
        return z**2 * mass + z * self.viscous + self.square, grown, poles

    @property
    def trace(self) -> float:
        """Sum of the zeros: the trace of a state matrix with these poles."""
        viscous = self.viscous + self.rows.T * self.dashpot @ self.rows
        return float(-self.dashpot.sum() - np.trace(np.linalg.solve(self.mass, viscous)))

    def step(self, s: Complex, others: Complex) -> Complex:
        """Newton's step towards a zero of p(s), det D(s) times the bodies' denominators, over all it has elsewhere.

        That is 1/(p′/p − others), with the sum of 1/(s − z) over all other zeros z.
        """
        stiffness, slope, poles = self.stiffness(s)
        value, growth = determinant(stiffness, slope)
        return np.asarray(value / (growth + value * (poles - others)))

    def _summed(self, weights: Complex) -> Complex:
        n_m = self.rows.shape[1]
        pairs = (self.rows[:, :, None] * self.rows[:, None, :]).reshape(len(self.rows), n_m**2)
        return (weights @ pairs).reshape(len(weights), n_m, n_m)


def secular_poles(secular: Secular, guess: Complex) -> Complex | None:
    """Poles in the order of the guesses, by Ehrlich's and Aberth's iteration from there; none if it does not settle.

    Source: Aberth, Iteration methods for finding all zeros of a polynomial simultaneously, Math. Comp. 27 (1973).
    """
    poles, sought = guess.copy(), np.ones(len(guess), dtype=bool)
    for own in secular.exact:
        nearest = np.argmin(np.where(sought, np.abs(poles - own), np.inf))
        poles[nearest], sought[nearest] = own, False
    zeros = _zeros(secular, poles[sought])
    if zeros is None or abs(zeros.sum() - secular.trace) > SETTLED * 10 * np.abs(zeros).sum():    # one found twice
        return None
    poles[sought] = zeros
    return poles


def newcomer(secular: Secular, body: Pedestrian, row: Array) -> Complex:
    """First guesses of the two poles that one body more brings [rad/s].

    Beside its own pole p the newcomer adds ρ φφᵀ/(s − p) to D, so that det D vanishes at p − ρ φᵀD⁻¹φ.
    """
    pole, conjugate = own_poles(body.omega, body.damping)
    with np.errstate(all="ignore"):
        stiffness = secular.stiffness(np.array([pole]))[0][0]
    shift = 1e-3 * pole             # among its like, whose pole it must not start from
    if np.all(np.isfinite(stiffness)):
        shift = pole**4 / (pole - conjugate) * body.sprung_mass * (row @ np.linalg.pinv(stiffness) @ row)
    guess = pole + shift * min(1.0, FAR * abs(pole) / max(abs(shift), 1e-300))
    return np.array([guess, np.conj(guess)])


def _zeros(secular: Secular, guess: Complex) -> Complex | None:
    z, moving = guess.copy(), np.arange(len(guess))
    for _ in range(ROUNDS):
        step = _step(secular, z, moving)
        if not np.all(np.isfinite(step)):
            return None
        z[moving] -= step
        moving = moving[np.abs(step) > SETTLED * np.abs(z[moving])]
        if not len(moving):
            return z
    return None


def _step(secular: Secular, z: Complex, moving: NDArray[np.intp]) -> Complex:
    """Newton's step for those that move still, kept away from all others."""
    apart = z[moving, None] - z
    apart[np.arange(len(moving)), moving] = np.inf
    with np.errstate(all="ignore"):
        return secular.step(z[moving], np.sum(1 / apart, axis=1))


def _combinations(rows: Array) -> Array:
    """Few rows with the same Gram matrix, without those that move no mode."""
    if len(rows) > 1:
        _, sizes, axes = np.linalg.svd(rows, full_matrices=False)
        rows = sizes[:, None] * axes
    return np.asarray(rows[np.sum(rows**2, axis=1) > APART])

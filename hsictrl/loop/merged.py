"""Poles of a bridge under equal bodies: to n_m modes, any number of them is n_m combinations."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.pedestrian.body import SprungBody

Complex = NDArray[np.complex128]


def own_poles(omega: Any, damping: Any) -> Complex:
    """Poles of oscillators on their own, upper and lower, shape (…, 2) [rad/s]."""
    upper = omega * (-damping + 1j * np.sqrt(1 - np.square(damping)))
    return np.stack([upper, np.conj(upper)], axis=-1)


def merged_poles(bridge: Footbridge, body: SprungBody, gram: Array, rank: int) -> Complex:
    """Poles of the modes and of the combinations of bodies that couple, shape (b, 2 (n_m + rank)) [rad/s].

    Equal bodies with rows Φ are felt through ΦᵀΦ alone. A square root R of it, RᵀR = ΦᵀΦ, is a few bodies that the
    modes cannot tell from the crowd; every other combination moves no mode.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    body : SprungBody
        One body, or b of them, one per problem.
    gram : array, shape (b, n_m, n_m)
        ΦᵀΦ of each problem [1/kg].
    rank : int
        Number of combinations that couple, at least the rank of ΦᵀΦ [-].
    """
    sizes, axes = np.linalg.eigh(gram)
    rows = np.sqrt(np.maximum(sizes, 0))[:, :, None] * np.swapaxes(axes, 1, 2)
    return np.linalg.eigvals(_state_matrices(bridge, body, gram, rows[:, bridge.n_modes - rank:])).astype(complex)


def _state_matrices(bridge: Footbridge, body: SprungBody, gram: Array, rows: Array) -> Array:
    """A of (A.8) with states z, u, dz, du, a matrix per problem."""
    n_m, rank = bridge.n_modes, rows.shape[1]
    m0, k, c, spring, dashpot = (np.atleast_1d(value)[:, None, None] for value in (
        body.unsprung_mass, body.stiffness, body.damping_coefficient, body.omega**2, 2 * body.damping * body.omega))
    back, half = np.swapaxes(rows, 1, 2), n_m + rank
    acceleration = np.linalg.solve(np.eye(n_m) + m0 * gram, np.concatenate([
        -np.diag(bridge.omega**2) - k * gram, k * back,
        -np.diag(2 * bridge.damping * bridge.omega) - c * gram, c * back], axis=2))
    A = np.zeros((len(gram), 2 * half, 2 * half))
    A[:, :half, half:] = np.eye(half)
    A[:, half:half + n_m] = acceleration
    A[:, half + n_m:, :half] = spring * np.concatenate([rows, -_eyes(rows)], axis=2)
    A[:, half + n_m:, half:] = dashpot * np.concatenate([rows, -_eyes(rows)], axis=2)
    return A


def _eyes(rows: Array) -> Array:
    return np.broadcast_to(np.eye(rows.shape[1]), (len(rows), rows.shape[1], rows.shape[1]))

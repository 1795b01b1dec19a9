"""The Hamiltonian test: whether, and where, a system from velocity to force gives more than it takes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvals, matrix_balance, solve_continuous_are

from hsictrl._checks import Array

Complex = NDArray[np.complexfloating[Any, Any]]
Matrices = tuple[Array, Array, Array, Array]
SMALL = 1e-9            # of the size of what is compared, below which it is rounding
ROUNDS = 30


@dataclass(frozen=True, slots=True)
class Margin:
    """Smallest eigenvalue of G(iω) + G(iω)ᴴ, the frequency where it is [rad/s], and what speaks against passivity."""

    smallest: float
    at: float
    objection: str = ""


def margin(matrices: Matrices) -> Margin:
    """Smallest eigenvalue of the Popov function over all frequencies, and whether the system is positive real.

    Where an eigenvalue crosses a level, an eigenvalue of the Hamiltonian pencil is imaginary. Between neighbours
    among their imaginary parts nothing crosses, so that one look there decides; the level is then lowered
    to what was seen, until nothing lies below (Boyd, Balakrishnan and Kabamba, 1989).
    """
    poles: Complex = np.linalg.eigvals(matrices[0]).astype(complex)
    size = np.abs(poles).max(initial=0.0) or 1.0
    on_axis: Array = np.unique(np.abs(poles[np.abs(poles.real) <= SMALL * size].imag))
    smallest, at, relative = _descend(matrices, np.concatenate([[0.0, 1e6 * size], np.abs(poles)]), on_axis, size)
    growing = poles[poles.real > SMALL * size]
    residues = _popov(matrices, 1e-5 * size + 1j * on_axis)[1]
    objection = ""
    if len(growing):
        objection = f"a pole at {growing[np.argmax(growing.real)]:.4g} rad/s grows"
    elif relative < -SMALL:
        objection = f"it gives energy at {at / (2 * np.pi):.4g} Hz"
    elif np.any(residues < -SMALL):
        objection = f"its residue at {on_axis[np.argmin(residues)] / (2 * np.pi):.4g} Hz is not positive"
    return Margin(smallest, at, objection)


def _descend(matrices: Matrices, omega: Array, on_axis: Array, size: float) -> tuple[float, float, float]:
    """The smallest eigenvalue of G + Gᴴ, its frequency [rad/s], and the smallest in relation to the size of G."""
    lowest, at, worst = np.inf, 0.0, np.inf
    for _ in range(ROUNDS):
        apart = np.abs(np.subtract.outer(omega, on_axis)).min(axis=1, initial=np.inf)
        omega = omega[apart > 1e-6 * size]
        found, relative = _popov(matrices, 1j * omega)
        before, i = lowest, int(np.argmin(found))
        lowest, at = min((lowest, at), (float(found[i]), float(omega[i])))
        worst = min(worst, float(relative.min()))
        if before - lowest <= SMALL * abs(lowest) and np.isfinite(before):
            break
        omega = _candidates(matrices, lowest)
    return lowest, at, worst


def dissipation(matrices: Matrices, storage: Array) -> Array:
    """What the system dissipates beyond ½xᵀPx, twice: [x; v]ᵀ K [x; v], K ≥ 0 by Kalman, Yakubovich and Popov."""
    A, B, C, D = matrices
    cross = C.T - storage @ B
    return np.block([[-A.T @ storage - storage @ A, cross], [cross.T, D + D.T]])


def stored(matrices: Matrices) -> Array | None:
    """P of the available storage ½xᵀPx of a system with a millionth of its own size more of feedthrough.

    The equality of Kalman, Yakubovich and Popov is a Riccati equation if the feedthrough is regular, hence the
    little more. None where it has no solution, as for a system that loses nothing at a pole of its own.
    """
    A, B, C, D = matrices
    if not len(A):
        return np.zeros((0, 0))
    balanced, scales = matrix_balance(A, permute=False)
    B, C = np.linalg.solve(scales, B), C @ scales
    beside = (0.01 + 1j) * np.maximum(np.abs(np.linalg.eigvals(A)), 1e-9)      # the poles
    little = 1e-6 * float(np.max(np.linalg.norm(_response((balanced, B, C, D), beside), 2, axis=(1, 2))))
    try:
        P = -solve_continuous_are(balanced, B, np.zeros_like(A), D + D.T + little * np.eye(len(D)), s=C.T)
    except np.linalg.LinAlgError:
        return None
    held = dissipation((balanced, B, C, D), P)
    if np.linalg.eigvalsh(held).min() < -2 * little - SMALL * np.linalg.norm(held, 2):
        return None
    back = np.linalg.inv(scales)
    return np.asarray(back.T @ (P + P.T) @ back / 2)


def _popov(matrices: Matrices, s: Complex) -> tuple[Array, Array]:
    """Smallest eigenvalue of G + Gᴴ, and the same over the size of G."""
    G, D = _response(matrices, s), matrices[3]
    smallest = np.asarray(np.linalg.eigvalsh(G + np.conj(np.swapaxes(G, 1, 2)))[:, 0])
    size = np.linalg.norm(G, 2, axis=(1, 2)) + np.linalg.norm(D, 2) + 1e-300
    return smallest, smallest / size


def _response(matrices: Matrices, s: Complex) -> Complex:
    A, B, C, D = matrices
    return np.asarray(D + C @ np.linalg.solve(s[:, None, None] * np.eye(len(A)) - A, B[None] + 0j))


def _candidates(matrices: Matrices, level: float) -> Array:
    """Frequencies at which an eigenvalue of G + Gᴴ may cross the level, and one between each two of them."""
    A, B, C, D = matrices
    n, p = B.shape
    zero = np.zeros((n, n))
    pencil = np.block([[A, zero, B], [zero, -A.T, -C.T], [C, B.T, D + D.T - level * np.eye(p)]])
    weights = np.zeros_like(pencil)
    weights[:2 * n, :2 * n] = np.eye(2 * n)
    found = eigvals(pencil, weights)
    ends = np.unique(np.concatenate([[0.0], np.abs(found[np.isfinite(found)].imag)]))
    return np.concatenate([ends, (ends[:-1] + ends[1:]) / 2, [2 * ends[-1] + 1.0]])

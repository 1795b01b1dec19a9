"""How far apart two crowds can be as a bridge feels them, at any frequency.

The map s = Ω(1 − z)/(1 + z) lays the imaginary axis on the unit circle, ω = Ω tan(θ/2) at z = exp(−iθ). There an
apparent mass is a power series with real coefficients cₙ that fall as |q|ⁿ: one transform gives it at many θ, and the
chord between two, h apart, is off by at most Σn²|cₙ| h²/8. What is true of all arcs is true of all frequencies.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.pedestrian.crowd import Crowd

Complex = NDArray[np.complex128]
Standing = tuple[Crowd, Array]      # bodies, and their participations in the modes
ARCS = 2**14
THETA = np.pi * np.arange(ARCS + 1) / ARCS
TERMS = 64, 4096
NEGLIGIBLE = 1e-13


def largest_difference(omega: Array, damping: Array, full: Standing, small: Standing) -> float:
    """Bound on sup ‖X̃ − X‖ / sup ‖X‖, X(iω) the modal accelerance under a crowd; infinite where none is found.

    X̃ − X = X̃ ΔA X and X = X̃ (1 + ΔA X̃)⁻¹, hence ‖X̃ − X‖ ≤ ‖X̃‖² ‖ΔA‖ / (1 − ‖X̃‖ ‖ΔA‖) at each frequency.
    """
    full, small = _taking_part(*full), _taking_part(*small)
    scale = float(np.sqrt(omega.min() * omega.max()))      # arcs are shortest, for their frequency, where the bridge is
    terms = _enough(max(np.abs(_circle(people, scale)[0]).max(initial=0.5) for people, _ in (full, small)))
    (exact, exact_tail), (series, tail) = (_series(*standing, scale, terms) for standing in (full, small))
    gain, top = _gain(_stiffness(series, omega / scale, damping), 4 * tail)
    apart, sag = _on_circle(exact - series)
    size = np.linalg.norm(apart, axis=(1, 2))
    return _relative(gain, np.maximum(size[1:], size[:-1]) + sag + tail + exact_tail, top)


def _relative(gain: Array, apart: Array, top: Array) -> float:
    """From bounds on ‖X̃‖ and ‖ΔA‖ on each arc, and the least size of X̃ at its end, the bound on the difference."""
    loop = gain * apart
    if not np.all(loop < 1):
        return np.inf
    error = gain * loop / (1 - loop)
    peak = np.max(top - error)
    return float(error.max() / peak) if peak > 0 else np.inf


def _gain(stiffness: Array, tail: float) -> tuple[Array, Array]:
    """‖X̃‖ = |1 − z|²/σ_min(F): the most it can be on each arc, and the least at the end of the arc."""
    values, sag = _on_circle(stiffness)
    least = _least_singular(values)
    step = np.linalg.norm(np.diff(values, axis=0), axis=(1, 2))
    lower = (least[1:] + least[:-1] - step) / 2 - sag - tail      # where the two ends' bounds meet
    moving = 4 * np.sin(THETA[1:] / 2) ** 2
    return moving / np.where(lower > 0, lower, np.nan), moving / (least[1:] + tail)


def _stiffness(series: Array, beta: Array, damping: Array) -> Array:
    """(1 − z)²(1 + Ã) + 2ξβ(1 − z²) + β²(1 + z)², dynamic stiffness times (1 + z)²/Ω², as a series."""
    inertia = series.copy()
    inertia[0] += np.eye(len(beta))
    whole = np.zeros((len(series) + 2, *series.shape[1:]))
    for power, (mass, damper, spring) in enumerate(((1, 1, 1), (-2, 0, 2), (1, -1, 1))):
        whole[power:power + len(series)] += mass * inertia
        whole[power] += np.diag(damper * 2 * damping * beta + spring * beta**2)
    return whole


def _series(people: Crowd, rows: Array, scale: float, terms: int) -> tuple[Array, float]:
    """Coefficients of the apparent mass in z, and the most that is left out."""
    q, head = _circle(people, scale)
    weights = people.sprung_mass * head * (1 + q)
    pairs = (rows[:, :, None] * rows[:, None, :]).reshape(len(people), rows.shape[1] ** 2)
    later = np.real(np.vander(q, terms - 1, increasing=True).T @ (weights[:, None] * pairs))
    first = (people.unsprung_mass + people.sprung_mass * head.real) @ pairs
    size = np.abs(q)
    with np.errstate(divide="ignore"):
        left = np.sum(rows**2, axis=1) @ (np.abs(weights) * size ** (terms - 1) / (1 - size))
    return np.vstack([first, later]).reshape(terms, rows.shape[1], -1), float(left)


def _circle(people: Crowd, scale: float) -> tuple[Complex, Complex]:
    """q and head: the real parts of the coefficients of head (1 + z)/(1 − qz) are those of a sprung body's g."""
    pole = people.omega * (-people.damping + 1j * np.sqrt(1 - people.damping**2))
    return (scale + pole) / (scale - pole), 1j * pole**2 / pole.imag / (scale - pole)


def _on_circle(series: Array) -> tuple[Complex, float]:
    """Values at all θ, and how far from the chords between them."""
    curvature = np.arange(len(series)) ** 2 @ np.linalg.norm(series, axis=(1, 2))
    return np.fft.rfft(series, n=2 * ARCS, axis=0), float(curvature * (np.pi / ARCS) ** 2 / 8)


def _least_singular(matrices: Complex) -> Array:
    if matrices.shape[1] == 1:      # a hundred times faster
        return np.asarray(np.abs(matrices[:, 0, 0]))
    return np.asarray(np.linalg.svd(matrices, compute_uv=False)[:, -1])


def _enough(decay: float) -> int:
    """How many powers of a number below one are not negligible."""
    return int(np.clip(np.log(NEGLIGIBLE) / np.log(min(decay, 1 - 1e-9)), *TERMS))


def _taking_part(people: Crowd, rows: Array) -> Standing:
    moved = np.any(rows, axis=1)
    return people.part(moved), rows[moved]

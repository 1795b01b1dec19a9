"""Which pole of the occupied bridge is a mode's own."""

from __future__ import annotations

import numpy as np

from hsictrl.coupling import OccupiedBridge
from hsictrl.resonance.curves import dynamic_stiffness_slope

SINGULAR = 1e-6     # at a pole that rounding has moved, over |s|²


def dominant_pole(system: OccupiedBridge, index: int) -> complex:
    """The oscillating pole p with the largest |residue/Re p| in the response on one mode's coordinate [rad/s]."""
    poles = system.poles()
    poles = poles[poles.imag > 0]
    return complex(max(poles, key=lambda pole: _weight(_residue(system, pole, index), pole)))


def _weight(residue: float, pole: complex) -> float:
    if not residue:
        return 0.0
    return abs(residue / pole.real) if pole.real else np.inf


def _residue(system: OccupiedBridge, pole: complex, index: int) -> float:
    """Residue of s²[D⁻¹]_jj at a pole: s²v_j²/(vᵀD′v), v the null vector of D.

    A body that no mode moves has a pole of its own, where D grows without bound instead: residue zero. So it does, but
    for a direction that is left, where several modes move together.
    """
    with np.errstate(all="ignore"):
        stiffness, slope = system.dynamic_stiffness(pole)[0], dynamic_stiffness_slope(system, pole)
    if not (np.isfinite(stiffness).all() and np.isfinite(slope).all()):
        return 0.0
    _, sizes, right = np.linalg.svd(stiffness)
    if sizes[-1] > SINGULAR * abs(pole)**2:
        return 0.0
    vector = right[-1].conj()
    return float(abs(pole**2 * vector[index]**2 / (vector @ slope @ vector)))

"""Effective properties of many bridges under one crowd, which they share."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.coupling import CondensedCrowd
from hsictrl.resonance.curves import Complex, peak_band

POINTS, STEPS = 1200, 5
LIGHTEST = 0.005      # lighter bodies resonate between the points of the grid


def effective_map(crowd: CondensedCrowd, frequencies: Any, dampings: Any) -> tuple[Array, Array]:
    """Effective frequency and damping (eq. 17) of single-mode bridges that differ in frequency and damping.

    The crowd's apparent mass S(ω) does not depend on the bridge: it is tabulated once, and
    ``1/|H|² = |1 + S − (ω_B/ω)² − 2iξ ω_B/ω|²`` is minimised for all bridges together.

    Parameters
    ----------
    crowd : CondensedCrowd
        The crowd on one mode.
    frequencies : array_like, shape (f,)
        Natural frequencies of the empty bridges [Hz].
    dampings : array_like, shape (d,)
        Their modal damping ratios [-].

    Returns
    -------
    frequency : array, shape (f, d)
        Effective frequencies [Hz].
    damping : array, shape (f, d)
        Effective damping ratios [-].

    Raises
    ------
    ValueError
        If a bridge has no peak, or a body a damping ratio below 0.5 %: `effective` looks more closely, at one bridge.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> occupied = couple(reference_bridge(), Pedestrian(), (np.arange(15) + 0.5) * 50 / 15)
    >>> frequency, damping = effective_map(occupied.condensed, [2.0, 3.25], [0.005])
    >>> print(frequency.round(4).ravel(), (100 * damping).round(3).ravel())
    [1.9709 3.2134] [0.758 2.147]
    """
    check.instance("crowd", crowd, CondensedCrowd, "give couple(bridge, people, positions).condensed")
    omega_b = 2 * np.pi * check.numbers("frequencies", frequencies, above=0, ndim=1, remedy="give Hz")[:, None]
    xi = check.numbers("dampings", dampings, least=0, below=1, ndim=1, remedy="give fractions, not percent")[None, :]
    if crowd.rows.shape[1] != 1:
        raise ValueError(f"the crowd must stand on one mode, got {crowd.rows.shape[1]}; "
                         "use effective() for bridges with several")
    check.numbers("the crowd's damping", crowd.people.damping, least=LIGHTEST,
                  remedy="use effective() for bodies with less")
    band = peak_band(crowd, omega_b)
    mass = _tabulated_mass(crowd, band)
    start = _grid_minimum(mass, band, omega_b, xi)
    omega = _refined(mass, start, omega_b, xi)
    if not np.all(np.abs(np.log(omega / start)) < 2 * np.log(band[1] / band[0]) / POINTS):
        raise _no_peak()
    return omega / (2 * np.pi), np.sqrt(_inverse_square(mass, omega, omega_b, xi)[0]) / 2


def _tabulated_mass(crowd: CondensedCrowd, band: tuple[float, float]) -> CubicSpline:
    """1 + S as a spline, with nodes as close as the narrowest resonance of a body asks for."""
    width = float(np.min(crowd.people.damping, initial=0.3))
    nodes = np.geomspace(0.9 * band[0], 1.1 * band[1], int(130 / width))
    return CubicSpline(nodes, 1 + crowd.apparent_mass(1j * nodes)[:, 0, 0])


def _grid_minimum(mass: CubicSpline, band: tuple[float, float], omega_b: Array, xi: Array) -> Array:
    """The best grid point for each bridge, moved to the vertex of the parabola through it and its neighbours."""
    grid = np.geomspace(*band, POINTS)
    ratio = omega_b / grid
    table = mass(grid)
    real, imaginary = (table.real - ratio**2)**2, table.imag - 2 * xi.T[:, :, None] * ratio
    size = np.moveaxis(real + imaginary**2, 0, 1)
    best = np.argmin(size, axis=-1)[..., None]
    if np.any((best == 0) | (best == POINTS - 1)):
        raise _no_peak()
    left, here, right = (np.take_along_axis(size, best + shift, -1)[..., 0] for shift in (-1, 0, 1))
    shift = 0.5 * (left - right) / (left - 2 * here + right)
    return np.asarray(grid[best[..., 0]] * (grid[1] / grid[0])**np.clip(shift, -1, 1))


def _no_peak() -> ValueError:
    return ValueError("every bridge must have a peak of |H|, got one without; use effective() for each of them, which "
                      "tells what is wrong with which")


def _refined(mass: CubicSpline, omega: Array, omega_b: Array, xi: Array) -> Array:
    """Newton's steps towards the zero of the slope."""
    for _ in range(STEPS):
        _, slope, bend = _inverse_square(mass, omega, omega_b, xi)
        omega = omega - slope / bend
    return omega


def _inverse_square(mass: CubicSpline, omega: Array, omega_b: Array, xi: Array) -> tuple[Array, Array, Array]:
    """g = |1/H|² on the mode's coordinate and its first two derivatives in ω."""
    r = omega_b / omega
    q = mass(omega) - r**2 - 2j * xi * r
    q1 = mass(omega, 1) + (2 * r**2 + 2j * xi * r) / omega
    q2 = mass(omega, 2) - (6 * r**2 + 4j * xi * r) / omega**2
    return _dot(q, q), 2 * _dot(q, q1), 2 * (_dot(q1, q1) + _dot(q, q2))


def _dot(a: Complex, b: Complex) -> Array:
    return (a * b.conj()).real

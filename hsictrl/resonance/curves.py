"""Curves whose peaks are read: the response on a mode's own coordinate, modelled or measured."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, final

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from hsictrl._checks import Array
from hsictrl.coupling import CondensedCrowd, OccupiedBridge, OccupiedMeasurement

Complex = NDArray[np.complex128]
# |1/H| of a resonance is nearly a parabola, so a grid this coarse brackets the narrowest peak.
POINTS = 401


class Curve(ABC):
    """Accelerance of one mode at its antinode, over angular frequency [m/s² per N]."""

    modal_mass: float
    band: tuple[float, float]

    @abstractmethod
    def magnitude(self, omega: Any) -> Array:
        """|H| [m/s² per N] at angular frequencies [rad/s]."""

    @abstractmethod
    def slope(self, omega: float) -> float:
        """d ln|H|/dω [s]."""

    def mixing(self, omega: float) -> float:
        """Largest motion of another mode over this one's, mass-normalised, where this one is driven [-]."""
        return 0.0

    def peaks(self, band: tuple[float, float]) -> Array:
        """Angular frequencies of all local maxima inside the band, refined by the slope's zero [rad/s]."""
        grid = np.geomspace(*band, POINTS)
        size = np.pad(self.magnitude(grid), 1)      # a peak may hide between an end of the band and its neighbour
        tops = np.flatnonzero((size[1:-1] >= size[:-2]) & (size[1:-1] > size[2:]))
        around = np.pad(grid, 1, mode="edge")
        return np.concatenate([np.zeros(0), *(self._refined(*around[top:top + 3]) for top in tops)])

    def _refined(self, low: float, top: float, high: float) -> Array:
        """The maximum beside a grid point that is higher than its neighbours; none if that is an end of the band."""
        low, high = (top, high) if self.slope(top) > 0 else (low, top)
        if self.slope(low) > 0 > self.slope(high):
            return np.array([brentq(self.slope, low, high, xtol=1e-14 * top, rtol=1e-14)])
        wiggles = high - low > 1e-9 * top           # several maxima between two points of the grid
        return self.peaks((low, high)) if wiggles else np.zeros(0)

    def half_power(self, peak: float) -> tuple[float, float]:
        """Angular frequencies on both sides of a peak where |H| falls to 1/√2 of it [rad/s]."""
        level = self.magnitude([peak])[0] / np.sqrt(2)

        def excess(omega: float) -> float:
            return float(self.magnitude([omega])[0] - level)

        return _crossing(excess, peak, self.band[0]), _crossing(excess, peak, self.band[1])


@final
class ModalCurve(Curve):
    """s²[D⁻¹]_jj/m_j from the condensed dynamic stiffness D of an occupied bridge."""

    def __init__(self, system: OccupiedBridge, index: int) -> None:
        self.system, self.index = system, index
        self.modal_mass = system.bridge.mode(index).modal_mass
        self.band = peak_band(system.condensed, system.bridge.omega)

    def magnitude(self, omega: Any) -> Array:
        s = 1j * np.asarray(omega)
        with np.errstate(divide="ignore", invalid="ignore"):
            flexibility = np.linalg.inv(self.system.dynamic_stiffness(s))[:, self.index, self.index]
        return np.asarray(np.abs(s**2 * flexibility)) / self.modal_mass

    def slope(self, omega: float) -> float:
        s = 1j * omega
        with np.errstate(divide="ignore", invalid="ignore"):
            stiffness, growth = self.system.dynamic_stiffness(s)[0], dynamic_stiffness_slope(self.system, s)
        column = np.linalg.solve(stiffness, np.eye(len(stiffness))[self.index])
        return float((1j * (2 / s - column @ growth @ column / column[self.index])).real)

    def mixing(self, omega: float) -> float:
        stiffness = self.system.dynamic_stiffness(1j * omega)[0]
        motion = np.abs(np.linalg.solve(stiffness, np.eye(len(stiffness))[self.index]))
        return float(np.max(np.delete(motion, self.index), initial=0.0) / motion[self.index])


@final
class MeasuredCurve(Curve):
    """A measured accelerance between its lines, through 1/H: near a resonance that is smooth where H is not."""

    def __init__(self, system: OccupiedMeasurement) -> None:
        self.modal_mass = system.bridge.modal_mass
        self.band = (float(system.omega[0]), float(system.omega[-1]))
        self._inverse = CubicSpline(system.omega, 1 / system.first_point)

    def magnitude(self, omega: Any) -> Array:
        return np.asarray(1 / np.abs(self._inverse(omega)))

    def slope(self, omega: float) -> float:
        return float(-(self._inverse(omega, 1) / self._inverse(omega)).real)


def dynamic_stiffness_slope(system: OccupiedBridge, s: complex) -> Complex:
    """dD/ds of the condensed dynamic stiffness, shape (n_m, n_m) [1/s]."""
    bridge, crowd = system.bridge, system.condensed
    mass = np.eye(bridge.n_modes) + crowd.apparent_mass(s)[0]
    modal = np.diag(2 * bridge.damping * bridge.omega)
    return np.asarray(2 * s * mass + s**2 * crowd.apparent_mass_slope(s) + modal)


def peak_band(crowd: CondensedCrowd, omega: Array) -> tuple[float, float]:
    """A band outside which no mode can have its peak, of bridges with these angular frequencies and this crowd [rad/s].

    Below, Dunkerley's bound with the whole crowd as added mass; above, the frequency of bodies and bridge
    in series with all springs. Peaks of acceleration lie above the poles: hence the factors.
    """
    mass = np.linalg.norm(crowd.apparent_mass(0)[0].real, 2)
    softest = np.min(crowd.people.omega, initial=omega.min())
    stiffest = np.max(crowd.people.omega, initial=0.0)
    low = 1 / np.sqrt((1 + mass) / omega.min()**2 + 1 / softest**2)
    return 0.5 * float(low), 2.0 * float(np.sqrt(omega.max()**2 + (1 + mass) * stiffest**2))


def _crossing(excess: Any, peak: float, end: float) -> float:
    """Where the curve first falls below the level, on the way from the peak to the end of the band."""
    way = peak + (end - peak) * np.geomspace(1e-6, 1.0, 200)
    below = next((i for i, omega in enumerate(way) if excess(omega) < 0), None)
    if below is None:
        raise ValueError("half-power damping needs |H| to fall to 1/√2 of the peak on both sides, got none between "
                         f"{peak / (2 * np.pi):.3g} and {end / (2 * np.pi):.3g} Hz; use method='peak' or 'pole'")
    return float(brentq(excess, way[below - 1] if below else peak, way[below], xtol=1e-14 * peak, rtol=1e-14))

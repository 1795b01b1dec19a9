"""Footbridges described by a measured frequency response."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MeasuredBridge:
    """A footbridge known by its frequency response, from forces to accelerations at some points.

    People can stand at these points, and at no other.

    Parameters
    ----------
    response : control.FrequencyResponseData
        Accelerance of the empty bridge: response (i, j) is the acceleration of point i per force at
        point j, on a grid of angular frequencies in increasing order [m/s² per N, rad/s].
    positions : array_like, shape (n,) or (n, 2)
        Places x, or (x, y), of the n points [m].
    modal_mass : float
        Modal mass of the mode in question, scaled to one at the first point; effective damping
        refers to it (eq. 17) [kg].
    direction : {"vertical", "lateral"}
        Direction of the forces and accelerations; bodies of the other direction couple to nothing.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> plant = reference_bridge(frequency=2.0).ss(at=[25.0])
    >>> omega = 2 * np.pi * np.linspace(1.0, 3.0, 401)
    >>> MeasuredBridge(response=ct.frequency_response(plant["a[0]", "F[0]"], omega),
    ...                positions=[25.0], modal_mass=25e3).positions
    array([[25.,  0.]])
    """

    response: ct.FrequencyResponseData
    positions: Array
    modal_mass: float
    direction: str = "vertical"

    def __post_init__(self) -> None:
        check.instance("response", self.response, ct.FrequencyResponseData, "use control.frd or a frequency_response")
        places = check.points("positions", self.positions, least=1)
        if self.response.shape != (len(places), len(places)):
            raise ValueError(f"response must have a row and a column for each of the {len(places)} positions, got "
                             f"shape {self.response.shape}; measure the force at every point, at every point")
        check.numbers("the response's omega", self.response.omega, above=0, remedy="leave out 0 rad/s and below")
        _check_rising(self.response.omega)
        if not np.all(np.isfinite(self.response.frdata)):
            raise ValueError("response must be finite, got NaN or infinity; leave out the frequencies where it is not")
        check.choice("direction", self.direction, check.DIRECTIONS)
        mass = check.number("modal_mass", self.modal_mass, above=0, remedy="give kg")
        _refuse_repeated(places)
        check.store(self, positions=places, modal_mass=mass)

    def points_of(self, name: str, positions: Any) -> np.ndarray:
        """Index of the measured point at each place; refuse places where nothing was measured.

        Parameters
        ----------
        name : str
            What to call the places in a refusal.
        positions : array_like, shape (n,) or (n, 2)
            Places x, or (x, y) [m].

        Returns
        -------
        array of int, shape (n,)
            Index of the point [-].

        Examples
        --------
        >>> frd = ct.frd(np.ones((2, 2, 5)), np.arange(1.0, 6.0))
        >>> MeasuredBridge(response=frd, positions=[10.0, 20.0], modal_mass=1.0).points_of("positions", [20.0])
        array([1])
        """
        places = check.points(name, positions)
        apart = np.linalg.norm(places[:, None] - self.positions[None], axis=2)
        if np.any(apart.min(axis=1, initial=np.inf) > 1e-6):
            i = int(np.argmax(apart.min(axis=1)))
            raise ValueError(f"{name} must be among the measured points, got {name}[{i}] = ({places[i, 0]:g}, "
                             f"{places[i, 1]:g}) m; move it to the nearest point, or measure there")
        return np.argmin(apart, axis=1)


def _check_rising(omega: Array) -> None:
    """At least the four points of a cubic, in order."""
    if len(omega) < 4:
        raise ValueError(f"the response's omega must hold at least 4 frequencies, got {len(omega)}; measure at more")
    falls = np.flatnonzero(np.diff(omega) <= 0)
    if len(falls):
        i = falls[0]
        raise ValueError(f"the response's omega[{i + 1}] must be above omega[{i}], got {omega[i + 1]:g} rad/s after "
                         f"{omega[i]:g} rad/s; sort the record by frequency, and give each once")


def _refuse_repeated(places: Array) -> None:
    for i, place in enumerate(places):
        if np.any(np.all(np.abs(places[:i] - place) < 1e-6, axis=1)):
            raise ValueError(f"positions must differ, got positions[{i}] = ({place[0]:g}, {place[1]:g}) m a second "
                             "time; leave one of the two channels out")

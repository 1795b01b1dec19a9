"""A measured frequency response, occupied by a crowd."""

from __future__ import annotations

from typing import Any, final

import control as ct
import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.bridge import MeasuredBridge
from hsictrl.pedestrian import Crowd


@final
class OccupiedMeasurement(ct.FrequencyResponseData):
    """A measured bridge with standing people, on the frequencies of the measurement. Made by `couple`.

    Contact forces −α(iω)a at the points where people stand close the loop: (I + H A)⁻¹H with the
    measured accelerance H and the apparent masses A = diag Σα.

    Parameters
    ----------
    bridge : MeasuredBridge
        The empty bridge.
    people : Crowd
        The n bodies.
    positions : array, shape (n, 2)
        Where they stand, each at a measured point [m].
    force_at, sense_at : array_like, optional
        Measured points of the forces and accelerations; the first point if not given [m].
    name : str
        Name of the system.

    Attributes
    ----------
    first_point : array, shape (w,)
        Accelerance at the first measured point, to which the modal mass refers [m/s² per N].
    apparent_mass : array, shape (w, p)
        Apparent mass Σα(iω) of those who stand at each measured point [kg].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> plant = reference_bridge(frequency=2.0).ss(at=[25.0])
    >>> omega = 2 * np.pi * np.linspace(1.0, 3.0, 401)
    >>> measured = MeasuredBridge(response=ct.frequency_response(plant["a[0]", "F[0]"], omega),
    ...                           positions=[25.0], modal_mass=25e3)
    >>> occupied = couple(measured, [Pedestrian()] * 8, np.full(8, 25.0))
    >>> bool(abs(occupied.frdata).max() < abs(measured.response.frdata).max())
    True
    """

    def __init__(
        self, bridge: MeasuredBridge, people: Crowd, positions: Array, *,
        force_at: Any = None, sense_at: Any = None, name: str = "occupied",
    ) -> None:
        self.bridge, self.people, self.positions = bridge, people, positions
        drive, sense = _points(bridge, "force_at", force_at), _points(bridge, "sense_at", sense_at)
        self.apparent_mass = _apparent_mass(bridge, people, bridge.points_of("positions", positions))
        closed = _closed_loop(bridge, self.apparent_mass)
        self.first_point = closed[:, 0, 0]
        super().__init__(
            np.moveaxis(closed[:, sense][:, :, drive], 0, -1), bridge.response.omega, name=name,
            inputs=labels("F", len(drive)), outputs=labels("a", len(sense)))


def _points(bridge: MeasuredBridge, name: str, places: Any) -> NDArray[np.intp]:
    """Index of the points asked for, or of the first."""
    return bridge.points_of(name, check.points(name, bridge.positions[:1] if places is None else places, least=1))


def _apparent_mass(bridge: MeasuredBridge, people: Crowd, points: NDArray[np.intp]) -> NDArray[np.complex128]:
    """Apparent mass at every measured point, shape (w, p)."""
    s = 1j * bridge.response.omega
    mass = np.zeros((len(s), len(bridge.positions)), dtype=complex)
    for body, point in zip(people, points, strict=True):
        if body.direction == bridge.direction:
            mass[:, point] += body.apparent_mass(s)
    return mass


def _closed_loop(bridge: MeasuredBridge, mass: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Accelerance of the occupied bridge between all points, shape (w, p, p)."""
    empty = np.moveaxis(bridge.response.frdata, -1, 0)
    return np.linalg.solve(np.eye(mass.shape[1]) + empty * mass[:, None, :], empty)

"""Passivity: what never gives more energy than it took stays stable with whatever else is passive."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np
from scipy.linalg import block_diag

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.bridge import Footbridge, Mode
from hsictrl.coupling import OccupiedBridge
from hsictrl.loop.bare import bare
from hsictrl.loop.gain import LoopGain
from hsictrl.loop.popov import Margin, Matrices, margin, stored
from hsictrl.loop.sensitivity import Sensitivity
from hsictrl.pedestrian import Crowd, Pedestrian


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Passivity:
    """Whether a system is passive, with what proves it: a storage function, or a frequency.

    Parameters
    ----------
    passive : bool
        Whether it never gives more energy than it has taken.
    margin : float
        Smallest eigenvalue of Z(iω) + Z(iω)ᴴ over all frequencies [unit of the system].
    frequency : float
        Where that is; if negative, a steady motion there draws energy from the system [Hz].
    objection : str
        Why it is not passive; empty if it is.
    system : control.StateSpace
        What was tested: from contact velocities v[k] to the forces on the bodies, without unsprung masses; from
        modal forces P[j] to modal velocities; or the system given.
    storage : array, shape (n, n), or None
        P of the energy ½xᵀPx that the system stores; none if it is not passive [J per unit of the states squared].
    unsprung_mass : array, shape (ports,)
        m₀ of the energy ½m₀v² that is stored besides, as the system's velocities say [kg].

    Examples
    --------
    >>> certificate = passivity(Pedestrian(mass=70.0, frequency=3.25, damping=0.3))
    >>> print(certificate)
    passive: it stores ½xᵀPx with 2 states, and ½m₀v² in 3.5 kg
    >>> print(certificate.storage.round(1))                     # k of the spring, and m₁
    [[27729.9     0. ]
     [    0.     66.5]]
    """

    passive: bool
    margin: float
    frequency: float
    objection: str
    system: ct.StateSpace
    storage: Array | None
    unsprung_mass: Array

    def __post_init__(self) -> None:
        check.freeze(self.storage, self.unsprung_mass)

    def __bool__(self) -> bool:
        return self.passive

    def __str__(self) -> str:
        if not self.passive:
            return f"not passive: {self.objection}"
        if self.storage is None:
            return "passive: it gives energy at no frequency"
        mass = float(self.unsprung_mass.sum())
        return (f"passive: it stores ½xᵀPx with {len(self.storage)} states"
                + (f", and ½m₀v² in {mass:.4g} kg" if mass else ""))


def passivity(system: Pedestrian | Crowd | Footbridge | ct.StateSpace) -> Passivity:
    """Certify that a bridge, a body, a crowd, or any system from contact velocity to force is passive.

    Smallest eigenvalue and frequency come from the Hamiltonian test. Bodies and bridges store the energy of their
    springs and masses, in closed form; what another system stores is solved for, to a millionth of its size.
    A bridge and a crowd that are both passive are stable together, whoever stands where.

    Parameters
    ----------
    system : Pedestrian, Crowd, Footbridge or control.StateSpace
        Bodies are taken from the velocity of the deck to the force on them; the states are the stretch u − y of
        the spring and the velocity of the sprung mass. Bridges are taken from modal forces to modal velocities,
        which covers forces and velocities at any points. Other systems have as many outputs as inputs.

    Returns
    -------
    Passivity

    Raises
    ------
    ValueError
        If the system has not as many outputs as inputs, is in discrete time, or is a bridge with absorbers.

    Examples
    --------
    >>> print(passivity(Crowd(mass=[70.0, 80.0], frequency=3.25, damping=0.3)))
    passive: it stores ½xᵀPx with 4 states, and ½m₀v² in 7.5 kg
    >>> active = ct.ss([[0, 1], [-400, 2]], [[-1], [-2]], [[-28e3, 140]], [[-140]])      # pushes as the deck moves
    >>> print(passivity(active))
    not passive: a pole at 1+19.97j rad/s grows
    """
    if isinstance(system, Pedestrian):
        system = Crowd.of([system])
    if isinstance(system, Crowd):
        return _of_bodies(system)
    if isinstance(system, Footbridge):
        return _of_bridge(bare(system, "certify them as bodies, Crowd.of([absorber])"))
    return _of_system(system)


def _of_bodies(people: Crowd) -> Passivity:
    n = len(people)
    if not n:
        raise ValueError("a crowd must hold at least one body, got none; nobody stores no energy")
    parts = [_body(body) for body in people]
    stores = [np.diag([body.stiffness, body.sprung_mass]) for body in people]
    names = {"inputs": labels("v", n), "outputs": labels("F", n), "states": labels(["stretch", "du"], n)}
    return _together(parts, stores, people.unsprung_mass, names)


def _of_bridge(bridge: Footbridge) -> Passivity:
    n = bridge.n_modes
    stores = [np.diag([omega**2, 1.0]) for omega in bridge.omega]
    names = {"inputs": labels("P", n), "outputs": labels("dz", n), "states": labels(["z", "dz"], n)}
    return _together([_mode(mode) for mode in bridge.modes], stores, np.zeros(n), names)


def _of_system(system: Any) -> Passivity:
    check.instance("system", system, ct.StateSpace, "give a Pedestrian, a Crowd, a Footbridge or a control.StateSpace")
    if isinstance(system, OccupiedBridge | LoopGain | Sensitivity):
        raise TypeError(f"system must lead from velocity to force, or back, got {type(system).__name__}; certify the "
                        "bridge and the people on their own")
    if system.isdtime(strict=True):
        raise ValueError(f"system must be in continuous time, got steps of {system.dt:g} s; certify it before sampling")
    if system.ninputs != system.noutputs:
        raise ValueError(f"system must have as many outputs as inputs, got {system.noutputs} and {system.ninputs}; "
                         "give force and velocity at the same points")
    matrices = (system.A, system.B, system.C, system.D)
    found = margin(matrices)
    return _certificate(found, system, None if found.objection else stored(matrices), np.zeros(system.ninputs))


def _together(parts: list[Matrices], stores: list[Array], unsprung_mass: Array, names: dict[str, Any]) -> Passivity:
    """Parts beside each other: as passive as the least passive of them, and all their energies added."""
    found = min((margin(part) for part in parts), key=lambda one: (not one.objection, one.smallest))
    system = ct.ss(*(block_diag(*each) for each in zip(*parts, strict=True)), **names)
    return _certificate(found, system, None if found.objection else block_diag(*stores), np.array(unsprung_mass))


def _certificate(found: Margin, system: ct.StateSpace, storage: Array | None, unsprung_mass: Array) -> Passivity:
    return Passivity(passive=not found.objection, margin=found.smallest, frequency=found.at / (2 * np.pi),
                     objection=found.objection, system=system, storage=storage, unsprung_mass=unsprung_mass)


def _body(body: Pedestrian) -> Matrices:
    """From the deck's velocity to the force of spring and damper on it, with stretch u − y and velocity du."""
    k, c, m = body.stiffness, body.damping_coefficient, body.sprung_mass
    return (np.array([[0, 1], [-k / m, -c / m]]), np.array([[-1.0], [c / m]]), np.array([[-k, -c]]), np.array([[c]]))


def _mode(mode: Mode) -> Matrices:
    block = mode.ss()
    return block.A, block.B, block.C[1:2], block.D[1:2]

"""The moving crowd: a bridge whose people walk, as a system that varies in time (section 2.1)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.bridge import Footbridge
from hsictrl.coupling.occupied import OccupiedBridge, couple
from hsictrl.crowd import Traffic
from hsictrl.pedestrian import Crowd


def moving_crowd(bridge: Footbridge, traffic: Traffic, *, convective: bool = False) -> MovingCrowd:
    """Let people walk over a bridge: the time-varying system of (A.7), by its structure.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    traffic : Traffic
        Who walks over it.
    convective : bool
        Whether contact points feel that they move along the shapes, see `MovingCrowd`.

    Returns
    -------
    MovingCrowd

    Raises
    ------
    ValueError
        If a trajectory leaves the deck, or convective terms are asked for where somebody follows a trajectory.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.crowd import Walker
    >>> from hsictrl.walking import HarmonicForce
    >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> print(moving_crowd(reference_bridge(), Traffic([walker])))
    1 walker at 2.00 Hz on footbridge 50 m × 3 m, 50000 kg
      mode 0: 2.000 Hz, 0.50 %, 25000 kg
    """
    check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
    check.instance("traffic", traffic, Traffic, "draw it with CrowdFlow.sample, or make it with Traffic([walker])")
    check.instance("convective", convective, bool, "give True or False")
    if convective and traffic.walkers.trajectories:
        raise ValueError("convective terms need walkers who go straight on, got some who follow a trajectory; leave "
                         "these terms out")
    traffic.walkers.carried(bridge)     # refuses trajectories that leave the deck
    return MovingCrowd(bridge=bridge, traffic=traffic, convective=convective)


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MovingCrowd:
    """A bridge with people who walk over it. Made by `moving_crowd`.

    Velocities and accelerations of a contact point are partial derivatives in time, as in (A.1). With convective
    terms they are the derivatives of y(t) = φ(vt)·z(t): ẏ = φ·ż + v φ′·z and ÿ = φ·z̈ + 2v φ′·ż + v² φ″·z.
    Absorbers of the bridge are bodies that stay where they are.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    traffic : Traffic
        Who walks over it.
    convective : bool
        Whether contact points feel that they move along the shapes.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.crowd import Walker
    >>> from hsictrl.walking import HarmonicForce
    >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> crowd = moving_crowd(reference_bridge(), Traffic([walker]))
    >>> crowd.rows(20.0).round(6)      # 1/√25 t at midspan
    array([[0.006325]])
    """

    bridge: Footbridge
    traffic: Traffic
    convective: bool = False

    def __str__(self) -> str:
        return f"{self.traffic} on {self.bridge}"

    @property
    def nstates(self) -> int:
        """Order 2(n_m + n_H) of the system, everybody in the traffic and every absorber counted [-].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.crowd import Walker
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
        >>> moving_crowd(reference_bridge(), Traffic([walker])).nstates
        4
        """
        return 2 * (self.bridge.n_modes + len(self.bodies))

    @property
    def bodies(self) -> Crowd:
        """Absorbers of the bridge, and then everybody in the traffic."""
        return self.bridge.fixed[0] + self.traffic.walkers.bodies

    def rows(self, time: float) -> Array:
        """Participation of every body in the modes at an instant, zero for walkers off the deck.

        Parameters
        ----------
        time : float
            The instant [s].

        Returns
        -------
        array, shape (n, n_m)
            Rows of Φ, those of the bridge's absorbers first [1/√kg].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.crowd import Walker
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
        >>> moving_crowd(reference_bridge(), Traffic([walker])).rows(-1.0)
        array([[0.]])
        """
        walkers = self.traffic.walkers
        moving = self.bridge.participation(walkers.places(time), walkers.bodies.direction)
        if not self.bridge.absorbers:
            return moving
        bodies, places = self.bridge.fixed
        return np.vstack([self.bridge.participation(places, bodies.direction), moving])

    def row_rates(self, time: float, order: int) -> Array:
        """Derivatives of `rows` in time that convective terms take; zero where these are left out.

        Parameters
        ----------
        time : float
            The instant [s].
        order : int
            Order of the derivative; 0 gives `rows` [-].

        Returns
        -------
        array, shape (n, n_m)
            v^order times the derivatives of the shapes along the deck [1/(√kg s^order)].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.crowd import Walker
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
        >>> crowd = moving_crowd(reference_bridge(), Traffic([walker]), convective=True)
        >>> crowd.row_rates(0.0, 1).round(6)      # 1.25 π/50/√25 t
        array([[0.000497]])
        """
        order = check.whole("order", order, least=0, remedy="give 0, 1 or 2")
        if order == 0:
            return self.rows(time)
        walkers, n_fixed = self.traffic.walkers, len(self.bridge.absorbers)
        rates = np.zeros((n_fixed + len(walkers), self.bridge.n_modes))
        if self.convective:
            rates[n_fixed:] = walkers.speed[:, None]**order * self.bridge.participation(
                walkers.places(time), walkers.bodies.direction, order)
        return rates

    def at(self, time: float, *, force_at: Any = None, sense_at: Any = None) -> OccupiedBridge:
        """The system of one instant, as if everybody on the deck stood still.

        Parameters
        ----------
        time : float
            The instant [s].
        force_at, sense_at : array_like, optional
            As in `couple` [m].

        Returns
        -------
        OccupiedBridge
            Its `effective` properties are the instantaneous ones.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.crowd import Walker
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
        >>> moving_crowd(reference_bridge(), Traffic([walker])).at(20.0).positions
        array([[25.,  0.]])
        """
        time = check.number("time", time, remedy="give s")
        walkers, places = self.traffic.walkers, self.traffic.walkers.places(time)
        present = self.bridge.carries(places)
        return couple(self.bridge, walkers.bodies.part(present), places[present],
                      force_at=force_at, sense_at=sense_at, name="instant")

    def to_nlsys(self, *, force_at: Any = None, sense_at: Any = None, name: str = "moving") -> ct.NonlinearIOSystem:
        """Give the system to the host, walking forces included, for `control.input_output_response`.

        Everybody in the traffic has two states, at rest before they step on.

        Parameters
        ----------
        force_at, sense_at : array_like, optional
            As in `couple`: where further forces act, and where accelerations are read [m].
        name : str
            Name of the system.

        Returns
        -------
        control.NonlinearIOSystem
            Inputs F[i] [N], outputs a[i] [m/s²], states z[j], u[k], dz[j], du[k] as in (A.7).

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.crowd import Walker
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
        >>> system = moving_crowd(reference_bridge(), Traffic([walker])).to_nlsys()
        >>> record = ct.input_output_response(system, np.linspace(0, 10, 501), 0)
        >>> bool(np.abs(record.outputs).max() > 0)
        True
        """
        empty = couple(self.bridge, force_at=force_at, sense_at=sense_at)
        drive, sense = (self.bridge.participation(points) for points in (empty.force_at, empty.sense_at))
        rates, n_m, n = _rates(self, drive), self.bridge.n_modes, len(self.bodies)
        sizes = {"z": n_m, "u": n, "dz": n_m, "du": n}
        return ct.nlsys(
            lambda t, x, u, params: np.concatenate([x[n_m + n:], rates(t, x, u)]),
            lambda t, x, u, params: sense @ rates(t, x, u)[:n_m],
            inputs=empty.input_labels, outputs=empty.output_labels, name=name,
            states=[name for part, size in sizes.items() for name in labels(part, size)])


def _rates(crowd: MovingCrowd, drive: Array) -> Callable[[float, Array, Array], Array]:
    """Accelerations of modes and bodies (A.3, A.4) as a function of time, state and further forces."""
    bridge, walkers = crowd.bridge, crowd.traffic.walkers
    people, lines = crowd.bodies, walkers.lines()
    n_m, n, n_fixed = bridge.n_modes, len(people), len(bridge.absorbers)
    gamma, square = 2 * bridge.damping * bridge.omega, bridge.omega**2
    vertical = bool(np.all(walkers.bodies.direction == "vertical"))

    def rates(t: float, x: Array, further: Array) -> Array:
        z, u, dz, du = np.split(x, [n_m, n_m + n, 2 * n_m + n])
        rows = crowd.rows(t)
        pull = people.damping_coefficient * (du - rows @ dz) + people.stiffness * (u - rows @ z)
        contact = pull
        if crowd.convective:
            along, bend = crowd.row_rates(t, 1), crowd.row_rates(t, 2)
            pull = pull - people.damping_coefficient * (along @ z)
            contact = pull - people.unsprung_mass * (2 * along @ dz + bend @ z)
        upright = rows[n_fixed:] if vertical else bridge.participation(walkers.places(t))     # forces are vertical
        modal = rows.T @ contact + upright.T @ _walking_forces(lines, n - n_fixed, t) + drive.T @ np.atleast_1d(further)
        mass = np.eye(n_m) + rows.T * people.unsprung_mass @ rows
        return np.concatenate([np.linalg.solve(mass, modal - gamma * dz - square * z), -pull / people.sprung_mass])

    return rates


def _walking_forces(lines: Any, n: int, time: float) -> Array:
    """Force of every walker on rigid ground at an instant, shape (n,) [N]."""
    forces = np.zeros(n)
    for who, force in lines:
        forces[who] = force.at([time])[:, 0]
    return forces

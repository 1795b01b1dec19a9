"""The occupied bridge at an instant, as a linear time-invariant system (A.7–A.10)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, final, overload

import control as ct
import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.bridge import Footbridge, MeasuredBridge
from hsictrl.coupling.blocks import blocks_of
from hsictrl.coupling.condensation import CondensedCrowd
from hsictrl.coupling.frozen import FrozenSystem
from hsictrl.coupling.interconnection import interconnect
from hsictrl.coupling.measurement import OccupiedMeasurement
from hsictrl.pedestrian import Body, Crowd

Complex = NDArray[np.complex128]


@overload
def couple(
    bridge: Footbridge, people: Crowd | Body | Sequence[Body] = ..., positions: Any = ...,
    *, force_at: Any = ..., sense_at: Any = ..., name: str = ...,
) -> OccupiedBridge: ...
@overload
def couple(
    bridge: MeasuredBridge, people: Crowd | Body | Sequence[Body] = ..., positions: Any = ...,
    *, force_at: Any = ..., sense_at: Any = ..., name: str = ...,
) -> OccupiedMeasurement: ...
def couple(
    bridge: Footbridge | MeasuredBridge, people: Crowd | Body | Sequence[Body] = (), positions: Any = (),
    *, force_at: Any = None, sense_at: Any = None, name: str = "occupied",
) -> OccupiedBridge | OccupiedMeasurement:
    """Put people on a bridge and close the loop, exactly (A.7–A.10).

    Parameters
    ----------
    bridge : Footbridge or MeasuredBridge
        The empty bridge.
    people : Crowd, Pedestrian, Absorber, or sequence of these bodies
        One body per position, or one body that stands at all of them; nobody by default. Absorbers of the bridge
        itself come first.
    positions : array_like, shape (n,) or (n, 2)
        Places x, or (x, y), on the deck [m].
    force_at, sense_at : array_like, shape (p,) or (p, 2), optional
        Where vertical forces act and where vertical accelerations are read; the antinode of the
        first mode if not given (of a measured bridge, the first point) [m].
    name : str
        Name of the system.

    Returns
    -------
    OccupiedBridge
        A `control.StateSpace` from F[i] [N] to a[i] [m/s²]; of a measured bridge, an
        `OccupiedMeasurement`, which is a `control.FrequencyResponseData`.

    Raises
    ------
    ValueError
        If a place lies off the deck, or the number of bodies and positions differs.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.pedestrian import Pedestrian
    >>> occupied = couple(reference_bridge(frequency=2.0), Pedestrian(), np.linspace(0, 50, 15))
    >>> occupied.nstates, occupied.input_labels, occupied.output_labels
    (32, ['F[0]'], ['a[0]'])
    >>> empty = couple(reference_bridge(frequency=2.0))
    >>> empty.nstates
    2
    """
    check.instance("bridge", bridge, (Footbridge, MeasuredBridge), "describe the bridge first")
    check.instance("name", name, str, "give a word")
    places = check.points("positions", positions)
    crowd = _crowd(people, len(places))
    if isinstance(bridge, MeasuredBridge):
        return OccupiedMeasurement(bridge, crowd, places, force_at=force_at, sense_at=sense_at, name=name)
    if bridge.absorbers:
        fixed, there = bridge.fixed
        crowd, places = fixed + crowd, np.vstack([there, bridge.on_deck("positions", places)])
    return OccupiedBridge(bridge, crowd, places, force_at=force_at, sense_at=sense_at, name=name)


@final
class OccupiedBridge(FrozenSystem):
    """A bridge with standing people: every `control` function takes it. Made by `couple`.

    States are those of (A.7): z[j], u[k], dz[j], du[k]. The frequency response condenses the
    bodies into an n_m × n_m apparent mass, whatever their number, and so does every function
    of the host that asks for one.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    people : Crowd
        The n bodies, absorbers of the bridge first.
    positions : array, shape (n, 2)
        Where they stand [m].
    force_at, sense_at : array_like, optional
        As in `couple` [m].
    name : str
        Name of the system.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.pedestrian import Pedestrian
    >>> print(couple(reference_bridge(frequency=2.0), Pedestrian(), [20.0, 30.0]))
    <OccupiedBridge> occupied: 2 bodies, 140 kg, 3.25–3.25 Hz, 30–30 %
    on footbridge 50 m × 3 m, 50000 kg
      mode 0: 2.000 Hz, 0.50 %, 25000 kg
    Inputs (1): ['F[0]']
    Outputs (1): ['a[0]']
    States (6): ['z[0]', 'u[0]', 'u[1]', 'dz[0]', 'du[0]', 'du[1]']
    """

    def __init__(
        self, bridge: Footbridge, people: Crowd, positions: Array, *,
        force_at: Any = None, sense_at: Any = None, name: str = "occupied",
    ) -> None:
        self.bridge, self.people = bridge, people
        self.positions = bridge.on_deck("positions", positions)
        self.force_at = _points(bridge, "force_at", force_at)
        self.sense_at = _points(bridge, "sense_at", sense_at)
        self._drive, self._sense = bridge.participation(self.force_at), bridge.participation(self.sense_at)
        self.condensed = CondensedCrowd(people, bridge.participation(self.positions, people.direction))
        n_m, n = self.condensed.rows.shape[1], len(people)
        made_of = {"bridge": bridge, "people": people, "positions": self.positions, "force_at": self.force_at,
                   "sense_at": self.sense_at}
        super().__init__(
            made_of, self._matrices(), name=name,
            inputs=labels("F", len(self.force_at)), outputs=labels("a", len(self.sense_at)),
            states=labels("z", n_m) + labels("u", n) + labels("dz", n_m) + labels("du", n))

    def _matrices(self) -> tuple[Array, Array, Array, Array]:
        """A_c, B_c, C_c, D_c of (A.8) by their structure: only the modal mass matrix is ever inverted."""
        people, rows = self.people, self.condensed.rows
        n, n_m = rows.shape
        mass = np.eye(n_m) + rows.T * people.unsprung_mass @ rows
        stiffness = np.diag(self.bridge.omega**2) + rows.T * people.stiffness @ rows
        damping = np.diag(2 * self.bridge.damping * self.bridge.omega) + rows.T * people.damping_coefficient @ rows
        acceleration = np.linalg.solve(mass, np.hstack([
            -stiffness, rows.T * people.stiffness, -damping, rows.T * people.damping_coefficient]))
        half = n_m + n
        A = np.zeros((2 * half, 2 * half))
        A[np.arange(half), half + np.arange(half)] = 1.0
        A[half:half + n_m] = acceleration
        u, du = n_m + np.arange(n), half + n_m + np.arange(n)
        spring, dashpot = people.omega**2, 2 * people.damping * people.omega
        A[half + n_m:, :n_m] = spring[:, None] * rows
        A[half + n_m:, half:half + n_m] = dashpot[:, None] * rows
        A[du, u], A[du, du] = -spring, -dashpot
        push = np.linalg.solve(mass, self._drive.T)
        B = np.zeros((2 * half, len(self._drive)))
        B[half:half + n_m] = push
        return A, B, self._sense @ acceleration, self._sense @ push

    def dynamic_stiffness(self, s: Any) -> Complex:
        """Condensed dynamic stiffness s²(I + Σφφᵀα(s)) + sΓ + Ω² of the occupied bridge.

        Parameters
        ----------
        s : complex or array, shape (w,)
            Laplace variable [rad/s].

        Returns
        -------
        array, shape (w, n_m, n_m)
            In mass-normalised coordinates [1/s²].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> couple(reference_bridge(frequency=2.0)).dynamic_stiffness(0)[0, 0, 0].real ** 0.5 / (2 * np.pi)
        np.float64(2.0)
        """
        s = np.atleast_1d(np.asarray(s, dtype=complex))
        stiffness = s[:, None, None]**2 * (np.eye(self.bridge.n_modes) + self.condensed.apparent_mass(s))
        diagonal = np.einsum("wjj->wj", stiffness)
        diagonal += np.multiply.outer(s, 2 * self.bridge.damping * self.bridge.omega) + self.bridge.omega**2
        return stiffness

    def horner(self, x: Any, warn_infinite: bool = True) -> Complex:
        """Evaluate the transfer function by condensation; the host's functions call this.

        Parameters
        ----------
        x : complex or array, shape (w,)
            Laplace variable [rad/s].
        warn_infinite : bool
            Whether to warn at a pole.

        Returns
        -------
        array, shape (outputs, inputs, w)
            Accelerance [m/s² per N].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> couple(reference_bridge(frequency=2.0)).horner(4j * np.pi).shape
        (1, 1, 1)
        """
        s = check.laplace(x)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            stiffness = self.dynamic_stiffness(s)
            response = self._condensed_response(s, stiffness)
            missed = ~np.isfinite(response).all(axis=(0, 1)) | self._drowned(s, stiffness)
        if np.any(missed):    # at a pole of the system or of an undamped body the host knows the limit
            response[:, :, missed] = super().horner(s[missed], warn_infinite)
        return response

    def _condensed_response(self, s: Complex, stiffness: Complex) -> Complex:
        try:
            motion = np.linalg.solve(stiffness, self._drive.T[None])
        except np.linalg.LinAlgError:
            motion = np.full((len(s), *self._drive.T.shape), np.nan + 0j)
        return np.asarray(np.moveaxis(s[:, None, None]**2 * (self._sense @ motion), 0, -1))

    def _drowned(self, s: Complex, stiffness: Complex) -> NDArray[np.bool_]:
        """Where an undamped body resonates, its apparent mass drowns the modes in rounding."""
        mass = np.trace(self.condensed.apparent_mass(0)[0].real)
        ordinary = np.abs(s)**2 * (1 + mass) + self.bridge.omega.max()**2
        return np.asarray(np.abs(stiffness).max(axis=(1, 2)) > 1e4 * ordinary)

    def zeros(self) -> Complex:
        """Zeros from force to acceleration; the host's plots choose their frequencies by poles and zeros.

        A constant force accelerates nothing: two zeros per port lie at the origin, where rounding would leave them
        at random tiny frequencies. With a port for each mode the rest are the poles of the bodies, each of which
        holds the deck still under itself.

        Returns
        -------
        array of complex
            Zeros [rad/s].

        Raises
        ------
        NotImplementedError
            By the host, for more inputs than outputs, or fewer, with more modes than either.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.pedestrian import Pedestrian
        >>> couple(reference_bridge(frequency=2.0), Pedestrian(), [25.0]).zeros().round(3)
        array([ 0.   +0.j  ,  0.   +0.j  , -6.126+19.48j, -6.126-19.48j])
        """
        ports = min(np.linalg.matrix_rank(shapes) for shapes in (self._drive, self._sense))
        if ports == self.bridge.n_modes:
            people = self.people
            poles = people.omega * (-people.damping + 1j * np.sqrt(1 - people.damping**2))
            return np.concatenate([np.zeros(2 * ports), poles, poles.conj()])
        found = np.asarray(super().zeros())
        found[np.argsort(np.abs(found))[:2 * ports]] = 0
        return found

    def respond(self, s: Complex, modal_forces: Any) -> Complex:
        """Accelerations under modal forces, in the Laplace domain: a crowd's forces move, but act through few modes.

        Parameters
        ----------
        s : array, shape (w,)
            Laplace variable [rad/s].
        modal_forces : array, shape (n_m, w)
            Transforms of the modal forces Φᵀp in mass-normalised coordinates [N s/√kg].

        Returns
        -------
        array, shape (outputs, w)
            Transforms of the accelerations at `sense_at` [m/s].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> couple(reference_bridge()).respond(1j * np.ones(3), np.ones((1, 3))).shape
        (1, 3)
        """
        motion = np.linalg.solve(self.dynamic_stiffness(s), modal_forces.T[:, :, None])[:, :, 0]
        return np.asarray(self._sense @ (s**2 * motion.T))

    def interconnected(self) -> ct.LinearICSystem:
        """Give the same system as blocks: one named block per mode and per walker, joined by signal names.

        Returns
        -------
        control.LinearICSystem
            With blocks mode0, mode1, …, absorber0, … and walker0, walker1, …; its `connection_table` shows who
            is joined to whom.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.pedestrian import Pedestrian
        >>> blocks = couple(reference_bridge(frequency=2.0), Pedestrian(), [25.0]).interconnected()
        >>> [block.name for block in blocks.syslist]
        ['mode0', 'walker0']
        """
        outputs = [[(f"mode{j}", f"ddz[{j}]", float(share)) for j, share in enumerate(row)] for row in self._sense]
        return interconnect(
            blocks_of(self.bridge, self.people, self.condensed.rows, self._drive, self.input_labels),
            inplist=self.input_labels, inputs=self.input_labels, outlist=outputs, outputs=self.output_labels,
            check_unused=False, name=self.name)

    def __str__(self) -> str:
        signals = (("Inputs", self.input_labels), ("Outputs", self.output_labels), ("States", self.state_labels))
        return "\n".join([f"<OccupiedBridge> {self.name}: {self.people}", f"on {self.bridge}",
                          *(f"{kind} ({len(names)}): {_shortened(names)}" for kind, names in signals)])


def _crowd(people: Any, n: int) -> Crowd:
    remedy = "give a Crowd, a Pedestrian or a sequence of Pedestrian"
    if isinstance(people, Body):
        return Crowd.of([people] * n)
    if not isinstance(people, Crowd):
        people = Crowd.of(check.instance("people", people, Sequence, remedy))
    if len(people) != n:
        raise ValueError(f"people and positions must be as many, got {len(people)} bodies and {n} positions; "
                         "give one position per body")
    return people


def _points(bridge: Footbridge, name: str, places: Any) -> Array:
    """The places asked for, or the antinode of the first mode."""
    antinode = [bridge.modes[0].shape.antinode]
    return bridge.on_deck(name, check.points(name, antinode if places is None else places, least=1))


def _shortened(names: list[str]) -> str:
    if len(names) <= 12:
        return str(names)
    return str(names[:4])[:-1] + ", …, " + str(names[-2:])[1:]

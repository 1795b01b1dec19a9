"""The loop gain: once around the loop, from modal force to modal force."""

from __future__ import annotations

from typing import Any, final

import control as ct
import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.coupling import FrozenSystem, OccupiedBridge, OccupiedMeasurement

Complex = NDArray[np.complex128]
POINTS = 2001
AROUND = np.geomspace(1e-6, 0.1, 81)    # beside a mode of little damping the loop gain turns within its bandwidth
REMEDY = "make one with couple(bridge, people, positions)"


@final
class LoopGain(FrozenSystem):
    """Once around the loop of an occupied bridge, from modal force to modal force. Made by `loop_gain`.

    States are z[j] and dz[j] of the empty bridge, r[k] and dr[k] of the sprung masses relative to the deck
    under them: as many as the closed loop has, and all of them stable. The frequency response condenses
    the bodies, whatever their number.

    Parameters
    ----------
    occupied : OccupiedBridge
        Bridge and crowd.
    name : str
        Name of the system.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> print(LoopGain(couple(reference_bridge(frequency=2.0), Pedestrian(), [20.0, 30.0])))
    <LoopGain> loop: 2 bodies, 140 kg, 3.25–3.25 Hz, 30–30 % around 1 mode, 6 states
    """

    def __init__(self, occupied: OccupiedBridge, name: str = "loop") -> None:
        self.occupied = check.instance("occupied", occupied, OccupiedBridge, REMEDY)
        n_m, n = occupied.bridge.n_modes, len(occupied.people)
        super().__init__(
            {"occupied": occupied}, _matrices(occupied), name=name,
            inputs=labels("P", n_m), outputs=labels("held", n_m),
            states=labels("z", n_m) + labels("dz", n_m) + labels("r", n) + labels("dr", n))

    def horner(self, x: Any, warn_infinite: bool = True) -> Complex:
        """Evaluate the loop gain by condensation; the host's functions call this.

        Parameters
        ----------
        x : complex or array, shape (w,)
            Laplace variable [rad/s].
        warn_infinite : bool
            Whether to warn at a pole.

        Returns
        -------
        array, shape (n_m, n_m, w)
            L(s) = s²A(s)D₀(s)⁻¹ [-].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.coupling import couple
        >>> LoopGain(couple(reference_bridge(frequency=2.0))).horner(4j * np.pi).shape
        (1, 1, 1)
        """
        s = check.laplace(x)
        bridge = self.occupied.bridge
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            stiffness = s[:, None]**2 + np.multiply.outer(s, 2 * bridge.damping * bridge.omega) + bridge.omega**2
            plant = s[:, None]**2 / stiffness
            gain = np.moveaxis(self.occupied.condensed.apparent_mass(s) * plant[:, None, :], 0, -1)
        missed = ~np.isfinite(gain).all(axis=(0, 1))
        if np.any(missed):    # at a pole, of a mode or of a body, the host knows the limit
            gain[:, :, missed] = super().horner(s[missed], warn_infinite)
        return gain

    def frequencies(self, band: tuple[float, float] | None = None) -> Array:
        """Frequencies that resolve the resonance of every mode, which the host's own choice may miss.

        Parameters
        ----------
        band : (float, float), optional
            From where to where; from a tenth of the lowest frequency of bridge and bodies to ten times the
            highest if not given [Hz].

        Returns
        -------
        array, shape (w,)
            Increasing [Hz].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.coupling import couple
        >>> hertz = LoopGain(couple(reference_bridge(frequency=2.0))).frequencies((1.0, 4.0))
        >>> print(hertz[[0, -1]], 2.0 in hertz)
        [1. 4.] True
        """
        low, high = self._limits() if band is None else _rising(band)
        modes = self.occupied.bridge.omega / (2 * np.pi)
        around = np.multiply.outer(modes, np.concatenate([1 - AROUND, [1], 1 + AROUND])).ravel()
        inside = around[(around > low) & (around < high)]
        return np.unique(np.concatenate([[low], np.geomspace(low, high, POINTS)[1:-1], inside, [high]]))

    def _limits(self) -> tuple[float, float]:
        own = np.concatenate([self.occupied.bridge.omega, self.occupied.people.omega]) / (2 * np.pi)
        return 0.1 * float(own.min()), 10 * float(own.max())

    def __str__(self) -> str:
        modes = self.ninputs
        return (f"<LoopGain> {self.name}: {self.occupied.people} around {modes} mode{'s' * (modes > 1)}, "
                f"{self.nstates} states")


def loop_gain(
    occupied: OccupiedBridge | OccupiedMeasurement, *, name: str = "loop",
) -> LoopGain | ct.FrequencyResponseData:
    """Loop gain of bridge and crowd, L = A G, in negative feedback as the host means it.

    The bridge turns modal forces into modal accelerations by its accelerance G = s²D₀⁻¹, and the crowd holds
    A times these accelerations against it, A the modal apparent mass. The loop is opened at the modal forces,
    so that the occupied bridge is the empty one behind (I + L)⁻¹, see `sensitivity`. Opened at the modal
    accelerations, its gain is the transpose. Absorbers of the bridge count as bodies of the crowd here.

    Parameters
    ----------
    occupied : OccupiedBridge or OccupiedMeasurement
        What `couple` returns.
    name : str
        Name of the loop.

    Returns
    -------
    LoopGain or control.FrequencyResponseData
        A `control.StateSpace` from modal forces P[j] to the modal forces held[j] that the crowd holds
        against them [-]. Of a measured bridge, from forces to forces at the measured points, on the
        frequencies of the measurement [-].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> x = (np.arange(15) + 0.5) * 50 / 15
    >>> gain = loop_gain(couple(reference_bridge(frequency=2.0), Pedestrian(), x))
    >>> print(abs(gain(4j * np.pi)).round(3))           # at the bridge's own frequency
    3.046
    """
    check.instance("name", name, str, "give a word")
    check.instance("occupied", occupied, (OccupiedBridge, OccupiedMeasurement), REMEDY)
    return LoopGain(occupied, name) if isinstance(occupied, OccupiedBridge) else _measured(occupied, name)


def _measured(occupied: OccupiedMeasurement, name: str) -> ct.FrequencyResponseData:
    response, n = occupied.bridge.response, len(occupied.bridge.positions)
    return ct.frd(occupied.apparent_mass.T[:, None] * response.frdata, response.omega,
                  inputs=labels("F", n), outputs=labels("held", n), name=name)


def _matrices(occupied: OccupiedBridge) -> tuple[Array, Array, Array, Array]:
    """The bridge from P to ddz, and behind it the crowd from ddz to m₀ddz − c dr − k r (A.2, A.3)."""
    bridge, people, rows = occupied.bridge, occupied.people, occupied.condensed.rows
    n, n_m = rows.shape
    acceleration = np.hstack([-np.diag(bridge.omega**2), -np.diag(2 * bridge.damping * bridge.omega)])
    A = np.zeros((2 * (n_m + n), 2 * (n_m + n)))
    z, dz, r, dr = np.split(np.arange(len(A)), np.cumsum([n_m, n_m, n]))
    A[z, dz], A[r, dr] = 1.0, 1.0
    A[dz, :2 * n_m] = acceleration
    A[dr, :2 * n_m] = -rows @ acceleration
    A[dr, r], A[dr, dr] = -people.omega**2, -2 * people.damping * people.omega
    B = np.zeros((len(A), n_m))
    B[dz], B[dr] = np.eye(n_m), -rows
    D = rows.T * people.unsprung_mass @ rows
    C = np.hstack([D @ acceleration, -rows.T * people.stiffness, -rows.T * people.damping_coefficient])
    return A, B, C, D


def _rising(band: Any) -> tuple[float, float]:
    low, high = check.band(band)
    if low >= high:
        raise ValueError(f"band must be (low, high) with low below high, got {[low, high]}; give two frequencies in Hz")
    return low, high

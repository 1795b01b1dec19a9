"""The sensitivity: what is left of a force on the bridge once the crowd has held against it."""

from __future__ import annotations

from typing import Any, final

import control as ct
import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.coupling import FrozenSystem, OccupiedBridge, OccupiedMeasurement
from hsictrl.loop.gain import LoopGain, loop_gain

Complex = NDArray[np.complex128]


@final
class Sensitivity(FrozenSystem):
    """The closed loop from outer to net modal forces, S = (I + L)⁻¹. Made by `sensitivity`.

    States are those of the loop gain; the frequency response is inverted from the condensed loop gain.

    Parameters
    ----------
    gain : LoopGain
        The open loop.
    name : str
        Name of the system.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> print(Sensitivity(LoopGain(couple(reference_bridge(frequency=2.0), Pedestrian(), [20.0, 30.0]))))
    <Sensitivity> sensitivity of 2 bodies, 140 kg, 3.25–3.25 Hz, 30–30 % around 1 mode, 6 states
    """

    def __init__(self, gain: LoopGain, name: str = "sensitivity") -> None:
        self.gain = check.instance("gain", gain, LoopGain, "make one with loop_gain(occupied)")
        super().__init__({"gain": gain}, _closed(gain), name=name, inputs=labels("P", gain.ninputs),
                         outputs=labels("net", gain.ninputs), states=gain.state_labels)

    def horner(self, x: Any, warn_infinite: bool = True) -> Complex:
        """Evaluate (I + L)⁻¹; the host's functions call this.

        Parameters
        ----------
        x : complex or array, shape (w,)
            Laplace variable [rad/s].
        warn_infinite : bool
            Whether to warn at a pole.

        Returns
        -------
        array, shape (n_m, n_m, w)
            S(s) [-].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.coupling import couple
        >>> sensitivity(couple(reference_bridge(frequency=2.0))).horner(4j * np.pi).real
        array([[[1.]]])
        """
        s = check.laplace(x)
        gain = self.gain.horner(s, warn_infinite=False)
        known = np.isfinite(gain).all(axis=(0, 1))
        left = np.zeros_like(gain)
        try:
            left[:, :, known] = _inverse(gain[:, :, known])
        except np.linalg.LinAlgError:
            known[:] = False
        if not np.all(known):    # where the loop gain, or the sensitivity, has a pole
            left[:, :, ~known] = super().horner(s[~known], warn_infinite)
        return left

    def __str__(self) -> str:
        return f"<Sensitivity> {self.name} of {str(self.gain).partition(': ')[2]}"


def sensitivity(
    occupied: OccupiedBridge | OccupiedMeasurement, *, name: str = "sensitivity",
) -> Sensitivity | ct.FrequencyResponseData:
    """Sensitivity S = (I + L)⁻¹ of the bridge to its crowd, from the loop gain.

    Under modal forces P the occupied bridge moves as the empty one does under S P: its accelerance is G S,
    with G of the empty bridge. The diagonal S_jj is the accelerance on a mode's own coordinate over that of
    the empty bridge; with one mode, S is H_occupied/H_empty between any two points. Below one the crowd
    helps, above one it amplifies, see `amplified_bands`. Absorbers of the bridge count as bodies of the crowd.

    Parameters
    ----------
    occupied : OccupiedBridge or OccupiedMeasurement
        What `couple` returns.
    name : str
        Name of the system.

    Returns
    -------
    Sensitivity or control.FrequencyResponseData
        A `control.StateSpace` from modal forces P[j] to the net modal forces net[j] [-]. Of a measured
        bridge, from forces to net forces at the measured points [-].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> x = (np.arange(15) + 0.5) * 50 / 15
    >>> left = sensitivity(couple(reference_bridge(frequency=2.0), Pedestrian(), x))
    >>> print(abs(left(2j * np.pi * np.array([1.9, 2.0]))).round(3))       # it amplifies, and it helps
    [1.351 0.297]
    """
    check.instance("name", name, str, "give a word")
    gain = loop_gain(occupied)
    return Sensitivity(gain, name) if isinstance(gain, LoopGain) else _measured(gain, name)


def _measured(gain: ct.FrequencyResponseData, name: str) -> ct.FrequencyResponseData:
    return ct.frd(_inverse(gain.frdata), gain.omega, inputs=gain.input_labels,
                  outputs=labels("net", gain.ninputs), name=name)


def _inverse(gain: Complex) -> Complex:
    """(I + L)⁻¹ at every frequency, shape (n, n, w)."""
    return np.asarray(np.moveaxis(np.linalg.inv(np.eye(len(gain)) + np.moveaxis(gain, -1, 0)), 0, -1))


def _closed(gain: LoopGain) -> tuple[Array, Array, Array, Array]:
    """The state equations of P − L net = net, solved for net."""
    D = np.linalg.inv(np.eye(gain.ninputs) + gain.D)
    B, C = gain.B @ D, -D @ gain.C
    return gain.A + gain.B @ C, B, C, D

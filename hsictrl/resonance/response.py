"""The frequency response on a grid in Hz."""

from __future__ import annotations

from typing import Any

import control as ct
import numpy as np

from hsictrl import _checks as check
from hsictrl.bridge import Footbridge, MeasuredBridge
from hsictrl.coupling import OccupiedBridge, OccupiedMeasurement, couple


def occupied(system: Any) -> OccupiedBridge | OccupiedMeasurement:
    """The system itself if it is occupied already, a bare bridge with nobody on it."""
    check.instance("system", system, (OccupiedBridge, OccupiedMeasurement, Footbridge, MeasuredBridge),
                   "make one with couple(bridge, people, positions)")
    return couple(system) if isinstance(system, Footbridge | MeasuredBridge) else system


def frf(
    system: OccupiedBridge | OccupiedMeasurement | Footbridge | MeasuredBridge, frequencies: Any,
) -> ct.FrequencyResponseData:
    """Accelerance over frequencies in Hz (eq. 14).

    Parameters
    ----------
    system : OccupiedBridge, OccupiedMeasurement, Footbridge or MeasuredBridge
        What `couple` returns, or a bridge with nobody on it.
    frequencies : array_like, shape (w,)
        Increasing frequencies above 0 [Hz].

    Returns
    -------
    control.FrequencyResponseData
        From forces to accelerations [m/s² per N].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> response = frf(reference_bridge(frequency=2.0, damping=0.005), [1.0, 2.0, 3.0])
    >>> print(abs(response.frdata[0, 0]).round(8))     # 1/(2 ξ m) = 0.004 at resonance (eq. 16)
    [1.333e-05 4.000e-03 7.199e-05]
    """
    hertz = check.numbers("frequencies", frequencies, above=0, ndim=1, remedy="give an increasing array of Hz")
    if not len(hertz) or np.any(np.diff(hertz) <= 0):
        raise ValueError(f"frequencies must increase, got {_short(hertz)}; give at least one, and sort them")
    system = occupied(system)
    if isinstance(system, OccupiedBridge):
        return ct.frequency_response(system, 2 * np.pi * hertz)
    return _interpolated(system, 2 * np.pi * hertz)


def _short(hertz: np.ndarray) -> str:
    fall = int(np.argmax(np.diff(hertz) <= 0)) if len(hertz) > 1 else 0
    return f"{hertz[fall + 1]:g} Hz after {hertz[fall]:g} Hz" if len(hertz) else "none"


def _interpolated(measured: OccupiedMeasurement, omega: np.ndarray) -> ct.FrequencyResponseData:
    """Read a measurement between its lines."""
    low, high = measured.omega[0], measured.omega[-1]
    if omega[0] < low * (1 - 1e-12) or omega[-1] > high * (1 + 1e-12):
        raise ValueError(f"frequencies must lie in the measured band [{low / (2 * np.pi):g}, {high / (2 * np.pi):g}] "
                         f"Hz, got {omega[0] / (2 * np.pi):g} to {omega[-1] / (2 * np.pi):g}; stay inside it")
    smooth = ct.frd(measured.frdata, measured.omega, smooth=True, inputs=measured.input_labels,
                    outputs=measured.output_labels, name=measured.name)
    return ct.frequency_response(smooth, omega)

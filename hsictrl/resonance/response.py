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
        Increasing frequencies above 0; of a measured bridge, lines of the measurement [Hz].

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
    return _measured(system, 2 * np.pi * hertz)


def _short(hertz: np.ndarray) -> str:
    fall = int(np.argmax(np.diff(hertz) <= 0)) if len(hertz) > 1 else 0
    return f"{hertz[fall + 1]:g} Hz after {hertz[fall]:g} Hz" if len(hertz) else "none"


def _measured(system: OccupiedMeasurement, omega: np.ndarray) -> ct.FrequencyResponseData:
    """Lines of a measurement; between them nothing is known but near a peak, see `effective`."""
    lines = np.argmin(np.abs(system.omega[:, None] - omega), axis=0)
    off = np.abs(system.omega[lines] / omega - 1) > 1e-9
    if np.any(off):
        first, nearest = (values[np.argmax(off)] / (2 * np.pi) for values in (omega, system.omega[lines]))
        raise ValueError(f"frequencies must be lines of the measurement, got {first:g} Hz, whose nearest line is "
                         f"{nearest:g} Hz; take them from system.omega / (2π), or ask effective() for a peak")
    return ct.frd(system.frdata[:, :, lines], omega, inputs=system.input_labels, outputs=system.output_labels,
                  name=system.name)

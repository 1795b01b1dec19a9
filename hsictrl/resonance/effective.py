"""Effective frequency and damping of the occupied bridge, by three definitions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from hsictrl import _checks as check
from hsictrl.bridge import Footbridge, MeasuredBridge
from hsictrl.coupling import OccupiedBridge, OccupiedMeasurement
from hsictrl.resonance.curves import Curve, MeasuredCurve, ModalCurve
from hsictrl.resonance.poles import dominant_pole
from hsictrl.resonance.response import occupied

METHODS = ("peak", "pole", "halfpower")
EQUAL = 1e-3            # peaks that differ by less are one as high as the other: rounding is not to choose
MIXED = 0.5             # the peak is lower by 1/(1 + mixing²), so that ξ_eff is a quarter too high
UNBOUNDED = 1e12        # below a damping ratio of 1e-12 rounding decides how high a peak is


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class EffectiveProperties:
    """Effective properties of one mode; unpacks into frequency and damping.

    Parameters
    ----------
    frequency : float
        Effective frequency f_eff [Hz].
    damping : float
        Effective damping ratio ξ_eff [-].
    peak : float
        Largest accelerance at the antinode of the mode [m/s² per N].
    method : str
        Definition by which frequency and damping were read: "peak", "pole" or "halfpower".
    competing : tuple of (float, float)
        Frequency and accelerance of every other local maximum, highest first. Where a mode shifts, two
        peaks compete, and f_eff jumps from one to the other [Hz, m/s² per N].
    mixing : float
        How much the mode that moves along the most does, over this one, both mass-normalised, at the peak. From about
        a half on the peak belongs to no mode of the bridge alone, and says little of this one [-].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> frequency, damping = effective(reference_bridge(frequency=2.0, damping=0.005))
    >>> round(frequency, 5), round(damping, 7)
    (2.00005, 0.0049999)
    """

    frequency: float
    damping: float
    peak: float
    method: str
    competing: tuple[tuple[float, float], ...] = ()
    mixing: float = 0.0

    def __iter__(self) -> Iterator[float]:
        return iter((self.frequency, self.damping))

    def __str__(self) -> str:
        text = f"{self.frequency:.4f} Hz, {100 * self.damping:.3f} % ({self.method}), |H| = {self.peak:.4g} m/s² per N"
        others = ", ".join(f"{f:.3f} Hz ({h / self.peak:.0%})" for f, h in self.competing)
        mixed = f"; another mode moves {self.mixing:.0%} as much" if self.mixing > MIXED else ""
        return (f"{text}; competing peaks at {others}" if others else text) + mixed

    def to_dict(self) -> dict[str, Any]:
        """Export with the units in the keys.

        Returns
        -------
        dict
            Plain numbers and strings, ready for JSON or a data frame.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> sorted(effective(reference_bridge(frequency=2.0)).to_dict())
        ['competing', 'damping', 'frequency_hz', 'method', 'mixing', 'peak_m_per_s2_per_n']
        """
        return {"frequency_hz": self.frequency, "damping": self.damping, "peak_m_per_s2_per_n": self.peak,
                "method": self.method, "competing": [list(pair) for pair in self.competing], "mixing": self.mixing}


def effective(
    system: OccupiedBridge | OccupiedMeasurement | Footbridge | MeasuredBridge, *, mode: int = 0,
    band: tuple[float, float] | None = None, method: str = "peak",
) -> EffectiveProperties:
    """Effective frequency and damping of a mode of the occupied bridge.

    The response is read on the mode's own coordinate, at its antinode. The three definitions agree
    only for a lightly damped mode on its own:

    * "peak": frequency of the largest ``|H|``, and ``ξ_eff = 1/(2 m_B max|H|)`` with the modal mass of the
      *empty* bridge (eq. 17); the paper's definition. Of peaks that are equal within 0.1 %, as an absorber
      makes them, it is the lowest frequency.
    * "pole": modulus and damping of the pole that contributes the most to the response.
    * "halfpower": the peak's frequency, and the width of the band above 1/√2 of the peak over twice
      that frequency.

    Parameters
    ----------
    system : OccupiedBridge, OccupiedMeasurement, Footbridge or MeasuredBridge
        What `couple` returns, or a bridge with nobody on it.
    mode : int
        Which mode of the bridge, from 0; a measured bridge has its first point instead [-].
    band : (float, float), optional
        Where to look for the peak; wherever one can be if not given [Hz].
    method : {"peak", "pole", "halfpower"}
        Definition, see above.

    Returns
    -------
    EffectiveProperties

    Raises
    ------
    ValueError
        If the band holds no peak, or the definition cannot be applied.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> x = (np.arange(15) + 0.5) * 50 / 15
    >>> print(effective(couple(reference_bridge(frequency=2.0), Pedestrian(), x)))
    1.9709 Hz, 0.758 % (peak), |H| = 0.002638 m/s² per N
    """
    check.choice("method", method, METHODS)
    curve = _curve(occupied(system), mode)
    limits = curve.band if band is None else _hertz_band(band, curve)
    try:
        tops = curve.peaks(limits)
    except np.linalg.LinAlgError:
        raise _unbounded(f"between {limits[0] / (2 * np.pi):.3g} and {limits[1] / (2 * np.pi):.3g} Hz") from None
    if not len(tops):
        raise ValueError(f"the band must hold a peak of |H|, got none between {limits[0] / (2 * np.pi):.3g} and "
                         f"{limits[1] / (2 * np.pi):.3g} Hz; widen it, or draw frf() to see where the peak is")
    return _described(curve, tops, method)


def _described(curve: Curve, tops: np.ndarray, method: str) -> EffectiveProperties:
    heights = curve.magnitude(tops)
    first = np.flatnonzero(heights >= (1 - EQUAL) * np.max(heights))[0]
    order = [first, *(i for i in np.argsort(-heights) if i != first)]
    if 2 * curve.modal_mass * heights[order[0]] > UNBOUNDED:
        raise _unbounded(f"at {tops[order[0]] / (2 * np.pi):.4g} Hz")
    omega, damping = _read(curve, float(tops[order[0]]), float(heights[order[0]]), method)
    others = tuple((float(tops[i] / (2 * np.pi)), float(heights[i])) for i in order[1:])
    return EffectiveProperties(frequency=omega / (2 * np.pi), damping=damping, peak=float(heights[order[0]]),
                               method=method, competing=others, mixing=curve.mixing(float(tops[order[0]])))


def _read(curve: Curve, top: float, height: float, method: str) -> tuple[float, float]:
    """Angular frequency [rad/s] and damping ratio [-] by the definition asked for."""
    if method == "peak":
        return top, 1 / (2 * curve.modal_mass * height)
    if method == "halfpower":
        low, high = curve.half_power(top)
        return top, (high - low) / (2 * top)
    if not isinstance(curve, ModalCurve):
        raise ValueError("method='pole' needs a bridge described by modes, got a measured one; "
                         "use 'peak' or 'halfpower'")
    pole = dominant_pole(curve.system, curve.index)
    return abs(pole), -pole.real / abs(pole)


def _curve(system: OccupiedBridge | OccupiedMeasurement, mode: int) -> Curve:
    if isinstance(system, OccupiedBridge):
        return ModalCurve(system, mode)
    if mode != 0:
        raise ValueError(f"mode must be 0 for a measured bridge, got {mode}; choose the peak with band=")
    return MeasuredCurve(system)


def _hertz_band(band: Any, curve: Curve) -> tuple[float, float]:
    low, high = check.band(band)
    omega = 2 * np.pi * low, 2 * np.pi * high
    if isinstance(curve, MeasuredCurve):
        omega = max(omega[0], curve.band[0]), min(omega[1], curve.band[1])
    if omega[0] >= omega[1]:
        raise ValueError(f"band must be (low, high) with low below high, got ({low:g}, {high:g}) Hz; "
                         "swap or widen it")
    return omega


def _unbounded(where: str) -> ValueError:
    return ValueError(f"effective properties need damping, got a peak of |H| without bound {where}; "
                      "give the bridge a damping ratio above 0")

"""A virtual measurement: what sensors on a bridge would record, of poles that are known."""

from __future__ import annotations

from typing import Any

import control as ct
import numpy as np
from scipy.fft import next_fast_len

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.coupling import MovingCrowd, OccupiedBridge
from hsictrl.stepper import simulate

DURATION = 600.0        # of a record under ambient forces [s]
FORCE = 100.0           # of ambient excitation [N]
TIME_CONSTANTS = 5.0    # 1/(ξω) of the slowest mode, after which a vibration is forgotten


def virtual_measurement(
    system: OccupiedBridge | MovingCrowd, *, rng: np.random.Generator, sense_at: Any = None,
    duration: float | None = None, sampling_frequency: float = 50.0, force: float | None = None, noise: float = 1e-3,
) -> ct.TimeResponseData:
    """Accelerations of a bridge with people as sensors would record them, noise included.

    People who stand leave the bridge to ambient forces: at each of the system's inputs a white one, up to half the
    sampling frequency, that has gone on for ever. People who walk drive it themselves (`simulate`).

    Parameters
    ----------
    system : OccupiedBridge or MovingCrowd
        Who stands or walks on which bridge: ``couple(...)`` or ``moving_crowd(...)``.
    rng : numpy.random.Generator
        Source of randomness of forces and noise.
    sense_at : array_like, shape (p,) or (p, 2), optional
        Where the sensors are; where an occupied bridge is read, or the antinode of the first mode of one that people
        walk over, if not given [m].
    duration : float, optional
        Length of the record; 600 s under ambient forces, the observed window of traffic, if not given [s].
    sampling_frequency : float
        Samples a second [Hz].
    force : float, optional
        Standard deviation of each ambient force; 100 N if not given. None for people who walk [N].
    noise : float
        Standard deviation of the sensors' own white noise [m/s²].

    Returns
    -------
    control.TimeResponseData
        Accelerations, one output per sensor [m/s², s].

    Raises
    ------
    ValueError
        If a mode without damping would never come to a steady state, or traffic ends before the record does.

    Notes
    -----
    The ambient response is exact: the spectrum of the forces times the condensed frequency response. Forces repeat
    after twice the record and the time in which the empty bridge forgets, so that its ends know nothing of each other.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> occupied = hsi.couple(hsi.reference_bridge(), hsi.Pedestrian(), np.linspace(0, 50, 15))
    >>> record = virtual_measurement(occupied, sense_at=[12.5, 25.0, 37.5], rng=np.random.default_rng(1))
    >>> record.outputs.shape, record.outputs.std(axis=1).round(4)
    ((3, 30000), array([0.0085, 0.012 , 0.0085]))
    """
    check.instance("rng", rng, np.random.Generator, "give numpy.random.default_rng(seed)")
    check.instance("system", system, (OccupiedBridge, MovingCrowd), "make it with couple, or with moving_crowd")
    rate = check.number("sampling_frequency", sampling_frequency, above=0, remedy="give samples a second")
    spread = check.number("noise", noise, least=0, remedy="give m/s², 0 for none")
    if isinstance(system, MovingCrowd):
        if force is not None:
            raise TypeError(f"force must go with people who stand, got {force!r} N with a moving crowd, which drives "
                            "the bridge itself; leave it out")
        time = _times(system, duration, rate)
        exact = np.atleast_2d(simulate(system, time, sense_at=sense_at).response.outputs)
    else:
        time = np.arange(_count(DURATION if duration is None else duration, rate)) / rate
        exact = _ambient(_sensed(system, sense_at), len(time), rate, FORCE if force is None else force, rng)
    record = exact + spread * rng.standard_normal(exact.shape)
    return ct.TimeResponseData(time, record, issiso=len(record) == 1, output_labels=labels("a", len(record)),
                               plot_inputs=False, title="measured acceleration")


def _ambient(occupied: OccupiedBridge, count: int, rate: float, force: float, rng: np.random.Generator) -> Array:
    """Less than half of a periodic steady state under white forces, shape (p, count) [m/s²]."""
    if np.any(occupied.bridge.damping == 0):
        raise ValueError("every mode must have damping for ambient forces to end in a steady state, got 0 %; give the "
                         "bridge a damping ratio above 0")
    size = check.number("force", force, above=0, remedy="give the standard deviation in N")
    memory = TIME_CONSTANTS / np.min(occupied.bridge.damping * occupied.bridge.omega)
    period = next_fast_len(2 * (count + int(memory * rate)), real=True)
    spectra = np.fft.rfft(size * rng.standard_normal((occupied.ninputs, period)))
    response = occupied.horner(2j * np.pi * np.fft.rfftfreq(period, 1 / rate))
    return np.fft.irfft(np.einsum("pfw,fw->pw", response, spectra), period)[:, :count]


def _sensed(occupied: OccupiedBridge, sense_at: Any) -> OccupiedBridge:
    """The same system, read elsewhere."""
    if sense_at is None:
        return occupied
    return OccupiedBridge(occupied.bridge, occupied.people, occupied.positions,     # `couple` would fix absorbers twice
                          force_at=occupied.force_at, sense_at=sense_at)


def _times(crowd: MovingCrowd, duration: float | None, rate: float) -> Array:
    """Samples from the start of the observed window on, for as long as drawn traffic arrives [s]."""
    start, end = crowd.traffic.observed(crowd.bridge)
    length = end - start if duration is None else duration
    time = start + np.arange(_count(length, rate)) / rate
    if crowd.traffic.drawn_from is not None and time[-1] > end:
        raise ValueError(f"duration must be at most the {end - start:.4g} s for which this traffic was drawn, got "
                         f"{length:.4g}; leave it out, or make the traffic by hand")
    return time


def _count(duration: float, rate: float) -> int:
    length = check.number("duration", duration, above=0, remedy="give s")
    count = round(length * rate)
    if count < 2:
        raise ValueError(f"duration must hold at least two samples, got {length:g} s at {rate:g} Hz; measure longer")
    return count

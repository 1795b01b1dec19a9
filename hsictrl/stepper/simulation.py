"""The response of a moving crowd, with an estimate of its error."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, final

import control as ct
import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.coupling import MovingCrowd, couple
from hsictrl.stepper.clock import Clock

LONGEST_STEP = 0.0125     # s; resolves how bodies of up to 4 Hz and the deck answer each other, to 1e-6 … 4e-5
MODE_MARGIN = 25.0        # default steps in a period of the highest mode, and
FEWEST = 10.0             # fewest in a period, and while a walker crosses
CROSSING_MARGIN = 100.0   # default steps while a walker crosses
TOLERANCE = 6e-5          # estimated error that the default step keeps: 1e-4, since an estimate may be two thirds
HALVINGS = 6
MOST_STEPS = 10_000_000   # in the window, and pairs of steps before it: a day of arrivals
# Two roads of order p differ by 2^p − 1 errors of the finer. This divisor keeps the estimate within 2/3 and 5 times
# the error for every order from 3.1 to 5.8.
SPREAD = 11.0


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Simulation:
    """How a bridge moves under a moving crowd. Made by `simulate`.

    Parameters
    ----------
    response : control.TimeResponseData
        Outputs a[i], accelerations at the points where they are read [m/s²]; states z[j] and dz[j] of the modes,
        mass-normalised [m √kg, m √kg/s].
    step : float
        Step that was used [s].
    error : float
        Estimated error of the accelerations, the largest over the window relative to their peak [-].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import moving_crowd
    >>> from hsictrl.crowd import Traffic, Walker
    >>> from hsictrl.walking import HarmonicForce
    >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> print(simulate(moving_crowd(reference_bridge(frequency=2.0), Traffic([walker]))))
    0.802 m/s², error 2e-06 at steps of 12.5 ms
    """

    response: ct.TimeResponseData
    step: float
    error: float

    def __str__(self) -> str:
        peak = float(np.max(np.abs(self.response.y)))
        return f"{peak:.3f} m/s², error {self.error:.0e} at steps of {1e3 * self.step:.3g} ms"


def simulate(
    crowd: MovingCrowd, timepts: Any = None, forces: Any = None, *, force_at: Any = None, sense_at: Any = None,
    initial_state: Any = None, step: float | None = None,
) -> Simulation:
    """Step the time-varying system of a moving crowd (eqs. 5 to 8).

    Parameters
    ----------
    crowd : MovingCrowd
        The system, `moving_crowd(bridge, traffic)`.
    timepts : array_like, shape (m,), optional
        Evenly spaced times at which the response is given; the observed window of the traffic, at the default step,
        if not given. Whoever arrives earlier, in traffic or before, finds a bridge at rest and sets it in motion [s].
    forces : array_like, shape (m,) or (p, m), optional
        Further vertical forces at `timepts`, linear in between [N].
    force_at, sense_at : array_like, shape (p,) or (p, 2), optional
        Where these forces act and where accelerations are read; the antinode of the first mode if not given [m].
    initial_state : float or array_like, shape (2 n_m,), optional
        z and dz of the modes at the first of `timepts`, where the simulation starts if they are given, with
        everybody's body at rest; 0 is a bridge at rest [m √kg, m √kg/s].
    step : float, optional
        Longest step; the default one is halved until the estimated error is at most 6e-5 [s].

    Returns
    -------
    Simulation

    Raises
    ------
    ValueError
        If the step is too long for a mode, for a walker or for what people do to the bridge, nobody has arrived when
        the window ends, or shapes do not match.

    Examples
    --------
    A bridge that somebody crosses, and the free decay of the bridge with somebody on it:

    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import moving_crowd
    >>> from hsictrl.crowd import Traffic, Walker
    >>> from hsictrl.walking import HarmonicForce
    >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> crowd = moving_crowd(reference_bridge(frequency=2.0), Traffic([walker]))
    >>> float(np.abs(simulate(crowd, step=0.01).response.outputs).max().round(4))
    0.8023
    >>> decay = simulate(crowd, np.linspace(10, 15, 501), initial_state=[1.0, 0.0])
    >>> decay.response.states.shape
    (2, 501)
    """
    check.instance("crowd", crowd, MovingCrowd, "make it with moving_crowd(bridge, traffic)")
    points = couple(crowd.bridge, force_at=force_at, sense_at=sense_at)
    longest = _default_step(crowd) if step is None else _checked_step(crowd, step)
    clock = _clock(crowd, timepts, longest, forces is not None, initial_state is not None)
    drive = _drive(crowd, forces, points.force_at, clock)
    initial = _initial(crowd, initial_state)
    if forces is None and initial_state is None:
        _refuse_silence(crowd, clock)
    sense = crowd.bridge.participation(points.sense_at)
    found = _run(crowd, clock, drive, initial, sense)
    for _ in range(HALVINGS if step is None else 0):
        if found.error <= TOLERANCE:
            break
        clock = replace(clock, substeps=2 * clock.substeps)
        found = _run(crowd, clock, drive, initial, sense)
    return _settled(found)


def _settled(found: Simulation) -> Simulation:
    """Refuse a response whose error is as large as itself."""
    if found.error >= 1:
        raise ValueError(f"the step must be short enough for what people do to the bridge, got {found.step:.3g} s and "
                         f"an estimated error of {found.error:.0%} of the peak; give a shorter step, or lighter people")
    return found


def _run(crowd: MovingCrowd, clock: Clock, drive: Array, initial: Array, sense: Array) -> Simulation:
    from hsictrl.stepper.march import march  # only now: it loads the compiler

    fine, coarse = march(crowd, clock, drive, initial)
    ours, rough = sense @ fine[:, 2].T, sense @ coarse[:, 2].T
    read = slice(None, clock.substeps * (len(clock.times) - 1) + 1, clock.substeps)
    states, n_m = fine[read, :2].reshape(len(clock.times), -1).T, crowd.bridge.n_modes
    response = ct.TimeResponseData(
        clock.times, ours[:, read], states, output_labels=labels("a", len(sense)), issiso=len(sense) == 1,
        state_labels=labels("z", n_m) + labels("dz", n_m), plot_inputs=False, sysname="moving",
        title="moving: acceleration")
    return Simulation(response=response, step=clock.step, error=_error(ours, rough))


def _error(fine: Array, coarse: Array) -> float:
    """Estimate from accelerations by steps of h and of 2h, relative to their peak; infinite where they overflow."""
    if not (np.all(np.isfinite(fine)) and np.all(np.isfinite(coarse))):
        return np.inf
    peak = float(np.max(np.abs(fine)))
    return float(np.max(np.abs(fine[:, ::2] - coarse))) / SPREAD / peak if peak else 0.0


def _default_step(crowd: MovingCrowd) -> float:
    """Step that resolves modes, bodies, and how long anybody stays; the error tells whether it suffices [s]."""
    return min(LONGEST_STEP, 1 / (MODE_MARGIN * _highest(crowd)), _quickest(crowd) / CROSSING_MARGIN)


def _checked_step(crowd: MovingCrowd, step: float) -> float:
    step = check.number("step", step, above=0, remedy="give s")
    longest = 1 / (FEWEST * _highest(crowd))
    if step > longest:
        raise ValueError(f"step must be at most a tenth of the period of the highest mode, {_highest(crowd):g} Hz, got "
                         f"{step:g} s; give at most {longest:.3g}, or leave that mode out")
    if step > _quickest(crowd) / FEWEST:
        raise ValueError(f"step must be at most a tenth of the time that any walker is on the deck, got {step:g} s and "
                         f"{_quickest(crowd):g} s; give at most {_quickest(crowd) / FEWEST:.3g}, or slow that walker")
    return step


def _highest(crowd: MovingCrowd) -> float:
    """Highest natural frequency of the bridge [Hz]."""
    return max(mode.frequency for mode in crowd.bridge.modes)


def _quickest(crowd: MovingCrowd) -> float:
    """Shortest time in which anybody walks the length of the deck [s]."""
    return float(crowd.bridge.length / np.max(crowd.traffic.walkers.top_speed(), initial=1e-300))


def _clock(crowd: MovingCrowd, timepts: Any, longest: float, forced: bool, starts_there: bool) -> Clock:
    """Steps in pairs through the times, early enough for all, and in step with forces that have kinks there."""
    if timepts is None:
        start, end = crowd.traffic.observed(crowd.bridge)
        if (end - start) / longest > MOST_STEPS:
            raise ValueError(f"the window must hold at most {MOST_STEPS:.0e} steps of {longest:.3g} s, got "
                             f"{end - start:.3g} s; give the traffic a window, or timepts")
        timepts = np.linspace(start, end, int(np.ceil((end - start) / longest - 1e-9)) + 1)
    times = check.even_times("timepts", timepts)
    given, pace = (times[-1] - times[0]) / (len(times) - 1), 2 if forced else 1
    first = times[0] if starts_there else np.min(crowd.traffic.walkers.arrival, initial=times[0])
    clock = Clock(times=times, start=float(first), substeps=pace * int(np.ceil(given / longest / pace - 1e-9)))
    if clock.pairs_before > MOST_STEPS:
        raise ValueError(f"traffic must begin at most {MOST_STEPS:.0e} double steps before timepts, got an arrival "
                         f"{times[0] - first:g} s before; leave the early ones out with since(), or give an "
                         "initial_state")
    return clock


def _drive(crowd: MovingCrowd, forces: Any, force_at: Array, clock: Clock) -> Array:
    """Modal forces of further forces at the times of the clock [N/√kg]."""
    if forces is None:
        return np.zeros((len(clock.times), crowd.bridge.n_modes))
    given = np.atleast_2d(check.numbers("forces", forces, remedy="give N"))
    if given.shape != (len(force_at), len(clock.times)):
        raise ValueError(f"forces must be given at every point and time, of shape {(len(force_at), len(clock.times))}, "
                         f"got {given.shape}; sample them at timepts, one row per point in force_at")
    return np.asarray(given.T @ crowd.bridge.participation(force_at))


def _initial(crowd: MovingCrowd, state: Any) -> Array:
    """Modal displacements and velocities, shape (2, n_m)."""
    n_m = crowd.bridge.n_modes
    if state is None:
        return np.zeros((2, n_m))
    state = check.numbers("initial_state", state, remedy="give z of all modes, then dz")
    if state.shape not in ((), (2 * n_m,)):
        raise ValueError(f"initial_state must hold z and dz of {n_m} mode(s), got shape {state.shape}; give "
                         f"{2 * n_m} numbers, or 0 for rest")
    return np.broadcast_to(state, (2 * n_m,)).reshape(2, n_m)


def _refuse_silence(crowd: MovingCrowd, clock: Clock) -> None:
    """Refuse walkers none of whom has stepped on when the window ends."""
    arrival = crowd.traffic.walkers.arrival
    if len(arrival) and np.min(arrival) >= clock.times[-1]:
        raise ValueError(f"somebody must arrive before the window ends at {clock.times[-1]:g} s, got a first arrival "
                         f"at {np.min(arrival):g} s; move the window, or give forces or an initial_state")

"""The five models (Table 1): recipes that differ in the system, or in whether forces and bodies move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.coupling import MovingCrowd, OccupiedBridge, couple, moving_crowd
from hsictrl.crowd import Traffic, Walkers, resonant_step_frequency, settling_time
from hsictrl.prediction.forces import Lines, modal_force
from hsictrl.prediction.grid import Grid, largest
from hsictrl.prediction.refusals import check_vertical
from hsictrl.prediction.spectral import accelerations
from hsictrl.prediction.steady import steady_accelerations
from hsictrl.resonance import EffectiveProperties, effective
from hsictrl.stepper import TOLERANCE, simulate

MODELS = ("SF", "MF", "MFAM", "PMC", "MC")
Resonances = list[EffectiveProperties | None]


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prediction:
    """What a model predicts for one sample of traffic.

    Parameters
    ----------
    model : str
        Name of the model.
    response : control.TimeResponseData
        Acceleration at the antinode of the first mode, or at `sense_at`, over the observed window; that of MC holds
        the states of the modes too, as `simulate` does [m/s², s].
    system : OccupiedBridge or MovingCrowd
        The system that responds: the empty bridge for SF and MF, the one that carries the crowd's mass for
        MFAM, the occupied one for PMC, the time-varying one for MC.
    remarks : tuple of str
        What a reader of the numbers should know.
    error : float, optional
        Estimated error of MC's accelerations, the largest over the window relative to their peak; the other models
        take no steps in time [-].
    step : float, optional
        Step that MC took [s].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.crowd import Walker
    >>> from hsictrl.walking import HarmonicForce
    >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> print(predict("MF", reference_bridge(frequency=2.0), Traffic([walker])))
    MF: 0.837 m/s²
    """

    model: str
    response: ct.TimeResponseData
    system: OccupiedBridge | MovingCrowd
    remarks: tuple[str, ...]
    error: float | None = None
    step: float | None = None

    def __str__(self) -> str:
        return f"{self.model}: {self.peak_acceleration:.3f} m/s²"

    @property
    def peak_acceleration(self) -> float:
        """Largest absolute acceleration, at the point where it is largest; read between the samples [m/s²]."""
        return max(largest(signal) for signal in self.response.y.reshape(-1, self.response.y.shape[-1]))


def predict(
    model: str, bridge: Footbridge, traffic: Traffic, *, timepts: Any = None, sense_at: Any = None,
    warm_up: float | None = None,
) -> Prediction:
    """Predict the acceleration under traffic; step frequencies stay as they are (see `tune`).

    Four models are time-invariant systems. Three of them stand under forces that move, and are solved in the
    frequency domain: the modal forces are sampled, and divided by the condensed dynamic stiffness. "MF" takes
    the empty bridge (eq. 12); "MFAM" the bridge loaded evenly with the mass of the standing crowd, its damping
    ratios and shapes kept (`Footbridge.with_crowd_mass`); "PMC" the bridge with that crowd on it (eq. 11).
    "SF" is the steady state of the empty bridge under walkers who step in place without intra-person
    variability (`Traffic.stopped_on`, `WalkingForce.periodic`). "MC" varies in time: bodies walk with their
    forces (eq. 5), and the system is stepped (`simulate`).

    Parameters
    ----------
    model : {"SF", "MF", "MFAM", "PMC", "MC"}
        Stationary force, moving force, moving force with added mass, pseudo-moving crowd, or moving crowd model.
    bridge : Footbridge
        The empty bridge.
    traffic : Traffic
        Who walks over it.
    timepts : array_like, shape (m,), optional
        Evenly spaced times at which the response is given; over the observed window, at least 40 per period
        of the highest mode (25 for "MC"), if not given. Forces are sampled at the given times at least, so that a
        finer step resolves better how walkers step on and off [s].
    sense_at : array_like, shape (p,) or (p, 2), optional
        Where accelerations are read; at the first mode's antinode if not given [m].
    warm_up : float, optional
        Time between a full deck and the window; max(T, 5/(ξω)) by the model's own damping if not given. The steady
        state of "SF" has none, and traffic made by hand is taken as it is [s].

    Returns
    -------
    Prediction

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.crowd import CrowdFlow
    >>> bridge = reference_bridge(frequency=2.0)
    >>> traffic = CrowdFlow(density=1.0).sample(bridge, rng=np.random.default_rng(1))
    >>> for model in MODELS:
    ...     print(predict(model, bridge, tune(model, bridge, traffic)))
    SF: 11.701 m/s²
    MF: 6.792 m/s²
    MFAM: 3.941 m/s²
    PMC: 1.625 m/s²
    MC: 1.614 m/s²
    """
    system = _system(model, bridge, traffic, sense_at)
    return _predicted(system, _resonances(system), traffic, timepts, warm_up)


def predict_tuned(model: str, bridge: Footbridge, traffic: Traffic) -> Prediction:
    """Tune traffic to a model's own resonance and predict, from one and the same resonance.

    Parameters
    ----------
    model : {"SF", "MF", "MFAM", "PMC", "MC"}
        As in `predict`.
    bridge : Footbridge
        The empty bridge.
    traffic : Traffic
        Who walks over it.

    Returns
    -------
    Prediction
        Of ``predict(model, bridge, tune(model, bridge, traffic))``.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.crowd import CrowdFlow
    >>> bridge = reference_bridge(frequency=2.0)
    >>> traffic = CrowdFlow(density=0.2).sample(bridge, rng=np.random.default_rng(1))
    >>> tuned = predict("PMC", bridge, tune("PMC", bridge, traffic))
    >>> predict_tuned("PMC", bridge, traffic).peak_acceleration == tuned.peak_acceleration
    True
    """
    system = _system(model, bridge, traffic, None)
    found = _resonances(system)
    resonant = (found[0] or effective(system)) if found else system.bridge.modes[0]
    return _predicted(system, found, _tuned(traffic, resonant.frequency), None, None)


def _predicted(
    system: OccupiedBridge, found: Resonances, traffic: Traffic, timepts: Any, warm_up: float | None,
) -> Prediction:
    """Response of a system whose resonances are known."""
    window = traffic.observed(system.bridge)
    times = None if timepts is None else _within(traffic, window, check.even_times("timepts", timepts))
    if warm_up is not None:
        check.number("warm_up", warm_up, least=0, remedy="give s")
    if system.name == "SF":
        return _steady(system, traffic, window, times)
    decay = _slowest_decay(system, found)
    traffic = _relevant(traffic, system.bridge, decay, warm_up)
    if system.name == "MC":
        return _stepped(system, traffic, times)
    return _moving(system, traffic, window, times, decay)


def _stepped(system: OccupiedBridge, traffic: Traffic, times: Array | None) -> Prediction:
    """Moving bodies and forces, step by step."""
    crowd = moving_crowd(system.bridge, traffic)
    found = simulate(crowd, times, sense_at=system.sense_at)
    coarse = () if found.error <= TOLERANCE else (f"the estimated error is {found.error:.1g} of the peak",)
    return Prediction(model="MC", system=crowd, remarks=traffic.remarks + coarse, error=found.error, step=found.step,
                      response=_response(system, found.response.time, found.response.y, found.response))


def _moving(
    system: OccupiedBridge, traffic: Traffic, window: tuple[float, float], times: Array | None, decay: float,
) -> Prediction:
    """Moving forces, in the frequency domain."""
    lines = traffic.walkers.lines()
    grid = _grid(window, times, traffic.walkers, system.bridge, lines)
    response = accelerations(system, modal_force(system.bridge, traffic.walkers, lines, grid), grid, decay)
    return _prediction(system, grid.times, response, traffic.remarks)


def _steady(
    system: OccupiedBridge, traffic: Traffic, window: tuple[float, float], times: Array | None,
) -> Prediction:
    """Periodic forces in place, line by line."""
    stopped, places = traffic.stopped_on(system.bridge)
    walkers, asked = stopped.periodic(), len(traffic.standing_on(system.bridge)[0])
    grid = _grid(window, times, walkers, system.bridge, walkers.lines())
    few = () if len(walkers) == asked else (
        f"only {len(walkers)} of {asked} standing places could be taken, since no more walkers arrive",)
    response = steady_accelerations(system, walkers, places, grid)
    return _prediction(system, grid.times, response, traffic.remarks + few)


def _prediction(system: OccupiedBridge, times: Array, response: Array, remarks: tuple[str, ...]) -> Prediction:
    return Prediction(model=system.name, system=system, remarks=remarks, response=_response(system, times, response))


def _response(
    system: OccupiedBridge, times: Array, response: Array, stepped: ct.TimeResponseData | None = None,
) -> ct.TimeResponseData:
    states, names = (None, None) if stepped is None else (stepped.x, stepped.state_labels)
    return ct.TimeResponseData(
        times, response, states, output_labels=system.output_labels, state_labels=names, issiso=len(response) == 1,
        plot_inputs=False, sysname=system.name, title=f"{system.name}: acceleration")


def tune(model: str, bridge: Footbridge, traffic: Traffic) -> Traffic:
    """Tune traffic to a model's own resonance, the load case of section 2.2.

    Parameters
    ----------
    model : {"SF", "MF", "MFAM", "PMC", "MC"}
        "SF" and "MF" meet the empty bridge's first mode (`Footbridge.led_by` puts another first), "MFAM" that of
        the bridge with the mass of this traffic's standing crowd, "PMC" and "MC" the effective frequency of the
        bridge with that crowd. A bridge with absorbers has its effective frequency in all of them.
    bridge : Footbridge
        The empty bridge.
    traffic : Traffic
        Who walks over it.

    Returns
    -------
    Traffic
        The same walkers, stepping about f_l = f/h, with the smallest harmonic h for which f_l is at
        most 2.5 Hz.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.crowd import CrowdFlow
    >>> bridge = reference_bridge(frequency=2.0)
    >>> traffic = CrowdFlow(density=1.0).sample(bridge, rng=np.random.default_rng(1))
    >>> [round(tune(model, bridge, traffic).target, 3) for model in MODELS]
    [2.0, 2.0, 1.818, 1.754, 1.754]
    """
    system = _system(model, bridge, traffic, None)
    resonant = effective(system) if len(system.people) else system.bridge.modes[0]
    return _tuned(traffic, resonant.frequency)


def _tuned(traffic: Traffic, frequency: float) -> Traffic:
    return traffic.tuned(resonant_step_frequency(frequency)[0])


def _system(model: str, bridge: Footbridge, traffic: Traffic, sense_at: Any) -> OccupiedBridge:
    """The system that responds."""
    check.choice("model", model, MODELS)
    check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
    check.instance("traffic", traffic, Traffic, "draw it with CrowdFlow.sample, or make it with Traffic([walker])")
    check_vertical(bridge)
    deck, people, places = _carrier(model, bridge, traffic)
    return couple(deck, people, places, sense_at=sense_at, name=model)


def _carrier(model: str, bridge: Footbridge, traffic: Traffic) -> tuple[Footbridge, Any, Any]:
    """Bridge, bodies and their places: where the models differ in human-structure interaction (Table 1)."""
    if model in ("SF", "MF"):
        return bridge, (), ()
    people, places = traffic.standing_on(bridge)
    bridge.on_deck("standing", places)
    return (bridge.with_crowd_mass(float(people.mass.sum())), (), ()) if model == "MFAM" else (bridge, people, places)


def _within(traffic: Traffic, window: tuple[float, float], times: Array) -> Array:
    """Refuse times at which drawn traffic has not filled the deck, or has no more arrivals."""
    if traffic.drawn_from is not None and (times[0] < window[0] - 1e-9 or times[-1] > window[1] + 1e-9):
        raise ValueError(f"timepts must lie in the window of the traffic, {window[0]:g} to {window[1]:g} s, got "
                         f"{times[0]:g} to {times[-1]:g} s; stay inside it, or make the traffic by hand")
    return times


def _relevant(traffic: Traffic, bridge: Footbridge, decay: float, warm_up: float | None) -> Traffic:
    """Walkers who arrive from one crossing and the warm-up before the window on; all of those made by hand."""
    if warm_up is None:
        return traffic.since(first_arrival(traffic, bridge, decay))
    if traffic.drawn_from is None or not len(traffic.walkers):
        return traffic
    full = _full_deck(traffic, bridge)
    drawn = full - traffic.drawn_from
    if warm_up > drawn * (1 + 1e-9):
        raise ValueError(f"warm_up must be at most the {drawn:g} s for which this traffic was drawn, got {warm_up:g}; "
                         "leave it out, or make the traffic by hand")
    return traffic.since(full - warm_up)


def first_arrival(traffic: Traffic, bridge: Footbridge, decay: float) -> float:
    """When the first of those arrives whom a vibration remembers: one crossing and the warm-up before the window.

    Parameters
    ----------
    traffic : Traffic
        Who walks; nobody is left out if it was made by hand.
    bridge : Footbridge
        The bridge.
    decay : float
        Decay rate ξω of the slowest vibration [1/s].

    Returns
    -------
    float
        [s]
    """
    if traffic.drawn_from is None or not len(traffic.walkers):
        return float(np.min(traffic.walkers.arrival, initial=traffic.observed(bridge)[0]))
    return _full_deck(traffic, bridge) - settling_time(_crossing(traffic, bridge), decay)


def _full_deck(traffic: Traffic, bridge: Footbridge) -> float:
    """One crossing before the window: who steps on then is the last to have left when it begins [s]."""
    return traffic.observed(bridge)[0] - _crossing(traffic, bridge)


def _crossing(traffic: Traffic, bridge: Footbridge) -> float:
    return float(np.max(traffic.walkers.stay(bridge.length)))


def _resonances(system: OccupiedBridge) -> Resonances:
    """Effective properties of every mode where a body is, if it has a peak; a bare bridge has its own."""
    return [_resonance(system, j) for j in range(system.bridge.n_modes if len(system.people) else 0)]


def _resonance(system: OccupiedBridge, mode: int) -> EffectiveProperties | None:
    try:
        return effective(system, mode=mode)
    except ValueError:    # so much damping, or so little, that there is no peak to read
        return None


def _slowest_decay(system: OccupiedBridge, found: Resonances) -> float:
    """Smallest ξω of the modes, effective ones where somebody stands, and of the bodies [1/s]."""
    bridge = system.bridge
    if not found:
        return float(np.min(bridge.damping * bridge.omega))
    read = [(mode if one is None else one) for mode, one in zip(bridge.modes, found, strict=True)]
    decays = [2 * np.pi * one.frequency * one.damping for one in read]
    if bridge.absorbers:    # of two peaks, the higher one tells of half the motion only: the poles know
        decays.append(max(0.0, -float(couple(bridge).poles().real.max())))
    people = system.people.part(slice(len(bridge.absorbers), None))
    return float(np.min(people.damping * people.omega, initial=min(decays)))


def _grid(
    window: tuple[float, float], times: Array | None, walkers: Walkers, bridge: Footbridge, lines: Lines,
) -> Grid:
    highest = (max((force.highest_frequency for _, force in lines), default=0.0),
               max(mode.frequency for mode in bridge.modes))
    start = float(np.min(walkers.arrival, initial=window[0]))
    return Grid.over(window, start, *highest) if times is None else Grid.at(times, start, *highest)

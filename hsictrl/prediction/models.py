"""The time-invariant models of section 2.4: moving forces, without and with a standing crowd."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.coupling import OccupiedBridge, couple
from hsictrl.crowd import Traffic, resonant_step_frequency
from hsictrl.crowd.flow import settling_time
from hsictrl.prediction.forces import Lines, modal_force
from hsictrl.prediction.grid import Grid, evenly_spaced
from hsictrl.prediction.spectral import accelerations
from hsictrl.resonance import EffectiveProperties, effective

MODELS = ("MF", "PMC")
Resonances = list[EffectiveProperties]


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Prediction:
    """What a model predicts for one sample of traffic.

    Parameters
    ----------
    model : str
        Name of the model.
    response : control.TimeResponseData
        Acceleration at the antinode of the first mode, or at `sense_at`, over the observed window [m/s², s].
    system : OccupiedBridge
        The time-invariant system that responds: the empty bridge for MF, the occupied one for PMC.
    remarks : tuple of str
        What a reader of the numbers should know.

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
    system: OccupiedBridge
    remarks: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.model}: {self.peak_acceleration:.3f} m/s²"

    @property
    def peak_acceleration(self) -> float:
        """Largest absolute acceleration, at the point where it is largest; read between the samples [m/s²]."""
        return max(_peak(signal) for signal in self.response.y.reshape(-1, self.response.y.shape[-1]))


def predict(
    model: str, bridge: Footbridge, traffic: Traffic, *, timepts: Any = None, sense_at: Any = None,
    warm_up: float | None = None,
) -> Prediction:
    """Predict the acceleration under traffic; step frequencies stay as they are (see `tune`).

    Both models are time-invariant systems under forces that move. They are solved in the frequency
    domain: the modal forces are sampled, and divided by the condensed dynamic stiffness. "MF" takes
    the empty bridge (eq. 12), "PMC" the bridge with the crowd that stands for the moving one (eq. 11).

    Parameters
    ----------
    model : {"MF", "PMC"}
        Moving force model, or pseudo-moving crowd model.
    bridge : Footbridge
        The empty bridge.
    traffic : Traffic
        Who walks over it.
    timepts : array_like, shape (m,), optional
        Evenly spaced times at which the response is given; over the observed window, at least 40 per period
        of the highest mode, if not given. Forces are sampled at the given times at least, so that a finer step
        resolves better how walkers step on and off [s].
    sense_at : array_like, shape (p,) or (p, 2), optional
        Where accelerations are read; at the first mode's antinode if not given [m].
    warm_up : float, optional
        Time between a full deck and the window; max(T, 5/(ξω)) by the model's own damping if not given [s].

    Returns
    -------
    Prediction

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.crowd import CrowdFlow
    >>> bridge = reference_bridge(frequency=2.0)
    >>> traffic = CrowdFlow(density=1.0).sample(bridge, rng=np.random.default_rng(1))
    >>> without, within = predict("MF", bridge, traffic), predict("PMC", bridge, tune("PMC", bridge, traffic))
    >>> within.peak_acceleration < without.peak_acceleration
    True
    """
    system = _system(model, bridge, traffic, sense_at)
    return _predicted(system, _resonances(system), traffic, timepts, warm_up)


def predict_tuned(model: str, bridge: Footbridge, traffic: Traffic) -> Prediction:
    """Tune traffic to a model's own resonance and predict, from one and the same resonance.

    Parameters
    ----------
    model : {"MF", "PMC"}
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
    return _predicted(system, found, _tuned(traffic, bridge, found), None, None)


def _predicted(
    system: OccupiedBridge, found: Resonances, traffic: Traffic, timepts: Any, warm_up: float | None,
) -> Prediction:
    """Response of a system whose resonances are known."""
    bridge, window = system.bridge, traffic.observed(system.bridge)
    if warm_up is not None:
        check.number("warm_up", warm_up, least=0, remedy="give s")
    decay = _slowest_decay(system, found)
    traffic = _relevant(traffic, bridge, decay, window, warm_up)
    lines = traffic.walkers.lines()
    grid = _grid(window, None if timepts is None else evenly_spaced(timepts), traffic, bridge, lines)
    response = accelerations(system, modal_force(bridge, traffic.walkers, lines, grid), grid, decay)
    return Prediction(model=system.name, system=system, remarks=traffic.remarks, response=ct.TimeResponseData(
        grid.times, response, output_labels=system.output_labels, issiso=len(response) == 1,
        plot_inputs=False, sysname=system.name, title=f"{system.name}: acceleration"))


def tune(model: str, bridge: Footbridge, traffic: Traffic) -> Traffic:
    """Tune traffic to a model's own resonance, the load case of section 2.2.

    Parameters
    ----------
    model : {"MF", "PMC"}
        "MF" meets the empty bridge's first mode, "PMC" the effective frequency of the bridge with the
        standing crowd of this traffic.
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
    >>> round(tune("MF", bridge, traffic).target, 3), round(tune("PMC", bridge, traffic).target, 3)
    (2.0, 1.754)
    """
    system = _system(model, bridge, traffic, None)
    return _tuned(traffic, bridge, [effective(system)] if len(system.people) else [])


def _tuned(traffic: Traffic, bridge: Footbridge, found: Resonances) -> Traffic:
    frequency = found[0].frequency if found else bridge.modes[0].frequency
    return traffic.tuned(resonant_step_frequency(frequency)[0])


def _system(model: str, bridge: Footbridge, traffic: Traffic, sense_at: Any) -> OccupiedBridge:
    """The system that responds."""
    check.choice("model", model, MODELS)
    check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
    check.instance("traffic", traffic, Traffic, "draw it with CrowdFlow.sample, or make it with Traffic([walker])")
    people, places = traffic.standing_on(bridge) if model == "PMC" else ((), ())
    return couple(bridge, people, places, sense_at=sense_at, name=model)


def _relevant(
    traffic: Traffic, bridge: Footbridge, decay: float, window: tuple[float, float], warm_up: float | None,
) -> Traffic:
    """Walkers who arrive from one crossing and the warm-up before the window on; all of those made by hand."""
    if traffic.window is None or not len(traffic.walkers):
        return traffic
    crossing = bridge.length / float(traffic.walkers.speed.min())
    if warm_up is None:
        warm_up = settling_time(crossing, decay)
    return traffic.since(window[0] - crossing - warm_up)


def _resonances(system: OccupiedBridge) -> Resonances:
    """Effective properties of every mode where somebody stands; an empty bridge has its own."""
    return [effective(system, mode=j) for j in range(system.bridge.n_modes if len(system.people) else 0)]


def _slowest_decay(system: OccupiedBridge, found: Resonances) -> float:
    """Smallest ξω of the modes, effective ones where somebody stands, and of the bodies [1/s]."""
    if not found:
        return float(np.min(system.bridge.damping * system.bridge.omega))
    bodies = np.min(system.people.damping * system.people.omega)
    return float(min(bodies, *(2 * np.pi * one.frequency * one.damping for one in found)))


def _grid(
    window: tuple[float, float], times: Array | None, traffic: Traffic, bridge: Footbridge, lines: Lines,
) -> Grid:
    highest = (max((force.highest_frequency for _, force in lines), default=0.0),
               max(mode.frequency for mode in bridge.modes))
    start = float(np.min(traffic.walkers.arrival, initial=window[0]))
    return Grid.over(window, start, *highest) if times is None else Grid.at(times, start, *highest)


def _peak(signal: Array) -> float:
    """Largest absolute value of a sampled signal, at the vertex of the parabola about its largest sample."""
    i = int(np.argmax(np.abs(signal)))
    if i in (0, len(signal) - 1):    # the parabola would tell of times that were not asked for
        return float(abs(signal[i]))
    left, top, right = signal[i - 1:i + 2] * np.sign(signal[i])
    bend = left - 2 * top + right
    return float(top - (left - right)**2 / (8 * bend) if bend < 0 else top)

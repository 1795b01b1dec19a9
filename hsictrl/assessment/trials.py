"""One trial of a study of a bridge and a flow: a peak acceleration, or effective properties."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass, field
from typing import final

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.coupling import couple
from hsictrl.crowd import CrowdFlow
from hsictrl.prediction import MODELS, Prediction, check_alike, predict, predict_tuned, tuned_peaks
from hsictrl.prediction.refusals import check_case
from hsictrl.prediction.shared import SHARED_MODELS
from hsictrl.resonance import effective
from hsictrl.walking import WalkingForce, ZivanovicForce


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class PeakTrial:
    """A trial: traffic tuned to a model's own resonance, and the peak acceleration it causes (sections 2.2 and 4.3).

    Parameters
    ----------
    model : str
        "SF", "MF", "MFAM", "PMC" or "MC".
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        The stream of people.
    force : WalkingForce
        Their walking force.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> trial = PeakTrial(model="PMC", bridge=reference_bridge(), flow=CrowdFlow(density=0.2))
    >>> bool(trial(np.random.default_rng(1)) > 0)     # m/s²
    True
    """

    model: str
    bridge: Footbridge
    flow: CrowdFlow
    force: WalkingForce = field(default_factory=ZivanovicForce)

    def __post_init__(self) -> None:
        check.choice("model", self.model, MODELS)
        check_case(self.bridge, self.flow)
        check.instance("force", self.force, WalkingForce, "use HarmonicForce, YoungForce or ZivanovicForce")

    def __call__(self, rng: np.random.Generator) -> float:
        return self.prediction(rng).peak_acceleration

    def prediction(self, rng: np.random.Generator) -> Prediction:
        """The response behind the peak.

        Parameters
        ----------
        rng : numpy.random.Generator
            Source of randomness; ``trial_rng(seed, i)`` for trial i of a study.

        Returns
        -------
        Prediction

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> trial = PeakTrial(model="PMC", bridge=reference_bridge(), flow=CrowdFlow(density=0.2))
        >>> trial.prediction(np.random.default_rng(1)).model
        'PMC'
        """
        traffic = self.flow.sample(self.bridge, rng=rng, force=self.force)
        forecast = predict_tuned if self.flow.step_frequency is None else predict
        return forecast(self.model, self.bridge, traffic)


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class PeaksTrial:
    """A trial: one sample of traffic, and the peak accelerations that models predict for it on several bridges.

    Each bridge and model has the traffic tuned to its own resonance, as in `PeakTrial`; what they share is worked out
    once (`tuned_peaks`).

    Parameters
    ----------
    models : sequence of str
        "SF", "MF" or "PMC".
    bridges : sequence of Footbridge
        Empty bridges of one mode, which may differ in its frequency, damping and modal mass.
    flow : CrowdFlow
        The stream of people, without a step frequency of its own.
    force : WalkingForce
        Their walking force.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> trial = PeaksTrial(models=("MF", "PMC"), flow=CrowdFlow(density=0.2),
    ...                    bridges=[reference_bridge(damping=damping) for damping in (0.002, 0.005, 0.02)])
    >>> trial(np.random.default_rng(1)).shape        # MF on all bridges, then PMC [m/s²]
    (6,)
    """

    models: Sequence[str]
    bridges: Sequence[Footbridge]
    flow: CrowdFlow
    force: WalkingForce = field(default_factory=ZivanovicForce)

    def __post_init__(self) -> None:
        check.store(self, models=check.several("models", self.models), bridges=check.several("bridges", self.bridges))
        for model in self.models:
            check.choice("models", model, SHARED_MODELS)
        for bridge in self.bridges:
            check_case(bridge, self.flow)
        check_alike(self.bridges)
        if self.flow.step_frequency is not None:
            raise ValueError("flow must leave step frequencies to the resonance of each bridge, got step_frequency="
                             f"{self.flow.step_frequency}; leave it out, or use PeakTrial")
        check.instance("force", self.force, WalkingForce, "use HarmonicForce, YoungForce or ZivanovicForce")

    def __call__(self, rng: np.random.Generator) -> Array:
        slowest = min(self.bridges, key=lambda bridge: bridge.damping[0] * bridge.omega[0])
        traffic = self.flow.sample(slowest, rng=rng, force=self.force)
        return tuned_peaks(self.models, self.bridges, traffic).ravel()


@final
@dataclass(frozen=True, slots=True)
class JointTrial:
    """A trial: several trials under the same random numbers, so that all of one flow meet the same people.

    Parameters
    ----------
    trials : sequence of PeakTrial or PeaksTrial
        Whose peaks follow each other.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> alone = PeakTrial(model="MFAM", bridge=reference_bridge(), flow=CrowdFlow(density=0.2))
    >>> joint = JointTrial([PeakTrial(model="MF", bridge=alone.bridge, flow=alone.flow), alone])
    >>> bool(joint(np.random.default_rng(1))[1] == alone(np.random.default_rng(1)))     # m/s²
    True
    """

    trials: Sequence[PeakTrial | PeaksTrial]

    def __post_init__(self) -> None:
        check.store(self, trials=check.several("trials", self.trials))
        for trial in self.trials:
            check.instance("trials", trial, (PeakTrial, PeaksTrial), "give a list of these")

    def __call__(self, rng: np.random.Generator) -> Array:
        return np.concatenate([np.atleast_1d(trial(deepcopy(rng))) for trial in self.trials])


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class EffectiveTrial:
    """A trial: a standing crowd, and the effective frequency [Hz] and damping [-] of the bridge (section 3.1).

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        Says how many people there are and who.
    mode : int
        Which mode of the bridge, from 0 [-].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> EffectiveTrial(bridge=reference_bridge(), flow=CrowdFlow(persons=15))(np.random.default_rng(1)).shape
    (2,)
    """

    bridge: Footbridge
    flow: CrowdFlow
    mode: int = 0

    def __post_init__(self) -> None:
        check_case(self.bridge, self.flow)
        self.bridge.mode(self.mode)

    def __call__(self, rng: np.random.Generator) -> Array:
        people, places = self.flow.crowd(self.bridge, rng)
        return np.array([*effective(couple(self.bridge, people, places), mode=self.mode)])

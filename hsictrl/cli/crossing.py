"""One trial of the moving crowd model, and the numbers that say how it went."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np

from hsictrl import assessment
from hsictrl.cli.description import Description
from hsictrl.comfort import comfort_class
from hsictrl.coupling import MovingCrowd, couple
from hsictrl.prediction import Prediction
from hsictrl.records import running_rms
from hsictrl.resonance import EffectiveProperties, effective
from hsictrl.study import trial_rng


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Crossing:
    """How one crowd crosses.

    Parameters
    ----------
    case : Description
        What was asked for, with one flow.
    trial : int
        Which trial of a study with the seed of the case [-].
    prediction : Prediction
        What MC predicts.
    standing : EffectiveProperties
        Of the bridge with the crowd that stands for the moving one.

    Examples
    --------
    >>> Crossing.of(Description().at_densities([0.2]), 0).row()["class_mc"]
    'CL3'
    """

    case: Description
    trial: int
    prediction: Prediction
    standing: EffectiveProperties

    @classmethod
    def of(cls, case: Description, trial: int) -> Crossing:
        """Run a trial of the only flow.

        Raises
        ------
        RuntimeError
            If the trial fails, as a study would.
        """
        peak = assessment.PeakTrial(model="MC", bridge=case.bridge, flow=case.flows[0], force=case.force)
        try:
            prediction = peak.prediction(trial_rng(case.seed, trial))
            standing = effective(couple(case.bridge, *prediction.system.traffic.standing_on(case.bridge)))
        except ValueError as error:
            raise RuntimeError(f"trial {trial} of seed {case.seed} failed: {error}; change the flow, or take another "
                               "trial") from error
        return cls(case=case, trial=trial, prediction=prediction, standing=standing)

    @property
    def crowd(self) -> MovingCrowd:
        """Who crosses what, as far as it matters to the window."""
        crowd = self.prediction.system
        assert isinstance(crowd, MovingCrowd)
        return crowd

    @property
    def title(self) -> str:
        """What the pictures show."""
        bridge = str(self.case.bridge).splitlines()[0]
        return f"{self.case.flows[0]} on {bridge}; MC, trial {self.trial} of seed {self.case.seed}"

    def row(self) -> dict[str, Any]:
        """The numbers with the units in the keys."""
        flow, bridge, found = self.case.flows[0], self.case.bridge, self.prediction
        times, traffic = found.response.time, self.crowd.traffic
        return {
            "density_per_m2": flow.density_on(bridge), "persons": flow.persons_on(bridge),
            "persons_on_deck_mean": float(np.mean(traffic.persons_on(bridge, times))),
            "crossing_s": bridge.length / flow.speed_on(bridge), "step_frequency_hz": traffic.target,
            "f_eff_hz": self.standing.frequency, "xi_eff": self.standing.damping,
            "a_mc_m_per_s2": found.peak_acceleration,
            "peak_at_s": float(times[np.argmax(np.abs(np.ravel(found.response.outputs)))]),
            "rms_m_per_s2": _largest_rms(found.response), "class_mc": comfort_class(found.peak_acceleration),
            "error": found.error, "step_s": found.step, "remarks": "; ".join(found.remarks)}


def _largest_rms(response: ct.TimeResponseData) -> float:
    """Largest RMS of a whole second; before that a running RMS is of a part of an oscillation [m/s²]."""
    age = response.time - response.time[0]
    return float(np.max(np.ravel(running_rms(response))[age >= min(1.0, age[-1])]))

"""What an assessment found, and how it is handed on."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from hsictrl.assessment.guides import GuideCase
from hsictrl.assessment.trials import PeakTrial
from hsictrl.bridge import Footbridge
from hsictrl.comfort import DesignResponse, comfort_class, comfort_verdict
from hsictrl.crowd import CrowdFlow
from hsictrl.prediction import Prediction
from hsictrl.study import Ensemble, trial_rng
from hsictrl.walking import WalkingForce, ZivanovicForce


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Assessment:
    """What an assessment found for one flow of people.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        The stream of people.
    effective : Ensemble
        Effective frequency [Hz] and damping ratio [-] of the occupied bridge: means.
    mf, pmc : Ensemble
        Peak acceleration without (MF) and with (PMC) human-structure interaction: a percentile [m/s²].
    guide : DesignResponse
        Design acceleration of HiVoSS for the same mode and density [m/s²].
    force : WalkingForce
        Walking force.
    mode : int
        The mode in resonance, from 0 [-].
    goal : {"CL1", "CL2", "CL3"}, optional
        The worst comfort class that will do.
    guides : tuple of GuideCase
        Load cases of all guides on every critical mode.
    remarks : tuple of str
        What a reader of the numbers should know.

    Examples
    --------
    >>> from hsictrl.assessment import assess
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.study import PercentileRule
    >>> found = assess(reference_bridge(), CrowdFlow(persons=15), rule=PercentileRule(tolerance=0.5))
    >>> found.reduction > 1
    True
    """

    bridge: Footbridge
    flow: CrowdFlow
    effective: Ensemble
    mf: Ensemble
    pmc: Ensemble
    guide: DesignResponse
    force: WalkingForce = field(default_factory=ZivanovicForce)
    mode: int = 0
    goal: str | None = None
    guides: tuple[GuideCase, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def reduction(self) -> float:
        """Reduction factor R_HSI (eq. 18) [-]."""
        return float(self.mf.estimate / self.pmc.estimate)

    @property
    def reduction_interval(self) -> tuple[float, float]:
        """Interval of R_HSI from the ends of both intervals; it covers at least as much as both do together [-]."""
        (low, high), (least, most) = self.mf.interval, self.pmc.interval
        return float(low / most), float(high / least)

    @property
    def classes(self) -> tuple[str, str]:
        """Comfort class without and with interaction."""
        return comfort_class(float(self.mf.estimate)), comfort_class(float(self.pmc.estimate))

    @property
    def verdicts(self) -> tuple[str, str] | None:
        """Whether the goal is met without and with interaction: "met", "not met" or "undecided", by the intervals."""
        if self.goal is None:
            return None
        return comfort_verdict(self.mf.interval, self.goal), comfort_verdict(self.pmc.interval, self.goal)

    def prediction(self, model: str, trial: int = 0) -> Prediction:
        """The response behind the peak of one trial.

        Parameters
        ----------
        model : {"MF", "PMC"}
            Without or with human-structure interaction.
        trial : int
            Which trial of the study, from 0 [-].

        Returns
        -------
        Prediction

        Examples
        --------
        >>> from hsictrl.assessment import assess
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.study import PercentileRule
        >>> found = assess(reference_bridge(), CrowdFlow(persons=15), rule=PercentileRule(tolerance=0.5))
        >>> found.prediction("PMC", trial=7).peak_acceleration == found.pmc.samples[7]
        np.True_
        """
        again = PeakTrial(model=model, bridge=self.bridge.led_by(self.mode), flow=self.flow, force=self.force)
        return again.prediction(trial_rng(self.pmc.seed, trial))

    def to_dict(self) -> dict[str, Any]:
        """Export with the units in the keys.

        Returns
        -------
        dict
            Plain numbers and strings, ready for JSON, a CSV row or a data frame.

        Examples
        --------
        >>> from hsictrl.assessment import assess
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.study import PercentileRule
        >>> found = assess(reference_bridge(), CrowdFlow(persons=15), rule=PercentileRule(tolerance=0.5))
        >>> found.to_dict()["persons"]
        15
        """
        found, (low, high) = np.ravel(self.effective.estimate), map(np.ravel, self.effective.interval)
        mf, pmc = self.verdicts or (None, None)
        return {
            "density_per_m2": self.flow.density_on(self.bridge), "persons": self.flow.persons_on(self.bridge),
            **_quantity("f_eff", "_hz", found[0], (low[0], high[0])),
            **_quantity("xi_eff", "", found[1], (low[1], high[1])), "effective_trials": self.effective.n_trials,
            **_peak("a_mf", self.mf), **_peak("a_pmc", self.pmc),
            **_quantity("r_hsi", "", self.reduction, self.reduction_interval),
            "class_mf": self.classes[0], "class_pmc": self.classes[1],
            "hivoss_m_per_s2": self.guide.acceleration, "mode": self.mode, "traffic_class": self.flow.traffic_class,
            "goal": self.goal, "verdict_mf": mf, "verdict_pmc": pmc, "remarks": "; ".join(self.remarks)}


def _quantity(name: str, unit: str, estimate: Any, interval: Any) -> dict[str, float]:
    """An estimate and the ends of its interval, the unit last in each key."""
    parts = {"": estimate, "_low": interval[0], "_high": interval[1]}
    return {f"{name}{part}{unit}": float(value) for part, value in parts.items()}


def _peak(name: str, ensemble: Ensemble) -> dict[str, Any]:
    return {**_quantity(name, "_m_per_s2", ensemble.estimate, ensemble.interval),
            f"{name}_trials": ensemble.n_trials, f"{name}_converged": ensemble.converged}

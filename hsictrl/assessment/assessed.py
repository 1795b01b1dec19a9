"""What an assessment found, and how it is handed on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from hsictrl.bridge import Footbridge
from hsictrl.comfort import DesignResponse, comfort_class
from hsictrl.crowd import CrowdFlow
from hsictrl.study import Ensemble


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
        Design acceleration of HiVoSS for the same density [m/s²].
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
        return {
            "density_per_m2": self.flow.density_on(self.bridge), "persons": self.flow.persons_on(self.bridge),
            **_quantity("f_eff", "_hz", found[0], (low[0], high[0])),
            **_quantity("xi_eff", "", found[1], (low[1], high[1])), "effective_trials": self.effective.n_trials,
            **_peak("a_mf", self.mf), **_peak("a_pmc", self.pmc),
            **_quantity("r_hsi", "", self.reduction, self.reduction_interval),
            "class_mf": self.classes[0], "class_pmc": self.classes[1],
            "hivoss_m_per_s2": self.guide.acceleration, "remarks": "; ".join(self.remarks)}


def _quantity(name: str, unit: str, estimate: Any, interval: Any) -> dict[str, float]:
    """An estimate and the ends of its interval, the unit last in each key."""
    parts = {"": estimate, "_low": interval[0], "_high": interval[1]}
    return {f"{name}{part}{unit}": float(value) for part, value in parts.items()}


def _peak(name: str, ensemble: Ensemble) -> dict[str, Any]:
    return {**_quantity(name, "_m_per_s2", ensemble.estimate, ensemble.interval),
            f"{name}_trials": ensemble.n_trials, f"{name}_converged": ensemble.converged}

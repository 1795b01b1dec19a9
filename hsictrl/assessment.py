"""From a bridge and a flow of people to a design acceleration, with and without interaction, and a comfort class."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.comfort import DesignResponse, comfort_class, design_acceleration
from hsictrl.coupling import couple
from hsictrl.crowd import CrowdFlow
from hsictrl.prediction import MODELS, Prediction, predict, predict_tuned, tune
from hsictrl.prediction.refusals import check_vertical
from hsictrl.resonance import effective
from hsictrl.study import AllRules, Ensemble, Ledger, MeanRule, PercentileRule, StopRule, monte_carlo
from hsictrl.walking import WalkingForce, ZivanovicForce

PERSON_MASS = 70.0   # kg, of the guides
PAPER_RULE = PercentileRule()


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
        _check_case(self.bridge, self.flow)
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
        _check_case(self.bridge, self.flow)
        self.bridge.mode(self.mode)

    def __call__(self, rng: np.random.Generator) -> Array:
        people, places = self.flow.crowd(self.bridge, rng)
        return np.array([*effective(couple(self.bridge, people, places), mode=self.mode)])


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
    >>> from hsictrl.bridge import reference_bridge
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
        >>> from hsictrl.bridge import reference_bridge
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


def assess(
    bridge: Footbridge, flow: CrowdFlow, *, force: WalkingForce | None = None,
    rule: PercentileRule = PAPER_RULE, seed: int = 1, executor: Executor | None = None,
    ledger: Ledger | None = None,
) -> Assessment:
    """Assess a footbridge under a flow of people: damping, accelerations, comfort class.

    Both models see the same people, each tuned to its own resonance (unless the flow sets the step
    frequency by hand).

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge; its first mode is the one in resonance.
    flow : CrowdFlow
        The stream of people.
    force : WalkingForce, optional
        Walking force; the narrow-band `ZivanovicForce` if not given.
    rule : PercentileRule
        Which percentile of the peak acceleration, and when it has settled [-].
    seed : int
        Seed of all trials [-].
    executor : concurrent.futures.Executor, optional
        Where trials run; in place if not given.
    ledger : Ledger, optional
        Keeps the trials, and gives those that it holds.

    Returns
    -------
    Assessment

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> found = assess(reference_bridge(), CrowdFlow(persons=15), rule=PercentileRule(tolerance=0.5))
    >>> found.classes[1]
    'CL3'
    """
    check_assessable(bridge, flow)
    check.instance("rule", rule, PercentileRule, "use PercentileRule(percentile=…, tolerance=…)")
    force = ZivanovicForce() if force is None else force
    peaks = {model: monte_carlo(
        PeakTrial(model=model, bridge=bridge, flow=flow, force=force), rule=rule, seed=seed, executor=executor,
        ledger=ledger, label=f"{flow}, {model}") for model in ("MF", "PMC")}
    found = study_effective(bridge, flow, rule=MeanRule(tolerance=rule.tolerance), seed=seed, executor=executor,
                            ledger=ledger)
    guide = guide_value(bridge, flow)
    return Assessment(bridge=bridge, flow=flow, effective=found, mf=peaks["MF"], pmc=peaks["PMC"], guide=guide,
                      remarks=_remarks(bridge, flow, guide, peaks | {"effective properties": found}))


def study_effective(
    bridge: Footbridge, flow: CrowdFlow, *, rule: StopRule | None = None, mode: int = 0, seed: int = 1,
    executor: Executor | None = None, ledger: Ledger | None = None,
) -> Ensemble:
    """Effective frequency [Hz] and damping [-] of a mode under standing crowds drawn from a flow (section 3.3).

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        Says how many people there are and who.
    rule : StopRule, optional
        When the study ends; when mean, 5 % and 95 % of both quantities have settled if not given.
    mode : int
        Which mode of the bridge, from 0 [-].
    seed : int
        Seed of all trials [-].
    executor : concurrent.futures.Executor, optional
        Where trials run; in place if not given.
    ledger : Ledger, optional
        Keeps the trials, and gives those that it holds.

    Returns
    -------
    Ensemble
        Two columns: f_eff [Hz] and ξ_eff [-].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> ensemble = study_effective(reference_bridge(), CrowdFlow(persons=15), rule=MeanRule())
    >>> ensemble.samples.shape[1]
    2
    """
    trial = EffectiveTrial(bridge=bridge, flow=flow, mode=mode)
    rule = effective_rule() if rule is None else rule
    return monte_carlo(trial, rule=rule, seed=seed, executor=executor, ledger=ledger, label=f"{flow}, effective")


def effective_rule(tolerance: float = 0.05) -> AllRules:
    """Mean, 5 % and 95 % percentile must all settle: what figure 4 shows.

    Parameters
    ----------
    tolerance : float
        Largest relative distance of an interval's ends from the estimate [-].

    Returns
    -------
    AllRules

    Examples
    --------
    >>> len(effective_rule().labels)
    3
    """
    return AllRules((MeanRule(tolerance=tolerance), PercentileRule(percentile=5.0, tolerance=tolerance),
                     PercentileRule(percentile=95.0, tolerance=tolerance)))


def guide_value(bridge: Footbridge, flow: CrowdFlow, *, guide: str = "hivoss", mode: int = 0) -> DesignResponse:
    """Design acceleration of the guides for one mode and the same density.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        The stream of people.
    guide : {"hivoss", "setra"}
        Which guide's load reduction.
    mode : int
        Which mode of the bridge, from 0 [-].

    Returns
    -------
    DesignResponse

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> round(guide_value(reference_bridge(frequency=2.0, damping=0.005), CrowdFlow(density=0.5)).acceleration, 3)
    4.268
    """
    _check_case(bridge, flow)
    resonant, density = bridge.mode(mode), flow.density_on(bridge)
    return design_acceleration(
        frequency=resonant.frequency, damping=resonant.damping, modal_mass=resonant.modal_mass, density=density,
        area=bridge.area, loaded_area=bridge.area * resonant.shape.mean_absolute,
        crowd_modal_mass=PERSON_MASS * density * bridge.area * resonant.shape.mean_square, guide=guide)


def check_assessable(bridge: Footbridge, flow: CrowdFlow) -> None:
    """Refuse what no study should be run for.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        The stream of people.

    Raises
    ------
    ValueError
        If nobody is on the deck, nothing damps the bridge, its first mode does not move vertically, or people are
        too many to walk.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> check_assessable(reference_bridge(), CrowdFlow(density=1.5))
    """
    _check_case(bridge, flow)
    if not flow.persons_on(bridge):
        raise ValueError(f"density must put at least one person on the deck of {bridge.area:g} m², got {flow}; "
                         "give a higher one")
    check.numbers("damping", bridge.damping, above=0, below=1, remedy="nothing settles without; give such as 0.005")
    check_vertical(bridge)
    guide_value(bridge, flow)


def _remarks(
    bridge: Footbridge, flow: CrowdFlow, guide: DesignResponse, ensembles: dict[str, Ensemble],
) -> tuple[str, ...]:
    unsettled = tuple(f"{name}: {one.reason}" for name, one in ensembles.items() if not one.converged)
    drawn = flow.sample(bridge, rng=np.random.default_rng(0))
    outside = f"{bridge.modes[0].frequency:g} Hz lies outside the range for which HiVoSS has a load"
    silent = () if guide.reduction else (outside,)
    tuned = () if flow.step_frequency is not None else tune("PMC", bridge, drawn).remarks
    return (*dict.fromkeys(drawn.remarks + tuned), *silent, *unsettled)


def _check_case(bridge: Any, flow: Any) -> None:
    check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
    check.instance("flow", flow, CrowdFlow, "use CrowdFlow(density=…) or CrowdFlow(persons=…)")


def _quantity(name: str, unit: str, estimate: Any, interval: Any) -> dict[str, float]:
    """An estimate and the ends of its interval, the unit last in each key."""
    parts = {"": estimate, "_low": interval[0], "_high": interval[1]}
    return {f"{name}{part}{unit}": float(value) for part, value in parts.items()}


def _peak(name: str, ensemble: Ensemble) -> dict[str, Any]:
    return {**_quantity(name, "_m_per_s2", ensemble.estimate, ensemble.interval),
            f"{name}_trials": ensemble.n_trials, f"{name}_converged": ensemble.converged}

"""Studies of a bridge under a flow of people, the guides' value beside them, and what is refused before they begin."""

from __future__ import annotations

from concurrent.futures import Executor

import numpy as np

from hsictrl import _checks as check
from hsictrl.assessment.assessed import Assessment
from hsictrl.assessment.guides import GuideCase, guide_cases, guide_value
from hsictrl.assessment.trials import EffectiveTrial, PeakTrial
from hsictrl.bridge import Footbridge
from hsictrl.comfort import COMFORT_CLASSES, DesignResponse
from hsictrl.crowd import CrowdFlow
from hsictrl.prediction import tune
from hsictrl.prediction.refusals import check_case, check_excitable
from hsictrl.study import AllRules, Ensemble, Ledger, MeanRule, PercentileRule, StopRule, monte_carlo
from hsictrl.walking import WalkingForce, ZivanovicForce

PAPER_RULE = PercentileRule()


def assess(
    bridge: Footbridge, flow: CrowdFlow, *, force: WalkingForce | None = None,
    rule: PercentileRule = PAPER_RULE, mode: int = 0, goal: str | None = None, seed: int = 1,
    executor: Executor | None = None, ledger: Ledger | None = None,
) -> Assessment:
    """Assess a footbridge under a flow of people: damping, accelerations, comfort class, and the guides beside them.

    Both models see the same people, each tuned to its own resonance (unless the flow sets the step
    frequency by hand). A bridge of several modes is assessed for one of them at a time; remarks name other modes for
    which the guides have a load.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        The stream of people.
    force : WalkingForce, optional
        Walking force; the narrow-band `ZivanovicForce` if not given.
    rule : PercentileRule
        Which percentile of the peak acceleration, and when it has settled [-].
    mode : int
        The mode in resonance, at whose antinode accelerations are read, from 0 [-].
    goal : {"CL1", "CL2", "CL3"}, optional
        The worst comfort class that will do.
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
    check_assessable(bridge, flow, mode=mode)
    check.instance("rule", rule, PercentileRule, "use PercentileRule(percentile=…, tolerance=…)")
    if goal is not None:
        check.choice("goal", goal, COMFORT_CLASSES[:-1])
    force = ZivanovicForce() if force is None else force
    peaks = {model: monte_carlo(
        PeakTrial(model=model, bridge=bridge.led_by(mode), flow=flow, force=force), rule=rule, seed=seed,
        executor=executor, ledger=ledger, label=_label(flow, mode, model)) for model in ("MF", "PMC")}
    found = study_effective(bridge, flow, rule=MeanRule(tolerance=rule.tolerance), mode=mode, seed=seed,
                            executor=executor, ledger=ledger)
    guide, cases = guide_value(bridge, flow, mode=mode), guide_cases(bridge, flow)
    studies = peaks | {"effective properties": found}
    return Assessment(
        bridge=bridge, flow=flow, force=force, mode=mode, goal=goal, effective=found, mf=peaks["MF"], pmc=peaks["PMC"],
        guide=guide, guides=cases,
        remarks=(*_remarks(bridge.led_by(mode), flow, guide, studies), *_left_out(bridge, mode, cases)))


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
    return monte_carlo(trial, rule=rule, seed=seed, executor=executor, ledger=ledger,
                       label=_label(flow, mode, "effective"))


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


def check_assessable(bridge: Footbridge, flow: CrowdFlow, *, mode: int = 0) -> None:
    """Refuse what no study should be run for.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        The stream of people.
    mode : int
        The mode in resonance, from 0 [-].

    Raises
    ------
    ValueError
        If nobody is on the deck, nothing damps the bridge or so little that it hardly settles, the mode does not move
        vertically, or people are too many to walk.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> check_assessable(reference_bridge(), CrowdFlow(density=1.5))
    """
    check_case(bridge, flow)
    check_excitable(bridge, flow, mode)
    guide_value(bridge, flow, mode=mode)
    flow.drawn_from(bridge)


def _remarks(
    bridge: Footbridge, flow: CrowdFlow, guide: DesignResponse, ensembles: dict[str, Ensemble],
) -> tuple[str, ...]:
    """On a bridge that is led by the mode in resonance."""
    unsettled = tuple(f"{name}: {one.reason}" for name, one in ensembles.items() if not one.converged)
    drawn = flow.sample(bridge, rng=np.random.default_rng(0))
    heavier = "" if guide.frequency == bridge.modes[0].frequency else ", with the crowd's mass,"
    outside = f"{guide.frequency:.4g} Hz{heavier} lies outside the range for which HiVoSS has a load"
    silent = () if guide.reduction else (outside,)
    bare = ("the guide's value is that of the bridge without its absorbers",) if bridge.absorbers else ()
    tuned = () if flow.step_frequency is not None else tune("PMC", bridge, drawn).remarks
    return (*dict.fromkeys(drawn.remarks + tuned), *silent, *bare, *unsettled)


def _left_out(bridge: Footbridge, mode: int, cases: tuple[GuideCase, ...]) -> tuple[str, ...]:
    """Modes for which a guide has a vertical load, but which the simulation does not bring into resonance."""
    others = dict.fromkeys(case.mode for case in cases if case.response.direction == "vertical" and case.mode != mode)
    return tuple(f"mode {j} ({bridge.modes[j].frequency:.4g} Hz) is critical by the guides too; this study is of mode "
                 f"{mode}" for j in others)


def _label(flow: CrowdFlow, mode: int, what: str) -> str:
    """Name of a study in a ledger; the first mode goes without saying."""
    return f"{flow}, mode {mode}, {what}" if mode else f"{flow}, {what}"

"""An assessment in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hsictrl import _checks as check
from hsictrl._digits import significant
from hsictrl.assessment import Assessment
from hsictrl.pedestrian import Population
from hsictrl.study import Ensemble, PercentileRule


def answer(found: Sequence[Assessment], largest: Assessment) -> list[str]:
    """The largest acceleration, its class, and whether goals are met."""
    name, (without, within) = largest.pmc.rule.labels[0], largest.classes
    goals = [f"{one.goal} under {one.flow}: {one.verdicts[1]}" for one in found if one.verdicts]
    return [f"Under {largest.flow}, {name} of the peak acceleration is {_told(largest.pmc)} with human-structure "
            f"interaction: comfort class {within}. Without interaction it is {_told(largest.mf)}: {without}.",
            *([f"Goals, with interaction: {'; '.join(goals)}."] if goals else [])]


def resonance(found: Assessment) -> str:
    """Which mode was brought into resonance."""
    tuned = "are tuned to its highest peak with the absorbers" if found.bridge.absorbers else "are tuned to it"
    steps = tuned if found.flow.step_frequency is None else "are set by hand"
    frequency = significant(found.bridge.modes[found.mode].frequency, 4)
    return (f"Mode {found.mode} ({frequency} Hz) is the one in resonance: steps {steps}, and accelerations are read at "
            "its antinode. Modes are counted from 0.")


def rule(ensemble: Ensemble) -> PercentileRule:
    """The stop rule of accelerations."""
    return check.instance("rule of each ensemble", ensemble.rule, PercentileRule, "use what hsictrl.assess returns")


def stops(one: PercentileRule) -> str:
    """When trials stop."""
    return (f"{one.labels[0]} of the peak acceleration, until its {100 * one.confidence:g} % interval lies within "
            f"±{100 * one.tolerance:g} %")


def bodies(people: Population) -> str:
    """Mean and standard deviation of what bodies are drawn from."""
    return (f"{_spread(people.frequency)} Hz, {_spread(people.damping, 100.0)} %, {_spread(people.mass)} kg, "
            f"{100 * people.sprung_ratio:g} % sprung")


def _spread(given: float | tuple[float, float], scale: float = 1.0) -> str:
    mean, spread = np.broadcast_to(given, 2) * scale     # a population keeps pairs
    return f"{mean:g} ± {spread:g}" if spread else f"{mean:g}"


def _told(ensemble: Ensemble) -> str:
    (low, high), level = ensemble.interval, rule(ensemble).confidence
    settled = "" if ensemble.converged else ", not settled"
    return (f"{significant(float(ensemble.estimate))} m/s² ({100 * level:g} % interval {significant(float(low))} to "
            f"{significant(float(high))}; {ensemble.n_trials} trials{settled})")

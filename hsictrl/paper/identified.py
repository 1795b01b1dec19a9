"""What virtual tests on the footbridge in Eeklo identify of its vertical mode, for figure 7."""

from __future__ import annotations

from functools import partial
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.assessment import effective_rule
from hsictrl.paper.eeklo import BRIDGE, POSTURES, SETUPS
from hsictrl.paper.reports import Rows, Run, rounded
from hsictrl.paper.studies import study_each
from hsictrl.paper.virtual_tests import BENT, PACES, VERTICAL, DecayTrial, SpanTrial, WalkingTrial
from hsictrl.study import Ensemble

SEED, TESTS, MOST = 7, 100, 5000
WALKERS = (9, 21)
ALONG = f"{BENT}, along the span"
SPANS = tuple(SpanTrial(persons=persons) for persons in WALKERS)
DECAYS = tuple(DecayTrial(posture=posture, persons=persons) for posture, persons in product(POSTURES, SETUPS))


def study(run: Run) -> Rows:
    """Rows of free decays, of the crowds that stand where people walk, and of tests with people who walk."""
    each = partial(study_each, label="fig7, {}", rule=effective_rule(), seed=SEED, executor=run.executor,
                   ledger=run.ledger)
    decays = each(DECAYS, lambda trial: trial, _decays, max_trials=TESTS)
    spans = each(SPANS, lambda trial: trial, _spans, max_trials=MOST)
    regions = {row["persons"]: row for row in spans}
    tests = [WalkingTrial(pace=pace, persons=persons, expected=regions[persons]["f_eff_mean_hz"])
             for pace, persons in product(PACES, WALKERS)]
    walked = each(tests, lambda trial: trial, lambda trial, ensemble: _walked(trial, ensemble, regions[trial.persons]),
                  max_trials=TESTS)
    return decays + spans + walked


def _decays(trial: DecayTrial, ensemble: Ensemble) -> Rows:
    return [_row("free decay", trial.posture, trial.persons, ensemble.samples)]


def _spans(trial: SpanTrial, ensemble: Ensemble) -> Rows:
    row = _row("model", ALONG, trial.persons, ensemble.samples)
    return [{**row, "inside": rounded(float(np.mean(_meets(ensemble.samples, 0.0, row))))}]


def _walked(trial: WalkingTrial, ensemble: Ensemble, region: dict[str, Any]) -> Rows:
    """Estimates, and intervals, within the region; a test that does not find the mode counts as outside."""
    found = ensemble.samples[ensemble.samples[:, 0] > 0]
    estimates, reach = found[:, :2], found[:, 2:]
    return [{**_row("subspace", trial.pace, trial.persons, estimates), "trials": ensemble.n_trials, "found": len(found),
             "inside": rounded(np.sum(_meets(estimates, 0.0, region)) / ensemble.n_trials),
             "interval_meets": rounded(np.sum(_meets(estimates, reach, region)) / ensemble.n_trials),
             "median_half_width_hz": rounded(float(np.median(reach[:, 0]))),
             "median_half_width_damping": rounded(float(np.median(reach[:, 1])))}]


def _row(source: str, posture: str, persons: int, samples: Array) -> dict[str, Any]:
    mode = BRIDGE.modes[VERTICAL]
    return {"source": source, "mode": "vertical", "posture": posture, "lateral_bodies": False, "persons": persons,
            "bodies": persons, "f_b_hz": mode.frequency, "xi_b": mode.damping, "trials": len(samples),
            **_statistics("f_eff", "_hz", samples[:, 0]), **_statistics("xi_eff", "", samples[:, 1]),
            "inside": None, "measured": ""}


def _statistics(name: str, unit: str, values: Array) -> dict[str, float]:
    low, high = np.quantile(values, [0.05, 0.95], method="median_unbiased")
    return {f"{name}_{key}{unit}": rounded(value)
            for key, value in {"mean": np.mean(values), "p5": low, "p95": high}.items()}


def _meets(estimates: Array, reach: Array | float, region: dict[str, Any]) -> NDArray[np.bool_]:
    """Whether f and ξ, give or take `reach`, lie between the 5 % and 95 % percentiles of a region."""
    low = np.array([region["f_eff_p5_hz"], region["xi_eff_p5"]])
    high = np.array([region["f_eff_p95_hz"], region["xi_eff_p95"]])
    return np.asarray(np.all((estimates + reach >= low) & (estimates - reach <= high), axis=1))

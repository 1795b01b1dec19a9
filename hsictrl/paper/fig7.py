"""Figure 7: effective frequency and damping of the footbridge in Eeklo (section 3.4)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple, final

import control as ct
import numpy as np

from hsictrl._checks import Array
from hsictrl.assessment import effective_rule
from hsictrl.coupling import couple
from hsictrl.paper.eeklo import BRIDGE, POSTURES, SETUPS, beside_centre, setup
from hsictrl.paper.intervals import Interval
from hsictrl.paper.reports import Report, Rows, Run, committed
from hsictrl.paper.studies import study_each
from hsictrl.pedestrian import Crowd, Population
from hsictrl.resonance import effective
from hsictrl.study import Ensemble

STATISTICS = ("mean", "p5", "p95")
SEED, MOST = 7, 5000
COLUMNS = ["mode", "posture", "lateral_bodies", "persons", "bodies", "trials", *(f"f_eff_{s}_hz" for s in STATISTICS),
           *(f"xi_eff_{s}" for s in STATISTICS)]


class Condition(NamedTuple):
    """What is looked at: a mode, by name and index, and whether bodies move laterally too."""

    name: str
    mode: int
    lateral: bool


CONDITIONS = (Condition("vertical", 1, False), Condition("lateral-torsional", 0, False),
              Condition("lateral-torsional", 0, True))


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class PostureTrial:
    """A trial: one crowd in a setup, and f_eff [Hz] and ξ_eff of both modes, of the first also with lateral bodies.

    Parameters
    ----------
    posture : str
        "upright" or "bent legs".
    persons : int
        The setup, by its number of persons [-].

    Examples
    --------
    >>> trial = PostureTrial(posture="bent legs", persons=9)
    >>> trial(np.random.default_rng(1)).shape        # f_eff of the three conditions, then ξ_eff
    (6,)
    """

    posture: str
    persons: int

    def __str__(self) -> str:
        return f"{self.posture}, {self.persons} persons"

    def __call__(self, rng: np.random.Generator) -> Array:
        upwards = POSTURES[self.posture].sample(self.persons, rng)
        sideways = Population.lateral().sample(self.persons, rng)
        found = [effective(couple(BRIDGE, *standing(condition, upwards, sideways)), mode=condition.mode)
                 for condition in CONDITIONS]
        return np.array([[one.frequency, one.damping] for one in found]).T.ravel()


def standing(condition: Condition, upwards: Crowd, sideways: Crowd) -> tuple[Crowd, Array]:
    """Bodies and their places: for the lateral-torsional mode those beside the central stringer only."""
    places = setup(len(upwards))
    if condition.mode == 1:
        return upwards, places
    beside = beside_centre(places)
    people, there = upwards.part(beside), places[beside]
    if not condition.lateral:
        return people, there
    return people + sideways.part(beside), np.vstack([there, there])


TRIALS = tuple(PostureTrial(posture=posture, persons=persons) for posture, persons in product(POSTURES, SETUPS))


def report(run: Run) -> Report:
    """All cells: two postures, five setups, and three conditions."""
    rows = _study(run) if run.recompute else committed("fig7")
    return Report(name="fig7", rows=rows, columns=COLUMNS, draw=lambda: _draw(rows), study=True, caption=(
        "Fig. 7: f_eff and ξ_eff (eq. 17) of the footbridge in Eeklo: mean, 5 % and 95 % of random bodies of 70 kg at "
        "assumed places (docs: choices); without those on the central stringer for the lateral-torsional mode. "
        "Measured, by the text: ξ_eff of the vertical mode from 0.2 % to 0.7 % upright, above 3.5 % with bent legs (26 "
        "persons); lateral-torsional mode: f_eff falls a little, ξ_eff rises"))


def _study(run: Run) -> Rows:
    return study_each(TRIALS, lambda trial: trial, _rows, label="fig7, {}", rule=effective_rule(), seed=SEED,
                      executor=run.executor, max_trials=MOST, ledger=run.ledger)


def _rows(trial: PostureTrial, ensemble: Ensemble) -> Rows:
    """One row per condition."""
    everybody = setup(trial.persons)
    beside = int(beside_centre(everybody).sum())
    return [{"mode": condition.name, "posture": trial.posture, "lateral_bodies": condition.lateral,
             "persons": trial.persons, "bodies": trial.persons if condition.mode == 1 else beside,
             "f_b_hz": BRIDGE.modes[condition.mode].frequency, "xi_b": BRIDGE.modes[condition.mode].damping,
             "trials": ensemble.n_trials, **_statistics("f_eff", "_hz", ensemble, i),
             **_statistics("xi_eff", "", ensemble, len(CONDITIONS) + i)}
            for i, condition in enumerate(CONDITIONS)]


def _statistics(name: str, unit: str, ensemble: Ensemble, index: int) -> dict[str, float]:
    values = np.array([ensemble.estimate, *ensemble.interval])[:, index]
    return {key: value for statistic, column in zip(STATISTICS, values.T, strict=True)
            for key, value in Interval(*column.tolist()).row(f"{name}_{statistic}", unit).items()}


def chosen(rows: Rows, mode: str, posture: str, lateral: bool = False) -> Rows:
    """Rows of one mode, posture and condition, in order of the setups."""
    return [row for row in rows if (row["mode"], row["posture"], row["lateral_bodies"]) == (mode, posture, lateral)]


def _draw(rows: Rows) -> ct.ControlPlot:
    from hsictrl import plots
    panels: dict[str, dict[str, dict[str, Any]]] = {"vertical": {}, "lateral-torsional": {}}
    for condition, posture in product(CONDITIONS, POSTURES):
        label = f"{posture}, lateral bodies too" if condition.lateral else posture
        panels[condition.name][label] = _curves(condition, chosen(rows, condition.name, posture, condition.lateral))
    return plots.bands_plot({f"{name} mode": curves for name, curves in panels.items()})


def _curves(condition: Condition, rows: Rows) -> dict[str, Any]:
    """Over the number of persons, from the empty bridge on: three rows of each quantity."""
    frequency, damping = effective(BRIDGE, mode=condition.mode)
    return {"persons": [0, *(row["persons"] for row in rows)], "hatched": condition.lateral,
            "frequency": [[frequency, *(row[f"f_eff_{s}_hz"] for row in rows)] for s in STATISTICS],
            "damping": [[damping, *(row[f"xi_eff_{s}"] for row in rows)] for s in STATISTICS]}

"""Figure 7: effective frequency and damping of the footbridge in Eeklo, computed and identified (section 3.4)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any, NamedTuple, final

import control as ct
import numpy as np

from hsictrl._checks import Array
from hsictrl.assessment import effective_rule
from hsictrl.coupling import couple
from hsictrl.paper import identified
from hsictrl.paper.eeklo import BRIDGE, POSTURES, SETUPS, beside_centre, setup
from hsictrl.paper.intervals import Interval
from hsictrl.paper.reports import Report, Rows, Run, committed
from hsictrl.paper.studies import study_each
from hsictrl.paper.virtual_tests import PACES
from hsictrl.pedestrian import Crowd, Population
from hsictrl.resonance import effective
from hsictrl.study import Ensemble

STATISTICS = ("mean", "p5", "p95")
SEED, MOST = 7, 5000
COLUMNS = ["source", "mode", "posture", "lateral_bodies", "persons", "trials",
           *(f"f_eff_{s}_hz" for s in STATISTICS), *(f"xi_eff_{s}" for s in STATISTICS), "inside", "measured"]
# what the text says of 26 persons (section 3.4); points of the figure are not printed as numbers
MEASURED = {("vertical", "upright"): "f falls, ξ 0.7 %", ("vertical", "bent legs"): "f about as empty, ξ > 3.5 %",
            ("lateral-torsional", "upright"): "f falls a little, ξ rises",
            ("lateral-torsional", "bent legs"): "f falls a little, ξ rises"}


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
    """All cells: two postures, five setups, and three conditions; beside them what virtual tests identify."""
    rows = _study(run) if run.recompute else committed("fig7")
    return Report(name="fig7", rows=rows, columns=COLUMNS, draw=lambda: _draw(rows), study=True, caption=(
        "Fig. 7: f_eff and ξ_eff (eq. 17) of the footbridge in Eeklo: mean, 5 % and 95 % of random bodies of 70 kg at "
        "assumed places (docs: choices); without those on the central stringer for the lateral-torsional mode. Beside "
        "the model: virtual free decays, and subspace identification while people walk for 180 s; inside: share of "
        "tests, or of crowds, with both quantities between the percentiles of as many people with bent legs along the "
        "span. Measured: what the text says"))


def _study(run: Run) -> Rows:
    standing = study_each(TRIALS, lambda trial: trial, _rows, label="fig7, {}", rule=effective_rule(), seed=SEED,
                          executor=run.executor, max_trials=MOST, ledger=run.ledger)
    return standing + identified.study(run)


def _rows(trial: PostureTrial, ensemble: Ensemble) -> Rows:
    """One row per condition."""
    everybody = setup(trial.persons)
    beside = int(beside_centre(everybody).sum())
    return [{"source": "model", "mode": condition.name, "posture": trial.posture, "lateral_bodies": condition.lateral,
             "persons": trial.persons, "bodies": trial.persons if condition.mode == 1 else beside,
             "f_b_hz": BRIDGE.modes[condition.mode].frequency, "xi_b": BRIDGE.modes[condition.mode].damping,
             "trials": ensemble.n_trials, **_statistics("f_eff", "_hz", ensemble, i),
             **_statistics("xi_eff", "", ensemble, len(CONDITIONS) + i), "inside": None,
             "measured": MEASURED[condition.name, trial.posture] if trial.persons == SETUPS[-1] else ""}
            for i, condition in enumerate(CONDITIONS)]


def _statistics(name: str, unit: str, ensemble: Ensemble, index: int) -> dict[str, float]:
    values = np.array([ensemble.estimate, *ensemble.interval])[:, index]
    return {key: value for statistic, column in zip(STATISTICS, values.T, strict=True)
            for key, value in Interval(*column.tolist()).row(f"{name}_{statistic}", unit).items()}


def chosen(rows: Rows, mode: str, posture: str, lateral: bool = False, *, source: str = "model") -> Rows:
    """Rows of one mode, posture and condition, in order of the number of persons."""
    return [row for row in rows
            if (row["source"], row["mode"], row["posture"], row["lateral_bodies"]) == (source, mode, posture, lateral)]


def _draw(rows: Rows) -> ct.ControlPlot:
    from hsictrl import plots
    panels: dict[str, dict[str, dict[str, Any]]] = {"vertical": {}, "lateral-torsional": {}}
    for condition, posture in product(CONDITIONS, POSTURES):
        label = f"{posture}, lateral bodies too" if condition.lateral else posture
        panels[condition.name][label] = _curves(condition, chosen(rows, condition.name, posture, condition.lateral))
    panels["vertical"] |= _identified(rows)
    return plots.bands_plot({f"{name} mode": curves for name, curves in panels.items()})


def _identified(rows: Rows) -> dict[str, dict[str, Any]]:
    """Where people walk: the model's band; beside it, what walking and free decays show, each a little aside."""
    along = _series(chosen(rows, "vertical", identified.ALONG), 0.0, "filled")
    walked = {pace: _series(chosen(rows, "vertical", pace, source="subspace"), 0.5 * i, "bars")
              for i, pace in enumerate(PACES, -1)}
    decays = {f"free decay, {posture}": _series(chosen(rows, "vertical", posture, source="free decay"), -0.3, "bars")
              for posture in reversed(POSTURES)}
    return {identified.ALONG: along, **walked, **decays}


def _curves(condition: Condition, rows: Rows) -> dict[str, Any]:
    """Over the number of persons, from the empty bridge on: three rows of each quantity."""
    frequency, damping = effective(BRIDGE, mode=condition.mode)
    empty = {"persons": 0, **dict.fromkeys((f"f_eff_{s}_hz" for s in STATISTICS), frequency),
             **dict.fromkeys((f"xi_eff_{s}" for s in STATISTICS), damping)}
    return _series([empty, *rows], 0.0, "hatched" if condition.lateral else "filled")


def _series(rows: Rows, aside: float, look: str) -> dict[str, Any]:
    """Three rows of each quantity over the number of persons."""
    return {"persons": [row["persons"] + aside for row in rows], "look": look,
            "frequency": [[row[f"f_eff_{s}_hz"] for row in rows] for s in STATISTICS],
            "damping": [[row[f"xi_eff_{s}"] for row in rows] for s in STATISTICS]}

"""Figure 4: effective frequency and damping under random crowds (section 3.3)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any, final

import control as ct
import numpy as np

from hsictrl._checks import Array
from hsictrl.assessment import effective_rule
from hsictrl.bridge import Footbridge, reference_bridge
from hsictrl.coupling import CondensedCrowd
from hsictrl.crowd import CrowdFlow
from hsictrl.paper.fig3 import persons_of
from hsictrl.paper.reports import Report, Rows, Run, committed, rounded
from hsictrl.paper.studies import study_each
from hsictrl.resonance import effective_map
from hsictrl.study import Ensemble, StopRule, checkpoints

MASS_RATIOS, DAMPINGS = (0.05, 0.1, 0.2, 0.3), (0.002, 0.005, 0.02)
FREQUENCIES = tuple(np.linspace(1.0, 6.0, 51).round(3).tolist())
STATISTICS = ("mean", "p5", "p95")
SEED, MOST = 4, 20_000
COLUMNS = ["mass_ratio", "xi_b", "f_b_hz", "trials", *(f"f_ratio_{s}" for s in STATISTICS),
           *(f"xi_eff_{s}" for s in STATISTICS)]


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class SharedCrowdTrial:
    """A trial: one random crowd, and f_eff/f_B and ξ_eff of all the bridges that it stands on.

    The crowd's apparent mass is the same for all bridges that differ in frequency and damping only.

    Parameters
    ----------
    mass_ratio : float
        Crowd to bridge mass ratio [-].
    frequencies, dampings : tuple of float
        Of the empty bridges [Hz, -].

    Examples
    --------
    >>> trial = SharedCrowdTrial(mass_ratio=0.1, frequencies=(2.0, 3.0), dampings=(0.005,))
    >>> trial(np.random.default_rng(1)).shape        # a ratio and a damping for either bridge
    (4,)
    """

    mass_ratio: float
    frequencies: tuple[float, ...] = FREQUENCIES
    dampings: tuple[float, ...] = DAMPINGS

    def __call__(self, rng: np.random.Generator) -> Array:
        bridge = reference_bridge()
        people, places = flow_of(self.mass_ratio, bridge).crowd(bridge, rng)
        crowd = CondensedCrowd(people, bridge.participation(places, people.direction))
        frequency, damping = effective_map(crowd, self.frequencies, self.dampings)
        return np.stack([frequency / np.array(self.frequencies)[:, None], damping]).ravel()


def flow_of(mass_ratio: float, bridge: Footbridge) -> CrowdFlow:
    """As many people as the mass ratio asks for."""
    return CrowdFlow(persons=persons_of(mass_ratio, bridge))


def report(run: Run) -> Report:
    """All cells: 4 mass ratios × 3 dampings × 51 frequencies."""
    rows = committed("fig4") if not run.recompute else study_each(
        MASS_RATIOS, lambda mass_ratio: SharedCrowdTrial(mass_ratio=mass_ratio), _rows, label="fig4, mass ratio {:g}",
        rule=effective_rule(), seed=SEED, executor=run.executor, max_trials=MOST, ledger=run.ledger)
    return Report(name="fig4", rows=rows, columns=COLUMNS, draw=lambda: _draw(rows), caption=(
        "Fig. 4: f_eff/f_B and ξ_eff (eq. 17) of the reference bridge under random crowds, N(3.25, 0.32) Hz, "
        "N(0.30, 0.05), uniform on the deck; a crowd is shared by all bridges of its mass ratio; trials: number at "
        "which mean, 5 % and 95 % of both have settled to ±5 % at 95 % confidence"))


def _rows(mass_ratio: float, ensemble: Ensemble) -> Rows:
    """One row per bridge, from the columns of a shared ensemble."""
    cells = len(FREQUENCIES) * len(DAMPINGS)
    settled = np.array([_settled_at(column, ensemble.rule) for column in ensemble.samples.T]).reshape(2, cells)
    bridges = product(FREQUENCIES, DAMPINGS)
    return [{"mass_ratio": mass_ratio, "xi_b": damping, "f_b_hz": frequency,
             "persons": persons_of(mass_ratio, reference_bridge()), "trials": int(settled[:, i].max()),
             "trials_run": ensemble.n_trials, **_statistics("f_ratio", ensemble, i),
             **_statistics("xi_eff", ensemble, cells + i)}
            for i, (frequency, damping) in enumerate(bridges)]


def _settled_at(samples: Array, rule: StopRule) -> int:
    """Number of trials at which the study would have ended had this quantity been alone."""
    return next((n for n in checkpoints(rule, len(samples)) if rule.judge(samples[:n]).converged), len(samples))


def _statistics(name: str, ensemble: Ensemble, index: int) -> dict[str, float]:
    parts = {"": ensemble.estimate, "_low": ensemble.interval[0], "_high": ensemble.interval[1]}
    return {f"{name}_{statistic}{end}": rounded(np.asarray(values)[index, k])
            for k, statistic in enumerate(STATISTICS) for end, values in parts.items()}


def column(rows: Rows, key: str, mass_ratio: float, damping: float) -> Array:
    """One column of the study over the frequencies of the empty bridge."""
    return np.array([row[key] for row in rows if row["mass_ratio"] == mass_ratio and row["xi_b"] == damping])


def _draw(rows: Rows) -> ct.ControlPlot:
    from hsictrl import plots
    panels: dict[str, dict[str, dict[str, Any]]] = {
        f"ξ_B = {100 * damping:g} %": {f"μ = {mass:g}": {
            "frequency": np.array([column(rows, f"f_ratio_{s}", mass, damping) for s in STATISTICS]),
            "damping": np.array([column(rows, f"xi_eff_{s}", mass, damping) for s in STATISTICS])}
            for mass in MASS_RATIOS} for damping in DAMPINGS}
    return plots.effective_panels(np.array(FREQUENCIES), panels)

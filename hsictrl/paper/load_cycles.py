"""Does SF meet MF where a crossing has the load cycles that a steady state needs (section 4.1)?"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import final

import numpy as np

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.crowd import CrowdFlow, weidmann_speed
from hsictrl.paper.intervals import RULE, percentile, ratio
from hsictrl.paper.reports import Report, Rows, Run, committed, rounded
from hsictrl.paper.studies import study_each
from hsictrl.prediction import Prediction, predict
from hsictrl.study import Ensemble, Ledger
from hsictrl.walking import ZivanovicForce

LENGTHS = (50.0, 100.0, 200.0, 400.0)
FREQUENCY, DAMPING, MODAL_MASS, WIDTH, PERSONS = 2.0, 0.005, 25e3, 3.0, 30
SPEED = weidmann_speed(0.2)    # 30 persons on the 50 m of the reference bridge
FORCE = ZivanovicForce().periodic()
SEED, MAX_TRIALS = 40, 5000
COLUMNS = ["length_m", "load_cycles", "a95_sf_m_per_s2", "a95_mf_m_per_s2", "sf_over_mf", "sf_over_mf_low",
           "sf_over_mf_high", "sf_over_instant", "sf_over_instant_low", "sf_over_instant_high", "trials", "settled"]


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class LoadCyclesTrial:
    """A trial: walkers in one step; the peaks of SF, of MF, and of MF in the last step of the window [m/s²].

    Modal mass, damping, frequency, number of people, speed and force stay; the span alone grows, and with it
    nothing but the number of load cycles of a crossing.

    Parameters
    ----------
    length : float
        Span of the bridge [m].

    Examples
    --------
    >>> LoadCyclesTrial(length=50.0)(np.random.default_rng(1)).shape
    (3,)
    """

    length: float

    def __call__(self, rng: np.random.Generator) -> Array:
        bridge = bridge_of(self.length)
        traffic = FLOW.sample(bridge, rng=rng, force=FORCE)
        stationary, moving = (predict(model, bridge, traffic) for model in ("SF", "MF"))
        return np.array([stationary.peak_acceleration, moving.peak_acceleration, _last_step(moving)])


FLOW = CrowdFlow(persons=PERSONS, speed=SPEED, step_frequency=FREQUENCY)


def bridge_of(length: float) -> Footbridge:
    """A bridge of another span, and the same modal mass."""
    return Footbridge.simply_supported(length=length, width=WIDTH, mass=2 * MODAL_MASS, frequency=FREQUENCY,
                                       damping=DAMPING)


def _last_step(moving: Prediction) -> float:
    """Peak acceleration in the last step of the window, where one crowd is on the deck [m/s²]."""
    time, acceleration = moving.response.time, np.abs(moving.response.y)
    return float(acceleration[..., time > time[-1] - 1 / FREQUENCY].max())


def report(run: Run) -> Report:
    """One row per span."""
    rows = study(LENGTHS, run.executor, run.ledger) if run.recompute else committed("load_cycles")
    return Report(name="load_cycles", rows=rows, columns=COLUMNS, study=True, caption=(
        f"SF over MF, one step frequency (case 2), {FREQUENCY:g} Hz, ξ_B {100 * DAMPING:g} %, m_B {MODAL_MASS:g} kg, "
        f"{PERSONS} persons at {SPEED:.3g} m/s, periodic forces for both; load cycles L f_s/v_s of a crossing; "
        "instant: over MF's peak in the last step of the window, when one crowd is on the deck"))


def study(
    lengths: Sequence[float], executor: Executor | None = None, ledger: Ledger | None = None, *,
    max_trials: int = MAX_TRIALS,
) -> Rows:
    """Run the trials of some spans."""
    return study_each(lengths, lambda length: LoadCyclesTrial(length=length), _rows, label="load cycles, {:g} m",
                      rule=RULE, seed=SEED, executor=executor, max_trials=max_trials, ledger=ledger)


def _rows(length: float, ensemble: Ensemble) -> Rows:
    """One row."""
    stationary, moving, instant = ensemble.samples.T
    return [{"length_m": length, "load_cycles": rounded(length * FREQUENCY / SPEED),
            **percentile(stationary).row("a95_sf", "_m_per_s2"), **percentile(moving).row("a95_mf", "_m_per_s2"),
            **ratio(stationary, moving).row("sf_over_mf"), **ratio(stationary, instant).row("sf_over_instant"),
            "trials": ensemble.n_trials, "settled": ensemble.converged}]

"""What a study leaves behind: every sample, and the last word of its stop rule."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.study.rules import StopRule, judged

_HISTORY_POINTS = 64  # a smooth curve on a plot


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class History:
    """The running estimate and its interval.

    Parameters
    ----------
    trials : ndarray
        Rising numbers of trials, the last one the whole ensemble [-].
    estimate, low, high : ndarray
        Estimate and ends of its interval, one row per number of trials [unit of the samples].

    Examples
    --------
    >>> from hsictrl.study import monte_carlo
    >>> history = monte_carlo(lambda rng: rng.normal(1.0, 0.1), seed=3).history()
    >>> int(history.trials[0]), int(history.trials[-1])
    (72, 250)
    """

    trials: NDArray[np.int_]
    estimate: Array
    low: Array
    high: Array

    def __post_init__(self) -> None:
        check.freeze(self.trials, self.estimate, self.low, self.high)


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ensemble:
    """Every sample of a study and the last word of its stop rule.

    Parameters
    ----------
    samples : ndarray
        Samples in index order, one column per quantity if the trial returns several [unit of the trial].
    estimate : float or ndarray
        Estimate; a row per quantity and a column per rule where there are several [unit of the trial].
    interval : tuple
        Low and high end of the confidence interval, each shaped as `estimate` [unit of the trial].
    converged : bool
        Whether every estimate has settled.
    reason : str
        The same in a sentence.
    seed : int
        Seed of the study; ``trial_rng(seed, i)`` is the generator of trial i [-].
    rule : StopRule
        The stop rule.

    Examples
    --------
    >>> from hsictrl.study import monte_carlo
    >>> print(monte_carlo(lambda rng: rng.normal(1.0, 0.1), seed=3))
    percentile 95 = 1.154 [1.137, 1.188], 250 trials, converged
    """

    samples: Array
    estimate: float | Array
    interval: tuple[float | Array, float | Array]
    converged: bool
    reason: str
    seed: int
    rule: StopRule

    def __post_init__(self) -> None:
        check.freeze(self.samples, self.estimate, *self.interval)

    @property
    def n_trials(self) -> int:
        """The number of trials [-]."""
        return len(self.samples)

    def history(self) -> History:
        """Return the running estimate and interval, for a convergence plot.

        They are computed anew at up to 64 numbers of trials in a constant ratio; the rule looked at fewer.

        Returns
        -------
        History
            Numbers of trials [-], estimates and ends of their intervals [unit of the trial].

        Examples
        --------
        >>> from hsictrl.study import monte_carlo
        >>> ensemble = monte_carlo(lambda rng: rng.normal(1.0, 0.1), seed=3)
        >>> bool(ensemble.history().estimate[-1] == ensemble.estimate)
        True
        """
        first = min(self.rule.least_trials, self.n_trials)
        trials = np.unique(np.rint(np.geomspace(first, self.n_trials, _HISTORY_POINTS)).astype(int))
        found = [judged(self.rule, self.samples[:n]) for n in trials]
        return History(
            trials=trials, estimate=np.array([one.estimate for one in found]),
            low=np.array([one.interval[0] for one in found]),
            high=np.array([one.interval[1] for one in found]),
        )

    def __str__(self) -> str:
        rows = zip(self._labels(), *map(np.ravel, (self.estimate, *self.interval)), strict=True)
        parts = [f"{label} = {middle:.4g} [{low:.4g}, {high:.4g}]" for label, middle, low, high in rows]
        ending = "converged" if self.converged else "not converged"
        return ", ".join([*parts, f"{self.n_trials} trials", ending])

    def _labels(self) -> list[str]:
        if self.samples.ndim == 1:
            return list(self.rule.labels)
        columns = range(self.samples.shape[1])
        return [f"{label} of quantity {k}" for k in columns for label in self.rule.labels]

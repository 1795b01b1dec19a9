"""Independent trials until a percentile has settled.

A trial is a function of a random generator that returns a number, or one number per quantity. `monte_carlo`
runs trials until its stop rule says that the estimate has settled, and returns an `Ensemble` that keeps every
sample. Trial i draws from a random stream of its own and a rule reads the trials in index order, so the
answer doesn't depend on the number of workers, and any trial can be run again alone.

Source: Van Nimmen et al. (2017), section 2.3.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn
from scipy import stats

from hsictrl._checks import Array, instance, number, numbers, whole

__all__ = [
    "AllRules", "Ensemble", "History", "Judgement", "MeanRule", "PercentileRule", "StopRule", "monte_carlo",
    "trial_rng",
]

Trial = Callable[[np.random.Generator], ArrayLike]

_PIECE = 5            # trials in one message to a worker
_HISTORY_POINTS = 64  # a smooth curve on a plot


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Judgement:
    """What a stop rule says about the samples of one quantity.

    Parameters
    ----------
    estimate : float or ndarray
        The estimate; one per member under `AllRules`. [unit of the samples]
    interval : tuple
        Low and high end of its confidence interval; nan where no end exists yet. [unit of the samples]
    converged : bool
        Whether the estimate has settled. [-]
    reason : str
        The same in a sentence. [-]

    Examples
    --------
    >>> PercentileRule().judge([1.0, 2.0, 3.0]).reason
    'no 95 % interval of percentile 95 exists below 72 trials; got 3'
    """

    estimate: float | Array
    interval: tuple[float | Array, float | Array]
    converged: bool
    reason: str


class StopRule(ABC):
    """Says when the samples of one quantity have settled.

    Examples
    --------
    >>> [isinstance(rule, StopRule) for rule in (PercentileRule(), MeanRule())]
    [True, True]
    """

    __slots__ = ()

    @property
    @abstractmethod
    def labels(self) -> tuple[str, ...]:
        """The name of each estimate. [-]"""

    @property
    @abstractmethod
    def least_trials(self) -> int:
        """The smallest number of trials for which the interval exists. [-]"""

    @abstractmethod
    def judge(self, samples: ArrayLike) -> Judgement:
        """Judge the samples of one quantity.

        Parameters
        ----------
        samples : array_like
            One sample per trial. [any unit]

        Returns
        -------
        Judgement
            Estimate, interval, whether they have settled, and why. [unit of the samples]

        Examples
        --------
        >>> MeanRule().judge([0.9, 1.0, 1.1]).estimate
        1.0
        """


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class PercentileRule(StopRule):
    """Settled when the confidence interval of a percentile lies within a tolerance of its estimate.

    The estimate is ``numpy.quantile(..., method="hazen")``, as Matlab's ``prctile``; the interval is the
    distribution-free one between two order statistics, `scipy.stats.quantile_test`.

    Parameters
    ----------
    percentile : float
        The percentile, above 0 and below 100. [%]
    tolerance : float
        Largest distance from the estimate to either end, as a fraction of the estimate. [-]
    confidence : float
        Confidence level of the interval, at least 0.5 and below 1. [-]

    Notes
    -----
    Source: Van Nimmen et al. (2017), section 2.3: ±5 % at 95 %. The paper names Matlab's Statistics Toolbox
    but no interval; the distribution-free one is our reading.

    Examples
    --------
    >>> PercentileRule().least_trials
    72
    >>> PercentileRule().judge(np.linspace(1.0, 1.2, 500)).converged
    True
    """

    percentile: float = 95.0
    tolerance: float = 0.05
    confidence: float = 0.95

    def __post_init__(self) -> None:
        number("percentile", self.percentile, above=0, below=100, remedy="give percent, such as 95")
        _check_levels(self.tolerance, self.confidence)

    @property
    def labels(self) -> tuple[str, ...]:
        return (f"percentile {self.percentile:g}",)

    @property
    def least_trials(self) -> int:
        share = self.percentile / 100
        return int(np.ceil(np.log((1 - self.confidence) / 2) / np.log(max(share, 1 - share))))

    def judge(self, samples: ArrayLike) -> Judgement:
        values, share = _one_quantity(samples), self.percentile / 100
        ends = stats.quantile_test(values, p=share).confidence_interval(confidence_level=self.confidence)
        estimate = float(np.quantile(values, share, method="hazen"))
        return _judged(self, estimate, float(ends.low), float(ends.high), values.size)


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class MeanRule(StopRule):
    """Settled when Student's confidence interval of the mean lies within a tolerance of the mean.

    Parameters
    ----------
    tolerance : float
        Largest distance from the mean to either end, as a fraction of the mean. [-]
    confidence : float
        Confidence level of the interval, at least 0.5 and below 1. [-]

    Notes
    -----
    Source: Van Nimmen et al. (2017), section 2.3, for both levels; Student's interval is our reading.

    Examples
    --------
    >>> MeanRule(tolerance=0.01).judge([0.9, 1.0, 1.1, 1.0]).converged
    False
    """

    tolerance: float = 0.05
    confidence: float = 0.95

    def __post_init__(self) -> None:
        _check_levels(self.tolerance, self.confidence)

    @property
    def labels(self) -> tuple[str, ...]:
        return ("mean",)

    @property
    def least_trials(self) -> int:
        return 2

    def judge(self, samples: ArrayLike) -> Judgement:
        values = _one_quantity(samples)
        mean, reach = float(np.mean(values)), _student_reach(values, self.confidence)
        return _judged(self, mean, mean - reach, mean + reach, values.size)


@final
@dataclass(frozen=True, slots=True)
class AllRules(StopRule):
    """Settled when every member has settled; an estimate per member.

    Parameters
    ----------
    rules : sequence of StopRule
        The members, none of them an `AllRules`. [-]

    Notes
    -----
    Source: Van Nimmen et al. (2017), Fig. 4 shows three statistics; that all must settle is our reading.

    Examples
    --------
    >>> rule = AllRules([MeanRule(), PercentileRule(percentile=50)])
    >>> rule.labels, rule.judge(np.arange(11.0)).estimate
    (('mean', 'percentile 50'), array([5., 5.]))
    """

    rules: Sequence[StopRule]

    def __post_init__(self) -> None:
        rules = tuple(instance("rules", self.rules, Sequence, "give a list of rules"))
        whole("the number of rules", len(rules), least=1, remedy="give at least one rule")
        for rule in rules:
            _check_member(rule)
        object.__setattr__(self, "rules", rules)

    @property
    def labels(self) -> tuple[str, ...]:
        return tuple(label for rule in self.rules for label in rule.labels)

    @property
    def least_trials(self) -> int:
        return max(rule.least_trials for rule in self.rules)

    def judge(self, samples: ArrayLike) -> Judgement:
        return _joined([rule.judge(samples) for rule in self.rules])


def _judged(
    rule: PercentileRule | MeanRule, estimate: float, low: float, high: float, n: int,
) -> Judgement:
    allowed = rule.tolerance * abs(estimate)
    settled = estimate - low <= allowed and high - estimate <= allowed
    what = f"{100 * rule.confidence:g} % interval of {rule.labels[0]}"
    verb = "stays within" if settled else "leaves"
    reason = f"the {what} {verb} ±{100 * rule.tolerance:g} % of the estimate"
    if n < rule.least_trials:
        reason = f"no {what} exists below {rule.least_trials} trials; got {n}"
    return Judgement(estimate=estimate, interval=(low, high), converged=settled, reason=reason)


def _joined(judgements: Sequence[Judgement]) -> Judgement:
    unsettled = [each.reason for each in judgements if not each.converged]
    ends = zip(*(each.interval for each in judgements), strict=True)
    low, high = (np.array(end) for end in ends)
    return Judgement(
        estimate=np.array([each.estimate for each in judgements]), interval=(low, high),
        converged=not unsettled, reason="; ".join(unsettled) or "every estimate has settled",
    )


def _student_reach(values: Array, confidence: float) -> float:
    n = values.size
    if n < 2:
        return np.nan
    return float(stats.t.ppf((1 + confidence) / 2, n - 1) * np.std(values, ddof=1) / np.sqrt(n))


def _one_quantity(samples: ArrayLike) -> Array:
    values = numbers("samples", samples, ndim=1, remedy="give one finite number per trial")
    whole("the number of samples", values.size, least=1, remedy="give one finite number per trial")
    return values


def _check_levels(tolerance: float, confidence: float) -> None:
    number("tolerance", tolerance, above=0, below=1, remedy="give a fraction, not percent")
    # below one half an order-statistics interval may miss its own estimate
    number("confidence", confidence, least=0.5, below=1, remedy="give a fraction, not percent")


def _check_member(rule: StopRule) -> None:
    instance("each rule", rule, StopRule, "give PercentileRule(...) or MeanRule(...)")
    if isinstance(rule, AllRules):
        raise TypeError(f"each rule must be a single one, got {rule!r}; list its members instead")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class History:
    """The running estimate and its interval.

    Parameters
    ----------
    trials : ndarray
        Rising numbers of trials, the last one the whole ensemble. [-]
    estimate, low, high : ndarray
        Estimate and ends of its interval, one row per number of trials. [unit of the samples]

    Examples
    --------
    >>> history = monte_carlo(lambda rng: rng.normal(1.0, 0.1), seed=3).history()
    >>> int(history.trials[0]), int(history.trials[-1])
    (72, 250)
    """

    trials: NDArray[np.int_]
    estimate: Array
    low: Array
    high: Array

    def __post_init__(self) -> None:
        _freeze(self.trials, self.estimate, self.low, self.high)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Ensemble:
    """Every sample of a study and the last word of its stop rule.

    Parameters
    ----------
    samples : ndarray
        Samples in index order, one column per quantity if the trial returns several. [unit of the trial]
    estimate : float or ndarray
        Estimate; a row per quantity and a column per rule where there are several. [unit of the trial]
    interval : tuple
        Low and high end of the confidence interval, each shaped as `estimate`. [unit of the trial]
    converged : bool
        Whether every estimate has settled. [-]
    reason : str
        The same in a sentence. [-]
    seed : int
        Seed of the study; ``trial_rng(seed, i)`` is the generator of trial i. [-]
    rule : StopRule
        The stop rule. [-]

    Examples
    --------
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
        _freeze(self.samples, self.estimate, *self.interval)

    @property
    def n_trials(self) -> int:
        """The number of trials. [-]"""
        return len(self.samples)

    def history(self) -> History:
        """Return the running estimate and interval, for a convergence plot.

        They are computed anew at up to 64 numbers of trials in a constant ratio; the rule looked at fewer.

        Returns
        -------
        History
            Numbers of trials [-], estimates and ends of their intervals. [unit of the trial]

        Examples
        --------
        >>> ensemble = monte_carlo(lambda rng: rng.normal(1.0, 0.1), seed=3)
        >>> bool(ensemble.history().estimate[-1] == ensemble.estimate)
        True
        """
        first = min(self.rule.least_trials, self.n_trials)
        trials = np.unique(np.rint(np.geomspace(first, self.n_trials, _HISTORY_POINTS)).astype(int))
        looks = [_look(self.rule, self.samples[:n]) for n in trials]
        return History(
            trials=trials, estimate=np.array([look.estimate for look in looks]),
            low=np.array([look.interval[0] for look in looks]),
            high=np.array([look.interval[1] for look in looks]),
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


_PAPER_RULE = PercentileRule()


def monte_carlo(
    trial: Trial, *, rule: StopRule = _PAPER_RULE, seed: int = 1, executor: Executor | None = None,
    max_trials: int = 20_000, label: str = "trials",
) -> Ensemble:
    """Run independent trials until their estimate has settled.

    Parameters
    ----------
    trial : callable
        Takes a `numpy.random.Generator` and returns a number, or one number per quantity, all of which must
        settle. Picklable if `executor` runs processes. [any unit]
    rule : StopRule
        Says when the estimate has settled. [-]
    seed : int
        Seed of the study. [-]
    executor : concurrent.futures.Executor, optional
        Runs the trials; in place without one. [-]
    max_trials : int
        Trials after which an ensemble that has not settled is returned all the same. [-]
    label : str
        What the progress bar calls the trials; a bar is drawn only if stderr is a terminal. [-]

    Returns
    -------
    Ensemble
        Samples, estimate and interval. [unit of the trial]

    Notes
    -----
    Each look at the samples is a chance to stop on a lucky interval, so the rule looks first at 100 trials (its
    least number, if larger), then each time at a quarter more, at least 50 more. Some luck is left: the
    95 % interval held the true percentile in 93 to 94 % of 3000 studies of each of four distributions.

    Source: Van Nimmen et al. (2017), section 2.3; the schedule of looks is ours.

    Examples
    --------
    >>> ensemble = monte_carlo(lambda rng: rng.rayleigh(), rule=PercentileRule(tolerance=0.1), seed=1)
    >>> ensemble.converged, bool(ensemble.interval[0] < 2.448 < ensemble.interval[1])
    (True, True)
    """
    _check_study(trial, rule, seed, executor, max_trials)
    samples: list[Array] = []
    with _progress() as bar:
        task = bar.add_task(label, total=None)
        for n in _looks(max(100, rule.least_trials), max_trials):
            for value in _values(trial, seed, range(len(samples), n), executor):
                samples.append(_alike(value, samples))
                bar.advance(task)
            judgement = _look(rule, np.array(samples))
            if judgement.converged:
                break
    return Ensemble(
        samples=np.array(samples), estimate=judgement.estimate, interval=judgement.interval,
        converged=judgement.converged, reason=_ending(judgement, max_trials), seed=seed, rule=rule,
    )


def trial_rng(seed: int, index: int) -> np.random.Generator:
    """Rebuild the random generator of one trial, to run that trial alone.

    Parameters
    ----------
    seed : int
        Seed of the study. [-]
    index : int
        Index of the trial, from 0. [-]

    Returns
    -------
    numpy.random.Generator
        The generator that `monte_carlo` hands to this trial. [-]

    Examples
    --------
    >>> ensemble = monte_carlo(lambda rng: rng.normal(1.0, 0.1), seed=3)
    >>> bool(trial_rng(3, 17).normal(1.0, 0.1) == ensemble.samples[17])
    True
    """
    whole("seed", seed, least=0, remedy="give the seed of the study")
    whole("index", index, least=0, remedy="count trials from 0")
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(index,)))


def _looks(first: int, most: int) -> Iterator[int]:
    n = first
    while n < most:
        yield n
        n += max(50, n // 4)
    yield most


def _values(trial: Trial, seed: int, indices: range, executor: Executor | None) -> Iterator[Array]:
    over = map if executor is None else executor.map
    pieces = [indices[i:i + _PIECE] for i in range(0, len(indices), _PIECE)]
    for piece in over(partial(_run_piece, trial, seed), pieces):
        yield from piece


def _run_piece(trial: Trial, seed: int, indices: Iterable[int]) -> list[Array]:
    return [_run(trial, seed, index) for index in indices]


def _run(trial: Trial, seed: int, index: int) -> Array:
    again = f"rerun it alone with trial(trial_rng({seed}, {index}))"
    try:
        value = trial(trial_rng(seed, index))
    except Exception as error:
        cause = f"{type(error).__name__}: {error}"
        raise RuntimeError(f"trial {index} of seed {seed} failed: {cause}; {again}") from error
    return numbers(f"result of trial {index} of seed {seed}", value, remedy=again)


def _alike(value: Array, samples: list[Array]) -> Array:
    index, expected = len(samples), samples[0].shape if samples else value.shape
    if value.ndim > 1 or value.size == 0 or value.shape != expected:
        raise ValueError(
            f"result of trial {index} must be one number, or one row of numbers as long in every trial, "
            f"got shape {value.shape} after {expected} in trial 0; return one number per quantity"
        )
    return value


def _look(rule: StopRule, samples: Array) -> Judgement:
    if samples.ndim == 1:
        return rule.judge(samples)
    return _joined([rule.judge(column) for column in samples.T])


def _ending(judgement: Judgement, max_trials: int) -> str:
    stopped = "" if judgement.converged else f"stopped at max_trials={max_trials}: "
    return stopped + judgement.reason


def _check_study(trial: Trial, rule: StopRule, seed: int, executor: Executor | None, max_trials: int) -> None:
    if not callable(trial):
        raise TypeError(f"trial must be callable, got {trial!r}; give a function of a numpy.random.Generator")
    instance("rule", rule, StopRule, "give PercentileRule(...), MeanRule(...) or AllRules([...])")
    whole("seed", seed, least=0, remedy="give any other whole number")
    whole("max_trials", max_trials, least=1, remedy="allow at least one trial")
    if executor is not None:
        instance("executor", executor, Executor, "give one of concurrent.futures, or None to run in place")


def _freeze(*values: float | NDArray) -> None:
    for value in values:
        if isinstance(value, np.ndarray):
            value.flags.writeable = False


def _progress() -> Progress:
    console = Console(stderr=True)
    rate = TaskProgressColumn(show_speed=True)
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed}"), rate
    # not console.is_terminal, which FORCE_COLOR makes true in the logs of CI
    return Progress(*columns, console=console, transient=True, disable=not console.file.isatty())

"""Stop rules: when an estimate has settled."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from hsictrl import _checks as check
from hsictrl._checks import Array


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Judgement:
    """What a stop rule says about the samples of one quantity.

    Parameters
    ----------
    estimate : float or ndarray
        The estimate; one per member under `AllRules` [unit of the samples].
    interval : tuple
        Low and high end of its confidence interval; nan where no end exists yet [unit of the samples].
    converged : bool
        Whether the estimate has settled.
    reason : str
        The same in a sentence.

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
        """The name of each estimate."""

    @property
    @abstractmethod
    def least_trials(self) -> int:
        """The smallest number of trials for which the interval exists [-]."""

    @abstractmethod
    def judge(self, samples: ArrayLike) -> Judgement:
        """Judge the samples of one quantity.

        Parameters
        ----------
        samples : array_like
            One sample per trial [any unit].

        Returns
        -------
        Judgement
            Estimate, interval, whether they have settled, and why [unit of the samples].

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
        The percentile, at least 1 and below 100 [%].
    tolerance : float
        Largest distance from the estimate to either end, as a fraction of the estimate [-].
    confidence : float
        Confidence level of the interval, at least 0.5 and below 1 [-].

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
        check.number("percentile", self.percentile, least=1, below=100, remedy="give percent, such as 95")
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
        return _weighed(self, estimate, float(ends.low), float(ends.high), values.size)


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class MeanRule(StopRule):
    """Settled when Student's confidence interval of the mean lies within a tolerance of the mean.

    Parameters
    ----------
    tolerance : float
        Largest distance from the mean to either end, as a fraction of the mean [-].
    confidence : float
        Confidence level of the interval, at least 0.5 and below 1 [-].

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
        return _weighed(self, mean, mean - reach, mean + reach, values.size)


@final
@dataclass(frozen=True, slots=True)
class AllRules(StopRule):
    """Settled when every member has settled; an estimate per member.

    Parameters
    ----------
    rules : sequence of StopRule
        The members, none of them an `AllRules`.

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
        rules = tuple(check.instance("rules", self.rules, Sequence, "give a list of rules"))
        check.whole("the number of rules", len(rules), least=1, remedy="give at least one rule")
        for rule in rules:
            _check_member(rule)
        check.store(self, rules=rules)

    @property
    def labels(self) -> tuple[str, ...]:
        return tuple(label for rule in self.rules for label in rule.labels)

    @property
    def least_trials(self) -> int:
        return max(rule.least_trials for rule in self.rules)

    def judge(self, samples: ArrayLike) -> Judgement:
        return _joined([rule.judge(samples) for rule in self.rules])


def _weighed(
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
    values = check.numbers("samples", samples, ndim=1, remedy="give one finite number per trial")
    check.whole("the number of samples", values.size, least=1, remedy="give one finite number per trial")
    return values


def _check_levels(tolerance: float, confidence: float) -> None:
    check.number("tolerance", tolerance, above=0, below=1, remedy=check.PERCENT)
    # below one half an order-statistics interval may miss its own estimate
    check.number("confidence", confidence, least=0.5, below=1, remedy=check.PERCENT)


def _check_member(rule: StopRule) -> None:
    check.instance("each rule", rule, StopRule, "give PercentileRule(...) or MeanRule(...)")
    if isinstance(rule, AllRules):
        raise TypeError(f"each rule must be a single one, got {rule!r}; list its members instead")


def judged(rule: StopRule, samples: Array) -> Judgement:
    """Judge every column of the samples."""
    if samples.ndim == 1:
        return rule.judge(samples)
    return _joined([rule.judge(column) for column in samples.T])

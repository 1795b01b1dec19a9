"""Running trials until a rule is content with them, read in index order."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._progress import progress
from hsictrl.study.batches import Batches, Trial
from hsictrl.study.ensembles import Ensemble
from hsictrl.study.identity import described
from hsictrl.study.ledger import Account, Ledger, account
from hsictrl.study.rules import Judgement, PercentileRule, StopRule, judged

PAPER_RULE = PercentileRule()


def monte_carlo(
    trial: Trial, *, rule: StopRule = PAPER_RULE, seed: int = 1, executor: Executor | None = None,
    max_trials: int = 20_000, label: str = "trials", ledger: Ledger | None = None,
) -> Ensemble:
    """Run independent trials until their estimate has settled.

    Parameters
    ----------
    trial : callable
        Takes a `numpy.random.Generator` and returns a number, or one number per quantity, all of which must
        settle. Picklable if `executor` runs processes.
    rule : StopRule
        Says when the estimate has settled.
    seed : int
        Seed of the study [-].
    executor : concurrent.futures.Executor, optional
        Runs the trials; in place without one.
    max_trials : int
        Trials after which an ensemble that has not settled is returned all the same [-].
    label : str
        What the progress bar calls the trials, drawn only if stderr is a terminal, and the name of the study in
        its ledger.
    ledger : Ledger, optional
        Keeps each batch of trials as it finishes, and gives those that it holds in place of running them again.

    Returns
    -------
    Ensemble
        Samples, estimate and interval [unit of the trial].

    Notes
    -----
    Each look at the samples is a chance to stop on a lucky interval, so the rule looks first at 100 trials (its
    least number, if larger), then each time at a quarter more, at least 50 more. Some luck is left: the
    95 % interval held the true percentile in 93 to 94 % of 3000 studies of each of four distributions.

    Source: Van Nimmen et al. (2017), section 2.3; the schedule of checkpoints is ours.

    Examples
    --------
    >>> ensemble = monte_carlo(lambda rng: rng.rayleigh(), rule=PercentileRule(tolerance=0.1), seed=1)
    >>> ensemble.converged, bool(ensemble.interval[0] < 2.448 < ensemble.interval[1])
    (True, True)
    """
    check_callable("trial", trial, "give a function of a numpy.random.Generator")
    check_study(rule, seed, executor, max_trials, ledger)
    return settled(trial, rule=rule, seed=seed, executor=executor, max_trials=max_trials, label=label, ledger=ledger)


def settled(
    trial: Trial, *, rule: StopRule, seed: int, executor: Executor | None, max_trials: int, label: str,
    ledger: Ledger | None, shape: tuple[int, ...] | None = None,
) -> Ensemble:
    """Run a study whose arguments have been checked; refuse samples of another shape, if one is given."""
    samples: list[Array] = []
    with _account(ledger, label, trial, seed) as kept, progress() as bar:
        task, batches = bar.add_task(label, total=None), Batches(trial, seed, executor, kept)
        for n in checkpoints(rule, max_trials):
            for value in batches.values(range(len(samples), n)):
                samples.append(_alike(value, samples) if shape is None else _shaped(value, len(samples), label, shape))
                bar.advance(task)
            judgement = judged(rule, np.array(samples))
            if judgement.converged:
                break
    return Ensemble(
        samples=np.array(samples), estimate=judgement.estimate, interval=judgement.interval,
        converged=judgement.converged, reason=_ending(judgement, max_trials), seed=seed, rule=rule,
    )


def checkpoints(rule: StopRule, most: int) -> Iterator[int]:
    """Numbers of trials at which a rule looks at the samples of a study.

    Parameters
    ----------
    rule : StopRule
        The rule of the study.
    most : int
        Number of trials after which the study ends in any case [-].

    Returns
    -------
    iterator of int
        Rising numbers of trials, the last one `most` [-].

    Examples
    --------
    >>> list(checkpoints(PercentileRule(), 300))
    [100, 150, 200, 250, 300]
    """
    n = max(100, rule.least_trials)
    while n < most:
        yield n
        n += max(50, n // 4)
    yield most


def _account(
    ledger: Ledger | None, label: str, trial: Trial, seed: int,
) -> AbstractContextManager[Account | None]:
    return nullcontext() if ledger is None else account(ledger, label, described(trial, seed))


def _alike(value: Array, samples: list[Array]) -> Array:
    index, expected = len(samples), samples[0].shape if samples else value.shape
    if value.ndim > 1 or value.size == 0 or value.shape != expected:
        raise ValueError(
            f"result of trial {index} must be one number, or one row of numbers as long in every trial, "
            f"got shape {value.shape} after {expected} in trial 0; return one number per quantity"
        )
    return value


def _shaped(value: Array, index: int, label: str, shape: tuple[int, ...]) -> Array:
    if value.shape != shape:
        raise ValueError(
            f"result of trial {index} of '{label}' must have shape {shape}, got {value.shape}; return a row of one "
            "number for every combination of the shared axes, or one number if there are none"
        )
    return value


def _ending(judgement: Judgement, max_trials: int) -> str:
    stopped = "" if judgement.converged else f"stopped at max_trials={max_trials}: "
    return stopped + judgement.reason


def check_callable(name: str, thing: Any, remedy: str) -> None:
    """Refuse what can't be called."""
    if not callable(thing):
        raise TypeError(f"{name} must be callable, got {thing!r}; {remedy}")


def check_study(
    rule: StopRule, seed: int, executor: Executor | None, max_trials: int, ledger: Ledger | None,
) -> None:
    """Refuse a study that can't be run."""
    check.instance("rule", rule, StopRule, "give PercentileRule(...), MeanRule(...) or AllRules([...])")
    check.whole("seed", seed, least=0, remedy="give 0, 1, 2, …")
    check.whole("max_trials", max_trials, least=1, remedy="allow at least one trial")
    if executor is not None:
        check.instance("executor", executor, Executor, "give one of concurrent.futures, or None to run in place")
    if ledger is not None:
        check.instance("ledger", ledger, Ledger, "give Ledger(path), or None to keep nothing")

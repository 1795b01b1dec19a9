"""One study per case, and the rows that come of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from typing import TypeVar

from hsictrl.paper.reports import Rows
from hsictrl.study import Ensemble, Ledger, StopRule, monte_carlo
from hsictrl.study.batches import Trial

Case = TypeVar("Case")


def study_each(
    cases: Iterable[Case], trial: Callable[[Case], Trial], rows: Callable[[Case, Ensemble], Rows], *, label: str,
    rule: StopRule, seed: int, executor: Executor | None, max_trials: int, ledger: Ledger | None = None,
) -> Rows:
    """Run the trials of each case, all from one seed, and put the rows together.

    Parameters
    ----------
    cases : iterable
        What the studies are about.
    trial : callable
        Makes the trial of a case.
    rows : callable
        Makes rows of a case and its ensemble.
    label : str
        What the progress bar and the ledger call a case, which takes the place of the braces.
    rule : StopRule
        Says when an estimate has settled.
    seed : int
        Seed of every study [-].
    executor : concurrent.futures.Executor, optional
        Runs the trials; in place without one.
    max_trials : int
        Trials after which a study ends all the same [-].
    ledger : Ledger, optional
        Keeps the trials of all cases.

    Returns
    -------
    list of dict

    Examples
    --------
    >>> from hsictrl.study import MeanRule
    >>> study_each([1.0, 2.0], lambda mean: lambda rng: rng.normal(mean, 0.1),
    ...            lambda mean, ensemble: [{"mean": mean, "trials": ensemble.n_trials}],
    ...            label="about {:g}", rule=MeanRule(), seed=1, executor=None, max_trials=200)
    [{'mean': 1.0, 'trials': 100}, {'mean': 2.0, 'trials': 100}]
    """
    return [row for case in cases
            for row in rows(case, monte_carlo(trial(case), rule=rule, seed=seed, executor=executor,
                                              max_trials=max_trials, label=label.format(case), ledger=ledger))]

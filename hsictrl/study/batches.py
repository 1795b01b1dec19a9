"""Batches of trials: as many as are worth a message to a worker, each kept as soon as it has finished."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import contextmanager
from functools import partial
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.study.ledger import Account

Trial = Callable[[np.random.Generator], ArrayLike]
Samples = dict[int, Array]
Run = Callable[[Sequence[int]], tuple[Samples, float]]

_PIECES = 64                # so many workers are busy at once, and two share evenly
_LEAST, _MOST = 0.02, 0.25  # s: a message costs little beside it; no more than that is lost if the study is killed


class TrialError(RuntimeError):
    """A trial failed."""


@final
class Batches:
    """Runs the trials of one study, those that its ledger doesn't hold."""

    def __init__(self, trial: Trial, seed: int, executor: Executor | None, account: Account | None) -> None:
        self._run: Run = partial(_run_piece, trial, seed)
        self._executor, self._account = executor, account
        self._cost = np.inf     # s, of the cheapest trial so far: the first ones of a worker load and compile

    def values(self, indices: range) -> Iterator[Array]:
        """Yield the samples of these trials in index order."""
        found = {} if self._account is None else self._account.read(indices)
        finished = self._finished([index for index in indices if index not in found])
        for index in indices:
            while index not in found:
                found |= next(finished)
            yield found.pop(index)

    def _finished(self, indices: Sequence[int]) -> Iterator[Samples]:
        pieces = cut(indices, self._cost)
        done = map(self._run, pieces) if self._executor is None else _spread(self._run, pieces, self._executor)
        for samples, seconds in done:
            self._cost = min(self._cost, seconds / len(samples))
            if self._account is not None:
                self._account.write(samples)
            yield samples


def cut(indices: Sequence[int], cost: float) -> list[Sequence[int]]:
    """Cut trials that cost so many seconds each into pieces; one by one as long as the cost is not known."""
    cost = max(cost, 1e-9)
    size = max(1, int(min(max(len(indices) / _PIECES, _LEAST / cost), _MOST / cost)))
    return [indices[start:start + size] for start in range(0, len(indices), size)]


def trial_rng(seed: int, index: int) -> np.random.Generator:
    """Rebuild the random generator of one trial, to run that trial alone.

    Parameters
    ----------
    seed : int
        Seed of the study [-].
    index : int
        Index of the trial, from 0 [-].

    Returns
    -------
    numpy.random.Generator
        The generator that `monte_carlo` hands to this trial.

    Examples
    --------
    >>> from hsictrl.study import monte_carlo
    >>> ensemble = monte_carlo(lambda rng: rng.normal(1.0, 0.1), seed=3)
    >>> bool(trial_rng(3, 17).normal(1.0, 0.1) == ensemble.samples[17])
    True
    """
    check.whole("seed", seed, least=0, remedy="give the seed of the study")
    check.whole("index", index, least=0, remedy="count trials from 0")
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(index,)))


def _spread(run: Run, pieces: Sequence[Sequence[int]], executor: Executor) -> Iterator[tuple[Samples, float]]:
    """Yield the samples of each piece when they arrive."""
    waiting: set[Future[tuple[Samples, float]]] = set()
    try:
        with _lost_workers_explained():
            waiting |= {executor.submit(run, piece) for piece in pieces}
            while waiting:
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                # those that failed last: what arrived with them is to be kept
                yield from (future.result() for future in sorted(done, key=_has_failed))
    finally:
        for future in waiting:
            future.cancel()


def _has_failed(future: Future[tuple[Samples, float]]) -> bool:
    return future.cancelled() or future.exception() is not None


@contextmanager
def _lost_workers_explained() -> Iterator[None]:
    try:
        yield
    except (TrialError, TypeError, ValueError):     # what a trial itself, or the check of its result, has to say
        raise
    except Exception as error:
        raise RuntimeError(f"the workers must live until the trials are done, got {type(error).__name__}: {error}; "
                           "look for what ended them, such as too little memory, and run the study again, which "
                           "goes on from its ledger if it has one") from error


def _run_piece(trial: Trial, seed: int, indices: Sequence[int]) -> tuple[Samples, float]:
    start = time.perf_counter()
    samples = {index: _run(trial, seed, index) for index in indices}
    return samples, time.perf_counter() - start


def _run(trial: Trial, seed: int, index: int) -> Array:
    again = f"rerun it alone with trial(trial_rng({seed}, {index}))"
    try:
        value = trial(trial_rng(seed, index))
    except Exception as error:
        cause = f"{type(error).__name__}: {error}"
        raise TrialError(f"trial {index} of seed {seed} failed: {cause}; {again}") from error
    return check.numbers(f"result of trial {index} of seed {seed}", value, remedy=again)

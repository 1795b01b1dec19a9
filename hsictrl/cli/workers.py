"""Where trials run: in place, or in processes with one BLAS thread each."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context

from hsictrl import _checks as check

ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"), "1")


def checked_processes(processes: int) -> int:
    """Return the number of processes if there is at least one."""
    return check.whole("processes", processes, least=1, remedy="give 1 to run in place")


@contextmanager
def workers(processes: int) -> Iterator[Executor | None]:
    """Give an executor of so many processes, or None where one is enough."""
    if processes == 1:
        yield None
        return
    # spawned, not forked: BLAS reads its number of threads when a process starts
    pool = ProcessPoolExecutor(processes, mp_context=get_context("spawn"), initializer=_leave_interrupts_to_parent)
    try:
        with _environment(ONE_THREAD):
            yield pool
    finally:
        pool.shutdown(cancel_futures=True)


@contextmanager
def _environment(variables: dict[str, str]) -> Iterator[None]:
    before = dict(os.environ)
    os.environ.update(variables)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


def _leave_interrupts_to_parent() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)

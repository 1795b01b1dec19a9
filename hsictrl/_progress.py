"""Bars on stderr for work that takes long."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.text import Text

_MEMORY = 3600.0    # s of the past that tell the rate, so that a step may take minutes
_DRAWN: ContextVar[Progress | None] = ContextVar("_DRAWN", default=None)


class _Rate(ProgressColumn):
    """Steps per second, or seconds per step where those are more."""

    def render(self, task: Task) -> Text:
        if not task.speed:
            return Text("")
        return Text(f"{task.speed:.3g}/s" if task.speed >= 1 else f"{1 / task.speed:.3g} s each")


@contextmanager
def progress() -> Iterator[Progress]:
    """Bars that are drawn on a terminal, and nowhere else; work inside other work has its own below, while it lasts."""
    outer = _DRAWN.get()
    if outer is None:
        with _bars() as bars, _remembered(bars):
            yield bars
    else:
        with _cleared(outer):
            yield outer


@contextmanager
def _remembered(bars: Progress) -> Iterator[None]:
    token = _DRAWN.set(bars)
    try:
        yield
    finally:
        _DRAWN.reset(token)


@contextmanager
def _cleared(bars: Progress) -> Iterator[None]:
    before = bars.task_ids
    try:
        yield
    finally:
        for task in set(bars.task_ids).difference(before):
            bars.remove_task(task)


def _bars() -> Progress:
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), _Rate(), TimeElapsedColumn(),
               TimeRemainingColumn())
    # not console.is_terminal, which FORCE_COLOR makes true in the logs of CI
    return Progress(*columns, console=console, transient=True, speed_estimate_period=_MEMORY,
                    disable=not console.file.isatty())

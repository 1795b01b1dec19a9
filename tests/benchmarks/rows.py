"""Rows of a table that holds ours against another road, and how they are timed and printed."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from rich.console import Console
from rich.table import Table

UNITS = {"min": 60.0, "s": 1.0, "ms": 1e-3, "µs": 1e-6}


@dataclass(frozen=True)
class Row:
    """One comparison: seconds of ours, seconds of the other road, and what was asked for."""

    what: str
    ours: float
    other: str
    theirs: float | None
    bar: str


def best(run: Callable[[], object], repeats: int) -> float:
    """Median time of several runs [s]; a first run warms caches up."""
    if repeats > 1:
        run()
    return float(np.median([seconds_of(run) for _ in range(repeats)]))


def seconds_of(run: Callable[[], object]) -> float:
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def told(seconds: float) -> str:
    """Three digits and a unit; minutes from two of them on."""
    unit = next((unit for unit, size in UNITS.items() if seconds >= (2 * size if unit == "min" else size)), "µs")
    return f"{seconds / UNITS[unit]:.3g} {unit}"


def show(title: str, rows: Callable[[], Iterable[Row]], *notes: Callable[[], str]) -> None:
    """Print the table, and notes below it."""
    if os.environ.get("OPENBLAS_NUM_THREADS") != "1":
        sys.exit("OPENBLAS_NUM_THREADS must be 1, so that one thread is compared with one; use make bench")
    table = Table("what", "ours", "other road", "theirs", "ratio", "bar", title=title)
    for row in rows():
        compared = row.theirs is not None
        theirs, ratio = (told(row.theirs), f"{row.theirs / row.ours:.3g}×") if compared else ("-", "-")
        table.add_row(row.what, told(row.ours), row.other, theirs, ratio, row.bar)
    Console(width=150).print(table, *(note() for note in notes))

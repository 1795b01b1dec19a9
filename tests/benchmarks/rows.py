"""Rows that hold ours against another road: how they are timed, printed, and handed to the documentation."""

from __future__ import annotations

import json
import os
import platform
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from datetime import date
from importlib.metadata import version
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

PUBLISHED = Path(__file__).parents[2] / "docs" / "benchmarks.json"
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


def show(name: str, title: str, rows: Callable[[], Iterable[Row]], *notes: Callable[[], str]) -> None:
    """Print and publish a table of times, and notes below it."""
    check_threads()
    cells = [[row.what, told(row.ours), row.other, *compared(row), row.bar] for row in rows()]
    publish(name, title, ["what", "ours", "other road", "theirs", "ratio", "bar"], cells, [note() for note in notes])


def check_threads() -> None:
    if os.environ.get("OPENBLAS_NUM_THREADS") != "1":
        sys.exit("OPENBLAS_NUM_THREADS must be 1, so that one thread is compared with one; use make bench")


def compared(row: Row) -> tuple[str, str]:
    """Seconds of the other road, and how many times ours they are."""
    return ("-", "-") if row.theirs is None else (told(row.theirs), f"{float(f'{row.theirs / row.ours:.3g}'):g}×")


def publish(name: str, title: str, columns: list[str], cells: list[list[str]], notes: list[str]) -> None:
    """Print a table, and put it where the documentation reads it, beside those of other runs."""
    table = Table(*columns, title=title)
    for row in cells:
        table.add_row(*row)
    Console(width=150).print(table, *notes)
    tables = json.loads(PUBLISHED.read_text(encoding="utf-8")) if PUBLISHED.exists() else {}
    tables[name] = {"where": where(), "columns": columns, "rows": cells, "notes": notes}
    PUBLISHED.write_text(json.dumps(tables, indent=1, ensure_ascii=False, sort_keys=True) + "\n", encoding="utf-8")


def where() -> dict[str, str]:
    """When and on what a table was measured, and what else the machine did: a load of one or two is the run itself."""
    versions = [f"{package} {version(package)}" for package in ("hsictrl", "control", "numpy", "scipy", "numba")]
    machine = f"{processor()}, {os.cpu_count()} cores, load average {os.getloadavg()[0]:.1f}"
    return {"date": date.today().isoformat(), "machine": machine,
            "versions": ", ".join([f"Python {platform.python_version()}", *versions])}


def processor() -> str:
    """Its name, from where Linux keeps it, or what Python knows."""
    cpuinfo = Path("/proc/cpuinfo")
    lines = cpuinfo.read_text(encoding="utf-8").splitlines() if cpuinfo.exists() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()

"""A bar on stderr for work that takes long."""

from __future__ import annotations

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn


def progress() -> Progress:
    """A bar that is drawn on a terminal, and nowhere else."""
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed}"), TimeElapsedColumn()
    # not console.is_terminal, which FORCE_COLOR makes true in the logs of CI
    return Progress(*columns, console=console, transient=True, disable=not console.file.isatty())

"""How a command ends when it can't go on: one message on stderr, and an exit code."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

import typer

from hsictrl.study import ChangedStudyError

FAILED, REFUSED = 1, 2


@contextmanager
def refusing() -> Iterator[None]:
    """Refuse bad input with the message of whoever found it, and exit code 2."""
    try:
        yield
    except (TypeError, ValueError) as error:
        _stop(error, REFUSED)


@contextmanager
def failing() -> Iterator[None]:
    """Report a trial that failed, or a worker that died, with exit code 1; a ledger of another study with 2."""
    try:
        yield
    except ChangedStudyError as error:
        _stop(error, REFUSED)
    except RuntimeError as error:
        _stop(error, FAILED)


@contextmanager
def unwritable(path: Path) -> Iterator[None]:
    """Report a file that could not be written after all, with exit code 1."""
    try:
        yield
    except OSError as error:
        _stop(RuntimeError(f"{path} must be a file that can be written, got {error.strerror}; choose another"), FAILED)


def _stop(error: Exception, code: int) -> NoReturn:
    typer.echo(f"Error: {error}", err=True)
    raise typer.Exit(code) from None

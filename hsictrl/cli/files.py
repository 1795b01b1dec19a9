"""Files that are written whole or not at all, in folders that are checked before the long work."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import typer

from hsictrl.cli.endings import unwritable
from hsictrl.study import Ledger


def checked_folder(folder: Path) -> Path:
    """Return the folder if files can be written into it."""
    if not folder.is_dir():
        raise ValueError(f"the output folder must exist, got {folder}; make it first")
    if not os.access(folder, os.W_OK):
        raise ValueError(f"the output folder must be writable, got {folder}; choose another")
    return folder


def checked_figure(path: Path) -> Path:
    """Return the path if a figure can be written there."""
    from hsictrl.plots import file_endings  # only now: no other command needs it

    return _checked_file("a figure", path, file_endings())


def checked_report(path: Path) -> Path:
    """Return the path if a report can be written there."""
    return _checked_file("a report", path, ("html",))


def checked_animation(path: Path) -> Path:
    """Return the path if an animation can be written there."""
    from hsictrl.plots import animation_endings

    return _checked_file("an animation", path, animation_endings())


def _checked_file(name: str, path: Path, endings: Sequence[str]) -> Path:
    if path.suffix.lstrip(".") not in endings or path.is_dir():
        raise ValueError(f"{name} must be a file that ends in one of .{', .'.join(endings)}, got {path}; rename it")
    checked_folder(path.parent)
    return path


def checked_ledger(path: Path | None, resume: bool) -> Ledger | None:
    """Return the ledger if it may be written; one that holds trials only to go on with them."""
    if path is None:
        if resume:
            raise ValueError("--resume must come with the ledger to go on with, got none; add --ledger FILE")
        return None
    ledger = Ledger(path)
    held = sum(ledger.trials().values())
    if held and not resume:
        raise ValueError(f"the ledger must be a new file, got {path}, which holds {held} trials; give --resume to go "
                         "on with them, or choose another file by --ledger")
    return ledger


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a draft beside `path`, which takes its place when it has been written without an error."""
    draft = path.with_name(f".{os.getpid()}-{path.name}")
    with unwritable(path):
        try:
            yield draft
            draft.replace(path)
        finally:
            draft.unlink(missing_ok=True)
    typer.echo(f"wrote {path}", err=True)

"""The ledger: finished trials go into one file, which outlives the process that ran them."""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import final

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.study.identity import Words, changes, digest

_MARK = 0x68736963      # "hsic" in the file's header says that it is a ledger
_FORMAT = 1
_PATIENCE = 60.0        # s to wait until another process has written
_NEW_FILE = "choose a new file for the ledger"
_TABLES = f"""
BEGIN IMMEDIATE;
CREATE TABLE IF NOT EXISTS study (
    id INTEGER PRIMARY KEY, label TEXT NOT NULL UNIQUE, digest TEXT NOT NULL, words TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS sample (
    study INTEGER NOT NULL REFERENCES study, trial INTEGER NOT NULL, shape TEXT NOT NULL, value BLOB NOT NULL,
    PRIMARY KEY (study, trial)) WITHOUT ROWID;
PRAGMA application_id = {_MARK};
PRAGMA user_version = {_FORMAT};
COMMIT;
"""
_COUNTS = "SELECT label, count(trial) FROM study LEFT JOIN sample ON study = id GROUP BY id ORDER BY id"


class ChangedStudyError(ValueError):
    """A ledger holds another study under the same label."""


@final
@dataclass(frozen=True, slots=True)
class Ledger:
    """A file that keeps the finished trials of studies, so that a study which was stopped goes on where it was.

    `monte_carlo` writes each batch of trials as it finishes and doesn't run again what the file holds. A study is
    known by its label. It is refused if anything that determines its samples is not as in the file: the trial and
    all that it holds, the seed, the versions of Python, hsictrl, NumPy, SciPy, Numba and python-control.

    Parameters
    ----------
    path : str or path
        The file; made by the first study if it doesn't exist. On a disk of the machine that runs `monte_carlo`.

    Notes
    -----
    The stop rule and the largest number of trials are not part of a study's identity: they say how many samples
    there are, not which. A study that is run again with a stricter rule starts from the samples it has.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from hsictrl.study import PercentileRule, monte_carlo
    >>> with TemporaryDirectory() as folder:
    ...     ledger = Ledger(f"{folder}/study.ledger")
    ...     rough = monte_carlo(np.random.Generator.rayleigh, rule=PercentileRule(tolerance=0.2), ledger=ledger)
    ...     fine = monte_carlo(np.random.Generator.rayleigh, rule=PercentileRule(tolerance=0.1), ledger=ledger)
    ...     ledger.trials() == {"trials": fine.n_trials}, bool(np.all(fine.samples[:rough.n_trials] == rough.samples))
    (True, True)
    """

    path: Path

    def __post_init__(self) -> None:
        path = Path(check.instance("path", self.path, (str, Path), "give the name of a file"))
        check.store(self, path=path)
        _check_place(path)
        if path.exists():
            _check_content(path)

    def trials(self) -> dict[str, int]:
        """Count the trials it holds.

        Returns
        -------
        dict
            Number of trials by label of the study [-].

        Examples
        --------
        >>> Ledger("not_yet_there.ledger").trials()
        {}
        """
        if not self.path.exists():
            return {}
        with _explained(self.path), closing(_connection(self.path)) as file:
            # none in a file whose first study was killed when it had just made it
            [tables] = file.execute("SELECT count(*) FROM sqlite_master").fetchone()
            return dict(file.execute(_COUNTS)) if tables else {}


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Account:
    """What a ledger holds of one study."""

    path: Path
    file: sqlite3.Connection
    study: int

    def read(self, indices: range) -> dict[int, Array]:
        """Return the samples of those of the trials that have been run."""
        with _explained(self.path):
            rows = self.file.execute("SELECT trial, shape, value FROM sample WHERE study = ? AND trial >= ? "
                                     "AND trial < ?", (self.study, indices.start, indices.stop)).fetchall()
        return {trial: np.frombuffer(value, "<f8").reshape(json.loads(shape)) for trial, shape, value in rows}

    def write(self, samples: Mapping[int, Array]) -> None:
        """Keep the samples of a batch: all of them, or none if the machine stops now."""
        rows = [(self.study, trial, json.dumps(value.shape), value.astype("<f8").tobytes())
                for trial, value in samples.items()]
        # another process may have run the same trials: they have the same samples
        with _explained(self.path), self.file:
            self.file.executemany("INSERT OR IGNORE INTO sample VALUES (?, ?, ?, ?)", rows)


@contextmanager
def account(ledger: Ledger, label: str, words: Words) -> Iterator[Account]:
    """Open the account of one study, made of these words; refuse it if the label's study was made of others."""
    with _explained(ledger.path), closing(_opened(ledger.path)) as file:
        yield Account(path=ledger.path, file=file, study=_entered(file, label, words))


def _entered(file: sqlite3.Connection, label: str, words: Words) -> int:
    with file:
        file.execute("INSERT OR IGNORE INTO study (label, digest, words) VALUES (?, ?, ?)",
                     (label, digest(words), json.dumps(words)))
    [found] = file.execute("SELECT id, digest, words FROM study WHERE label = ?", (label,))
    if found[1] != digest(words):
        raise ChangedStudyError(f"a study must stay what it was, but '{label}' changed: "
                                f"{changes(json.loads(found[2]), words)}; {_NEW_FILE}, or undo the change")
    return int(found[0])


def _opened(path: Path) -> sqlite3.Connection:
    file = _connection(path)
    # a killed process loses nothing: its writes are with the operating system. A machine that loses power may
    # lose the last batches, never the file: waiting for the disk at each of them would buy only those
    file.executescript(f"PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; {_TABLES}")
    return file


def _connection(path: Path) -> sqlite3.Connection:
    return sqlite3.connect(path, timeout=_PATIENCE)


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    try:
        yield
    except sqlite3.Error as error:
        raise RuntimeError(f"the ledger {path} must stay readable and writable, got: {error}; see to its disk and "
                           "run the study again, which goes on after the last batch it holds") from error


def _check_place(path: Path) -> None:
    if not path.parent.is_dir():
        raise ValueError(f"the folder of a ledger must exist, got {path.parent}; make it first")
    if path.is_dir() or not os.access(path if path.exists() else path.parent, os.W_OK):
        raise ValueError(f"a ledger must be a file that can be written, got {path}; {_NEW_FILE}")


def _check_content(path: Path) -> None:
    try:
        with closing(_connection(path)) as file:
            file.execute("BEGIN")       # one look at all, while another process may be making it
            [mark], [form] = (file.execute(f"PRAGMA {name}").fetchone() for name in ("application_id", "user_version"))
            [tables] = file.execute("SELECT count(*) FROM sqlite_master").fetchone()
    except sqlite3.Error as error:
        raise ValueError(f"a ledger must be a file made by hsictrl, got {path}: {error}; {_NEW_FILE}") from None
    if (mark, form) != (_MARK, _FORMAT) and (mark or tables):
        raise ValueError(f"a ledger must be a file made by this version of hsictrl, got {path}; {_NEW_FILE}")

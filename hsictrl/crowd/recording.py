"""Who was where, and when: tables as crowd simulators and video tracking write them."""

from __future__ import annotations

import re
import sqlite3
from collections.abc import Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array

SQLITE = b"SQLite format 3\0"
JUPEDSIM = {"id": "id", "frame": "frame", "x": "pos_x", "y": "pos_y"}
TEXT = ("id", "frame", "x", "y")
RATE = re.compile(r"framerate\s*[:=]?\s*([-+.\w]+(?:[,/]\w+)?)", re.IGNORECASE)
UNIT = re.compile(r"(?:\bx/|\bin )(cm\b|centimet|m\b|met)", re.IGNORECASE)      # as PedPy reads it
NEITHER = "give the SQLite file of JuPedSim, or text with columns id, frame, x and y"


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Recording:
    """Rows of a table, each of which says where somebody was at a time; in any order.

    Parameters
    ----------
    name : str
        What to call the table in a refusal.
    rows : array of int, shape (n,)
        Number of each row in the table, for refusals [-].
    columns : dict of array, shape (n,)
        Columns id, time [s], x and y [m], and further ones by their own names.
    """

    name: str
    rows: NDArray[np.intp]
    columns: Mapping[str, NDArray[Any]]

    def __post_init__(self) -> None:
        for head in ("id", "time", "x", "y"):
            self._check_finite(head)
        who, times = self._who(), self.columns["time"]
        order = np.lexsort((times, who))
        again = np.all([one[order[1:]] == one[order[:-1]] for one in (who, times)], axis=0)
        if np.any(again):
            i = int(np.argmax(again))
            first, second = sorted(order[i:i + 2])
            raise ValueError(f"{self.place(second, 'id')}: nobody can be recorded twice at a time, got person "
                             f"{self.columns['id'][second]:g} at {times[second]:g} s in row "
                             f"{self.rows[first]}, too; leave one of them out")

    def place(self, index: int, head: str) -> str:
        """Where a number is in the table."""
        return f"{self.name}, row {self.rows[index]}, column {head}"

    def persons(self) -> list[NDArray[np.intp]]:
        """Rows of each person, in order of time; persons in order of their ids."""
        who = self._who()
        order = np.lexsort((self.columns["time"], who))
        return np.split(order, np.flatnonzero(np.diff(who[order])) + 1)

    def _who(self) -> NDArray[np.intp]:
        return np.unique(self.columns["id"], return_inverse=True)[1].ravel()

    def _check_finite(self, head: str) -> None:
        column = self.columns[head]
        wrong = np.flatnonzero(~np.isfinite(column))
        if wrong.size:
            raise ValueError(f"{self.place(wrong[0], head)}: the cell must be finite, got {column[wrong[0]]}; leave "
                             "the row out, or fill it")


def read(table: Any, frame_rate: float | None) -> Recording:
    """Read a file of JuPedSim or PedPy, or a table in memory.

    Parameters
    ----------
    table : str, Path, or table with columns
        As in `Traffic.from_trajectories`.
    frame_rate : float, optional
        Frames per second, where the table doesn't say [Hz].

    Returns
    -------
    Recording
    """
    if frame_rate is not None:
        check.number("frame_rate", frame_rate, above=0, remedy="give frames per second")
    if not isinstance(table, (str, Path)):
        return _in_memory(table, frame_rate)
    path = Path(table)
    try:
        with path.open("rb") as file:
            binary = file.read(len(SQLITE)) == SQLITE
        return (_jupedsim if binary else _text)(path, frame_rate)
    except OSError as error:
        raise ValueError(f"{path}: the trajectories must be a file that can be read, got {error.strerror}; correct the "
                         "path") from None


def _jupedsim(path: Path, frame_rate: float | None) -> Recording:
    """Tables trajectory_data and metadata."""
    name = f"{path}, table trajectory_data"
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True)) as file:
            heads = [head for _, head, *_ in file.execute("PRAGMA table_info(trajectory_data)")]
            _need(name, JUPEDSIM.values(), heads)
            cells = file.execute("SELECT * FROM trajectory_data ORDER BY rowid").fetchall()
            told = file.execute("SELECT value FROM metadata WHERE key = 'fps'").fetchone()
    except sqlite3.Error as error:
        raise ValueError(f"{path}: the file must be one of JuPedSim, got {error}; {NEITHER}") from None
    rate = _rate(str(path), told[0] if told else None, frame_rate, "write fps into the table metadata")
    return _recording(name, np.arange(1, len(cells) + 1), _columns(heads, cells), JUPEDSIM, rate)


def _text(path: Path, frame_rate: float | None) -> Recording:
    """Columns id, frame, x and y between blanks; lines with # in front of them tell the frame rate and the unit."""
    head, rows, cells = "", [], []
    try:
        with path.open(encoding="utf-8-sig") as file:
            for number, line in enumerate(file, start=1):
                row = line.partition("#")[0].split()
                if row:
                    rows.append(number)
                    cells.append(row)
                elif not rows:
                    head += line
    except UnicodeDecodeError:
        raise ValueError(f"{path}: the file must be SQLite or text in UTF-8, got neither; {NEITHER}") from None
    for number, row in zip(rows, cells, strict=True):
        if len(row) < len(TEXT):
            raise ValueError(f"{path}, row {number}: a row must hold id, frame, x and y between blanks, got {len(row)} "
                             f"cell(s); {NEITHER}")
    rate = _rate(str(path), next(iter(RATE.findall(head)), None), frame_rate, "add a line '# framerate: 25'")
    columns = _columns(list(TEXT), [row[:len(TEXT)] for row in cells])
    return _recording(str(path), np.array(rows), columns, {one: one for one in TEXT}, rate, _scale(path, head))


def _in_memory(table: Any, frame_rate: float | None) -> Recording:
    """Columns id, x, y, and time or frame."""
    heads = _heads(table)
    _need("table", ("id", "x", "y"), heads)
    if "time" not in heads and "frame" not in heads:
        raise ValueError(f"table: the table must have a column 'time' or 'frame', got {', '.join(map(repr, heads))}; "
                         "add it, or rename the one that holds it")
    if "time" in heads and frame_rate is not None:
        raise ValueError("frame_rate must be left out where the table has a column 'time', got both; leave one out")
    arrays = {head: np.asarray(table[head]).ravel() for head in heads}
    for head, array in arrays.items():
        if array.dtype.kind in "mM":    # which would be read as nanoseconds, or not at all
            raise ValueError(f"table, column {head}: the cells must be plain numbers, got {array.dtype}; give seconds, "
                             "such as (times - times[0]) / numpy.timedelta64(1, 's')")
    columns = {head: array.tolist() for head, array in arrays.items()}
    sizes = {head: len(column) for head, column in columns.items()}
    if len(set(sizes.values())) > 1:
        raise ValueError(f"table: the columns must have the same length, got {sizes}; give a cell in each row")
    clock = "time" if "time" in heads else "frame"
    rate = 1.0 if clock == "time" else _rate("table", None, frame_rate, "give a column 'time'")
    return _recording("table", np.arange(sizes["id"]), columns, {one: one for one in ("id", clock, "x", "y")}, rate)


def _heads(table: Any) -> list[str]:
    """Names of the columns of a data frame, a structured array or a mapping."""
    for heads in (getattr(table, "columns", None), getattr(getattr(table, "dtype", None), "names", None),
                  table if isinstance(table, Mapping) else None):
        if heads is not None:
            return list(heads)
    raise TypeError(f"table must be a file, or have columns by name, got {type(table).__name__}; give the name of a "
                    "file, a dict of columns, a structured array or a data frame")


def _columns(heads: Sequence[str], cells: Sequence[Sequence[Any]]) -> dict[str, Sequence[Any]]:
    return dict(zip(heads, zip(*cells, strict=True), strict=True)) if cells else dict.fromkeys(heads, ())


def _recording(
    name: str, rows: NDArray[np.intp], columns: Mapping[str, Sequence[Any]], known: Mapping[str, str], rate: float,
    scale: float = 1.0,
) -> Recording:
    """A recording of columns by their names in a table; further ones are kept as they are."""
    if not len(rows):
        raise ValueError(f"{name}: the table must hold somebody, got no rows; {NEITHER}")
    found = {ours: _numbers(name, rows, theirs, columns[theirs]) for ours, theirs in known.items()}
    if "frame" in found:
        found["time"] = found.pop("frame") / rate
    found |= {"x": scale * found["x"], "y": scale * found["y"]}
    further = {head: np.asarray(cells) for head, cells in columns.items() if head not in known.values()}
    return Recording(name=name, rows=rows, columns=further | found)


def _numbers(name: str, rows: NDArray[np.intp], head: str, cells: Sequence[Any]) -> Array:
    try:
        return np.array(cells, dtype=float)
    except (TypeError, ValueError):
        for row, cell in zip(rows, cells, strict=True):
            try:
                float(cell)
            except (TypeError, ValueError):
                raise ValueError(f"{name}, row {row}, column {head}: the cell must be a number, got {cell!r}; write it "
                                 "like 2.5, or leave the row out") from None
        raise


def _need(name: str, needed: Iterable[str], heads: list[str]) -> None:
    for head in needed:
        if head not in heads:
            raise ValueError(f"{name}: the table must have a column {head!r}, got "
                             f"{', '.join(map(repr, heads)) or 'none'}; add it, or rename the one that holds it")


def _rate(source: str, told: Any, given: float | None, remedy: str) -> float:
    """Frames per second, from the table or by hand."""
    if told is None:
        if given is None:
            raise ValueError(f"{source}: the frame rate must be known, got none; give frame_rate, or {remedy}")
        return given
    try:
        rate = check.number(f"{source}: the frame rate", float(told), above=0, remedy=remedy)
    except ValueError:
        raise ValueError(f"{source}: the frame rate must be a number above 0, got {told!r}; {remedy}") from None
    if given not in (None, rate):
        raise ValueError(f"frame_rate must be that of {source}, {rate:g} Hz, got {given:g} Hz; leave it out")
    return rate


def _scale(path: Path, head: str) -> float:
    """Metres in the unit of places."""
    units = {unit.lower()[0] for unit in UNIT.findall(head)}
    if len(units) != 1:
        raise ValueError(f"{path}: the unit of x and y must be told once, as m or cm, got "
                         f"{'both' if units else 'none'}; add a line '# id frame x/m y/m'")
    return 0.01 if units == {"c"} else 1.0

"""Tables of numbers, read strictly from CSV: a refusal names the file, the row and the column."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Cells:
    """A table of numbers, with a row of heads above it.

    Parameters
    ----------
    path : Path
        The file.
    heads : tuple of str
        What stands above the columns.
    rows : tuple of int
        Rows of the file that hold the numbers; the heads are in row 1 [-].
    values : ndarray, shape (n_rows, n_heads)
        The numbers.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "modes.csv"
    >>> _ = path.write_text("mode, frequency\\n1, 2.0\\n")
    >>> Cells.of(path).column("frequency")
    array([2.])
    """

    path: Path
    heads: tuple[str, ...]
    rows: tuple[int, ...]
    values: Array

    @classmethod
    def of(cls, path: Path) -> Cells:
        """Read a file."""
        lines = _lines(path)
        if len(lines) < 2:
            raise ValueError(f"{path}: the table must hold a row of heads and rows of numbers, got {len(lines)} "
                             "row(s); export it again")
        heads = tuple(lines[0][1])
        values = np.array([_numbers(path, row, cells, heads) for row, cells in lines[1:]])
        return cls(path=path, heads=heads, rows=tuple(row for row, _ in lines[1:]), values=values)

    def column(self, head: str) -> Array:
        """The numbers below a head."""
        return self.values[:, self.heads.index(head)]

    def place(self, index: int, head: str) -> str:
        """Where a number is in the file."""
        return f"{self.path}, row {self.rows[index]}, column {head}"

    def within(
        self, head: str, *, least: float, most: float | None = None, below: float | None = None, remedy: str,
    ) -> Array:
        """The numbers below a head, having checked that they lie within bounds."""
        for index, value in enumerate(self.column(head)):
            check.number(f"{self.place(index, head)}: {head}", value, least=least, most=most, below=below,
                         remedy=remedy)
        return self.column(head)

    def need(self, *heads: str) -> None:
        """Refuse a table without these columns."""
        for head in heads:
            if head not in self.heads:
                raise ValueError(f"{self.path}, row 1: the table must have a column {head!r}, got "
                                 f"{', '.join(map(repr, self.heads))}; add it, or rename the one that holds it")

    def refuse_unknown(self, known: Sequence[str]) -> None:
        """Refuse a table with further columns."""
        for index, head in enumerate(self.heads, start=1):
            if head not in known:
                raise ValueError(f"{self.path}, row 1, column {index}: each column must be one of "
                                 f"{', '.join(map(repr, known))}, got {head!r}; rename it, or leave it out")

    def refuse_repeated(self, head: str, keys: NDArray[Any]) -> None:
        """Refuse a row whose key is that of a row above."""
        _, first, which = np.unique(keys, return_index=True, return_inverse=True)
        repeated = np.flatnonzero(first[which] != np.arange(len(keys)))
        if repeated.size:
            again = int(repeated[0])
            raise ValueError(f"{self.place(again, head)}: rows must differ, got what row "
                             f"{self.rows[first[which[again]]]} holds; leave one of them out")


def _lines(path: Path) -> list[tuple[int, list[str]]]:
    """The rows that hold something, with their numbers."""
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file, strict=True)
            rows = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader]
    except OSError as error:
        raise ValueError(f"{path}: the table must be a file that can be read, got {error.strerror}; correct the "
                         "path") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"{path}: the table must be CSV in UTF-8, got {error}; export it as text with "
                         "commas") from None
    rows = [(row, cells) for row, cells in rows if any(cells)]
    if rows:
        _check_heads(path, *rows[0])
    return rows


def _check_heads(path: Path, row: int, heads: list[str]) -> None:
    for index, head in enumerate(heads):
        if head in heads[:index]:
            raise ValueError(f"{path}, row {row}: each column must come once, got {head!r} in columns "
                             f"{heads.index(head) + 1} and {index + 1}; leave one out, or number the second anew")


def _numbers(path: Path, row: int, cells: list[str], heads: tuple[str, ...]) -> list[float]:
    if len(cells) != len(heads):
        raise ValueError(f"{path}, row {row}: the row must have a cell below each of the {len(heads)} heads, got "
                         f"{len(cells)}; part cells by commas, and write decimals with a point")
    return [_value(f"{path}, row {row}, column {head}", cell) for cell, head in zip(cells, heads, strict=True)]


def _value(place: str, cell: str) -> float:
    try:
        value = float(cell.replace("_", "?"))     # which Python takes for a number
    except ValueError:
        raise ValueError(f"{place}: the cell must be a number, got {cell!r}; write it like 2.5e-3") from None
    return check.number(f"{place}: the cell", value, remedy="leave the mode or the node out")

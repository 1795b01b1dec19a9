"""What a page is made of: sections of text, lists, tables and pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

Cell = tuple[str, ...]    # the value, and what stands below it in small print


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A table; the first cell of a row is its head."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[Cell]]


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A picture as a data URI, what it shows in words, and its caption."""

    source: str
    alternative: str
    caption: str


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A heading and what stands below it, in this order."""

    title: str
    text: Sequence[str] = ()
    points: Sequence[str] = ()
    tables: Sequence[Table] = ()
    pictures: Sequence[Picture] = ()
    quoted: str = ""

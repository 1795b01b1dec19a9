"""Tables of a TOML document, read strictly: a refusal says where in the file it is."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn, TypeVar, final

Made = TypeVar("Made")
HEADER = re.compile(r"\s*\[\[?([\w\s.\"'-]+)\]")
ASSIGNMENT = re.compile(r"\s*([\w.\"'-][\w\s.\"'-]*?)\s*=")


@final
@dataclass(frozen=True, slots=True)
class Expected:
    """What the value of a key may be: in words, by an example, and as a test."""

    words: str
    example: str
    fits: Callable[[Any], bool]


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _text(value: Any) -> bool:
    return isinstance(value, str)


def _all(value: Any, fits: Callable[[Any], bool]) -> bool:
    return isinstance(value, list) and bool(value) and all(map(fits, value))


NUMBER = Expected("a number", "2.5", _number)
WHOLE = Expected("a whole number", "2", _whole)
TEXT = Expected("a word in quotes", '"word"', _text)
FILE = Expected("a path in quotes", '"nodes.csv"', _text)
TABLE = Expected("a table", "[name]", lambda value: isinstance(value, dict))
TABLES = Expected("a list of tables", "[[name]]", lambda value: _all(value, lambda one: isinstance(one, dict)))
PLACE = Expected("a place x or [x, y]", "[25.0, 0.5]",
                 lambda value: _number(value) or (_all(value, _number) and len(value) == 2))
NUMBERS = Expected("a list of numbers", "[20.0, 30.0]", lambda value: _all(value, _number))
WORDS = Expected("a word in quotes or a list of them", '["one", "other"]',
                 lambda value: _text(value) or _all(value, _text))
ENDS = Expected("a list of two words", '["pinned", "clamped"]', lambda value: _all(value, _text) and len(value) == 2)
ONE_OR_MORE = Expected("a number or a list of numbers", "[0.2, 0.5]",
                       lambda value: _number(value) or _all(value, _number))
COUNTS = Expected("a whole number or a list of them", "[15, 75]", lambda value: _whole(value) or _all(value, _whole))
NORMAL = Expected("a number or [mean, standard deviation]", "[3.25, 0.32]",
                  lambda value: _number(value) or (_all(value, _number) and len(value) == 2))

Keys = Mapping[str, Expected]


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """A table of a document; it knows its name and its place.

    Parameters
    ----------
    path : Path
        The document.
    text : str
        What is written in it.
    names : tuple of str
        Where the table is: () for the top of the document, ("traffic", "population") for [traffic.population].
    values : dict
        What the table holds.
    """

    path: Path
    text: str
    names: tuple[str, ...] = ()
    values: dict[str, Any]

    @classmethod
    def of(cls, path: Path) -> Table:
        """The top of a document."""
        try:
            text = path.read_text(encoding="utf-8")
            return cls(path=path, text=text, values=tomllib.loads(text))
        except OSError as error:
            raise ValueError(f"{path}: the description must be a file that can be read, got {error.strerror}; "
                             "correct the path") from None
        except ValueError as error:
            raise ValueError(f"{path}: the description must be TOML in UTF-8, got {error}; "
                             "correct it there") from None

    def table(self, key: str) -> Table:
        """A table within this one."""
        return Table(path=self.path, text=self.text, names=(*self.names, key), values=self.values[key])

    def tables(self, key: str) -> Iterator[Table]:
        """The tables of a list within this one; each knows the document from its own header on."""
        lines = self.text.splitlines()
        headers = [number for number, line in enumerate(lines) if _opens(line, *self.names, key)]
        for i, values in enumerate(self.values[key]):
            first = headers[i] if i < len(headers) else 0
            text = "\n".join([""] * first + lines[first:])
            yield Table(path=self.path, text=text, names=(*self.names, key), values=values)

    def read(self, keys: Keys, *, needs: Iterable[str] = ()) -> dict[str, Any]:
        """The values, having checked that every key is known, none is missing, and each is of its type."""
        for key in self.values:
            if key not in keys:
                self.refuse(key, f"key must be one of {', '.join(map(repr, keys))}, got {key!r}; "
                                 "correct its spelling or leave it out")
        for key in needs:
            if key not in self.values:
                self.refuse(None, f"the table must hold {', '.join(map(repr, needs))}, got no {key!r}; add it")
        return {key: self._typed(key, keys[key]) for key in self.values}

    def make(self, make: Callable[..., Made], values: Mapping[str, Any]) -> Made:
        """What `make` makes of the values; its refusals get the place in the document in front."""
        try:
            return make(**values)
        except (TypeError, ValueError) as error:
            self.refuse(self._key_in(str(error)), str(error))

    def refuse(self, key: str | None, message: str) -> NoReturn:
        """Refuse a key, or the table as a whole."""
        raise ValueError(f"{self._place(key)}: {message}")

    def _typed(self, key: str, expected: Expected) -> Any:
        value = self.values[key]
        if not expected.fits(value):
            self.refuse(key, f"{key} must be {expected.words}, got {value!r}; write it like {expected.example}")
        if expected is FILE:
            return self.path.parent / value
        return tuple(value) if isinstance(value, list) else value

    def _key_in(self, message: str) -> str | None:
        return next((word for word in re.findall(r"\w+", message) if word in self.values), None)

    def _place(self, key: str | None) -> str:
        names = (*self.names, key) if key else self.names
        line = line_of(self.text, *names) if names else None
        table = f"[{'.'.join(self.names)}] " if self.names else ""
        return ", ".join(filter(None, [str(self.path), f"line {line}" if line else "", f"{table}{key or ''}".strip()]))


def line_of(text: str, *names: str) -> int | None:
    """First line of a TOML text that sets the key, or opens the table, of this dotted name.

    Examples
    --------
    >>> line_of("seed = 1\\n[bridge]\\ndamping = 5", "bridge", "damping")
    3
    """
    opened: list[str] = []
    for number, line in enumerate(text.splitlines(), start=1):
        header, assignment = HEADER.match(line), ASSIGNMENT.match(line)
        opened = _parts(header[1]) if header else opened
        found = opened + _parts(assignment[1]) if assignment else opened
        if found[:len(names)] == list(names):
            return number
    return None


def _opens(line: str, *names: str) -> bool:
    header = HEADER.match(line)
    return header is not None and _parts(header[1]) == list(names)


def _parts(dotted: str) -> list[str]:
    return [part.strip(" \t\"'") for part in dotted.split(".")]

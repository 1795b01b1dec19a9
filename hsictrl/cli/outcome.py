"""What a command prints on stdout: a table with notes, JSON or CSV."""

from __future__ import annotations

import csv
import json
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, final

from rich.console import Console
from rich.table import Table

from hsictrl import __version__
from hsictrl.bridge import Footbridge
from hsictrl.cli.description import Description

PIPED_WIDTH = 120   # where no terminal says how wide it is
Rows = list[dict[str, Any]]


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """Rows of numbers, and what a reader needs to understand them.

    Parameters
    ----------
    description : Description
        What was studied.
    settings : dict
        How it was studied: further settings for JSON, units in the keys.
    rows : list of dict
        The numbers, units in the keys.
    table : rich.table.Table
        The same for reading.
    notes : sequence of str
        Lines below the table.
    further : mapping of str to (rich.table.Table, list of dict)
        Further tables and their rows, by their keys in JSON; CSV leaves them out.
    """

    description: Description
    settings: dict[str, Any]
    rows: Rows
    table: Table
    notes: Sequence[str]
    further: Mapping[str, tuple[Table, Rows]] = field(default_factory=dict)

    def show(self, *, as_json: bool, as_csv: bool) -> None:
        """Print JSON, CSV or the table."""
        if as_json:
            print_json({"bridge": bridge_document(self.description.bridge), "settings": self._settings(),
                        "rows": self.rows, **{key: rows for key, (_, rows) in self.further.items()}})
        elif as_csv:
            print_csv(self.rows)
        else:
            print_table(self.table, self.notes, further=[table for table, rows in self.further.values() if rows])

    def _settings(self) -> dict[str, Any]:
        return {**self.settings, "seed": self.description.seed, "force": repr(self.description.force),
                "flows": list(map(repr, self.description.flows)), "hsictrl": __version__}


def one_form(as_json: bool, as_csv: bool) -> None:
    """Refuse to print two forms at once."""
    if as_json and as_csv:
        raise ValueError("the output must have one form, got --json and --csv; leave one of them out")


def print_json(document: Any) -> None:
    """Print JSON; what is not a number is null."""
    print(json_text(document))


def json_text(document: Any) -> str:
    """Write JSON; what is not a number is null."""
    return json.dumps(_plain(document), indent=2, ensure_ascii=False, allow_nan=False)


def print_csv(rows: Rows) -> None:
    """Print CSV with every digit."""
    writer = csv.DictWriter(sys.stdout, fieldnames=list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(_plain(rows))


def print_table(table: Table, notes: Sequence[str], *, further: Sequence[Table] = ()) -> None:
    """Print a table as wide as the terminal, further ones below it, and what there is to say about them."""
    console = Console(width=None if sys.stdout.isatty() else PIPED_WIDTH, highlight=False, markup=False)
    console.print(table)
    for one in further:
        console.print("", one, sep="\n")
    console.print("", *notes, sep="\n")


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def bridge_document(bridge: Footbridge) -> dict[str, Any]:
    """A bridge for JSON, units in the keys."""
    modes = [{"frequency_hz": mode.frequency, "damping": mode.damping, "modal_mass_kg": mode.modal_mass}
             for mode in bridge.modes]
    document = {"length_m": bridge.length, "width_m": bridge.width, "mass_kg": bridge.mass, "modes": modes}
    absorbers = [{"mass_kg": body.mass, "frequency_hz": body.frequency, "damping": body.damping,
                  "direction": body.direction, "x_m": x, "y_m": y} for body, (x, y) in bridge.absorbers]
    return document | ({"absorbers": absorbers} if absorbers else {})

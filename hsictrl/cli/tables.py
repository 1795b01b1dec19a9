"""Tables for reading: one row per flow of people, and below each estimate its interval and number of trials."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, final

from rich import box
from rich.console import JustifyMethod
from rich.table import Table

from hsictrl._digits import significant
from hsictrl.cli.description import Description
from hsictrl.study import MeanRule, PercentileRule

Row = Mapping[str, Any]


@final
@dataclass(frozen=True, slots=True)
class Column:
    """A head with its unit, and what a row has to say under it."""

    head: str
    unit: str
    cell: Callable[[Row], str]
    justify: JustifyMethod = "right"


def estimate(name: str, *, unit: str = "", trials: str = "", digits: int = 3, scale: float = 1.0,
             ) -> Callable[[Row], str]:
    """A cell with an estimate, and its interval and number of trials below."""
    def cell(row: Row) -> str:
        middle, low, high = (significant(scale * row[name + end + unit], digits) for end in ("", "_low", "_high"))
        count = f"\n({row[trials]})" if trials else ""
        return f"{middle}\n{low}–{high}{count}"
    return cell


def table(columns: Sequence[Column], rows: Sequence[Row]) -> Table:
    """A table that is as narrow as its words: an assessment fits a terminal of 80 characters."""
    drawn = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False, show_lines=True)
    for column in columns:
        drawn.add_column(f"{column.head}\n{column.unit}".rstrip(), justify=column.justify, overflow="fold")
    for row in rows:
        drawn.add_row(*(column.cell(row) for column in columns))
    return drawn


def _flow(row: Row) -> str:
    words = [row.get("traffic_class"), f"{row['density_per_m2']:.3g}", f"n={row['persons']}"]
    return "\n".join(filter(None, words))


FLOW = Column("d", "[1/m²]", _flow)


def case_notes(case: Description) -> list[str]:
    """What was studied, in the first lines below a table."""
    inferred = [f"Remark on the bridge: {remark}." for remark in case.bridge.remarks]
    return [str(case.bridge), *inferred, f"Force: {case.force}. Seed: {case.seed}. d, n: density and number of people."]


def interval_note(rule: PercentileRule | MeanRule) -> str:
    """What stands below an estimate."""
    return (f"Below an estimate: its {100 * rule.confidence:g} % interval and (number of trials), which stop when the "
            f"interval lies within ±{100 * rule.tolerance:g} %.")

"""Percentiles, ratios of percentiles of samples that belong together, and what their intervals tell about a claim."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from hsictrl._checks import Array
from hsictrl.paper.reports import rounded
from hsictrl.study import PercentileRule
from hsictrl.study.ratios import ratios

RULE = PercentileRule()


class Interval(NamedTuple):
    """An estimate and the ends of its 95 % interval."""

    estimate: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.estimate:.3g} [{self.low:.3g}, {self.high:.3g}]"

    @property
    def distance(self) -> Interval:
        """Distance from one."""
        ends = sorted((abs(self.low - 1), abs(self.high - 1)))
        return Interval(abs(self.estimate - 1), 0.0 if self.low <= 1 <= self.high else ends[0], ends[1])

    def within(self, least: float, most: float) -> bool | None:
        """Whether it lies inside (True) or outside (False) a band as a whole; None where it does neither."""
        if least <= self.low and self.high <= most:
            return True
        return False if self.high < least or self.low > most else None

    def above(self, other: Interval) -> bool | None:
        """Whether it lies above (True) or below (False) another as a whole; None where both overlap."""
        if self.low > other.high:
            return True
        return False if self.high < other.low else None

    def row(self, name: str, unit: str = "") -> dict[str, float]:
        """Three entries of a row of results, the unit last in each key."""
        return {f"{name}{end}{unit}": rounded(value)
                for end, value in zip(("", "_low", "_high"), self, strict=True)}

    @classmethod
    def of(cls, row: dict[str, Any], name: str, unit: str = "") -> Interval:
        """Read `row` back."""
        return cls(*(row[f"{name}{end}{unit}"] for end in ("", "_low", "_high")))


def percentile(samples: Array) -> Interval:
    """The percentile with the interval of the stop rule."""
    found = RULE.judge(samples)
    return Interval(float(found.estimate), float(found.interval[0]), float(found.interval[1]))


def ratio(top: Array, bottom: Array) -> Interval:
    """Ratio of the percentiles of two quantities of the same trials, by a paired percentile bootstrap."""
    estimate, low, high = ratios(RULE, top[:, None], bottom[:, None])
    return Interval(float(estimate[0]), float(low[0]), float(high[0]))


def verdict(cells: Iterable[bool | None]) -> bool | None:
    """A claim about all cells: it fails if one does, holds if all do, and is undecided otherwise."""
    told = list(cells)
    return False if False in told else None if None in told else True

"""Claims about table 2, and about SF and MF where a crossing has many load cycles (section 4.1)."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from hsictrl.paper.cells import DENSITIES, Cell
from hsictrl.paper.intervals import Interval, verdict
from hsictrl.paper.reports import Finding, Rows
from hsictrl.paper.table2 import cell_of, found

AGREE, EXCEEDS = (0.9, 1.15), (1.0, np.inf)
Told = dict[Cell, bool | None]
Intervals = dict[Cell, Interval]


def findings(table: Rows, cycles: Rows) -> dict[str, Callable[[], Finding]]:
    """The claims that the rows of table 2, and those over the number of load cycles, decide, by id."""
    evaluated: dict[str, Callable[[Rows], Finding]] = {
        "C19": stationary_and_moving, "C20": added_mass, "C21": partial(pseudo_moving, 0.2, 0.05),
        "C22": partial(pseudo_moving, 1.0, 0.03), "C23": density_reduces_more, "C24": resonance_reduces_more,
        "C25": printed_values, "C41": accuracy_lost}
    return {**{name: partial(evaluate, table) for name, evaluate in evaluated.items()},
            "C40": partial(many_load_cycles, cycles)}


def stationary_and_moving(rows: Rows) -> Finding:
    """SF over MF in a band in case 1, and above one in case 2."""
    ratios = found(rows, "over_mf", "SF")
    bands = {1: AGREE, 2: EXCEEDS}
    told = {cell: one.within(*bands[cell.case]) for cell, one in ratios.items()}
    return (f"SF/MF in case 1: {_spread(ratios, 1)}; in case 2: {_spread(ratios, 2)}", verdict(told.values()),
            _cells(told, ratios))


def added_mass(rows: Rows) -> Finding:
    """MF above MFAM, more so in a denser crowd."""
    over = found(rows, "over_mf", "MFAM")
    slight = {cell: one.within(0.0, 1.0) for cell, one in over.items()}
    grows = {cell: over[cell].above(over[_dense(cell)]) for cell in _sparse(over)}
    return (f"MFAM/MF {_by_density(over)}; below one in {_count(slight)} cells, lower at the higher density in "
            f"{_count(grows)} pairs", verdict([*slight.values(), *grows.values()]),
            "; ".join(filter(None, (_cells(slight, over), _pairs(grows, over)))))


def pseudo_moving(density: float, tolerance: float, rows: Rows) -> Finding:
    """PMC over MC within a tolerance of one at one density."""
    ratios = {cell: one for cell, one in found(rows, "ratio", "PMC").items() if cell.density == density}
    told = {cell: one.within(1 - tolerance, 1 + tolerance) for cell, one in ratios.items()}
    return ("PMC/MC " + ", ".join(f"{one} ({cell})" for cell, one in ratios.items()), verdict(told.values()),
            f"the interval lies within ±{100 * tolerance:g} % as a whole in {_count(told)} cells, and outside in "
            f"{list(told.values()).count(False)}")


def density_reduces_more(rows: Rows) -> Finding:
    """MF over MC larger in the denser crowd."""
    return _larger(found(rows, "ratio", "MF"), _dense, "at 1.0 than at 0.2 /m²", _sparse)


def resonance_reduces_more(rows: Rows) -> Finding:
    """MF over MC larger where all step alike."""
    return _larger(found(rows, "ratio", "MF"), _alike, "in case 2 than in case 1", _varied)


def accuracy_lost(rows: Rows) -> Finding:
    """|MF/MC − 1| larger in the denser crowd."""
    distances = {cell: one.distance for cell, one in found(rows, "ratio", "MF").items()}
    return _larger(distances, _dense, "at 1.0 than at 0.2 /m²", _sparse, what="|MF/MC − 1|")


def printed_values(rows: Rows) -> Finding:
    """Median deviation from the 48 printed ratios."""
    models = [row for row in rows if row["model"] != "MC"]
    deviations = np.array([_deviation(row) for row in models])
    median, least, most = np.median(deviations, axis=0)
    worst = models[int(np.argmax(deviations[:, 0]))]
    holds = Interval(median, least, most).within(0.0, 0.10)
    return (f"median deviation {100 * median:.1f} % of the printed ratio ({100 * least:.1f}–{100 * most:.1f} % with "
            f"all at the nearer or the farther end of their intervals), worst {100 * worst['deviation']:+.0f} % "
            f"({worst['model']}, {cell_of(worst)}); {_contained(models)} of {len(models)} intervals contain it", holds,
            "the median is above 10 %" if holds is False else "10 % lies within the interval of the median")


def many_load_cycles(rows: Rows) -> Finding:
    """SF over MF tends to one with the number of load cycles."""
    ratios = [Interval.of(row, "sf_over_mf") for row in rows]
    first, last = ratios[0], ratios[-1]
    listed = ", ".join(f"{one} at {row['load_cycles']:.0f}" for one, row in zip(ratios, rows, strict=True))
    nearer = first.distance.above(last.distance)
    holds = False if last.distance.low > 0 or nearer is False else nearer
    overlap = f"intervals of |SF/MF − 1| overlap: {first.distance} with fewest load cycles, {last.distance} with most"
    return f"SF/MF {listed} load cycles", holds, overlap if holds is None else _many_crowds(rows[-1])


def _many_crowds(row: dict[str, Any]) -> str:
    """Why SF stays away from MF, however many load cycles."""
    return (f"with most load cycles it is {Interval.of(row, 'sf_over_mf')}: MF's maximum over a crossing sees many "
            "crowds while SF sees one; SF over MF's peak in the last step of the same window is "
            f"{Interval.of(row, 'sf_over_instant')}")


def _larger(
    values: Intervals, partner: Callable[[Cell], Cell], how: str, of: Callable[[Iterable[Cell]], list[Cell]], *,
    what: str = "MF/MC",
) -> Finding:
    told = {cell: values[partner(cell)].above(values[cell]) for cell in of(values)}
    listed = ", ".join(f"{values[cell].estimate:.2f} → {values[partner(cell)].estimate:.2f} ({cell})" for cell in told)
    return (f"{what} larger {how} in {_count(told)} pairs: {listed}", verdict(told.values()),
            _pairs(told, values, partner))


def _dense(cell: Cell) -> Cell:
    return replace(cell, density=DENSITIES[1])


def _alike(cell: Cell) -> Cell:
    return replace(cell, case=2)


def _sparse(cells: Iterable[Cell]) -> list[Cell]:
    return [cell for cell in cells if cell.density == DENSITIES[0]]


def _varied(cells: Iterable[Cell]) -> list[Cell]:
    return [cell for cell in cells if cell.case == 1]


def _deviation(row: dict[str, float]) -> Interval:
    """Absolute deviation of a ratio from the printed one, relative to the latter."""
    return Interval(*(end / row["printed_ratio"] for end in Interval.of(row, "ratio"))).distance


def _contained(rows: Rows) -> int:
    return sum(row["ratio_low"] <= row["printed_ratio"] <= row["ratio_high"] for row in rows)


def _spread(ratios: Intervals, case: int) -> str:
    values = [one.estimate for cell, one in ratios.items() if cell.case == case]
    return f"{min(values):.2f}–{max(values):.2f}"


def _by_density(ratios: Intervals) -> str:
    return ", ".join(f"{min(values):.2f}–{max(values):.2f} at {density:g} /m²" for density in DENSITIES
                     if (values := [one.estimate for cell, one in ratios.items() if cell.density == density]))


def _count(told: Told) -> str:
    return f"{list(told.values()).count(True)} of {len(told)}"


def _cells(told: Told, values: Intervals) -> str:
    """Cells that fail or stay undecided, with their intervals."""
    return _listed(told, {cell: f"{cell}: {values[cell]}" for cell in told})


def _pairs(told: Told, values: Intervals, partner: Callable[[Cell], Cell] = _dense) -> str:
    """Pairs that fail or stay undecided, with their intervals."""
    return _listed(told, {cell: f"{cell}: {values[cell]} and {values[partner(cell)]}" for cell in told})


def _listed(told: Told, texts: dict[Cell, str]) -> str:
    parts = {"not so": False, "undecided": None}
    groups = {word: [texts[cell] for cell, one in told.items() if one is kind] for word, kind in parts.items()}
    return "; ".join(f"{word} {', '.join(cells)}" for word, cells in groups.items() if cells)

"""Claims about figure 8 (section 4.1)."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from hsictrl.paper.cells import CELLS, Cell
from hsictrl.paper.fig8 import MODELS, found
from hsictrl.paper.intervals import Interval, verdict
from hsictrl.paper.reports import Finding, Rows

Condition = tuple[str, float, float, int]       # model, density, f_B, case
Pair = tuple[Condition, Condition]


def findings(rows: Rows) -> dict[str, Callable[[], Finding]]:
    """The claims that the rows of figure 8 decide, by id."""
    return {"C26": partial(inter_hides_intra, rows), "C27": partial(damping_hides_both, rows)}


def inter_hides_intra(rows: Rows) -> Finding:
    """The ratio without to with intra-person variability is closer to one in case 1 than in case 2."""
    return _closer(rows, [((model, *place, 1), (model, *place, 2)) for model in MODELS for place in _places()],
                   "in case 1 than in case 2")


def damping_hides_both(rows: Rows) -> Finding:
    """The same ratio is closer to one with interaction than without."""
    without, interacting = MODELS
    return _closer(rows, [((interacting, *place, case), (without, *place, case)) for place in _places()
                          for case in (1, 2)], "with interaction than without")


def _closer(rows: Rows, pairs: list[Pair], how: str) -> Finding:
    """Judged for Young's force, as in the paper; the same walkers with all steps alike are reported beside it."""
    told, twin = (_told(rows, pairs, force) for force in ("Young", "periodic"))
    ratios = _ratios(rows, "Young")
    return (f"a95 without over with intra-person variability: {_spread(ratios)} (Young); closer to one {how} in "
            f"{_count(told)} (Young), {_count(twin)} (same walkers, periodic)", verdict(told.values()),
            _listed(told, ratios))


def _told(rows: Rows, pairs: list[Pair], force: str) -> dict[Pair, bool | None]:
    """Whether the first of each pair is closer to one than the second."""
    distances = {condition: one.distance for condition, one in _ratios(rows, force).items()}
    return {(near, far): distances[far].above(distances[near]) for near, far in pairs}


def _ratios(rows: Rows, force: str) -> dict[Condition, Interval]:
    return {(model, cell.density, cell.frequency, cell.case): one for model in MODELS
            for cell, one in found(rows, model, force).items()}


def _places() -> list[tuple[float, float]]:
    return list(dict.fromkeys((cell.density, cell.frequency) for cell in CELLS))


def _spread(ratios: dict[Condition, Interval]) -> str:
    values = [one.estimate for one in ratios.values()]
    return f"{min(values):.2f}–{max(values):.2f}"


def _count(told: dict[Pair, bool | None]) -> str:
    values = list(told.values())
    return (f"{values.count(True)} of {len(values)} pairs, not in {values.count(False)}, undecided in "
            f"{values.count(None)}")


def _listed(told: dict[Pair, bool | None], ratios: dict[Condition, Interval]) -> str:
    """Pairs that fail, with their intervals; and how many intervals overlap."""
    wrong = [f"{_named(near)}: {ratios[near]} and {ratios[far]}" for (near, far), one in told.items() if one is False]
    unsure = list(told.values()).count(None)
    return "; ".join(filter(None, (f"not so {', '.join(wrong)}" if wrong else "",
                                   f"intervals of {unsure} pairs overlap" if unsure else "")))


def _named(condition: Condition) -> str:
    model, density, frequency, case = condition
    return f"{model}, {Cell(frequency=frequency, density=density, case=case)}"

"""Claims about figure 7 (section 3.4)."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from scipy.stats import binomtest

from hsictrl.paper.eeklo import POSTURES
from hsictrl.paper.fig7 import chosen
from hsictrl.paper.identified import ALONG
from hsictrl.paper.intervals import Interval, verdict
from hsictrl.paper.reports import Finding, Rows

UPRIGHT, BENT = POSTURES


def findings(rows: Rows) -> dict[str, Callable[[], Finding]]:
    """The claims that the rows of figure 7 decide, by id."""
    evaluated = {"C13": upright, "C14": bent_legs, "C15": added_mass, "C16": lateral_bodies,
                 "C18": walking}
    return {name: partial(evaluate, rows) for name, evaluate in evaluated.items()}


def upright(rows: Rows) -> Finding:
    """Upright, vertical mode: frequency falls, damping rises to about 0.7 %."""
    at = {row["persons"]: row for row in chosen(rows, "vertical", UPRIGHT)}
    f_eff, xi = [_frequency(at[persons]) for persons in (9, 15, 21)], _damping(at[26])
    told = verdict([f_eff[0].above(f_eff[1]), f_eff[1].above(f_eff[2]), xi.within(0.005, 0.010)])
    return (f"mean f_eff {', '.join(f'{one.estimate:.3f}' for one in f_eff)} Hz for 9, 15, 21 persons; mean ξ_eff "
            f"{_percent(xi)} with 26", told, "f_eff does not fall, or ξ_eff leaves 0.5–1.0 %, within an interval")


def bent_legs(rows: Rows) -> Finding:
    """Bent legs, vertical mode: frequency changes little, damping passes 3.5 % and five times the upright value."""
    row, other = chosen(rows, "vertical", BENT)[-1], chosen(rows, "vertical", UPRIGHT)[-1]
    f_b, f_eff, xi, ratio = row["f_b_hz"], _frequency(row), _damping(row), _over(_damping(row), _damping(other))
    told = verdict([f_eff.within(0.92 * f_b, 1.08 * f_b), xi.above(_exactly(0.035)), ratio.above(_exactly(5.0))])
    return (f"26 persons: mean f_eff {100 * (f_eff.estimate / f_b - 1):+.1f} %, mean ξ_eff {_percent(xi)}, {ratio} "
            "times that upright", told, "a bound is missed, or within an interval")


def added_mass(rows: Rows) -> Finding:
    """Vertical bodies alone hardly damp the lateral-torsional mode."""
    last = {posture: chosen(rows, "lateral-torsional", posture)[-1] for posture in POSTURES}
    told = verdict([one for row in last.values() for one in
                    (_exactly(row["f_b_hz"]).above(_frequency(row)), _exactly(0.003).above(_gain(row)))])
    return (_listed({posture: f"f_eff {100 * (row['f_eff_mean_hz'] / row['f_b_hz'] - 1):+.2f} %, ξ_eff − ξ_B "
                              f"{_percent(_gain(row))}" for posture, row in last.items()}),
            told, "f_eff does not fall, or damping rises by 0.3 % or more, within an interval")


def lateral_bodies(rows: Rows) -> Finding:
    """Lateral bodies damp the lateral-torsional mode."""
    gains = {posture: [_gain(chosen(rows, "lateral-torsional", posture, lateral)[-1]) for lateral in (False, True)]
             for posture in POSTURES}
    told = verdict([sideways.above(Interval(*(3 * end for end in upwards))) for upwards, sideways in gains.values()])
    return (_listed({posture: f"ξ_eff − ξ_B {_percent(sideways)} with, {_percent(upwards)} without"
                     for posture, (upwards, sideways) in gains.items()}),
            told, "not three times as much, as a whole interval")


def walking(rows: Rows) -> Finding:
    """Walking people: what is identified lies in the region of as many with bent legs along the span."""
    tests = [row for row in rows if row["source"] == "subspace"]
    told = verdict(_share(row).above(_exactly(0.8)) for row in tests)
    inside = "; ".join(f"{row['posture']}, {row['persons']} persons {_hundredths(row['inside'])}" for row in tests)
    meet = [_hundredths(row["interval_meets"]) for row in tests]
    crowds = max(_hundredths(row["inside"]) for row in chosen(rows, "vertical", ALONG))
    return (f"of 100 tests inside: {inside}; interval meets the region: {min(meet)} to {max(meet)}", told,
            "in three minutes an identification scatters as much as the region is wide; of crowds without any such "
            f"error {crowds} of 100 are inside")


def _hundredths(share: float) -> int:
    return round(100 * share)


def _share(row: dict[str, Any]) -> Interval:
    """Share of tests inside, with its Clopper–Pearson interval."""
    count = round(row["inside"] * row["trials"])
    low, high = binomtest(count, row["trials"]).proportion_ci()
    return Interval(row["inside"], float(low), float(high))


def _frequency(row: dict[str, float]) -> Interval:
    return Interval.of(row, "f_eff_mean", "_hz")


def _damping(row: dict[str, float]) -> Interval:
    return Interval.of(row, "xi_eff_mean")


def _gain(row: dict[str, float]) -> Interval:
    """Mean ξ_eff − ξ_B."""
    return Interval(*(end - row["xi_b"] for end in _damping(row)))


def _over(top: Interval, bottom: Interval) -> Interval:
    """A ratio whose interval is that of both intervals, which is wider than need be."""
    return Interval(top.estimate / bottom.estimate, top.low / bottom.high, top.high / bottom.low)


def _exactly(value: float) -> Interval:
    return Interval(value, value, value)


def _percent(one: Interval) -> str:
    return f"{Interval(*(100 * end for end in one))} %"


def _listed(by_posture: dict[str, str]) -> str:
    return "26 persons, " + "; ".join(f"{posture}: {text}" for posture, text in by_posture.items())

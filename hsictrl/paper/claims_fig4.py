"""Claims about figure 4 (section 3.3)."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.paper.fig4 import DAMPINGS, FREQUENCIES, MASS_RATIOS, column
from hsictrl.paper.reports import Finding, Rows

F_B = np.array(FREQUENCIES)
Mask = NDArray[np.bool_]


def findings(rows: Rows) -> dict[str, Callable[[], Finding]]:
    """The claims that the rows of figure 4 decide, by id."""
    evaluated = {"C06": soft_range, "C07": middle_range, "C08": stiff_range, "C09": scatter, "C10": best_frequency,
                 "C11": relative_growth, "C12": number_of_trials, "C42": onset}
    return {name: partial(evaluate, rows) for name, evaluate in evaluated.items()}


def soft_range(rows: Rows) -> Finding:
    """Below 2 Hz people act as added mass."""
    soft = (F_B >= 1.0) & (F_B <= 1.75)
    ratio, gain = _table(rows, "f_ratio_mean")[..., soft], _gain(rows)[..., soft]
    falls = np.all(np.diff(ratio, axis=0) < 0)
    rises = np.all(np.diff(gain, axis=0) >= 0) and np.all(np.diff(gain, axis=2) >= 0)
    return (f"f_eff/f_B {ratio.min():.3f}–{ratio.max():.3f}, {'falls' if falls else 'does not fall'} with μ; "
            f"ξ_eff − ξ_B up to {100 * gain.max():.2f} %, {'non-decreasing' if rises else 'not monotonic'}",
            bool(falls and rises and gain.max() <= 0.02), _where(gain > 0.02, soft, "ξ_eff − ξ_B exceeds 2 %"))


def middle_range(rows: Rows) -> Finding:
    """Between 2 and 4.5 Hz damping reaches 4–5 % at low mass ratios and passes 10 % at high ones."""
    middle = (F_B >= 2.0) & (F_B <= 4.5)
    tops, least, most = (_table(rows, key)[..., middle].max(axis=2)
                         for key in ("xi_eff_mean", "xi_eff_mean_low", "xi_eff_mean_high"))
    light, heavy = tops[0, :2], tops[2:]
    measured = (f"largest mean ξ_eff {_percent(light)} at μ = 0.05 (ξ_B 0.2, 0.5 %), {_percent(heavy)} at μ = 0.2 "
                "and 0.3")
    if not np.all(heavy > 0.10):
        return measured, False, "at μ = 0.2 and 0.3 not above 10 %"
    if np.all((light >= 0.04) & (light <= 0.055)):
        return measured, True, ""
    reached = np.all((most[0, :2] >= 0.04) & (least[0, :2] <= 0.055))
    interval = f"95 % intervals {100 * least[0, :2].min():.2f}–{100 * most[0, :2].max():.2f} %"
    return measured, None if reached else False, f"at μ = 0.05 not within 4–5.5 %, {interval}"


def stiff_range(rows: Rows) -> Finding:
    """Above 4.5 Hz damping rises less, and f_eff lies slightly above f_B."""
    stiff, middle = F_B >= 4.5, (F_B >= 2.0) & (F_B <= 4.5)
    gain, ratio = _gain(rows), _table(rows, "f_ratio_mean")[..., stiff]
    lower = np.all(gain[..., stiff].max(axis=2) < gain[..., middle].max(axis=2))
    heavy, light = ratio[2:], np.abs(ratio[0] - 1)
    return (f"damping {'below' if lower else 'not below'} its middle-range maximum; f_eff/f_B {heavy.min():.3f}–"
            f"{heavy.max():.3f} at μ = 0.2, 0.3; |f_eff/f_B − 1| up to {light.max():.4f} at μ = 0.05",
            bool(lower and np.all((heavy > 1) & (heavy <= 1.10)) and light.max() <= 0.01),
            f"f_eff/f_B reaches {heavy.max():.3f} at high mass ratios (bound 1.10) and deviates by {light.max():.4f} "
            "at the lowest (bound 0.01)")


def scatter(rows: Rows) -> Finding:
    """f_eff scatters little but where the mode shifts."""
    width = _table(rows, "f_ratio_p95") - _table(rows, "f_ratio_p5")
    outside = (F_B < 3.25) | (F_B > 4.0)
    return (f"5–95 % width of f_eff/f_B up to {width[..., outside].max():.3f} outside 3.25–4 Hz, "
            f"{width[..., ~outside].max():.3f} inside", bool(np.all(width[..., outside] <= 0.05)),
            _where(width[..., outside] > 0.05, outside, "wider than 0.05"))


def best_frequency(rows: Rows) -> Finding:
    """The frequency ratio of the largest damping falls with the mass ratio."""
    best = F_B[np.argmax(_table(rows, "xi_eff_mean"), axis=2)]
    holds = np.all(np.diff(best, axis=0) >= 0) and np.all(best[-1] > best[0])
    return (f"f_B of the largest mean ξ_eff over μ = {', '.join(map(str, MASS_RATIOS))} (by ξ_B): {_listed(best)} Hz",
            bool(holds), "not non-decreasing from 0.05 to 0.3, or not higher at the end")


def relative_growth(rows: Rows) -> Finding:
    """Damping grows relatively faster the lower it is."""
    growth = (_table(rows, "xi_eff_mean") / np.array(DAMPINGS)[None, :, None])[..., F_B > 1.5]
    larger = np.diff(growth, axis=1) < 0
    return (f"ξ_eff/ξ_B falls with ξ_B in {larger.sum()} of {larger.size} comparisons", bool(np.all(larger)),
            "not in all of them")


def number_of_trials(rows: Rows) -> Finding:
    """About 500 trials settle a cell."""
    trials = np.array([row["trials"] for row in rows])
    return (f"{trials.mean():.0f} trials on average over {len(trials)} cells ({trials.min()}–{trials.max()}; the first "
            "look is at 100)", bool(150 <= trials.mean() <= 1500),
            "the order-statistics interval settles after fewer trials than the printed 500")


def onset(rows: Rows) -> Finding:
    """Damping rises from lower frequencies on, the lighter and the less damped the bridge."""
    exceeds = _table(rows, "xi_eff_mean") > 1.5 * np.array(DAMPINGS)[None, :, None]
    first = np.where(exceeds.any(axis=2), F_B[np.argmax(exceeds, axis=2)], np.inf)
    holds = np.all(np.diff(first, axis=0) <= 0) and np.all(np.diff(first, axis=1) >= 0)
    return (f"ξ_eff first exceeds 1.5 ξ_B at f_B (over μ, by ξ_B): {_listed(first)} Hz", bool(holds),
            "not non-increasing in mass ratio and in falling ξ_B")


def _table(rows: Rows, key: str) -> Array:
    """One statistic over mass ratio, damping and frequency, shape (4, 3, 51)."""
    return np.array([[column(rows, key, mass, damping) for damping in DAMPINGS] for mass in MASS_RATIOS])


def _gain(rows: Rows) -> Array:
    """Mean ξ_eff − ξ_B, shape (4, 3, 51)."""
    return _table(rows, "xi_eff_mean") - np.array(DAMPINGS)[None, :, None]


def _listed(frequencies: Array) -> str:
    """Frequencies over the mass ratios, one list per damping."""
    return "; ".join(f"{100 * damping:g} %: " + ", ".join(f"{f:g}" for f in row)
                     for damping, row in zip(DAMPINGS, frequencies.T, strict=True))


def _percent(values: Array) -> str:
    return f"{100 * values.min():.2f}–{100 * values.max():.2f} %"


def _where(wrong: Mask, frequencies: Mask, what: str) -> str:
    """Say in which cells a bound is not kept."""
    mass, _, index = np.nonzero(wrong)
    if not len(mass):
        return "not monotonic as stated"
    places = F_B[frequencies][index]
    masses = sorted({MASS_RATIOS[i] for i in mass})
    return f"{what} in {len(mass)} cells: f_B {places.min():g}–{places.max():g} Hz, μ {', '.join(map(str, masses))}"

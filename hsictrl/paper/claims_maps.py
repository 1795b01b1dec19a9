"""Claims about figures 9 to 11 (section 4.4)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import final

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.paper.intervals import RULE, Interval
from hsictrl.paper.maps import KEYS, over
from hsictrl.paper.reports import Finding, Rows
from hsictrl.study import Estimates

Flags = NDArray[np.bool_]
DENSITY, FREQUENCY, MASS, DAMPING = range(4)      # axes of the arrays


@final
@dataclass(frozen=True, slots=True, eq=False)
class Told:
    """What intervals tell about cells: it is so, it is not so, or neither.

    Parameters
    ----------
    so, not_so : array of bool
        One per cell.

    Examples
    --------
    >>> Told(np.array([True, True]), np.array([False, False])).everywhere
    True
    """

    so: Flags
    not_so: Flags

    @property
    def everywhere(self) -> bool | None:
        """Whether it is so in all cells."""
        return self.in_share(1.0)

    def in_share(self, least: float) -> bool | None:
        """Whether it is so in this share of the cells at least."""
        if np.mean(self.so) >= least:
            return True
        return False if 1 - np.mean(self.not_so) < least else None

    def __str__(self) -> str:
        unsure = self.so.size - int(self.so.sum()) - int(self.not_so.sum())
        return f"so in {self.so.sum()} of {self.so.size}, not in {self.not_so.sum()}, undecided in {unsure}"


def findings(rows: Rows, stationary: Rows) -> dict[str, Callable[[], Finding]]:
    """The claims that the maps, and the stationary force on some of their cells, decide, by id."""
    names = {"mf": ("a95_mf", "_m_per_s2"), "pmc": ("a95_pmc", "_m_per_s2"), "r": ("r_hsi", "")}
    mf, pmc, r = (over(rows, *name) for name in names.values())
    trials = needed(rows)
    return {"C28": partial(first_harmonic_governs, mf), "C29": partial(highest_without_interaction, mf),
            "C30": partial(trials_needed, *trials), "C31": partial(two_peaks, pmc), "C32": partial(grows_less, mf, pmc),
            "C33": partial(peak_moves_up, pmc), "C34": partial(sparse_may_govern, pmc),
            "C35": partial(highest_with_interaction, pmc), "C36": partial(reduction_grows, r),
            "C37": partial(third_less, r), "C38": partial(little_in_damped_bridges, r),
            "C43": partial(dip_between_harmonics, r), "C44": partial(densest_governs, mf),
            "C45": partial(stationary_reduces_more, stationary)}


def first_harmonic_governs(mf: Estimates) -> Finding:
    """MF, ξ_B 0.5 %: the largest response between 1.5 and 2.5 Hz, above those between 2.5 and 5 Hz."""
    part = _part(mf, density=(0.2, 1.0), xi_b=(0.005,))
    inside, above, below = (_highest(part, *band) for band in ((1.5, 2.5), (2.5001, 5.0), (0.0, 1.4999)))
    outside = _highest(part, 5.0001, 9.9)
    told = _both(_above(inside, above), _both(_above(inside, below), _above(inside, outside)))
    argmax = np.array(_axis(mf, FREQUENCY))[np.argmax(part.estimate, axis=FREQUENCY)]
    return (f"largest at {_span(argmax)} Hz in {argmax.size} curves; maximum between 2.5 and 5 Hz over it "
            f"{_span(above.estimate / inside.estimate)}; {told}", told.everywhere, "intervals overlap")


def highest_without_interaction(mf: Estimates) -> Finding:
    """MF, ξ_B 0.5 %: up to 6 m/s² and 20 m/s²."""
    tops = [_top(_part(mf, density=(density,), xi_b=(0.005,))) for density in (0.2, 1.0)]
    told = [top.within(0.8 * wanted, 1.2 * wanted) for top, wanted in zip(tops, (6.0, 20.0), strict=True)]
    holds = False if False in told else None if None in told else True
    return f"{tops[0]} m/s² at 0.2 /m², {tops[1]} m/s² at 1.0 /m²", holds, "an interval leaves the band of ±20 %"


def trials_needed(mf: Estimates, pmc: Estimates) -> Finding:
    """10³ to 10⁴ trials, more for dense crowds and low damping."""
    both = np.stack([mf.estimate, pmc.estimate])
    dense = _dense(mf)
    by_density = [float(np.median(both[:, chosen])) for chosen in (~dense, dense)]
    by_damping = [float(np.median(both[..., j])) for j in range(both.shape[-1])]
    median = float(np.median(both))
    holds = 1e3 <= median <= 1e4 and by_density[1] > by_density[0] and all(np.diff(by_damping) < 0)
    dampings = ", ".join(f"{n:.0f} at {100 * xi:g} %" for n, xi in zip(by_damping, _axis(mf, DAMPING), strict=True))
    return (f"median over cells {median:.0f} (MF {np.median(mf.estimate):.0f}, PMC {np.median(pmc.estimate):.0f}; "
            f"extrapolated from the interval after {int(mf.low.flat[0])} trials by 1/√n); {by_density[0]:.0f} for "
            f"d < 1, {by_density[1]:.0f} for d ≥ 1; by ξ_B {dampings}", holds,
            "the median, or how it depends on density or damping, is otherwise")


def two_peaks(pmc: Estimates) -> Finding:
    """PMC: the largest response between 1.5 and 3 Hz, a smaller peak between 4 and 5 Hz."""
    inside, below, above = (_highest(pmc, *band) for band in ((1.5, 3.0), (0.0, 1.4999), (3.0001, 9.9)))
    told = _both(_above(inside, below), _above(inside, above))
    f_b = np.array(_axis(pmc, FREQUENCY))
    values = np.moveaxis(pmc.estimate, FREQUENCY, 0)
    peaks = (values[1:-1] > values[:-2]) & (values[1:-1] > values[2:]) & _band(f_b[1:-1], 4.0, 5.0)[:, None, None, None]
    share = float(np.mean(peaks.any(axis=0)))
    first = told.everywhere
    holds = False if first is False or share < 0.5 else first
    return (f"largest between 1.5 and 3 Hz: {told}; a local maximum between 4 and 5 Hz in {share:.0%} of the curves",
            holds, "a curve has its maximum elsewhere, or too few a second one" if holds is False else
            "intervals overlap")


def grows_less(mf: Estimates, pmc: Estimates) -> Finding:
    """PMC: grows as ξ_B and m_B fall, less than MF."""
    rises = [_steps_up(pmc, axis) for axis in (MASS, DAMPING)]
    less = [_ends(pmc, axis) < _ends(mf, axis) for axis in (MASS, DAMPING)]
    count = [int(one.sum()) for one in rises]
    everywhere = np.all([one.all(axis=(0, 2)) for one in less], axis=0)
    holds = bool(not sum(count) and everywhere.all())
    shown = [f"{_span(_ends(one, axis))}" for axis in (MASS, DAMPING) for one in (pmc, mf)]
    return (f"a95 rises with m_B in {count[0]}, with ξ_B in {count[1]} steps beyond the intervals; from the largest to "
            f"the smallest m_B by {shown[0]} (MF {shown[1]}), ξ_B by {shown[2]} (MF {shown[3]}); less than MF in "
            f"{np.mean(less[0]):.0%} and {np.mean(less[1]):.0%} of the cells", holds,
            f"PMC grows more than MF at f_B of {_frequencies(pmc, ~everywhere)} Hz" if not sum(count) else
            "a95 rises with damping or mass somewhere")


def peak_moves_up(pmc: Estimates) -> Finding:
    """PMC: the frequency of the largest response rises as m_B falls."""
    dense = np.flatnonzero(_dense(pmc))
    f_b = np.array(_axis(pmc, FREQUENCY))
    places = np.argmax(pmc.estimate[dense], axis=FREQUENCY)        # density, mass, damping
    wrong = f_b[places[:, 1:]] > f_b[places[:, :-1]]
    sure = np.zeros_like(wrong)
    for i, j, k in zip(*np.nonzero(wrong), strict=True):       # does the heavier bridge surely peak there, not lower?
        here, there = places[i, j + 1, k], places[i, j, k]
        sure[i, j, k] = pmc.low[dense[i], here, j + 1, k] > pmc.high[dense[i], there, j + 1, k]
    moved = [f"{_span(f_b[places[:, j]])} Hz at {mass / 1e3:g} t" for j, mass in enumerate(_axis(pmc, MASS))]
    holds = True if not wrong.any() else False if sure.any() else None
    return (f"for d ≥ 1 at {', '.join(moved)}; against the claim in {wrong.sum()} of {wrong.size} steps of m_B, in "
            f"{sure.sum()} beyond the intervals", holds, "neighbouring frequencies have overlapping intervals")


def sparse_may_govern(pmc: Estimates) -> Finding:
    """PMC, ξ_B 0.2 %: the sparsest crowd gives the largest response somewhere."""
    part = _part(pmc, xi_b=(0.002,))
    by_estimate = np.argmax(part.estimate, axis=DENSITY) == 0
    surely = part.low[0] > part.high[1:].max(axis=0)
    governs = [int(np.sum(np.argmax(part.estimate, axis=DENSITY) == i)) for i in range(len(_axis(pmc, DENSITY)))]
    listed = ", ".join(f"{n} at {d:g}" for n, d in zip(governs, _axis(pmc, DENSITY), strict=True))
    holds = True if surely.any() else None if by_estimate.any() else False
    return (f"governing density by estimate: {listed} /m²; d = 0.2 governs beyond the intervals in {surely.sum()} of "
            f"{surely.size} cells", holds, "no interval stands apart" if holds is None else "it governs nowhere")


def highest_with_interaction(pmc: Estimates) -> Finding:
    """PMC: at most 5 m/s²."""
    top = _top(pmc)
    over_five = int(np.sum(pmc.low > 5.0))
    return (f"largest a95 {top} m/s² at {_where(pmc, int(np.argmax(pmc.estimate)))}; beyond 5 m/s² in {over_five} of "
            f"{pmc.estimate.size} cells", top.within(0.0, 5.0), "the largest is higher" if top.low > 5 else
            "5 m/s² lies in its interval")


def reduction_grows(r: Estimates) -> Finding:
    """R_HSI is at least one, grows with density and falling ξ_B, and is largest between 2.5 and 5 Hz."""
    below_one = int(np.sum(r.high < 1.0))
    by_density, by_damping = (r.estimate.mean(axis=tuple({0, 1, 2, 3} - {axis})) for axis in (DENSITY, DAMPING))
    f_b = np.array(_axis(r, FREQUENCY))
    argmax = f_b[np.argmax(r.estimate, axis=FREQUENCY)]
    inside = _highest(r, 2.5, 5.0)
    told = _both(_above(inside, _highest(r, 0.0, 2.4999)), _above(inside, _highest(r, 5.0001, 9.9)))
    grows = bool(np.all(np.diff(by_density) > 0) and np.all(np.diff(by_damping) < 0))
    holds = False if below_one or not grows else told.everywhere
    return (f"below one beyond the interval in {below_one} of {r.estimate.size} cells; mean by density "
            f"{_list(by_density)}, by ξ_B {_list(by_damping)}; largest at {_span(argmax)} Hz, between 2.5 and 5 Hz: "
            f"{told}", holds, "it is below one, or does not grow, or is largest elsewhere" if holds is False else
            "intervals overlap")


def third_less(r: Estimates) -> Finding:
    """At least 30 % less for dense crowds; for sparse ones too, where ξ_B ≤ 0.5 % and 2 Hz ≤ f_B ≤ 6 Hz."""
    dense = r.estimate[_dense(r)]
    sparse = _part(r, density=tuple(d for d in _axis(r, DENSITY) if d < 1), xi_b=(0.002, 0.005))
    sparse = _part(sparse, f_b=tuple(f for f in _axis(r, FREQUENCY) if 2 <= f <= 6))
    crowds = {"d ≥ 1": _part(r, density=tuple(d for d in _axis(r, DENSITY) if d >= 1)), "d < 1": sparse}
    told = {name: Told(one.low >= 1 / 0.7, one.high < 1 / 0.7) for name, one in crowds.items()}
    verdicts = [one.everywhere for one in told.values()]
    holds = False if False in verdicts else None if None in verdicts else True
    exceptions = "; ".join(f"{name}: {_exceptions(one, told[name].not_so)}" for name, one in crowds.items())
    return (f"R_HSI ≥ 1.43: d ≥ 1 {told['d ≥ 1']} (least {dense.min():.2f}); d < 1 {told['d < 1']} (least "
            f"{sparse.estimate.min():.2f})", holds,
            f"not so in {exceptions}" if holds is False else "intervals overlap")


def little_in_damped_bridges(r: Estimates) -> Finding:
    """ξ_B 2 %: below 1.5 in most cells below 2.5 Hz and above 4.5 Hz."""
    part = _part(r, xi_b=(0.02,))
    part = _part(part, f_b=tuple(f for f in _axis(r, FREQUENCY) if f < 2.5 or f > 4.5))
    told = Told(part.high < 1.5, part.low >= 1.5)
    sparse = ~_dense(part)
    shares = [float(np.mean(part.estimate[i] < 1.5)) for i in range(len(sparse))]
    holds = Told(told.so[sparse], told.not_so[sparse]).in_share(0.8)
    listed = ", ".join(f"{share:.0%} at {d:g}" for share, d in zip(shares, _axis(part, DENSITY), strict=True))
    return (f"R_HSI < 1.5 in {listed} /m²; for d < 1 {Told(told.so[sparse], told.not_so[sparse])}", holds,
            "less than 80 % of the cells with d < 1" if holds is False else "intervals overlap")


def dip_between_harmonics(r: Estimates) -> Finding:
    """R_HSI at 2.6–2.8 Hz below that at 3.2–3.6 Hz."""
    part = _part(r, density=tuple(d for d in _axis(r, DENSITY) if d >= 1))
    told = _above(_highest(part, 3.2, 3.6), _highest(part, 2.6, 2.8))
    values = [_highest(part, *band).estimate for band in ((2.6, 2.8), (3.2, 3.6))]
    holds = told.in_share(0.5)
    return (f"mean R_HSI {values[0].mean():.2f} at 2.6–2.8 Hz, {values[1].mean():.2f} at 3.2–3.6 Hz; lower: {told}",
            holds, "it is not lower in most cells" if holds is False else "intervals overlap")


def densest_governs(mf: Estimates) -> Finding:
    """MF: 1.5 or 1.0 persons/m² give the largest response."""
    dense = _dense(mf)
    told = Told(mf.low[dense].max(axis=0) > mf.high[~dense].max(axis=0),
                mf.high[dense].max(axis=0) < mf.low[~dense].max(axis=0))
    by_estimate = np.mean(dense[np.argmax(mf.estimate, axis=DENSITY)])
    return (f"by estimate in {by_estimate:.0%} of the cells; {told}", told.in_share(0.95),
            "intervals of densities overlap" if told.in_share(0.95) is None else "a sparser crowd governs")


def stationary_reduces_more(rows: Rows) -> Finding:
    """SF over PMC above MF over PMC, that is, SF over MF above one."""
    ratio = over(rows, "sf_over_mf")
    told = Told(ratio.low > 1, ratio.high < 1)
    return (f"SF/MF {_span(ratio.estimate)}, median {np.median(ratio.estimate):.2f}; above one: {told}",
            told.in_share(0.9), "SF is below MF in more than 10 % of the cells" if told.in_share(0.9) is False else
            "intervals hold one")


def needed(rows: Rows) -> tuple[Estimates, Estimates]:
    """Trials until a95 of MF and PMC settle, if their intervals shrink as 1/√n; `low` and `high` are the trials run."""
    trials = over([{**row, "n": row["trials"], "n_low": row["trials"], "n_high": row["trials"]} for row in rows], "n")
    return tuple(  # type: ignore[return-value]
        Estimates(axes=trials.axes, estimate=trials.estimate * (_reach(one) / RULE.tolerance)**2, low=trials.low,
                  high=trials.high) for one in (over(rows, "a95_mf", "_m_per_s2"), over(rows, "a95_pmc", "_m_per_s2")))


def _reach(found: Estimates) -> Array:
    """Half-width of the intervals, as a fraction of the estimate."""
    return np.maximum(found.high - found.estimate, found.estimate - found.low) / found.estimate


def _axis(found: Estimates, axis: int) -> tuple[float, ...]:
    return tuple(float(value) for value in found.axes[KEYS[axis]])


def _dense(found: Estimates) -> Flags:
    return np.array(_axis(found, DENSITY)) >= 1


def _part(found: Estimates, **chosen: tuple[float, ...]) -> Estimates:
    """Some values of some axes."""
    short = {"density": DENSITY, "f_b": FREQUENCY, "m_b": MASS, "xi_b": DAMPING}
    axes, ends = dict(found.axes), [found.estimate, found.low, found.high]
    for name, values in chosen.items():
        axis = short[name]
        places = [k for k, one in enumerate(_axis(found, axis)) if one in values]
        ends = [np.take(end, places, axis) for end in ends]
        axes[KEYS[axis]] = tuple(axes[KEYS[axis]][k] for k in places)
    return Estimates(axes=axes, estimate=ends[0], low=ends[1], high=ends[2])


def _band(f_b: Array, least: float, most: float) -> Flags:
    return (f_b >= least) & (f_b <= most)


def _highest(found: Estimates, least: float, most: float) -> Estimates:
    """The highest value of each curve over frequency inside a band; zero if the band is empty."""
    inside = np.flatnonzero(_band(np.array(_axis(found, FREQUENCY)), least, most))
    axes = {name: values for name, values in found.axes.items() if name != KEYS[FREQUENCY]}
    if not len(inside):
        nothing = np.zeros(tuple(map(len, axes.values())))
        return Estimates(axes=axes, estimate=nothing, low=nothing, high=nothing)
    part = [np.take(end, inside, FREQUENCY) for end in (found.estimate, found.low, found.high)]
    best = np.argmax(part[0], axis=FREQUENCY, keepdims=True)
    ends = (np.take_along_axis(end, best, FREQUENCY)[:, 0] for end in part)
    return Estimates(axes=axes, **dict(zip(("estimate", "low", "high"), ends, strict=True)))


def _above(one: Estimates, other: Estimates) -> Told:
    return Told(one.low > other.high, one.high < other.low)


def _both(one: Told, other: Told) -> Told:
    return Told(one.so & other.so, one.not_so | other.not_so)


def _steps_up(found: Estimates, axis: int) -> Flags:
    """Where the value rises along an axis beyond the intervals."""
    low, high = (np.moveaxis(end, axis, 0) for end in (found.low, found.high))
    return np.asarray(low[1:] > high[:-1])


def _ends(found: Estimates, axis: int) -> Array:
    """First value over last along an axis."""
    values = np.moveaxis(found.estimate, axis, 0)
    return np.asarray(values[0] / values[-1])


def _top(found: Estimates) -> Interval:
    place = int(np.argmax(found.estimate))
    return Interval(*(float(end.flat[place]) for end in (found.estimate, found.low, found.high)))


def _where(found: Estimates, place: int) -> str:
    indices = np.unravel_index(place, found.estimate.shape)
    at = [float(values[k]) for values, k in zip(found.axes.values(), indices, strict=True)]
    return f"{at[0]:g} /m², {at[1]:g} Hz, {at[2] / 1e3:g} t, {100 * at[3]:g} %"


def _frequencies(found: Estimates, chosen: Flags) -> str:
    return ", ".join(f"{f:g}" for f, one in zip(_axis(found, FREQUENCY), chosen, strict=True) if one)


def _exceptions(found: Estimates, wrong: Flags) -> str:
    """Where most exceptions are."""
    if not wrong.any():
        return "none"
    worst = int(np.argmin(np.where(wrong, found.estimate, np.inf)))
    return f"{wrong.sum()} cells, the least {found.estimate.flat[worst]:.2f} at {_where(found, worst)}"


def _span(values: Array) -> str:
    return f"{np.min(values):.3g}–{np.max(values):.3g}"


def _list(values: Array) -> str:
    return ", ".join(f"{value:.2f}" for value in values)

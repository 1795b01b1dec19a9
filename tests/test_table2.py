"""Table 2, its readings, load cycles and figure 8: by second roads, and with claims that can hold, fail and do neither.

Nothing here depends on what the studies found: truths are the printed table, closed forms and rows made by hand.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import product
from types import ModuleType

import matplotlib

matplotlib.use("Agg")

import numpy as np
import pytest

import hsictrl as hsi
from hsictrl import paper
from hsictrl.paper import (
    claims,
    claims_fig8,
    claims_table2,
    fig4,
    fig7,
    fig8,
    identified,
    load_cycles,
    maps,
    readings,
    studies,
    table2,
)
from hsictrl.paper.cells import CELLS, DEFAULT, Cell, Reading, SharedTrafficTrial
from hsictrl.paper.intervals import Interval, percentile, ratio, verdict
from hsictrl.paper.reports import Finding, Rows, Run, committed
from hsictrl.paper.virtual_tests import PACES, DecayTrial, SpanTrial, WalkingTrial

MODELS = ("SF", "MF", "MFAM", "PMC", "MC")
# Table 2, typed from the paper: percent over MC; three natural frequencies of case 1, then of case 2
PRINTED = {
    ("SF", 0.2): [19, 131, 158, 33, 180, 196], ("SF", 1.0): [130, 339, 368, 185, 617, 707],
    ("MF", 0.2): [16, 109, 132, 23, 124, 135], ("MF", 1.0): [116, 303, 329, 122, 406, 465],
    ("MFAM", 0.2): [15, 104, 125, 22, 117, 127], ("MFAM", 1.0): [87, 227, 247, 92, 305, 349],
    ("PMC", 0.2): [-5, 2, 4, 4, 5, -3], ("PMC", 1.0): [1, 0, -3, 1, -1, -2],     # "<1" counts as 0
    ("MC", 0.2): [0] * 6, ("MC", 1.0): [0] * 6}
ORDERS = {"SF": "2 n_m", "MF": "2 n_m", "MFAM": "2 n_m", "PMC": "2(n_m + n_H)", "MC": "2(n_m + n_H)"}
SPARSE = Cell(frequency=3.25, density=0.2, case=2)


# intervals

RNG = np.random.default_rng(5)
COMMON = RNG.normal(size=400)
FIRST, SECOND = (np.exp(0.3 * (COMMON + 0.3 * RNG.normal(size=400))) for _ in range(2))


def test_ratio_of_a_quantity_to_its_double_has_no_width() -> None:
    """Only if both are resampled together."""
    assert ratio(2 * FIRST, FIRST) == pytest.approx((2.0, 2.0, 2.0))
    assert ratio(FIRST, FIRST) == (1.0, 1.0, 1.0)


def test_ratio_by_a_bootstrap_written_out() -> None:
    rng, found = np.random.default_rng(99), []
    for _ in range(4000):
        drawn = rng.integers(0, 400, 400)
        found.append(np.quantile(FIRST[drawn], 0.95, method="hazen") / np.quantile(SECOND[drawn], 0.95, method="hazen"))
    one = ratio(FIRST, SECOND)
    assert one.estimate == np.quantile(FIRST, 0.95, method="hazen") / np.quantile(SECOND, 0.95, method="hazen")
    assert (one.low, one.high) == pytest.approx(np.quantile(found, [0.025, 0.975]), rel=0.01)


def test_ratio_is_the_same_in_every_run() -> None:
    assert ratio(FIRST, SECOND) == ratio(FIRST, SECOND)


def test_percentile_is_that_of_the_stop_rule() -> None:
    judged = hsi.PercentileRule().judge(FIRST)
    assert percentile(FIRST) == (judged.estimate, *judged.interval)


@pytest.mark.parametrize(("ends", "expected"), [
    ((0.95, 1.05), True), ((0.96, 1.0), True), ((0.94, 1.0), None), ((0.9, 1.2), None), ((0.8, 0.94), False),
    ((1.06, 1.1), False)])
def test_an_interval_is_inside_a_band_outside_or_neither(ends: tuple[float, float], expected: bool | None) -> None:
    assert Interval(1.0, *ends).within(0.95, 1.05) is expected


@pytest.mark.parametrize(("ends", "expected"), [((2.1, 2.2), True), ((0.5, 0.9), False), ((0.5, 1.0), None),
                                                ((1.5, 3.0), None)])
def test_an_interval_is_above_another_below_or_neither(ends: tuple[float, float], expected: bool | None) -> None:
    assert Interval(1.0, *ends).above(Interval(1.5, 1.0, 2.0)) is expected


@pytest.mark.parametrize(("interval", "expected"), [
    ((1.2, 1.1, 1.4), (0.2, 0.1, 0.4)), ((0.7, 0.6, 0.9), (0.3, 0.1, 0.4)), ((1.1, 0.8, 1.3), (0.1, 0.0, 0.3))])
def test_distance_from_one(interval: tuple[float, ...], expected: tuple[float, ...]) -> None:
    assert Interval(*interval).distance == pytest.approx(expected)


def test_a_claim_fails_if_a_cell_does_and_holds_if_all_do() -> None:
    assert verdict([True, True]) is True
    assert verdict([True, None]) is None
    assert verdict([True, None, False]) is False


# table 2

def test_table2_is_compared_with_what_is_printed() -> None:
    rows = {(row["model"], row["density_per_m2"], row["case"], row["f_b_hz"]): row for row in committed("table2")}
    assert len(rows) == 60
    for (model, density), percents in PRINTED.items():
        for (case, f_b), percent in zip(product((1, 2), (2.0, 3.25, 5.0)), percents, strict=True):
            row = rows[model, density, case, f_b]
            assert row["printed_ratio"] == pytest.approx(1 + percent / 100)
            assert row["deviation"] == pytest.approx(row["ratio"] / (1 + percent / 100) - 1, abs=1e-5, rel=2e-5)
            assert (row["order"], row["time_variant"]) == (ORDERS[model], model == "MC")
    assert rows["PMC", 1.0, 1, 3.25]["printed_percent"] == "<1"
    assert [rows["PMC", 0.2, 1, f_b]["printed_percent"] for f_b in (2.0, 3.25, 5.0)] == ["-5", "+2", "+4"]


def test_table2_intervals_contain_their_estimates_and_mc_is_its_own_measure() -> None:
    for row in committed("table2"):
        for name, unit in (("a95", "_m_per_s2"), ("ratio", ""), ("over_mf", "")):
            assert row[f"{name}_low{unit}"] <= row[f"{name}{unit}"] <= row[f"{name}_high{unit}"]
        if row["model"] == "MC":
            assert (row["ratio_low"], row["ratio"], row["ratio_high"], row["deviation"]) == (1, 1, 1, 0)
        if row["model"] == "MF":
            assert (row["over_mf_low"], row["over_mf_high"]) == (1, 1)


def peaks(trials: int) -> np.ndarray:
    """The cell at 3.25 Hz and 0.2 persons/m², all in one step, by the public functions."""
    bridge = hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=3.25, damping=0.005)
    flow = hsi.CrowdFlow(density=0.2, step_frequency=1.625)
    traffics = [flow.sample(bridge, rng=hsi.trial_rng(table2.SEED, i)) for i in range(trials)]
    return np.array([[hsi.predict(model, bridge, hsi.tune(model, bridge, traffic)).peak_acceleration
                      for model in MODELS] for traffic in traffics])


def test_table2_cell_by_a_second_road() -> None:
    rows = table2.study([SPARSE], max_trials=5)
    expected = np.quantile(peaks(5), 0.95, axis=0, method="hazen")
    assert [row["model"] for row in rows] == list(MODELS)
    assert [row["a95_m_per_s2"] for row in rows] == pytest.approx(expected, rel=1e-5)
    assert [row["ratio"] for row in rows] == pytest.approx(expected / expected[4], rel=1e-5)
    assert [row["over_mf"] for row in rows] == pytest.approx(expected / expected[1], rel=1e-5)
    assert {(row["trials"], row["settled"]) for row in rows} == {(5, False)}


@pytest.mark.parametrize("density", [0.2, 1.0])
def test_case_says_how_step_frequencies_scatter_whatever_the_density(density: float) -> None:
    bridge = hsi.reference_bridge(frequency=5.0)
    spreads = [np.std(Cell(frequency=5.0, density=density, case=case).flow.sample(
        bridge, rng=np.random.default_rng(1)).walkers.step_frequency) for case in (1, 2)]
    assert spreads == pytest.approx([0.175, 0.0], rel=0.15)


def test_unknown_cells_and_readings_are_refused() -> None:
    with pytest.raises(ValueError, match="case must be 1 or 2, got 3; choose one of these"):
        Cell(frequency=2.0, density=0.2, case=3)
    with pytest.raises(ValueError, match="tuned_to must be one of 'own', 'empty', got 'f_B'; choose one of these"):
        Reading(name="other", tuned_to="f_B")


# readings

def test_a_reading_changes_what_it_says() -> None:
    bridge = Reading(name="other", damping=0.02, modal_mass=50e3).bridge(3.25)
    (mode,) = bridge.modes
    assert (mode.frequency, mode.damping, mode.modal_mass) == (3.25, 0.02, 50e3)
    traffic = SPARSE.flow.sample(bridge, rng=np.random.default_rng(1))
    tuned = hsi.tune("PMC", bridge, traffic)
    assert tuned.target != traffic.target
    for reading, seen, warm_up in (
            (DEFAULT, tuned, None), (Reading(name="cold", warm_up=0.0), tuned, 0.0),
            (Reading(name="empty", tuned_to="empty"), traffic, None)):
        expected = hsi.predict("PMC", bridge, seen, warm_up=warm_up).peak_acceleration
        assert reading.predict("PMC", bridge, traffic).peak_acceleration == expected
    assert len({reading.name for reading in readings.READINGS}) == len(readings.READINGS)


def test_the_name_of_a_reading_tells_all_its_changes() -> None:
    changed = [sum(getattr(reading, field) != getattr(DEFAULT, field)
                   for field in ("damping", "modal_mass", "warm_up", "tuned_to")) for reading in readings.READINGS]
    assert changed == [0, *(len(reading.name.split(", ")) for reading in readings.READINGS[1:])]
    assert max(changed) == 2
    caption = readings.report(Run()).caption
    assert "each changing what its name says of the default (ξ_B 0.5 %, m_B 25 t" in caption
    assert "one change" not in caption


def test_readings_by_a_second_road() -> None:
    heavy = Reading(name="heavy", modal_mass=50e3)
    rows = readings.study([heavy, DEFAULT], [SPARSE], trials=5)
    percentiles = np.quantile(peaks(5), 0.95, axis=0, method="hazen")
    wanted = 1 + np.array([PRINTED[model, 0.2][4] for model in MODELS[:4]]) / 100
    off = percentiles[:4] / percentiles[4] / wanted - 1
    row = next(row for row in rows if row["reading"] == "default")
    assert row["median_deviation"] == pytest.approx(np.median(abs(off)), rel=1e-5)
    assert row["worst_deviation"] == pytest.approx(off[np.argmax(abs(off))], rel=1e-5)
    assert row["worst"] == f"{MODELS[np.argmax(abs(off))]}, 0.2 /m², case 2, 3.25 Hz"
    assert [row[f"median_{model.lower()}"] for model in MODELS[:4]] == pytest.approx(abs(off), rel=1e-5)
    assert (row["trials"], row["ratios"]) == (5, 4)
    assert rows[0]["median_deviation"] <= rows[1]["median_deviation"]


@pytest.mark.parametrize(("printed", "expected"), [(1.1, True), (1.21, False), (0.89, False)])
def test_a_printed_ratio_lies_in_the_interval_or_not(printed: float, expected: bool) -> None:
    one = readings.Compared(cell=SPARSE, model="MF", ratio=Interval(1.0, 0.9, 1.2), printed=printed)
    assert one.contained is expected
    assert one.deviation == pytest.approx(1 / printed - 1)


def test_committed_readings_are_sorted_and_complete() -> None:
    rows = committed("readings")
    assert {row["reading"] for row in rows} == {reading.name for reading in readings.READINGS}
    assert [row["median_deviation"] for row in rows] == sorted(row["median_deviation"] for row in rows)
    assert {row["ratios"] for row in rows} == {48}


# all studies

@pytest.mark.parametrize("recipe", [table2, readings, load_cycles, fig8])
def test_recompute_runs_the_study_where_it_is_told(recipe: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recipe, "study", lambda *given: [{"given": given}])
    executor, ledger = ThreadPoolExecutor(1), hsi.Ledger("not_made.ledger")
    report = recipe.report(Run(recompute=True, executor=executor, ledger=ledger))
    assert report.rows[0]["given"][-2:] == (executor, ledger)
    assert recipe.report(Run()).rows == committed(recipe.__name__.split(".")[-1])
    assert recipe.report(Run()).study


def test_all_studies_share_one_ledger(monkeypatch: pytest.MonkeyPatch) -> None:
    """Under as many labels as there are studies: figures 4 and 7, table 2, figure 8, spans, readings, two sweeps."""
    labels, ledger = [], hsi.Ledger("not_made.ledger")
    sizes = {SharedTrafficTrial: 5, fig8.ForcesTrial: 6, load_cycles.LoadCyclesTrial: 3, fig4.SharedCrowdTrial: 1,
             fig7.PostureTrial: 1, SpanTrial: 2, DecayTrial: 2, WalkingTrial: 4}

    def made_up(trial: Callable, *, rule: hsi.StopRule, label: str, **how: object) -> hsi.Ensemble:
        assert how["ledger"] is ledger
        labels.append(label)
        samples = np.random.default_rng(1).uniform(1.0, 2.0, (20, sizes[type(trial)]))
        return hsi.Ensemble(samples=samples, estimate=samples[0], interval=(samples[0], samples[0]), converged=False,
                            reason="", seed=1, rule=rule)
    for module in (readings, studies):
        monkeypatch.setattr(module, "monte_carlo", made_up)
    for module in (fig8, load_cycles, readings, table2):    # whose bootstraps take long
        monkeypatch.setattr(module, "ratio", lambda first, second: Interval(1.0, 0.9, 1.1))
    monkeypatch.setattr(fig4, "_rows", lambda mass_ratio, ensemble: [
        row for row in committed("fig4") if row["mass_ratio"] == mass_ratio])
    monkeypatch.setattr(fig7, "_rows", lambda trial, ensemble: [])

    def swept(make: Callable, axes: object, *, label: str, ledger: hsi.Ledger, **how: object) -> str:
        labels.append(label)
        return str(ledger)
    monkeypatch.setattr(maps, "sweep", swept)
    monkeypatch.setattr(maps, "_rows", lambda given, name: committed(
        {"r_hsi": "maps", "sf_over_mf": "stationary"}[name]) if given == str(ledger) else [])
    monkeypatch.setattr(claims, "_claims", list)            # nothing is judged
    for name in ("claims", "readings"):
        paper.compute(name, recompute=True, ledger=ledger)
    walked = len(identified.DECAYS) + len(identified.SPANS) + len(PACES) * len(identified.WALKERS)
    assert len(set(labels)) == len(labels) == 4 + len(fig7.TRIALS) + walked + 12 + 12 + 4 + 9 * 12 + 2


@pytest.mark.parametrize("trial", [
    SharedTrafficTrial(cell=SPARSE), fig8.ForcesTrial(cell=SPARSE), load_cycles.LoadCyclesTrial(length=100.0)])
def test_trials_travel_to_processes(trial: Callable) -> None:
    assert pickle.loads(pickle.dumps(trial)) == trial


# load cycles

def test_a_longer_span_is_a_slower_walk() -> None:
    """Modal force and response depend on x/L alone: twice the span is half the speed, with the same traffic."""
    slow = hsi.CrowdFlow(persons=30, speed=load_cycles.SPEED / 2, step_frequency=2.0)
    bridge = hsi.reference_bridge()
    traffic = slow.sample(bridge, rng=hsi.trial_rng(1, 0), force=hsi.ZivanovicForce().periodic())
    expected = [hsi.predict(model, bridge, traffic).peak_acceleration for model in ("SF", "MF")]
    found = load_cycles.LoadCyclesTrial(length=100.0)(hsi.trial_rng(1, 0))
    assert found[:2] == pytest.approx(expected, rel=1e-6)
    assert found[2] <= found[1]


def test_load_cycles_are_counted() -> None:
    """L f_s / v_s by hand: 50 m · 2 Hz / 1.34 m/s = 74.6; the longest span has eight times as many."""
    cycles = [row["load_cycles"] for row in committed("load_cycles")]
    assert cycles[0] == pytest.approx(74.6, abs=0.1)
    assert cycles[-1] / cycles[0] == pytest.approx(8)


# figure 8

@pytest.mark.parametrize("case", [1, 2])
def test_fig8_forces_share_their_traffic(case: int) -> None:
    trial = fig8.ForcesTrial(cell=Cell(frequency=2.0, density=0.2, case=case))
    first, *others = trial.traffic(hsi.trial_rng(1, 3)).values()
    for other in others:
        for name in ("arrival", "step_frequency", "speed", "offset", "weight"):
            np.testing.assert_array_equal(getattr(first.walkers, name), getattr(other.walkers, name))
        np.testing.assert_array_equal(first.walkers.bodies.frequency, other.walkers.bodies.frequency)
        np.testing.assert_array_equal(first.standing[1], other.standing[1])
        assert other.walkers.forces != first.walkers.forces


def test_fig8_cell_by_a_second_road() -> None:
    cell = Cell(frequency=2.0, density=0.2, case=1)
    bridge, flow = hsi.reference_bridge(frequency=2.0), hsi.CrowdFlow(density=0.2, step_frequency=(2.0, 0.175))
    rows = fig8.study([cell], max_trials=3)
    for row in rows:
        force = {"narrow band": hsi.ZivanovicForce(), "Young": hsi.YoungForce(),
                 "periodic": hsi.ZivanovicForce().periodic()}[row["force"]]
        traffics = [flow.sample(bridge, rng=hsi.trial_rng(fig8.SEED, i), force=force) for i in range(3)]
        found = [hsi.predict(row["model"], bridge, hsi.tune(row["model"], bridge, traffic)).peak_acceleration
                 for traffic in traffics]
        assert row["a95_m_per_s2"] == pytest.approx(np.quantile(found, 0.95, method="hazen"), rel=1e-5)
        narrow = next(one for one in rows if (one["model"], one["force"]) == (row["model"], "narrow band"))
        assert row["ratio"] == pytest.approx(row["a95_m_per_s2"] / narrow["a95_m_per_s2"], rel=1e-5)
    conditions = [(row["model"], row["force"]) for row in rows]
    assert conditions == list(product(("MF", "PMC"), ("narrow band", "Young", "periodic")))


def test_fig8_intervals_contain_their_estimates() -> None:
    rows = committed("fig8")
    assert len(rows) == 12 * 2 * 3
    for row in rows:
        assert row["a95_low_m_per_s2"] <= row["a95_m_per_s2"] <= row["a95_high_m_per_s2"]
        assert row["ratio_low"] <= row["ratio"] <= row["ratio_high"]


def test_fig8_draws_its_rows() -> None:
    report = paper.compute("fig8")
    ax = report.draw().axes[1, 0]
    assert ax.get_title("left") == "(d) 2 Hz, 1 persons/m²"
    rows = [row for row in report.rows if (row["density_per_m2"], row["f_b_hz"]) == (1.0, 2.0)]
    expected = [row["a95_m_per_s2"] for force in ("narrow band", "Young") for row in rows if row["force"] == force]
    assert sorted(patch.get_height() for patch in ax.patches) == pytest.approx(sorted(expected))


# claims

def as_printed(model: str, cell: Cell) -> float:
    place = (2.0, 3.25, 5.0).index(cell.frequency) + 3 * (cell.case - 1)
    return 1 + PRINTED[model, cell.density][place] / 100


AS_PRINTED = {model: partial(as_printed, model) for model in MODELS}


def table(ratios: dict[str, Callable[[Cell], float]], width: float = 0.01) -> Rows:
    """Rows of table 2 whose ratios to MC are as given, with intervals of ± `width`."""
    rows = []
    for cell, model in product(CELLS, MODELS):
        value, moving = (ratios.get(name, lambda _: 1.0)(cell) for name in (model, "MF"))
        wanted = as_printed(model, cell)
        rows.append({"density_per_m2": cell.density, "case": cell.case, "f_b_hz": cell.frequency, "model": model,
                     "printed_ratio": wanted, "deviation": value / wanted - 1,
                     **Interval(value, value - width, value + width).row("ratio"),
                     **Interval(value / moving, value / moving - width, value / moving + width).row("over_mf")})
    return rows


def judge(rows: Rows, name: str) -> Finding:
    return claims_table2.findings(rows, [])[name]()


@pytest.mark.parametrize("name", ["C20", "C21", "C23", "C24", "C25", "C41"])
def test_claims_hold_for_the_printed_table(name: str) -> None:
    """With narrow intervals; the printed 5 % of C21 needs an interval without width."""
    assert judge(table(AS_PRINTED, width=0.0 if name == "C21" else 0.001), name)[1] is True


@pytest.mark.parametrize(("name", "ratios"), [
    ("C19", {"SF": lambda cell: 1.05, "MF": lambda cell: 1.0}),
    ("C22", {"PMC": lambda cell: 1.01 if cell.density == 1.0 else 1.2}),
    ("C21", {"PMC": lambda cell: 1.02 if cell.density == 0.2 else 1.2}),
])
def test_claims_hold_for_rows_made_by_hand(name: str, ratios: dict[str, Callable[[Cell], float]]) -> None:
    assert judge(table(ratios), name)[1] is True


@pytest.mark.parametrize(("name", "ratios"), [
    ("C19", {"SF": lambda cell: 1.05 if cell.case == 1 else 0.95}),
    ("C19", {"SF": lambda cell: 1.2}),
    ("C20", {"MFAM": lambda cell: 1.1}),
    ("C20", {"MFAM": lambda cell: 0.8 if cell.density == 0.2 else 0.9}),
    ("C21", {"PMC": lambda cell: 1.07 if cell == SPARSE else 1.0}),
    ("C22", {"PMC": lambda cell: 0.95 if cell.frequency == 5.0 else 1.0}),
    ("C23", {"MF": lambda cell: 3.0 - cell.density}),
    ("C24", {"MF": lambda cell: 3.0 - cell.case}),
    ("C25", {model: lambda cell, model=model: 1.2 * AS_PRINTED[model](cell) for model in MODELS}),
    ("C41", {"MF": lambda cell: 3.0 - cell.density}),
])
def test_claims_fail_for_rows_made_by_hand(name: str, ratios: dict[str, Callable[[Cell], float]]) -> None:
    measured, holds, reason = judge(table(ratios), name)
    assert holds is False
    assert measured
    assert reason


@pytest.mark.parametrize("name", ["C19", "C20", "C21", "C22", "C23", "C24", "C25", "C41"])
def test_claims_are_undecided_where_intervals_are_wide(name: str) -> None:
    assert judge(table(AS_PRINTED, width=8.0), name)[1] is None


def test_claims_with_one_failing_cell_fail_even_if_others_are_undecided() -> None:
    rows = table({"PMC": lambda cell: 1.2 if cell == SPARSE else 1.05})
    assert judge(rows, "C21")[1] is False
    assert "outside in 1" in judge(rows, "C21")[2]


def test_deviations_are_counted_by_hand() -> None:
    """All 48 at 1.2 times the printed ratio: median 20 %, none within ±0.01."""
    rows = table({model: lambda cell, model=model: 1.2 * AS_PRINTED[model](cell) for model in MODELS})
    assert "median deviation 20.0 %" in judge(rows, "C25")[0]
    assert "0 of 48 intervals contain it" in judge(rows, "C25")[0]


@pytest.mark.parametrize(("ratios", "width", "holds"), [
    ([1.3, 1.1, 1.05, 1.0], 0.02, True), ([1.3, 1.1, 0.9, 0.8], 0.02, False), ([1.3, 1.1, 1.05, 1.0], 0.2, None),
    ([1.0, 1.0, 1.0, 1.0], 0.02, None), ([1.01, 1.1, 1.2, 1.3], 0.02, False)])
def test_claim_of_load_cycles(ratios: list[float], width: float, holds: bool | None) -> None:
    rows = [{"load_cycles": 75.0 * 2**i, **Interval(value, value - width, value + width).row("sf_over_mf"),
             **Interval(1.0, 0.95, 1.05).row("sf_over_instant")} for i, value in enumerate(ratios)]
    _, found, reason = claims_table2.findings([], rows)["C40"]()
    assert found is holds
    assert ("overlap" in reason) is (holds is None)


def test_claim_of_load_cycles_that_is_undecided_tells_what_overlaps() -> None:
    """|1.3 ± 0.2 − 1| and |1.0 ± 0.2 − 1|, by hand."""
    rows = [{"load_cycles": cycles, **Interval(value, value - 0.2, value + 0.2).row("sf_over_mf"),
             **Interval(1.0, 0.95, 1.05).row("sf_over_instant")} for cycles, value in ((75.0, 1.3), (600.0, 1.0))]
    assert claims_table2.findings([], rows)["C40"]()[2] == (
        "intervals of |SF/MF − 1| overlap: 0.3 [0.1, 0.5] with fewest load cycles, 0 [0, 0.2] with most")


def bars(ratio_of: Callable[[str, Cell, str], float], width: float = 0.01) -> Rows:
    """Rows of figure 8 whose ratios to the narrow-band force are as given."""
    return [{"density_per_m2": cell.density, "case": cell.case, "f_b_hz": cell.frequency, "model": model,
             "force": force, **Interval(value, value - width, value + width).row("ratio")}
            for cell, (model, force) in product(CELLS, fig8.CONDITIONS) if (value := ratio_of(model, cell, force))]


def by_case(model: str, cell: Cell, force: str) -> float:
    return 1 + 0.2 * cell.case


def by_model(model: str, cell: Cell, force: str) -> float:
    return 0.9 if model == "PMC" else 0.7


@pytest.mark.parametrize(("name", "ratio_of", "width", "holds"), [
    ("C26", by_case, 0.01, True), ("C26", lambda model, cell, force: 1 - 0.2 * cell.case, 0.01, True),
    ("C26", lambda model, cell, force: 1.6 - 0.2 * cell.case, 0.01, False), ("C26", by_case, 0.3, None),
    ("C26", lambda *where: 1.2, 0.01, None),
    ("C27", by_model, 0.01, True), ("C27", lambda *where: 1.6 - by_model(*where), 0.01, False),
    ("C27", by_model, 0.2, None)])
def test_claims_of_figure_8(name: str, ratio_of: Callable, width: float, holds: bool | None) -> None:
    assert claims_fig8.findings(bars(ratio_of, width))[name]()[1] is holds


def test_claims_of_figure_8_are_judged_for_youngs_force_and_tell_of_the_other() -> None:
    rows = bars(lambda model, cell, force: by_case(model, cell, force) if force == "Young" else 1.6 - 0.2 * cell.case)
    measured, holds, _ = claims_fig8.findings(rows)["C26"]()
    assert holds is True
    assert ("12 of 12 pairs, not in 0, undecided in 0 (Young), 0 of 12 pairs, not in 12, undecided in 0 (same walkers, "
            "periodic)") in measured


def test_claims_of_figure_8_count_what_is_undecided() -> None:
    measured, _, reason = claims_fig8.findings(bars(by_case, 0.3))["C26"]()
    assert "0 of 12 pairs, not in 0, undecided in 12 (Young)" in measured
    assert reason == "intervals of 12 pairs overlap"


def test_a_trial_of_table2_shares_its_traffic() -> None:
    """A trial again alone, model by model."""
    found = SharedTrafficTrial(cell=SPARSE)(hsi.trial_rng(table2.SEED, 4))
    assert found == pytest.approx(peaks(5)[4], rel=1e-9)

"""The paper redrawn: table 1 as printed, figures by second roads, and claims that can fail."""

from __future__ import annotations

import copy
import tomllib
from dataclasses import replace
from pathlib import Path

import control as ct
import matplotlib

matplotlib.use("Agg")

import numpy as np
import pytest
from matplotlib.artist import Artist
from matplotlib.axes import Axes

import hsictrl as hsi
from hsictrl import paper
from hsictrl.paper import claims_fig3, claims_fig4, fig2, fig3, fig4, table1
from hsictrl.paper.reports import Rows, committed
from hsictrl.prediction import ASSUMPTIONS

PAPER = Path(claims_fig3.__file__).parent


@pytest.fixture(scope="module")
def rows() -> Rows:
    return committed("fig4")


# Table 1 as printed, with order and type as printed in Table 2: abbreviation, name, fixed-driver term, interaction,
# n_s, time-variant; and the order for one mode and 15 persons, by hand.
PRINTED = [
    ("SF", "Stationary force model", "stationary", "disregarded", "2n_m", "No", 2),
    ("MF", "Moving force model", "moving", "disregarded", "2n_m", "No", 2),
    ("MFAM", "Moving force model with added mass", "moving", "uniformly distributed crowd mass", "2n_m", "No", 2),
    ("PMC", "Pseudo moving crowd model", "moving", "stationary human body models", "2(n_m+n_H)", "No", 32),
    ("MC", "Moving crowd model", "moving", "moving human body models", "2(n_m+n_H)", "Yes", 32),
]


def test_table1_is_as_printed_and_its_systems_are_as_large_as_it_says() -> None:
    report = paper.compute("table1")
    found = [(row["model"], row["name"].capitalize(), row["fixed_driver"], row["interaction"],
              row["order"].replace(" ", ""), "Yes" if row["time_variant"] else "No", row["order_found"])
             for row in report.rows]
    assert found == PRINTED
    assert [row["time_variant_found"] for row in report.rows] == [False, False, False, False, True]
    assert {(row["modes"], row["persons_on_deck"]) for row in report.rows} == {(1, 15)}
    assert report.draw is None


@pytest.mark.parametrize(("model", "order"), [("SF", 4), ("MF", 4), ("MFAM", 4), ("PMC", 10), ("MC", 10)])
def test_table1_counts_modes_and_people(model: str, order: int) -> None:
    """Two modes and three persons by hand: 2 · 2 and 2 · (2 + 3)."""
    bridge = hsi.Footbridge.simply_supported(length=30.0, width=2.0, mass=30e3, frequency=3.0, damping=0.01, n_modes=2)
    assert table1.found(model, bridge, table1.traffic(bridge, 3)) == (order, model == "MC")


def test_table1_walkers_are_on_the_deck_together() -> None:
    """At x = (i + ½)L/n in the middle of the window, n = 5 and L = 50 m: 5, 15, …; nobody else comes."""
    bridge = hsi.reference_bridge()
    walkers = table1.traffic(bridge, 5)
    people, places = walkers.standing_on(bridge)
    assert (len(people), len(walkers.walkers)) == (5, 5)
    assert sorted(places[:, 0]) == pytest.approx([5.0, 15.0, 25.0, 35.0, 45.0])


def test_fig1_bodies_by_closed_form() -> None:
    """k = (2πf)² m and c = 2 ξ 2πf m with 66.5 kg of 70 kg sprung at 3.25 Hz and 30 % (section 2.2)."""
    for row, x in zip(paper.compute("fig1").rows, (9.0, 25.0, 41.0), strict=True):      # 1.25 m/s (36 s - t_a)
        assert row["x_m"] == pytest.approx(x)
        assert (row["m_h1_kg"], row["m_h0_kg"]) == pytest.approx((66.5, 3.5))
        assert row["k_h1_n_per_m"] == pytest.approx((2 * np.pi * 3.25)**2 * 66.5)
        assert row["c_h1_ns_per_m"] == pytest.approx(2 * 0.3 * 2 * np.pi * 3.25 * 66.5)


def symbols(ax: Axes, gid: str) -> list[Artist]:
    return ax.findobj(lambda artist: artist.get_gid() == gid)


def test_fig1_is_drawn_from_its_rows() -> None:
    report = paper.compute("fig1")
    body, contact, *_ = report.draw().axes.flat
    assert [one.xyann[0] for one in symbols(contact, "force")] == pytest.approx([row["x_m"] for row in report.rows])
    assert {r"$m_{H1}$ = 66.5 kg", r"$k_{H1}$ = 27.7 kN/m", r"$c_{H1}$ = 815 N s/m"} <= {
        text.get_text() for text in body.texts}


@pytest.mark.parametrize("index", range(5))
def test_fig2_shows_what_the_systems_hold(index: int) -> None:
    """Bodies and added mass read from the system that each model solves, not from what it is said to assume."""
    row = paper.compute("fig2").rows[index]
    if row["model"] == "MC":
        empty, system = fig2.BRIDGE, hsi.moving_crowd(fig2.BRIDGE, fig2.WALKERS).at(fig2.TIME)
    else:
        empty, system = fig2.BRIDGE, hsi.predict(row["model"], fig2.BRIDGE, fig2.WALKERS).system
    assert row["bodies_at_m"] == pytest.approx(system.positions[:, 0].tolist())
    assert row["added_mass_kg"] == pytest.approx(system.bridge.mass - empty.mass)
    assert row["bodies_move"] == table1.found(row["model"], fig2.BRIDGE, fig2.WALKERS)[1]


def test_fig2_forces_that_move_are_elsewhere_than_those_that_stay() -> None:
    """Four walkers at 1.25 m/s: at x = (i + ½) 12.5 m in the middle of the window, 35 s, and 3.75 m further at 38 s."""
    standing = [6.25, 18.75, 31.25, 43.75]
    places = {row["model"]: sorted(row["forces_at_m"]) for row in paper.compute("fig2").rows}
    assert places["SF"] == pytest.approx(standing)
    for model in ("MF", "MFAM", "PMC", "MC"):
        assert places[model] == pytest.approx([x + 3.75 for x in standing])


def test_fig2_panels_carry_their_assumptions() -> None:
    plot = paper.compute("fig2").draw()
    titles = [ax.get_title("left") for ax in plot.axes.flat]
    assert titles[2] == "(c) MFAM: moving force model with added mass\n$n_s = 2 n_m$, time-invariant"
    assert titles[4] == "(e) MC: moving crowd model\n$n_s = 2(n_m + n_H)$, time-variant"
    counts = [[len(symbols(ax, gid)) for gid in ("force", "force motion", "added mass", "spring", "body motion")]
              for ax in plot.axes.flat]
    assert counts == [[4, 0, 0, 0, 0], [4, 4, 0, 0, 0], [4, 4, 1, 0, 0], [4, 4, 0, 4, 0], [4, 4, 0, 4, 4], [0] * 5]


def test_fig2_follows_the_assumptions() -> None:
    """An imaginary model of stationary forces among moving bodies."""
    imaginary = replace(ASSUMPTIONS["MC"], fixed_driver="stationary")
    found = fig2.scene(imaginary, fig2.BRIDGE, fig2.WALKERS, fig2.TIME)
    assert (found["forces_move"], found["bodies_move"]) == (False, True)
    assert np.subtract(found["bodies_at_m"], found["forces_at_m"]) == pytest.approx([3.75] * 4)


@pytest.mark.parametrize(("mass_ratio", "persons"), [(0.1, 71), (0.4, 286)])
def test_fig3_head_counts(mass_ratio: float, persons: int) -> None:
    """μ m / 70 kg by hand: 0.1 · 50 t / 70 kg = 71.4 and 0.4 · 50 t / 70 kg = 285.7."""
    assert fig3.persons_of(mass_ratio, hsi.reference_bridge()) == persons


@pytest.mark.parametrize("index", range(10))
def test_fig3_peaks_against_the_plain_state_space_system(index: int) -> None:
    row = paper.compute("fig3").rows[index]
    system = fig3.occupied(row["mass_ratio"], row["frequency_ratio"])
    plain = ct.ss(system.A, system.B, system.C, system.D)
    around = row["f_eff_hz"] * (1 + 1e-4 * np.arange(-5, 6))
    size = np.abs(ct.frequency_response(plain, 2 * np.pi * around).frdata[0, 0])
    assert np.argmax(size) == 5
    assert row["peak_m_per_s2_per_n"] == pytest.approx(size[5], rel=1e-9)
    assert row["xi_eff"] == pytest.approx(1 / (2 * 25e3 * size[5]), rel=1e-9)      # eq. (17)


def test_fig4_has_every_cell_once(rows: Rows) -> None:
    cells = {(row["mass_ratio"], row["xi_b"], row["f_b_hz"]) for row in rows}
    assert len(cells) == len(rows) == 4 * 3 * 51


@pytest.mark.parametrize(("mass_ratio", "xi_b", "f_b"), [(0.1, 0.005, 2.0), (0.3, 0.02, 3.5), (0.2, 0.002, 5.0)])
def test_fig4_committed_cells_by_a_second_road(rows: Rows, mass_ratio: float, xi_b: float, f_b: float) -> None:
    """The same crowds, put on the bridge one by one with `couple` and `effective`."""
    row = next(r for r in rows if (r["mass_ratio"], r["xi_b"], r["f_b_hz"]) == (mass_ratio, xi_b, f_b))
    bridge = hsi.reference_bridge(frequency=f_b, damping=xi_b)
    flow = hsi.CrowdFlow(persons=round(mass_ratio * 50e3 / 70))
    crowds = (flow.crowd(bridge, hsi.trial_rng(fig4.SEED, i)) for i in range(row["trials_run"]))
    found = np.array([[*hsi.effective(hsi.couple(bridge, *crowd))] for crowd in crowds])
    assert row["f_ratio_mean"] == pytest.approx(found[:, 0].mean() / f_b, rel=1e-5)
    assert row["xi_eff_mean"] == pytest.approx(found[:, 1].mean(), rel=1e-5)
    low, high = np.quantile(found[:, 1], [0.05, 0.95], method="hazen")
    assert row["xi_eff_p5"] == pytest.approx(low, rel=1e-5)
    assert row["xi_eff_p95"] == pytest.approx(high, rel=1e-5)


def test_fig4_intervals_are_as_narrow_as_the_stop_rule_asks(rows: Rows) -> None:
    for row in rows:
        for name in (f"{quantity}_{statistic}" for quantity in ("f_ratio", "xi_eff") for statistic in fig4.STATISTICS):
            assert 0.95 - 1e-5 <= row[f"{name}_low"] / row[name] <= 1 <= row[f"{name}_high"] / row[name] <= 1.05 + 1e-5
        assert 100 <= row["trials"] <= row["trials_run"]


def test_claims_have_findings_and_findings_have_claims() -> None:
    listed = [claim["id"] for claim in tomllib.loads((PAPER / "claims.toml").read_text(encoding="utf-8"))["claim"]]
    report = paper.compute("claims")
    assert [row["id"] for row in report.rows] == listed == [f"C{i:02d}" for i in range(1, 46)]
    for row in report.rows:
        assert {"id", "where", "says", "measured", "verdict", "reason"} <= set(row)
        assert row["verdict"] in ("holds", "fails", "undecided")
        assert bool(row["reason"]) == (row["verdict"] != "holds")


def scaled(rows: Rows, key: str, factor: float, **where: float) -> Rows:
    changed = copy.deepcopy(rows)
    for row in changed:
        if all(row[name] == value for name, value in where.items()):
            row[key] *= factor
    return changed


@pytest.mark.parametrize(("claim", "key", "factor", "where"), [
    (claims_fig4.soft_range, "f_ratio_mean", 1.2, {"mass_ratio": 0.3}),
    (claims_fig4.stiff_range, "f_ratio_mean", 1.05, {"mass_ratio": 0.05}),
    (claims_fig4.scatter, "f_ratio_p95", 1.1, {"f_b_hz": 2.0}),
    (claims_fig4.best_frequency, "xi_eff_mean", 100.0, {"f_b_hz": 2.0, "mass_ratio": 0.3}),
    (claims_fig4.relative_growth, "xi_eff_mean", 100.0, {"xi_b": 0.02}),
    (claims_fig4.onset, "xi_eff_mean", 0.1, {"mass_ratio": 0.3}),
])
def test_claims_that_hold_can_fail(rows: Rows, claim, key: str, factor: float, where: dict[str, float]) -> None:
    assert claim(rows)[1] is True
    assert claim(scaled(rows, key, factor, **where))[1] is False


def test_claim_of_the_middle_range_is_undecided_only_where_the_interval_reaches_the_bound(rows: Rows) -> None:
    assert claims_fig4.middle_range(rows)[1] is None
    lifted = scaled(rows, "xi_eff_mean", 1.05)
    assert claims_fig4.middle_range(lifted)[1] is True
    lowered = scaled(scaled(rows, "xi_eff_mean", 0.9), "xi_eff_mean_high", 0.9)
    assert claims_fig4.middle_range(lowered)[1] is False


def test_claim_of_the_number_of_trials_counts(rows: Rows) -> None:
    assert claims_fig4.number_of_trials(rows)[1] is False
    assert claims_fig4.number_of_trials(scaled(rows, "trials", 3))[1] is True


def test_claim_of_single_peaks_counts_them(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the heavy crowd all curves have one peak."""
    monkeypatch.setattr(claims_fig3, "CASES", [(0.1, ratio) for ratio in fig3.FREQUENCY_RATIOS])
    assert claims_fig3.single_peak()[1] is True


def test_added_mass_of_a_soft_bridge_by_hand() -> None:
    """71 people of 70 kg on a half sine: 71 · 70 · ½ / 25 t = 0.0994."""
    assert claims_fig3._crowd_share() == pytest.approx(0.0994)


def test_unknown_names_and_grids_are_refused() -> None:
    with pytest.raises(ValueError, match="name must be one of 'table1', 'table2', 'readings', 'load_cycles', 'fig1', "
                                         "'fig2', 'fig3', 'fig4', 'fig5', 'fig6', 'fig7', 'fig8', 'maps', 'fig9', "
                                         "'fig10', 'fig11', 'stationary', 'claims', got 'fig99'; choose one"):
        paper.compute("fig99")
    with pytest.raises(ValueError, match="grid must be one of 'coarse', 'paper', got 'fine'; choose one of these"):
        paper.compute("fig3", grid="fine")

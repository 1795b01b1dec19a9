"""The paper redrawn: figures 3 and 4 by second roads, and claims that can fail."""

from __future__ import annotations

import copy
import tomllib
from pathlib import Path

import control as ct
import numpy as np
import pytest

import hsictrl as hsi
from hsictrl import paper
from hsictrl.paper import claims_fig3, claims_fig4, fig3, fig4
from hsictrl.paper.reports import Rows, committed

PAPER = Path(claims_fig3.__file__).parent


@pytest.fixture(scope="module")
def rows() -> Rows:
    return committed("fig4")


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
    assert [row["id"] for row in report.rows] == listed == [f"C{i:02d}" for i in range(1, 13)] + ["C39", "C42"]
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


def test_unknown_names_are_refused() -> None:
    with pytest.raises(ValueError, match="name must be one of 'fig3', 'fig4', 'claims', got 'fig99'; choose one"):
        paper.compute("fig99")

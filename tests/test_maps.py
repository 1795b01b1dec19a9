"""Figures 9 to 11: rows against single studies, and claims against made-up maps whose answer is known."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from hsictrl import trial_rng
from hsictrl.paper import claims_maps, compute, maps
from hsictrl.paper.claims_maps import Told
from hsictrl.paper.maps import DAMPINGS, DENSITIES, GRIDS, KEYS, over, rows_of, study
from hsictrl.paper.reports import Run
from hsictrl.prediction import predict_tuned

FREQUENCIES, MASSES = GRIDS["coarse"].frequencies, GRIDS["coarse"].masses
TINY = replace(GRIDS["coarse"], densities=(0.2, 1.0), frequencies=(2.0, 5.0), masses=(20e3, 50e3), trials=80)


# the study

@pytest.fixture(scope="module")
def tiny():
    return study(TINY)


def test_a_cell_is_the_percentile_of_its_trials_one_by_one(tiny):
    """Every bridge alone, with the traffic that is drawn for the slowest bridge of its frequency."""
    [bridge] = [one for one in TINY.trial(density=0.2, f_b=5.0).bridges
                if (one.modes[0].modal_mass, one.damping[0]) == (50e3, 0.02)]
    slowest = TINY.trial(density=0.2, f_b=5.0).bridges[0]
    flow = TINY.trial(density=0.2, f_b=5.0).flow
    for model in ("MF", "PMC"):
        peaks = [predict_tuned(model, bridge, flow.sample(slowest, rng=trial_rng(maps.SEED, i))).peak_acceleration
                 for i in range(TINY.trials)]
        found = tiny.at({"density": 0.2, "f_b": 5.0, "model": model, "m_b": 50e3, "xi_b": 0.02})
        assert float(found.estimate) == pytest.approx(np.quantile(peaks, 0.95, method="hazen"), rel=2e-3)


def test_without_interaction_the_response_is_inverse_to_modal_mass(tiny):
    mf = tiny.at({"model": "MF"}).estimate
    np.testing.assert_allclose(mf[:, :, 0] / mf[:, :, 1], 50 / 20, rtol=1e-12)


def test_rows_hold_what_the_sweep_found(tiny, monkeypatch):
    monkeypatch.setitem(maps.GRIDS, "coarse", TINY)
    rows = rows_of(Run(recompute=True))
    assert [tuple(row[key] for key in KEYS) for row in rows] == list(
        product(TINY.densities, TINY.frequencies, TINY.masses, DAMPINGS))
    back = over(rows, "a95_pmc", "_m_per_s2")
    np.testing.assert_allclose(back.high, tiny.at({"model": "PMC"}).high, rtol=1e-5)
    reduction = [row["a95_mf_m_per_s2"] / row["a95_pmc_m_per_s2"] for row in rows]
    np.testing.assert_allclose([row["r_hsi"] for row in rows], reduction, rtol=2e-5)
    assert all(row["r_hsi_low"] <= row["r_hsi"] <= row["r_hsi_high"] and row["trials"] == 80 for row in rows)


def test_the_grid_of_the_paper_is_not_committed():
    with pytest.raises(ValueError, match=r"the grid must be coarse unless .*, got paper; add --recompute"):
        compute("fig9", grid="paper")


@pytest.mark.parametrize(("name", "panels"), [("fig9", 2), ("fig10", 15), ("fig11", 15)])
def test_figures_draw_a_panel_per_crowd_and_damping(name, panels):
    figure = compute(name).draw().figure
    assert len([ax for ax in figure.axes if ax.get_label() != "<colorbar>"]) == panels


def test_committed_maps_are_complete():
    rows = compute("maps").rows
    assert len(rows) == len(DENSITIES) * len(FREQUENCIES) * len(MASSES) * len(DAMPINGS)
    assert min(row["trials"] for row in rows) >= 400
    assert len(compute("fig9").rows) == 2 * len(FREQUENCIES) * len(MASSES)


# the claims

def cells(**quantities):
    """Rows whose quantities are functions of density, frequency, mass and damping, with intervals of ±1 %."""
    units = {"a95_mf": "_m_per_s2", "a95_pmc": "_m_per_s2"}
    return [{**dict(zip(KEYS, place, strict=True)), "trials": 400,
             **{f"{name}{end}{units.get(name, '')}": factor * value(*place) for name, value in quantities.items()
                for end, factor in (("", 1.0), ("_low", 0.99), ("_high", 1.01))}}
            for place in product(DENSITIES, FREQUENCIES, MASSES, DAMPINGS)]


def found(name, unit="", **quantities):
    return over(cells(**quantities), name, unit)


def mf(of):
    return found("a95_mf", "_m_per_s2", a95_mf=of)


def pmc(of):
    return found("a95_pmc", "_m_per_s2", a95_pmc=of)


def reduction(of):
    return found("r_hsi", r_hsi=of)


def hill(f, top, width=1.0):
    return np.exp(-((f - top) / width)**2)


@pytest.mark.parametrize(("top", "holds"), [(2.0, True), (1.0, False), (3.5, False)])
def test_c28(top, holds):
    assert claims_maps.first_harmonic_governs(mf(lambda d, f, m, xi: hill(f, top)))[1] is holds


def test_c28_is_undecided_where_two_frequencies_tie():
    assert claims_maps.first_harmonic_governs(mf(lambda d, f, m, xi: 1.0))[1] is None


@pytest.mark.parametrize(("sparse", "dense", "holds"), [
    (6.0, 20.0, True), (7.1, 16.2, True), (9.0, 20.0, False), (6.0, 30.0, False), (7.19, 20.0, None)])
def test_c29(sparse, dense, holds):
    tops = {0.2: sparse, 1.0: dense}
    assert claims_maps.highest_without_interaction(mf(lambda d, f, m, xi: tops.get(d, 99.0)))[1] is holds


@pytest.mark.parametrize(("reach", "holds"), [(0.1, True), (0.3, False), (0.05, False)])
def test_c30_extrapolates_by_the_square_root(reach, holds):
    """After 400 trials a half-width of 10 % asks for four times as many to be 5 %: 1600."""
    def wide(rows):
        for row in rows:
            own = reach * (1 + row["density_per_m2"] / 10 - 5 * row["xi_b"])
            for model in ("mf", "pmc"):
                row[f"a95_{model}_high_m_per_s2"] = 1 + own
        return rows
    one = claims_maps.needed(wide(cells(a95_mf=lambda *cell: 1.0, a95_pmc=lambda *cell: 1.0)))
    d, xi = np.array(DENSITIES)[:, None, None, None], np.array(DAMPINGS)
    expected = 400 * (reach * (1 + d / 10 - 5 * xi) / 0.05)**2
    np.testing.assert_allclose(one[0].estimate, np.broadcast_to(expected, one[0].estimate.shape), rtol=1e-9)
    assert claims_maps.trials_needed(*one)[1] is holds


@pytest.mark.parametrize(("first", "second", "holds"), [
    (2.0, 4.5, True), (3.5, 4.5, False), (2.0, 3.5, False), (1.0, 4.5, False)])
def test_c31(first, second, holds):
    def two(d, f, m, xi):
        return hill(f, first, 0.7) + 0.5 * hill(f, second, 0.5)
    assert claims_maps.two_peaks(pmc(two))[1] is holds


@pytest.mark.parametrize(("power", "holds"), [(0.5, True), (1.2, False), (-0.5, False)])
def test_c32(power, holds):
    def falls(exponent):
        return lambda d, f, m, xi: (m * xi)**-exponent
    assert claims_maps.grows_less(mf(falls(1.0)), pmc(falls(power)))[1] is holds


@pytest.mark.parametrize(("slope", "holds"), [(-1, True), (0, True), (1, False)])
def test_c33(slope, holds):
    assert claims_maps.peak_moves_up(pmc(lambda d, f, m, xi: hill(f, 2.5 + slope * (m - 35e3) / 20e3)))[1] is holds


def test_c33_is_undecided_where_the_peak_is_flat():
    assert claims_maps.peak_moves_up(pmc(lambda d, f, m, xi: 1 + 1e-3 * f * m / 50e3 * (m > 45e3)))[1] is None


@pytest.mark.parametrize(("sparse", "holds"), [(1.1, True), (1.005, None), (0.9, False)])
def test_c34(sparse, holds):
    def somewhere(d, f, m, xi):
        return sparse if (d, f, xi) == (0.2, 2.5, 0.002) else 1.0 if d > 0.2 else 0.5
    assert claims_maps.sparse_may_govern(pmc(somewhere))[1] is holds


@pytest.mark.parametrize(("top", "holds"), [(4.9, True), (4.99, None), (5.2, False)])
def test_c35(top, holds):
    assert claims_maps.highest_with_interaction(pmc(lambda d, f, m, xi: top * hill(f, 2.0)))[1] is holds


@pytest.mark.parametrize(("least", "top", "density", "damping", "holds"), [
    (1.0, 3.5, 1, -1, True), (0.9, 3.5, 1, -1, False), (1.0, 5.5, 1, -1, False), (1.0, 3.5, -1, -1, False),
    (1.0, 3.5, 1, 1, False)])
def test_c36(least, top, density, damping, holds):
    def grows(d, f, m, xi):
        return least + hill(f, top) * d**density * xi**(0.3 * damping)
    assert claims_maps.reduction_grows(reduction(grows))[1] is holds


@pytest.mark.parametrize(("dense", "sparse", "elsewhere", "holds"), [
    (2.0, 2.0, 1.0, True), (1.5, 1.5, 1.0, True), (1.2, 2.0, 1.0, False), (2.0, 1.2, 1.0, False),
    (1.43, 2.0, 1.0, None)])
def test_c37(dense, sparse, elsewhere, holds):
    def less(d, f, m, xi):
        return dense if d >= 1 else sparse if xi <= 0.005 and f >= 2 else elsewhere
    assert claims_maps.third_less(reduction(less))[1] is holds


@pytest.mark.parametrize(("slow", "fast", "holds"), [
    (1.4, 1.4, True), (1.6, 1.4, False), (1.4, 1.6, False), (1.5, 1.5, None)])
def test_c38_looks_at_damped_bridges_away_from_the_bodies(slow, fast, holds):
    def little(d, f, m, xi):
        return 3.0 if xi != 0.02 or d >= 1 or 2.5 <= f <= 4.5 else slow if f < 2.5 else fast
    assert claims_maps.little_in_damped_bridges(reduction(little))[1] is holds


@pytest.mark.parametrize(("dip", "holds"), [(2.0, True), (4.0, False), (3.0, None)])
def test_c43(dip, holds):
    def dips(d, f, m, xi):
        return dip if f == 2.7 else 3.0
    assert claims_maps.dip_between_harmonics(reduction(dips))[1] is holds


@pytest.mark.parametrize(("power", "holds"), [(1, True), (-1, False), (0, None)])
def test_c44(power, holds):
    assert claims_maps.densest_governs(mf(lambda d, f, m, xi: d**power))[1] is holds


@pytest.mark.parametrize(("ratio", "holds"), [(1.2, True), (0.8, False), (1.0, None)])
def test_c45(ratio, holds):
    assert claims_maps.stationary_reduces_more(cells(sf_over_mf=lambda *cell: ratio))[1] is holds


def test_what_is_told_about_a_share():
    told = Told(np.array([True, True, True, False]), np.array([False, False, False, True]))
    assert [told.in_share(share) for share in (0.75, 0.8)] == [True, False]
    assert Told(np.array([True, False]), np.array([False, False])).in_share(0.9) is None
    assert str(told) == "so in 3 of 4, not in 1, undecided in 0"

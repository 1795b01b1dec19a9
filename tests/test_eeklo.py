"""The footbridge in Eeklo: what is printed, closed forms for its crowds, and claims against made-up rows."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import matplotlib

matplotlib.use("Agg")

import numpy as np
import pytest

import hsictrl as hsi
from hsictrl import paper, plots
from hsictrl.paper import claims_fig7, fig6, fig7, identified
from hsictrl.paper.eeklo import BRIDGE, POSTURES, SETUPS, beside_centre, setup
from hsictrl.paper.fig7 import CONDITIONS, SEED, PostureTrial
from hsictrl.paper.reports import Finding, Rows, committed
from hsictrl.paper.virtual_tests import DURATION, PACES, WalkingTrial, to_and_fro

SWAY, BENDING = 0, 1
UPRIGHT, BENT = hsi.Pedestrian(frequency=5.7, damping=0.44), hsi.Pedestrian()
SIDEWAYS = hsi.Pedestrian(frequency=0.75, damping=0.30, direction="lateral")


@pytest.fixture(scope="module")
def rows() -> Rows:
    return committed("fig7")


# the bridge and who stands on it

def test_modal_values_are_as_printed() -> None:
    """Section 3.4: 1.71 Hz, 2.3 %, 34 t and 2.99 Hz, 0.2 %, 22 t."""
    found = [(mode.frequency, mode.damping, mode.modal_mass) for mode in hsi.eeklo_bridge().modes]
    assert found == [(1.71, 0.023, 34e3), (2.99, 0.002, 22e3)]


def test_the_first_mode_sways_and_twists_and_the_second_bends() -> None:
    sway, bending = (mode.shape for mode in hsi.eeklo_bridge().modes)
    edge, middle = hsi.eeklo_bridge().width / 2, hsi.eeklo_bridge().length / 2
    assert [float(sway(middle, y, "lateral")) for y in (-edge, 0, edge)] == [1, 1, 1]
    assert [float(sway(middle, y)) for y in (-edge, 0, edge)] == [-0.5, 0, 0.5]
    assert [float(bending(middle, y)) for y in (-edge, 0, edge)] == [1, 1, 1]
    assert not np.any(bending(middle, edge, "lateral"))
    assert [hsi.eeklo_bridge().moves_vertically(mode) for mode in (SWAY, BENDING)] == [False, True]


def test_a_lateral_torsional_shape_is_a_half_sine_with_its_derivatives_and_means() -> None:
    shape = hsi.LateralTorsionShape(length=10.0, width=2.0, ratio=-0.8)
    x, y = np.linspace(0, 10, 21)[:, None], np.array([-1.0, 0.25])
    for order in range(3):
        wave = (np.pi / 10)**order * np.sin(np.pi * x / 10 + order * np.pi / 2)
        assert shape.derivative(x, y, "lateral", order) == pytest.approx(wave + 0 * y, abs=1e-14)
        assert shape.derivative(x, y, "vertical", order) == pytest.approx(-0.8 * y * wave, abs=1e-14)
    assert not np.any([shape([-0.1, 10.1], 1.0), shape([-0.1, 10.1], 1.0, "lateral")])
    assert (shape.antinode, shape.mean_square, shape.mean_absolute) == ((5.0, 0.0), 0.5, 2 / np.pi)


@pytest.mark.parametrize(("changed", "told"), [
    ({"ratio": 1.5}, r"ratio must .*, got 1.5; scale the shape to its lateral motion, which is the larger one"),
    ({"width": 0.0}, r"width must be above 0, got 0; give the width of the deck in metres"),
    ({"length": -1.0}, r"length must be above 0, got -1; give the length of the deck in metres"),
])
def test_shapes_that_are_none_are_refused(changed: dict[str, float], told: str) -> None:
    with pytest.raises(ValueError, match=told):
        hsi.LateralTorsionShape(**{"length": 10.0, "width": 2.0, "ratio": 0.5, **changed})


@pytest.mark.parametrize(("persons", "beside"), [(3, 2), (9, 6), (15, 10), (21, 14), (26, 18), (27, 18)])
def test_setups_have_so_many_people_on_and_beside_the_central_stringer(persons: int, beside: int) -> None:
    """Three at midspan and six more each time; without the central stringer two at midspan and four more."""
    places = setup(persons)
    assert len(np.unique(places, axis=0)) == len(places) == persons
    assert beside_centre(places).sum() == beside
    assert np.all(BRIDGE.carries(places))


@pytest.mark.parametrize("persons", [3, 9, 15, 21, 27])
def test_setups_are_symmetric_about_midspan_and_the_centre_line(persons: int) -> None:
    places = setup(persons) - (BRIDGE.length / 2, 0)
    for mirror in ((-1, 1), (1, -1)):
        assert {*map(tuple, places * mirror)} == {*map(tuple, places)}


@pytest.mark.parametrize(("fewer", "more"), [(3, 9), (9, 15), (15, 21), (21, 26), (26, 27)])
def test_a_setup_adds_to_the_one_before(fewer: int, more: int) -> None:
    assert np.array_equal(setup(more)[:fewer], setup(fewer))


def test_26_of_27_leave_out_one_on_the_central_stringer() -> None:
    assert setup(27)[-1, 1] == 0


def test_other_setups_are_refused() -> None:
    with pytest.raises(ValueError, match="persons must be one of 3, 9, 15, 21, 26 or 27, got 10; choose a setup"):
        setup(10)


# closed forms

def occupied(mode: int, persons: int, *bodies: hsi.Pedestrian) -> hsi.EffectiveProperties:
    places = setup(persons)
    people = [body for body in bodies for _ in range(persons)]
    return hsi.effective(hsi.couple(BRIDGE, people, np.vstack([places] * len(bodies))), mode=mode)


def added_mass(mode: int, body: hsi.Pedestrian, persons: int, frequency: float) -> complex:
    """Σ φ² α(iω)/m_B with α by hand, over the vertical shape of one mode."""
    r, xi = frequency / body.frequency, body.damping
    apparent = 3.5 + 66.5 * (1 + 2j * xi * r) / (1 - r**2 + 2j * xi * r)
    phi = BRIDGE.modes[mode].shape(*setup(persons).T)
    return complex(np.sum(phi**2) * apparent / BRIDGE.modes[mode].modal_mass)


@pytest.mark.parametrize("persons", SETUPS)
def test_people_upright_act_as_added_mass(persons: int) -> None:
    """f/f_B ≈ 1/√(1 + Σ m φ²/m_B): rigid masses of 70 kg, which bodies of 5.7 Hz amplify by some 30 %."""
    phi = np.sin(np.pi * setup(persons)[:, 0] / BRIDGE.length)
    rigid = 1 / np.sqrt(1 + np.sum(70 * phi**2) / 22e3)
    found = occupied(BENDING, persons, UPRIGHT).frequency / 2.99
    assert found == pytest.approx(rigid, rel=0.02)
    assert found < rigid


@pytest.mark.parametrize("body", [UPRIGHT, BENT])
@pytest.mark.parametrize("persons", [3, 26])
def test_damping_is_what_bodies_take_out_at_the_peak(body: hsi.Pedestrian, persons: int) -> None:
    """1/|H| = m_B |1 + S − (ω_B/ω)² − 2iξ ω_B/ω|: at the peak the real part is small and the imaginary one 2 ξ_eff."""
    found = occupied(BENDING, persons, body)
    lag = -added_mass(BENDING, body, persons, found.frequency).imag
    assert found.damping == pytest.approx(0.002 * 2.99 / found.frequency + lag / 2, rel=0.01)


def test_lateral_bodies_damp_the_swaying_mode_by_their_lag() -> None:
    """½ Σ φ² Im α/m_B at 1.71 Hz, by hand, on top of what there is."""
    phi = np.sin(np.pi * setup(9)[:, 0] / BRIDGE.length)
    transfer = 1 + 2j * 0.3 * 1.71 / 0.75
    lag = -(66.5 * transfer / (transfer - (1.71 / 0.75)**2)).imag * np.sum(phi**2) / 34e3 / 2
    found = occupied(SWAY, 9, BENT, SIDEWAYS).damping - occupied(SWAY, 9, BENT).damping
    assert found == pytest.approx(lag, rel=0.03)


def test_lateral_bodies_leave_bending_as_it_is() -> None:
    """A symmetric plan keeps the modes apart."""
    assert [*occupied(BENDING, 9, BENT, SIDEWAYS)] == pytest.approx([*occupied(BENDING, 9, BENT)], rel=1e-9)
    assert [*occupied(BENDING, 26, SIDEWAYS)] == pytest.approx([*hsi.effective(BRIDGE, mode=BENDING)], rel=1e-12)


# figure 7

def test_rows_hold_every_cell_once(rows: Rows) -> None:
    cells = {(row["source"], row["mode"], row["lateral_bodies"], row["posture"], row["persons"]) for row in rows}
    count = len(identified.DECAYS) + len(identified.SPANS) + len(PACES) * len(identified.WALKERS)
    assert len(cells) == len(rows) == len(CONDITIONS) * len(POSTURES) * len(SETUPS) + count
    assert all(row["bodies"] == row["persons"] * (1 if row["mode"] == "vertical" else 2 / 3)
               for row in rows if row["persons"] != 26)


@pytest.mark.parametrize(("posture", "population"), [
    ("upright", hsi.Population(frequency=(5.7, 0.56), damping=(0.44, 0.07))),
    ("bent legs", hsi.Population(frequency=(3.25, 0.32), damping=(0.30, 0.05)))])
def test_a_committed_cell_by_a_second_road(rows: Rows, posture: str, population: hsi.Population) -> None:
    """The printed distributions on a bridge of the bending mode alone, which a plan symmetric across nearly is."""
    [row] = [one for one in fig7.chosen(rows, "vertical", posture) if one["persons"] == 9]
    bridge = hsi.Footbridge(modes=BRIDGE.modes[1:], length=42.0, width=3.0, mass=44e3)
    crowds = (population.sample(9, hsi.trial_rng(SEED, i)) for i in range(row["trials"]))
    found = np.array([[*hsi.effective(hsi.couple(bridge, crowd, setup(9)))] for crowd in crowds])
    assert row["f_eff_mean_hz"] == pytest.approx(found[:, 0].mean(), rel=1e-4)
    for statistic, value in zip(("p5", "p95"), np.quantile(found[:, 1], [0.05, 0.95], method="hazen"), strict=True):
        assert row[f"xi_eff_{statistic}"] == pytest.approx(value, rel=5e-3)


def test_a_committed_cell_is_that_of_its_trials(rows: Rows) -> None:
    cell = [row for row in rows if (row["source"], row["posture"], row["persons"]) == ("model", "bent legs", 3)]
    trial = PostureTrial(posture="bent legs", persons=3)
    found = np.mean([trial(hsi.trial_rng(SEED, i)) for i in range(cell[0]["trials"])], axis=0)
    assert [row["f_eff_mean_hz"] for row in cell] == pytest.approx(found[:3], rel=1e-5)
    assert [row["xi_eff_mean"] for row in cell] == pytest.approx(found[3:], rel=1e-5)


# claims

def changed(rows: Rows, factors: dict[str, float], **where: Any) -> Rows:
    """Rows of which some have their mean and its interval scaled."""
    made = copy.deepcopy(rows)
    for row in made:
        if all(row[name] == value for name, value in where.items()):
            row |= {key: by * row[key] for name, by in factors.items() for key in row if key.startswith(f"{name}_mean")}
    return made


def test_five_claims_hold_and_one_fails() -> None:
    found = {row["id"]: row for row in paper.compute("claims").rows}
    assert [found[name]["verdict"] for name in ("C13", "C14", "C15", "C16", "C17")] == ["holds"] * 5
    assert found["C18"]["verdict"] == "fails"


@pytest.mark.parametrize(("share", "told"), [(0.95, True), (0.8, None), (0.6, False)])
def test_walking_is_judged_by_the_share_of_tests_inside(rows: Rows, share: float, told: bool | None) -> None:
    made = [{**row, "inside": share} if row["source"] == "subspace" else row for row in rows]
    assert claims_fig7.walking(made)[1] is told
    first = next(row for row in made if row["source"] == "subspace")
    first["inside"] = 0.5                   # one cell is enough
    measured, found, _ = claims_fig7.walking(made)
    assert found is False
    assert "walking slowly, 9 persons 50;" in measured


@pytest.mark.parametrize(("claim", "factors", "where"), [
    (claims_fig7.upright, {"f_eff": 1.05}, {"persons": 15}),
    (claims_fig7.upright, {"xi_eff": 2.0}, {"persons": 26, "posture": "upright"}),
    (claims_fig7.bent_legs, {"f_eff": 0.95}, {"persons": 26, "posture": "bent legs", "mode": "vertical"}),
    (claims_fig7.bent_legs, {"xi_eff": 0.8}, {"persons": 26, "mode": "vertical"}),
    (claims_fig7.bent_legs, {"xi_eff": 1.3}, {"persons": 26, "posture": "upright", "mode": "vertical"}),
    (claims_fig7.added_mass, {"f_eff": 1.01}, {"posture": "upright"}),
    (claims_fig7.added_mass, {"xi_eff": 1.2}, {"posture": "bent legs", "lateral_bodies": False}),
    (claims_fig7.lateral_bodies, {"xi_eff": 0.83}, {"posture": "upright", "lateral_bodies": True}),
])
def test_claims_hold_and_can_fail(
    rows: Rows, claim: Callable[[Rows], Finding], factors: dict[str, float], where: dict[str, Any],
) -> None:
    assert claim(rows)[1] is True
    assert claim(changed(rows, factors, **where))[1] is False


@pytest.mark.parametrize(("claim", "bound", "persons", "posture"), [
    (claims_fig7.upright, 0.010, 26, "upright"), (claims_fig7.bent_legs, 0.035, 26, "bent legs")])
def test_claims_are_undecided_where_an_interval_holds_the_bound(
    rows: Rows, claim: Callable[[Rows], Finding], bound: float, persons: int, posture: str,
) -> None:
    made = copy.deepcopy(rows)
    [row] = [one for one in fig7.chosen(made, "vertical", posture) if one["persons"] == persons]
    row["xi_eff_mean_low"], row["xi_eff_mean_high"] = 0.99 * bound, 1.01 * bound
    if claim is claims_fig7.bent_legs:      # five times upright all the same
        fig7.chosen(made, "vertical", "upright")[-1].update(
            xi_eff_mean=0.005, xi_eff_mean_low=0.005, xi_eff_mean_high=0.005)
    assert claim(made)[1] is None


# virtual tests

def test_a_free_decay_shows_the_pole_of_each_crowd(rows: Rows) -> None:
    """Means over the same crowds: identified from records, against eigenvalues."""
    [row] = [one for one in fig7.chosen(rows, "vertical", "bent legs", source="free decay") if one["persons"] == 9]
    crowds = (POSTURES["bent legs"].sample(9, hsi.trial_rng(identified.SEED, i)) for i in range(row["trials"]))
    poles = np.mean([[*hsi.effective(hsi.couple(BRIDGE, crowd, setup(9)), mode=BENDING, method="pole")]
                     for crowd in crowds], axis=0)
    assert (row["f_eff_mean_hz"], row["xi_eff_mean"]) == pytest.approx(poles, rel=2e-3)


@pytest.mark.parametrize("persons", identified.WALKERS)
def test_along_the_span_people_damp_by_half_of_what_they_would_at_midspan(rows: Rows, persons: int) -> None:
    """Mean of φ² is 1/2; bodies of mean frequency and damping, to first order."""
    [row] = [one for one in fig7.chosen(rows, "vertical", identified.ALONG) if one["persons"] == persons]
    r = row["f_eff_mean_hz"] / 3.25
    apparent = 66.5 * (1 + 0.6j * r) / (1 - r**2 + 0.6j * r)
    assert row["xi_eff_mean"] == pytest.approx(0.002 * 2.99 / (3.25 * r) - persons * apparent.imag / 22e3 / 4, rel=0.05)
    assert 0.7 < row["inside"] < 0.9        # 0.81 if f and ξ knew nothing of each other


def test_as_many_walk_on_the_span_at_any_time() -> None:
    pace = PACES["walking"]
    traffic = to_and_fro(pace, 9, np.random.default_rng(1))
    assert np.all(traffic.persons_on(BRIDGE, np.linspace(0.0, DURATION, 500)) == 9)
    walkers = traffic.walkers
    assert len(np.unique(walkers.step_frequency)) == len(np.unique(walkers.offset)) == 9
    again = walkers.arrival[walkers.offset == walkers.offset[0]]
    np.testing.assert_allclose(np.diff(again), 42.0 / 1.34)
    assert np.all(BRIDGE.carries_across(walkers.offset))


def test_a_walking_test_finds_the_mode_where_bodies_put_it(rows: Rows) -> None:
    """Mean f_eff of as many with bent legs: 2.96 Hz; the empty bridge has 2.99 Hz and 0.2 %."""
    [row] = [one for one in fig7.chosen(rows, "vertical", identified.ALONG) if one["persons"] == 9]
    trial = WalkingTrial(pace="walking", persons=9, expected=row["f_eff_mean_hz"])
    found = np.array([trial(hsi.trial_rng(1, i)) for i in range(2)])
    assert np.all(np.abs(found[:, 0] - row["f_eff_mean_hz"]) < 3 * found[:, 2])
    assert np.all(found[:, 1] > 0.005)


def test_a_test_that_does_not_find_the_mode_gives_zeros() -> None:
    assert not np.any(WalkingTrial(pace="walking", persons=9, expected=0.5)(np.random.default_rng(1)))


# the drawings

def test_figure_5_shows_the_modes_and_everybody() -> None:
    report = paper.compute("fig5")
    assert len(report.rows) == 26
    shapes = [(row["phi_vertical"], row["phi_lateral"], row["phi_torsion"]) for row in report.rows[:3]]
    assert shapes == [(1, 1, pytest.approx(-1 / 3)), (1, 1, pytest.approx(1 / 3)), (1, 1, 0)]
    plot = report.draw()
    drawn = np.vstack([line.get_xydata() for line in plot.lines[2, 0]])
    assert np.array_equal(drawn, [(row["x_m"], row["y_m"]) for row in report.rows])
    assert [max(line.get_ydata()) for line in plot.lines[0, 0]] == pytest.approx([0.5, 1.0])


def test_figure_7_is_drawn_from_its_rows(rows: Rows) -> None:
    plot = paper.compute("fig7").draw()
    bent = plot.lines[1, 0][1]
    assert bent.get_xdata().tolist() == [0, *SETUPS]
    assert bent.get_ydata()[-1] == pytest.approx(100 * fig7.chosen(rows, "vertical", "bent legs")[-1]["xi_eff_mean"])
    labels = [line.get_label() for line in plot.lines[0, 1]]
    assert labels == ["upright", "bent legs", "upright, lateral bodies too", "bent legs, lateral bodies too"]


def test_plots_refuse_what_they_cannot_draw() -> None:
    crowd = {"persons": [3, 9], "frequency": [[2, 2]] * 3, "damping": [[0.1, 0.1]] * 3, "look": "filled"}
    with pytest.raises(ValueError, match=r"panels\['a'\]\['b'\] must hold .*, got no 'look'; give all"):
        plots.bands_plot({"a": {"b": {key: crowd[key] for key in ("persons", "frequency", "damping")}}})
    with pytest.raises(ValueError, match=r"\['damping'\] must have shape \(3, 2\), got \(2, 2\); give mean, 5 % and"):
        plots.bands_plot({"a": {"b": {**crowd, "damping": [[0.1, 0.1]] * 2}}})
    with pytest.raises(ValueError, match=r"places\['far'\] must lie on the deck"):
        plots.modes_plot(BRIDGE, {"far": [(50.0, 0.0)]})


# figure 6

@pytest.mark.parametrize("posture", POSTURES)
def test_a_free_decay_reads_the_pole(posture: str) -> None:
    """Identified from the record alone, against an eigenvalue of the system."""
    system = fig6.occupied(posture)
    found, pole = fig6.decay(system), hsi.effective(system, mode=1, method="pole")
    assert found.damping == pytest.approx(pole.damping, rel=2e-3)
    assert found.frequency == pytest.approx(pole.frequency, rel=1e-3)
    assert found.r_squared > 0.999


def test_figure_6_has_a_column_per_posture() -> None:
    report = paper.compute("fig6")
    assert [row["posture"] for row in report.rows] == list(POSTURES)
    assert report.draw().axes.shape == (2, 2)
    assert fig6.straight()[1] is True

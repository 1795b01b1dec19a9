"""The guides' load cases: a calculation by hand from HiVoSS, and integrals of shapes by another road."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import hsictrl as hsi
from hsictrl.assessment import PeakTrial, assessing
from hsictrl.bridge import Extent

TC3 = hsi.CrowdFlow(traffic_class="TC3")


def half_sine(frequency: float, **words) -> hsi.Footbridge:
    """50 m × 3 m of 2500 kg/m at 1.5 %."""
    return hsi.Footbridge.simply_supported(
        length=50.0, width=3.0, mass=125e3, frequency=frequency, damping=0.015, **words)


def test_hivoss_by_hand_for_a_bridge_and_a_traffic_class():
    design = hsi.guide_value(half_sine(1.7992), TC3)
    assert design.equivalent_pedestrians == pytest.approx(0.076368, abs=5e-7)
    assert design.acceleration == pytest.approx(1.0890, abs=5e-5)
    assert design.comfort_class == "CL3"


@pytest.mark.parametrize(("name", "density", "persons"), [
    ("TC1", 0.1, 15), ("TC2", 0.2, 30), ("TC3", 0.5, 75), ("TC4", 1.0, 150), ("TC5", 1.5, 225)])
def test_traffic_classes_of_hivoss_on_150_square_metres(name, density, persons):
    bridge, flow = hsi.reference_bridge(), hsi.CrowdFlow(traffic_class=name)
    assert (flow.density_on(bridge), flow.persons_on(bridge)) == (pytest.approx(density), persons)
    assert str(flow) == f"{name}, " + (f"{persons} persons" if name == "TC1" else f"{density:g} persons/m²")
    plain = hsi.CrowdFlow(persons=15) if name == "TC1" else hsi.CrowdFlow(density=density)
    one, other = (each.sample(bridge, rng=np.random.default_rng(1)) for each in (flow, plain))
    np.testing.assert_array_equal(one.walkers.arrival, other.walkers.arrival)


def test_a_class_that_hivoss_does_not_have():
    with pytest.raises(ValueError, match=r"traffic_class must be one of 'TC1', .* got 'TC6'; choose one of these"):
        hsi.CrowdFlow(traffic_class="TC6")


def test_every_critical_mode_has_a_case_of_every_guide_that_reaches_it():
    """Modes at 1, 4, 9 and 16 Hz: Sétra's first trapezoid starts at 1 Hz with zero; second harmonics hold 4 Hz."""
    cases = hsi.guide_cases(half_sine(1.0, n_modes=4), TC3)
    assert [(case.mode, case.response.guide, case.response.direction) for case in cases] == [
        (1, "hivoss", "vertical"), (1, "setra", "vertical")]
    for case in cases:        # ∫|sin| is that of a half sine
        assert case.response.reduction == pytest.approx(0.25)
        assert case.response.acceleration == pytest.approx(1.0890 / 4, rel=5e-5)


def test_the_crowd_s_mass_brings_a_mode_into_a_range_or_out_of_it():
    """TC5 on the beam adds 70 · 1.5 · 150/125e3 = 12.6 % to every modal mass."""
    lowered = math.sqrt(1 / 1.126)
    assert [case.response.guide for case in hsi.guide_cases(half_sine(4.7), TC3)] == ["setra"]
    cases = hsi.guide_cases(half_sine(4.7), hsi.CrowdFlow(traffic_class="TC5"))
    assert [case.response.guide for case in cases] == ["hivoss", "setra"]
    for case in cases:
        assert case.response.frequency == pytest.approx(4.7 * lowered)
        assert case.response.modal_mass == pytest.approx(62.5e3 * 1.126)


def test_cases_are_of_a_bridge_and_a_flow():
    with pytest.raises(TypeError, match="bridge must be of type Footbridge, got str; describe the bridge by its modes"):
        hsi.guide_cases("bridge", TC3)
    with pytest.raises(TypeError, match="flow must be of type CrowdFlow, got float; use CrowdFlow"):
        hsi.guide_cases(half_sine(2.0), 0.5)


def test_the_shape_of_two_spans_is_integrated():
    bridge = hsi.Footbridge.beam(spans=[20.0, 30.0], width=3.0, mass=100e3, frequency=1.9, damping=0.01, n_modes=2)
    for j, mode in enumerate(bridge.modes):
        pieces = [quad(lambda x, shape=mode.shape: abs(float(shape(x))), *ends)[0] for ends in ((0, 20), (20, 50))]
        square = quad(lambda x, shape=mode.shape: float(shape(x)) ** 2, 0, 50, points=[20])[0]
        extent = Extent.of(bridge, j, "vertical")
        assert extent.mean_absolute == pytest.approx(sum(pieces) / 50, rel=1e-4)
        assert (extent.largest, extent.mean_square) == (pytest.approx(1.0), pytest.approx(square / 50))


X = np.linspace(0.0, 50.0, 26)
TWIST = hsi.SampledShape(x=X, y=[-1.5, 1.5], vertical=np.outer(np.sin(np.pi * X / 50), [-1.0, 1.0]))


def one_mode(shape, frequency: float) -> hsi.Footbridge:
    return hsi.Footbridge(modes=[hsi.Mode(frequency=frequency, damping=0.015, modal_mass=62.5e3, shape=shape)],
                          length=50.0, width=3.0, mass=125e3)


def test_a_twisting_mode_is_half_as_loaded_as_one_that_bends():
    """φ = 2y/B · sin(πx/L): ∫∫|φ| is half that of the sine, though the centre line rests; ∫∫φ² a third."""
    twisting, bending = (hsi.guide_value(bridge, TC3) for bridge in (one_mode(TWIST, 1.9), half_sine(1.9)))
    assert twisting.acceleration == pytest.approx(bending.acceleration / 2, rel=1e-4)
    dense = hsi.CrowdFlow(density=1.5)
    assert Extent.of(one_mode(TWIST, 1.9), 0, "vertical").mean_square == pytest.approx(1 / 6, rel=1e-4)
    assert hsi.guide_value(one_mode(TWIST, 1.9), dense).frequency == 1.9        # 4.2 % do not count, 12.6 % do
    assert hsi.guide_value(half_sine(1.9), dense).frequency < 1.9


def test_a_mode_that_sways_and_twists_has_cases_of_both_directions():
    """Motion of the modal coordinate q = P ψ n′ ∫∫|φ|/(2ξm), times the largest φ in the direction of the load."""
    ratio = 0.4
    shape = hsi.LateralTorsionShape(length=50.0, width=3.0, ratio=ratio)
    lateral, = hsi.guide_cases(one_mode(shape, 0.9), TC3)
    assert (lateral.response.guide, lateral.response.direction, lateral.mode) == ("hivoss", "lateral", 0)
    assert lateral.response.acceleration == pytest.approx(1.0890 * 35 / 280, rel=5e-5)
    vertical = hsi.guide_cases(one_mode(shape, 1.9), TC3)
    assert [case.response.direction for case in vertical] == ["vertical", "vertical"]
    motion = 1.0890 * ratio / 2       # of the sway: a load that follows 2y/B meets half of it
    assert vertical[0].response.acceleration == pytest.approx(ratio * motion, rel=5e-5)


def test_what_hardly_moves_in_a_direction_is_not_met_by_its_load():
    for ratio, directions in ((0.009, {"lateral"}), (0.011, {"lateral", "vertical"})):
        shape = hsi.LateralTorsionShape(length=50.0, width=3.0, ratio=ratio)
        modes = [*one_mode(shape, 0.9).modes, *one_mode(shape, 1.9).modes]
        bridge = hsi.Footbridge(modes=modes, length=50.0, width=3.0, mass=125e3)
        assert {case.response.direction for case in hsi.guide_cases(bridge, TC3)} == directions


def test_a_load_needs_motion_in_its_direction():
    with pytest.raises(ValueError, match="mode must move in the direction of the load, got mode 0, which has"):
        hsi.guide_value(half_sine(1.9), TC3, direction="lateral")
    with pytest.raises(ValueError, match="direction must be one of 'vertical', 'lateral', got 'up'"):
        hsi.guide_value(half_sine(1.9), TC3, direction="up")


# a study of any mode

PAIR = hsi.Footbridge.beam(spans=[30.0, 24.0], width=3.0, mass=81e3, frequency=2.0, damping=0.01, n_modes=2)
RULE = hsi.PercentileRule(percentile=90.0, tolerance=0.5)


@pytest.fixture(scope="module")
def second():
    return hsi.assess(PAIR, hsi.CrowdFlow(persons=8), force=hsi.YoungForce(), rule=RULE, mode=1, goal="CL2")


@pytest.mark.parametrize("model", ["MF", "PMC"])
def test_the_mode_in_resonance_by_hand(second, model):
    """On the bridge as it stands: walkers stepped to the second mode by hand, read at its antinode."""
    trial = hsi.trial_rng(1, 5)
    traffic = second.flow.sample(PAIR.led_by(1), rng=trial, force=hsi.YoungForce())
    met = PAIR.modes[1].frequency if model == "MF" else hsi.effective(
        hsi.couple(PAIR, *traffic.standing_on(PAIR)), mode=1).frequency
    by_hand = hsi.predict(model, PAIR, traffic.tuned(hsi.resonant_step_frequency(met)[0]),
                          sense_at=[PAIR.modes[1].shape.antinode])
    ensemble = second.mf if model == "MF" else second.pmc
    assert by_hand.peak_acceleration == pytest.approx(ensemble.samples[5], rel=1e-6)
    assert second.prediction(model, trial=5).peak_acceleration == ensemble.samples[5]


def test_effective_properties_and_guide_are_those_of_the_mode_in_resonance(second):
    alone = hsi.study_effective(PAIR, second.flow, rule=hsi.MeanRule(tolerance=0.5), mode=1)
    np.testing.assert_array_equal(second.effective.samples, alone.samples)
    assert second.guide == hsi.guide_value(PAIR, second.flow, mode=1)
    assert second.guides == hsi.guide_cases(PAIR, second.flow)
    assert second.to_dict()["mode"] == 1


def test_critical_modes_that_are_left_out_are_named(second):
    assert second.remarks == ("mode 0 (2 Hz) is critical by the guides too; this study is of mode 1",)


def test_first_and_second_mode_share_a_ledger(monkeypatch, tmp_path):
    usual = assessing.monte_carlo
    monkeypatch.setattr(assessing, "monte_carlo", lambda *a, **k: usual(*a, **k, max_trials=2))
    book = hsi.Ledger(tmp_path / "both.ledger")
    for mode in (0, 1):
        hsi.assess(PAIR, hsi.CrowdFlow(persons=1), force=hsi.HarmonicForce([0.4]), rule=RULE, mode=mode, ledger=book)
    assert sorted(book.trials()) == ["1 persons, MF", "1 persons, PMC", "1 persons, effective", "1 persons, mode 1, MF",
                                     "1 persons, mode 1, PMC", "1 persons, mode 1, effective"]


def test_verdicts_are_read_from_the_intervals(second):
    assert second.verdicts == tuple(hsi.comfort_verdict(one.interval, "CL2") for one in (second.mf, second.pmc))
    assert (second.to_dict()["verdict_mf"], second.to_dict()["verdict_pmc"]) == second.verdicts


@pytest.mark.parametrize(("words", "says"), [
    ({"mode": 2}, "mode must be below the number of modes 2, got 2"),
    ({"goal": "CL4"}, "goal must be one of 'CL1', 'CL2', 'CL3', got 'CL4'; choose"),
])
def test_what_cannot_be_assessed(words, says):
    with pytest.raises(ValueError, match=says):
        hsi.assess(PAIR, TC3, **words)


def test_a_mode_that_only_sways_is_refused_by_its_number():
    sway = hsi.Mode(frequency=1.0, damping=0.01, modal_mass=25e3, shape=hsi.SineShape(50.0, direction="lateral"))
    bridge = hsi.Footbridge(modes=[*hsi.reference_bridge().modes, sway], length=50.0, width=3.0, mass=50e3)
    with pytest.raises(ValueError, match=r"mode 1 must move vertically, got a shape .*, so choose another"):
        hsi.assess(bridge, TC3, mode=1)
    lateral = [case for case in hsi.guide_cases(bridge, TC3) if case.mode == 1]
    assert [case.response.direction for case in lateral] == ["lateral"]


def test_led_by_only_puts_a_mode_first():
    assert [mode.frequency for mode in PAIR.led_by(1).modes] == [PAIR.modes[j].frequency for j in (1, 0)]
    traffic = TC3.sample(PAIR, rng=np.random.default_rng(2), force=hsi.YoungForce())
    there, here = (hsi.couple(bridge, *traffic.standing_on(bridge)) for bridge in (PAIR, PAIR.led_by(1)))
    assert tuple(hsi.effective(there, mode=1)) == pytest.approx(tuple(hsi.effective(here, mode=0)), rel=1e-9)
    assert PeakTrial(model="MF", bridge=PAIR.led_by(0), flow=TC3) == PeakTrial(model="MF", bridge=PAIR, flow=TC3)

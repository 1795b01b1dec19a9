"""The main job: trials that can be run again alone, one crowd for both models, and the guides by hand."""

import json
import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from hsictrl import (
    CrowdFlow,
    Footbridge,
    HarmonicForce,
    MeanRule,
    Mode,
    PercentileRule,
    SineShape,
    YoungForce,
    assess,
    comfort_class,
    couple,
    effective,
    guide_value,
    predict,
    reference_bridge,
    study_effective,
    trial_rng,
    tune,
)
from hsictrl.assessment import EffectiveTrial, PeakTrial, assessing, effective_rule
from hsictrl.study import AllRules

BRIDGE, FLOW, SEED = reference_bridge(frequency=2.0), CrowdFlow(persons=15), 4
RULE = PercentileRule(percentile=90.0, tolerance=0.5)


@pytest.fixture(scope="module")
def found():
    return assess(BRIDGE, FLOW, force=YoungForce(), rule=RULE, seed=SEED)


# trials

@pytest.mark.parametrize("index", [0, 17, 99])
@pytest.mark.parametrize("model", ["MF", "PMC"])
def test_every_trial_can_be_run_again_alone(found, model, index):
    ensemble = found.mf if model == "MF" else found.pmc
    trial = PeakTrial(model=model, bridge=BRIDGE, flow=FLOW, force=YoungForce())
    assert trial(trial_rng(SEED, index)) == ensemble.samples[index]
    alone = EffectiveTrial(bridge=BRIDGE, flow=FLOW)(trial_rng(SEED, index))
    np.testing.assert_array_equal(alone, found.effective.samples[index])


def test_both_models_see_the_same_people_each_at_its_own_resonance(found):
    people = FLOW.sample(BRIDGE, rng=trial_rng(SEED, 3), force=YoungForce())
    for model, ensemble in (("MF", found.mf), ("PMC", found.pmc)):
        assert predict(model, BRIDGE, tune(model, BRIDGE, people)).peak_acceleration == ensemble.samples[3]


@pytest.mark.parametrize("model", ["MF", "PMC"])
def test_a_step_frequency_by_hand_is_not_retuned(model):
    flow = CrowdFlow(persons=15, step_frequency=1.8)
    trial = PeakTrial(model=model, bridge=BRIDGE, flow=flow, force=HarmonicForce([0.4]))
    traffic = flow.sample(BRIDGE, rng=trial_rng(1, 0), force=HarmonicForce([0.4]))
    assert trial(trial_rng(1, 0)) == predict(model, BRIDGE, traffic).peak_acceleration
    assert trial(trial_rng(1, 0)) != predict(model, BRIDGE, tune(model, BRIDGE, traffic)).peak_acceleration


def test_workers_do_not_change_the_answer(found):
    with ThreadPoolExecutor(2) as executor:
        again = assess(BRIDGE, FLOW, force=YoungForce(), rule=RULE, seed=SEED, executor=executor)
    assert again.to_dict() == found.to_dict()


def test_an_effective_trial_is_the_crowd_of_the_flow_on_the_bridge():
    people, places = FLOW.crowd(BRIDGE, trial_rng(SEED, 2))
    by_hand = effective(couple(BRIDGE, people, places))
    np.testing.assert_array_equal(EffectiveTrial(bridge=BRIDGE, flow=FLOW)(trial_rng(SEED, 2)),
                                  [by_hand.frequency, by_hand.damping])


def test_effective_properties_of_a_mode_that_people_do_not_drive():
    """On 3 modes, 0.1 persons/m² of 70 kg add at most m/M = 2.1 % to the modal mass: f₃ = 18 Hz ± 2 %."""
    bridge = Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=0.005, n_modes=3)
    frequency, _ = study_effective(bridge, FLOW, rule=MeanRule(), mode=2).estimate.ravel()
    assert frequency == pytest.approx(18.0, rel=0.021)


# what is read from the ensembles

def test_reduction_and_its_interval(found):
    """Eq. 18; the ratio is smallest from the low end of the numerator to the high end of the denominator."""
    without, within = (np.sort(ensemble.samples) for ensemble in (found.mf, found.pmc))
    assert found.mf.estimate == pytest.approx(np.percentile(without, 90), rel=0.02)
    assert found.reduction == pytest.approx(np.percentile(without, 90) / np.percentile(within, 90), rel=0.04)
    low, high = found.reduction_interval
    assert low == found.mf.interval[0] / found.pmc.interval[1]
    assert high == found.mf.interval[1] / found.pmc.interval[0]
    assert low < found.reduction < high


def test_classes_are_those_of_the_two_percentiles(found):
    assert found.classes == (comfort_class(found.mf.estimate), comfort_class(found.pmc.estimate))
    changed = replace(found, mf=replace(found.mf, estimate=2.6), pmc=replace(found.pmc, estimate=0.4))
    assert changed.classes == ("CL4", "CL1")        # beyond 2.5 and below 0.5 m/s², the bounds of HiVoSS (2008)


def test_the_dictionary_is_ready_for_json_and_names_its_units(found):
    row = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert row["density_per_m2"] == 0.1
    assert row["persons"] == 15
    assert row["f_eff_hz"] == pytest.approx(np.mean(found.effective.samples[:, 0]))
    assert row["xi_eff"] == pytest.approx(np.mean(found.effective.samples[:, 1]))
    for name, ensemble in (("mf", found.mf), ("pmc", found.pmc)):
        assert row[f"a_{name}_m_per_s2"] == ensemble.estimate
        assert (row[f"a_{name}_low_m_per_s2"], row[f"a_{name}_high_m_per_s2"]) == ensemble.interval
        assert row[f"a_{name}_trials"] == len(ensemble.samples)
        assert row[f"a_{name}_converged"] is True
    assert (row["r_hsi"], row["r_hsi_low"], row["r_hsi_high"]) == (found.reduction, *found.reduction_interval)
    assert (row["class_mf"], row["class_pmc"]) == found.classes
    for name in ("f_eff{}_hz", "xi_eff{}", "r_hsi{}", "a_mf{}_m_per_s2", "a_pmc{}_m_per_s2"):
        assert row[name.format("_low")] < row[name.format("")] < row[name.format("_high")]


def test_the_interval_of_the_mean_is_student_s(found):
    frequencies = found.effective.samples[:, 0]
    error = np.std(frequencies, ddof=1) / math.sqrt(len(frequencies))
    row = found.to_dict()
    assert row["f_eff_high_hz"] - row["f_eff_low_hz"] == pytest.approx(2 * 1.984 * error, rel=1e-3)    # t, 99 degrees


# remarks

def test_a_study_that_has_not_settled_says_so(monkeypatch):
    usual = assessing.monte_carlo
    monkeypatch.setattr(assessing, "monte_carlo", lambda *a, **k: usual(*a, **k, max_trials=30))
    found = assess(BRIDGE, FLOW, force=HarmonicForce([0.4]), rule=PercentileRule(percentile=50.0, tolerance=0.01))
    assert [remark[:26] for remark in found.remarks] == [
        "MF: stopped at max_trials=", "PMC: stopped at max_trials", "effective properties: stop"]
    assert json.loads(json.dumps(found.to_dict()))["a_mf_converged"] is False


def test_a_resonance_that_only_the_crowd_brings_below_walking_is_remarked():
    bridge = reference_bridge(frequency=1.0)        # f_eff lies below 1 Hz with people
    remarks = assess(bridge, FLOW, force=HarmonicForce([0.4]), rule=RULE).remarks
    assert len(remarks) == 2
    assert "lies outside 1.0–2.5 Hz" in remarks[0]
    assert remarks[1] == "1 Hz lies outside the range for which HiVoSS has a load"    # its ψ starts at 1.25 Hz
    by_hand = CrowdFlow(persons=15, step_frequency=1.8)
    assert assess(bridge, by_hand, force=HarmonicForce([0.4]), rule=RULE).remarks == remarks[1:]


def test_a_mode_that_the_crowd_takes_out_of_the_range_is_told_by_its_loaded_frequency():
    """HiVoSS has no load from 2.3 to 2.5 Hz: 10500 kg of people on half-sines take 2.55 Hz, which has one, to 2.318."""
    found = assess(reference_bridge(frequency=2.55), CrowdFlow(density=1.0), force=HarmonicForce([0.4]), rule=RULE)
    assert found.guide.acceleration == 0.0
    assert "2.318 Hz, with the crowd's mass, lies outside the range for which HiVoSS has a load" in found.remarks


# the guides

@pytest.mark.parametrize(("density", "damping", "modal_mass"), [
    (0.1, 0.005, 25e3), (0.2, 0.005, 25e3), (0.5, 0.005, 25e3), (1.0, 0.01, 25e3), (1.5, 0.01, 50e3),
])
def test_the_guide_s_value_by_hand(density, damping, modal_mass):
    """HiVoSS (2008): P = 280 N, n′ = 10.8 √(ξn)/S or 1.85 √n/S, half sine; mass of the crowd from 5 % on."""
    bridge, area = reference_bridge(frequency=2.0, damping=damping, modal_mass=modal_mass), 150.0
    crowd = 70.0 * density * area / 2                                       # ∫∫ sin² = half the area
    mass = modal_mass + (crowd if crowd > 0.05 * modal_mass else 0.0)
    frequency = 2.0 * math.sqrt(modal_mass / mass)
    corners = [(1.25, 0.0), (1.7, 1.0), (2.1, 1.0), (2.3, 0.0)]
    reduction = np.interp(frequency, *zip(*corners, strict=True))
    n = density * area
    equivalent = (10.8 * math.sqrt(damping * n) if density < 1 else 1.85 * math.sqrt(n)) / area
    by_hand = 280.0 * reduction * equivalent * (2 / math.pi * area) / (2 * damping * mass)
    guide = guide_value(bridge, CrowdFlow(density=density))
    assert (guide.frequency, guide.modal_mass) == (pytest.approx(frequency), pytest.approx(mass))
    assert guide.acceleration == pytest.approx(by_hand, rel=1e-12)
    assert (mass > modal_mass) == (density > 0.2)                           # 2.1 % and 4.2 % are left out


def test_the_guide_s_value_of_a_higher_mode():
    """Second mode at 8 Hz: beyond both harmonics, no load; Sétra's second harmonic ends at 5 Hz."""
    bridge = Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=0.005, n_modes=2)
    assert guide_value(bridge, FLOW, mode=1).acceleration == 0
    five = reference_bridge(frequency=4.8)
    assert guide_value(five, FLOW).acceleration == 0
    assert guide_value(five, FLOW, guide="setra").reduction == pytest.approx(0.25 * (5.0 - 4.8) / 0.8)


def test_the_assessment_holds_the_guide_s_value(found):
    assert found.guide == guide_value(BRIDGE, FLOW)


def test_figure_4_waits_for_mean_and_both_tails():
    rule = effective_rule(0.1)
    assert isinstance(rule, AllRules)
    samples = np.random.default_rng(0).normal(1.0, 0.05, 500)
    np.testing.assert_allclose(rule.judge(samples).estimate, [1.0, 0.918, 1.082], atol=0.01)    # ∓1.645 σ


# what should not be run for an hour is refused at once

SWAY = Mode(frequency=1.0, damping=0.01, modal_mass=25e3, shape=SineShape(50.0, direction="lateral"))
LATERAL = Footbridge(modes=[SWAY], length=50.0, width=3.0, mass=50e3)


@pytest.mark.parametrize(("bridge", "flow", "message"), [
    (BRIDGE, CrowdFlow(density=2.0), r"density must lie in \(0, 1.5\], got 2; beyond 1.5 persons/m² walking"),
    (reference_bridge(damping=0.0), FLOW, r"damping\[0\] must lie in \(0, 1\), got 0; nothing settles"),
    (BRIDGE, CrowdFlow(density=0.001), r"density must put at least one person on the deck of 150 m², got 0.001"),
    (LATERAL, FLOW, "the first mode must move vertically, got a shape that does not at its antinode; walking"),
    (BRIDGE, CrowdFlow(persons=900), r"density must lie in \(0, 1.5\], got 6; beyond 1.5 persons/m²"),
])
def test_what_the_guide_refuses_is_refused_before_the_first_trial(monkeypatch, bridge, flow, message):
    monkeypatch.setattr(assessing, "monte_carlo", lambda *a, **k: pytest.fail("a study was begun"))
    with pytest.raises(ValueError, match=message):
        assess(bridge, flow)

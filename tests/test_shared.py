"""Peaks that share their work against the predictions that do not, one bridge at a time."""

from itertools import product

import numpy as np
import pytest

from hsictrl import (
    CrowdFlow,
    Footbridge,
    HarmonicForce,
    Mode,
    Population,
    SineShape,
    Traffic,
    Walker,
    YoungForce,
    ZivanovicForce,
    reference_bridge,
)
from hsictrl.assessment import PeaksTrial
from hsictrl.prediction import predict_tuned
from hsictrl.prediction.shared import SHARED_MODELS, tuned_peaks

LENGTH = 50.0
FORCES = [ZivanovicForce(), ZivanovicForce().periodic(), YoungForce(), HarmonicForce([0.4, 0.1])]


def bridges(frequencies=(2.0,), dampings=(0.002, 0.02), masses=(20e3, 50e3)):
    return [reference_bridge(frequency=frequency, damping=damping, modal_mass=mass)
            for frequency, damping, mass in product(frequencies, dampings, masses)]


def peaks(model, several, traffic):
    [found] = tuned_peaks([model], several, traffic)
    return found


def one_by_one(model, several, traffic):
    return [predict_tuned(model, bridge, traffic).peak_acceleration for bridge in several]


@pytest.mark.parametrize("model", SHARED_MODELS)
@pytest.mark.parametrize(("frequency", "density"), [(2.0, 1.0), (3.25, 0.2), (5.0, 0.5)])
def test_peaks_are_those_of_each_bridge_alone(model, frequency, density):
    several = bridges(frequencies=[frequency])
    traffic = CrowdFlow(density=density).sample(several[0], rng=np.random.default_rng(1))
    # bridges that are tuned alike have the warm-up of the slowest
    np.testing.assert_allclose(peaks(model, several, traffic), one_by_one(model, several, traffic), rtol=5e-3)


@pytest.mark.parametrize("model", SHARED_MODELS)
@pytest.mark.parametrize("force", FORCES, ids=lambda force: type(force).__name__)
def test_one_bridge_is_predict_tuned_for_every_force(model, force):
    [bridge] = bridges(dampings=[0.005], masses=[25e3])
    traffic = CrowdFlow(density=0.5).sample(bridge, rng=np.random.default_rng(2), force=force)
    # tables of parts are read, and blended, in another order; effective() and effective_map agree to 1e-10
    np.testing.assert_allclose(peaks(model, [bridge], traffic), one_by_one(model, [bridge], traffic), rtol=1e-6)


def test_models_together_are_the_models_alone():
    several = bridges(frequencies=[2.5])
    traffic = CrowdFlow(density=0.5).sample(several[0], rng=np.random.default_rng(5))
    together = tuned_peaks(["PMC", "SF", "MF"], several, traffic)
    for model, found in zip(["PMC", "SF", "MF"], together, strict=True):
        # one record of forces for all, whose step is that of the highest line among them
        np.testing.assert_allclose(found, peaks(model, several, traffic), rtol=2e-3)


def test_bridges_of_several_frequencies_share_traffic_too():
    several = bridges(frequencies=[2.0, 4.5], dampings=[0.02], masses=[50e3])
    traffic = CrowdFlow(density=0.2).sample(several[0], rng=np.random.default_rng(3))
    np.testing.assert_allclose(peaks("MF", several, traffic), one_by_one("MF", several, traffic), rtol=2e-3)


def test_peaks_come_in_the_order_of_the_bridges():
    several = bridges()
    traffic = CrowdFlow(density=0.2).sample(several[0], rng=np.random.default_rng(4))
    for model in SHARED_MODELS:
        forth, back = peaks(model, several, traffic), peaks(model, several[::-1], traffic)
        np.testing.assert_allclose(forth, back[::-1], rtol=1e-12)


def test_walkers_made_by_hand():
    walkers = [Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25, arrival=t) for t in (0.0, 3.0)]
    traffic, several = Traffic(walkers), bridges(dampings=[0.01])
    for model in SHARED_MODELS:
        np.testing.assert_allclose(peaks(model, several, traffic), one_by_one(model, several, traffic), rtol=1e-6)


def two_modes():
    return Footbridge(modes=[Mode(frequency=f, damping=0.01, modal_mass=25e3, shape=SineShape(LENGTH, j))
                       for j, f in ((1, 2.0), (2, 5.0))], length=LENGTH, width=3.0, mass=50e3)


@pytest.mark.parametrize(("model", "several", "message"), [
    ("MC", bridges(), "models must be one of .*'SF', 'MF', 'PMC'.*, got 'MC'"),
    ("MF", [], "bridges must hold at least one, got none; give"),
    ("MF", [2.0], "bridges must be of type Footbridge, got float; describe each"),
    ("MF", [two_modes()], "bridges must have one mode each, got 2; use predict for each"),
    ("MF", [reference_bridge(), Footbridge.simply_supported(
        length=40.0, width=3.0, mass=50e3, frequency=2.0, damping=0.005)],
     "bridges must have the same deck and shape, got several"),
])
def test_refusals(model, several, message):
    traffic = CrowdFlow(density=0.2).sample(reference_bridge(), rng=np.random.default_rng(1))
    with pytest.raises((TypeError, ValueError), match=message):
        peaks(model, several, traffic)


def test_traffic_is_asked_for():
    with pytest.raises(TypeError, match=r"traffic must be of type Traffic, got int; draw it with CrowdFlow.sample"):
        tuned_peaks(["MF"], bridges(), 3)


@pytest.mark.parametrize(("changes", "message"), [
    ({"models": "MF"}, "models must be of type list or tuple, got str; give a list"),
    ({"models": []}, "models must hold at least one, got none"),
    ({"models": ["MC"]}, "models must be one of .*, got 'MC'"),
    ({"bridges": reference_bridge()}, "bridges must be of type list or tuple, got Footbridge; give a list"),
    ({"bridges": [two_modes()]}, "bridges must have one mode each, got 2"),
    ({"flow": CrowdFlow(density=0.2, step_frequency=2.0)}, "flow must leave step frequencies to the resonance"),
    ({"force": 3}, "force must be of type WalkingForce, got int"),
])
def test_a_trial_of_peaks_refuses(changes, message):
    given = {"models": ["MF"], "bridges": bridges(), "flow": CrowdFlow(density=0.2)} | changes
    with pytest.raises((TypeError, ValueError), match=message):
        PeaksTrial(**given)


# what a second look found

def sideways(**changes):
    return Population(frequency=(0.75, 0.1), damping=(0.3, 0.0), direction="lateral", **changes)


def test_lateral_bodies_leave_a_vertical_mode_alone():
    [bridge] = bridges(dampings=[0.005], masses=[20e3])
    traffic = CrowdFlow(density=0.2, population=sideways()).sample(bridge, rng=np.random.default_rng(1))
    [[mf], [pmc]] = tuned_peaks(["MF", "PMC"], [bridge], traffic)
    assert pmc == pytest.approx(one_by_one("PMC", [bridge], traffic)[0], rel=1e-6)
    assert pmc == pytest.approx(mf, rel=1e-2)       # but for a longer warm-up: the bodies take part in nothing


def test_bodies_with_hardly_any_damping():
    several = bridges(dampings=[0.005, 0.02], masses=[20e3])
    flow = CrowdFlow(density=0.2, population=Population(frequency=(3.25, 0.3), damping=(0.004, 0.0)))
    traffic = flow.sample(several[0], rng=np.random.default_rng(1))
    np.testing.assert_allclose(peaks("PMC", several, traffic), one_by_one("PMC", several, traffic), rtol=1e-3)


def test_a_bridge_without_a_peak_is_refused_as_alone():
    [bridge] = bridges(dampings=[0.8], masses=[20e3])
    traffic = CrowdFlow(density=0.2).sample(bridge, rng=np.random.default_rng(2))
    for road in (one_by_one, peaks):
        with pytest.raises(ValueError, match=r"the band must hold a peak of \|H\|"):
            road("PMC", [bridge], traffic)


def test_a_light_bridge_under_a_dense_crowd():
    [bridge] = bridges(frequencies=[6.0], dampings=[0.02], masses=[1e3])
    traffic = CrowdFlow(density=1.5).sample(bridge, rng=np.random.default_rng(1))
    np.testing.assert_allclose(peaks("PMC", [bridge], traffic), one_by_one("PMC", [bridge], traffic), rtol=1e-6)


def test_decks_are_the_same_by_value():
    several = [Footbridge.beam(spans=[50.0], width=3.0, mass=5e4, frequency=f, damping=0.01) for f in (2.0, 2.5)]
    traffic = CrowdFlow(density=0.2).sample(several[0], rng=np.random.default_rng(1))
    np.testing.assert_allclose(peaks("MF", several, traffic), one_by_one("MF", several, traffic), rtol=2e-3)
    assert several[0].modes[0].shape == several[1].modes[0].shape != Footbridge.beam(
        spans=[25.0, 25.0], width=3.0, mass=5e4, frequency=2.0, damping=0.01).modes[0].shape

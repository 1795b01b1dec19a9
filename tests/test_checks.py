"""Every refusal says the rule, the value and the remedy (habit 11 of the house)."""

import control as ct
import numpy as np
import pytest

import hsictrl as hsi
from hsictrl import (
    CrowdFlow,
    Footbridge,
    HarmonicForce,
    MeanRule,
    Traffic,
    Walker,
    Walkers,
    YoungForce,
    ZivanovicForce,
    assess,
    guide_value,
    predict,
    reference_bridge,
    resonant_step_frequency,
    study_effective,
    tune,
    weidmann_speed,
)
from hsictrl import _checks as check
from hsictrl.assessment import EffectiveTrial, PeakTrial

BRIDGE, FLOW = reference_bridge(frequency=2.0), CrowdFlow(density=0.2)
NAN, RNG = float("nan"), np.random.default_rng(1)


def walker(**changes):
    return Walker(**({"force": HarmonicForce([0.43]), "step_frequency": 2.0, "speed": 1.25} | changes))


def traffic(**options):
    return Traffic([walker()], **options)


def walkers(**changes):
    own = Walkers.of([walker(), walker(arrival=1.0)])
    return Walkers(**({name: getattr(own, name) for name in Walkers.__slots__} | changes))


def refused(kind, call, *parts):
    """The message is rule, got value, remedy: all three, in this order."""
    rule, value, remedy = parts
    with pytest.raises(kind) as caught:
        call()
    message = str(caught.value)
    assert rule in message, message
    assert f"got {value}" in message.split(rule, 1)[1], message
    assert remedy in message.split(f"got {value}", 1)[1], message
    assert "; " in message, message


# the checks themselves

@pytest.mark.parametrize(("bounds", "rule", "outside", "inside"), [
    ({"above": 0}, "be above 0", [0, -1], [1e-300, 1e300]),
    ({"least": 0}, "be at least 0", [-1e-9], [0, 5]),
    ({"below": 3}, "be below 3", [3, 4], [2.9, -1e9]),
    ({"most": 3}, "be at most 3", [3.1], [3, -7]),
    ({"above": 0, "below": 5.4}, "lie in (0, 5.4)", [0, 5.4], [5.3]),
    ({"least": 0, "below": 1}, "lie in [0, 1)", [-0.1, 1], [0, 0.99]),
    ({"least": 0.5, "most": 3.5}, "lie in [0.5, 3.5]", [0.49, 3.6], [0.5, 3.5]),
    ({}, "be finite", [], [-5, 0]),
])
def test_bounds_are_kept_and_named(bounds, rule, outside, inside):
    for value in inside:
        assert check.number("it", value, **bounds, remedy="mend it") == value
    for value in [*outside, NAN, np.inf, -np.inf]:
        named = "be finite" if np.isinf(value) else rule
        refused(ValueError, lambda value=value: check.number("it", value, **bounds, remedy="mend it"),
                f"it must {named}", f"{value:g}", "mend it")
        refused(ValueError, lambda value=value: check.numbers("it", [[inside[0], value]], **bounds, remedy="mend it"),
                f"it[0, 1] must {named}", f"{value:g}", "mend it")


@pytest.mark.parametrize("value", ["2", None, True, 1j, [[1], [1, 2]], object()])
def test_what_is_no_real_number_is_refused_by_type(value):
    with pytest.raises(TypeError, match=r"it must be real numbers, got .*; mend it$"):
        check.number("it", value, remedy="mend it")


def test_long_values_are_cut_short_in_messages():
    with pytest.raises(TypeError, match=r"got 'x{56}\.\.\.; mend it$"):
        check.number("it", "x" * 1000, remedy="mend it")


def test_arrays_are_copied_and_read_only():
    given = np.array([1.0, 2.0])
    checked = check.numbers("it", given, remedy="mend it")
    given[0] = 9.0
    np.testing.assert_array_equal(checked, [1.0, 2.0])
    assert not checked.flags.writeable


@pytest.mark.parametrize(("given", "places"), [
    ([], np.empty((0, 2))), (3.0, [[3, 0]]), ([1, 2], [[1, 0], [2, 0]]), ([(1, 0.5), (2, -1)], [[1, 0.5], [2, -1]]),
])
def test_points_are_pairs(given, places):
    np.testing.assert_array_equal(check.points("it", given), places)


@pytest.mark.parametrize(("kind", "call", "rule", "value", "remedy"), [
    (ValueError, lambda: check.number("it", [1, 2], remedy="mend it"), "must be one number", "an array of shape (2,)",
     "mend it"),
    (ValueError, lambda: check.numbers("it", [1], ndim=2, remedy="mend it"), "must have 2 dimension(s)", "shape (1,)",
     "mend it"),
    (TypeError, lambda: check.whole("it", 2.0, least=1, remedy="mend it"), "must be a whole number", "2.0", "mend it"),
    (TypeError, lambda: check.whole("it", True, least=1, remedy="mend it"), "must be a whole number", "True",
     "mend it"),
    (ValueError, lambda: check.whole("it", 0, least=1, remedy="mend it"), "must be at least 1", "0", "mend it"),
    (ValueError, lambda: check.choice("it", "c", ("a", "b")), "must be one of 'a', 'b'", "'c'", "choose one"),
    (TypeError, lambda: check.instance("it", 1, (str, list), "mend it"), "must be of type str or list", "int",
     "mend it"),
    (ValueError, lambda: check.points("it", [[1, 2, 3]]), "must have shape (n,) or (n, 2)", "(1, 3)", "give x [m]"),
])
def test_checks_refuse(kind, call, rule, value, remedy):
    refused(kind, call, rule, value, remedy)


# crowd

CROWD = {
    "density zero": (ValueError, lambda: CrowdFlow(density=0.0), "density must lie in (0, 5.4)", "0", "jam density"),
    "density negative": (ValueError, lambda: CrowdFlow(density=-1), "density must lie in (0, 5.4)", "-1",
                         "persons per"),
    "density of the jam": (ValueError, lambda: weidmann_speed(5.4), "must lie in (0, 5.4)", "5.4", "below the jam"),
    "density nan": (ValueError, lambda: CrowdFlow(density=NAN), "density must lie in (0, 5.4)", "nan", "persons per"),
    "density text": (TypeError, lambda: CrowdFlow(density="1"), "density must be real numbers", "'1'", "persons per"),
    "both": (ValueError, lambda: CrowdFlow(density=1, persons=15), "or a number of persons, or a traffic_class",
             "density=1 and persons=15", "give one of them"),
    "neither": (ValueError, lambda: CrowdFlow(), "a number of persons, or a traffic_class", "none", "give one of them"),
    "half a person": (TypeError, lambda: CrowdFlow(persons=2.5), "persons must be a whole number", "2.5", "give the"),
    "nobody": (ValueError, lambda: CrowdFlow(persons=0), "persons must be at least 1", "0", "give the number"),
    "too many": (ValueError, lambda: CrowdFlow(persons=900).sample(BRIDGE, rng=RNG), "density must lie in (0, 5.4)",
                 "6",
                 "below the jam"),
    "flow at rest": (ValueError, lambda: CrowdFlow(density=1, speed=0), "speed must lie in (0, 10]", "0", "give m/s"),
    "flow in km/h": (ValueError, lambda: CrowdFlow(density=1, speed=11), "speed must lie in (0, 10]", "11", "give m/s"),
    "flow's step": (ValueError, lambda: CrowdFlow(density=1, step_frequency=5.0),
                    "step_frequency must lie in [0.5, 3.5]",
                    "5", "give f_s, not a bridge"),
    "flow's spread": (ValueError, lambda: CrowdFlow(density=1, step_frequency=(2.0, -1.0)), "must be at least 0", "-1",
                      "people step"),
    "flow's triple": (ValueError, lambda: CrowdFlow(density=1, step_frequency=(2.0, 0.1, 1.0)),
                      "a number or (mean, standard deviation)", "shape (3,)", "give one of these"),
    "flow's weight": (ValueError, lambda: CrowdFlow(density=1, weight=0), "weight must be above 0", "0", "give N"),
    "flow's people": (TypeError, lambda: CrowdFlow(density=1, population=70.0), "must be of type Population", "float",
                      "Population.walking()"),
    "flow's seed": (TypeError, lambda: FLOW.sample(BRIDGE, rng=1), "rng must be of type Generator", "int",
                    "default_rng(seed)"),
    "flow's bridge": (TypeError, lambda: FLOW.sample(50.0, rng=RNG), "must be of type Footbridge", "float",
                      "by its modes"),
    "flow's force": (TypeError, lambda: FLOW.sample(BRIDGE, rng=RNG, force=0.4), "must be of type WalkingForce",
                     "float",
                     "HarmonicForce"),
    "crowd's seed": (TypeError, lambda: FLOW.crowd(BRIDGE, 1), "rng must be of type Generator", "int",
                     "default_rng(seed)"),
    "crowd's bridge": (TypeError, lambda: FLOW.crowd(None, RNG), "must be of type Footbridge", "NoneType",
                       "by its modes"),
    "resonance": (ValueError, lambda: resonant_step_frequency(0), "frequency must be above 0", "0", "give Hz"),
    "walker at rest": (ValueError, lambda: walker(speed=0), "speed must lie in (0, 10]", "0", "give m/s"),
    "walker's step": (ValueError, lambda: walker(step_frequency=0.4), "must lie in [0.5, 3.5]", "0.4", "give f_s"),
    "walker's fast step": (ValueError, lambda: walker(step_frequency=3.6), "must lie in [0.5, 3.5]", "3.6", "give f_s"),
    "walker's weight": (ValueError, lambda: walker(weight=-700), "weight must be above 0", "-700", "give N"),
    "walker's offset": (ValueError, lambda: walker(offset=NAN), "offset must be finite", "nan", "give m"),
    "walker's arrival": (ValueError, lambda: walker(arrival=np.inf), "arrival must be finite", "inf", "give s"),
    "walker's body": (TypeError, lambda: walker(body=70.0), "body must be of type Pedestrian", "float",
                      "hsictrl.Pedestrian()"),
    "walker's force": (TypeError, lambda: walker(force=[0.4]), "must be of type WalkingForce", "list",
                       "use HarmonicForce"),
    "no traffic": (ValueError, lambda: Traffic([]), "must hold at least one walker", "none", "use couple(bridge)"),
    "one walker": (TypeError, lambda: Traffic(walker()), "must be of type Sequence", "Walker", "give a list of Walker"),
    "strangers": (TypeError, lambda: Traffic([walker(), 1]), "must be of type Walker", "int", "give a list of Walker"),
    "no generator": (ValueError, lambda: Traffic([walker(force=ZivanovicForce())]), "draws 505 random numbers",
                     "no generator", "rng=numpy.random.default_rng"),
    "a seed": (TypeError, lambda: Traffic([walker(force=YoungForce())], rng=1), "must be of type Generator", "int",
               "default_rng(seed)"),
    "window reversed": (ValueError, lambda: traffic(window=(5, 1)), "start before end", "(5.0, 1.0)", "swap or widen"),
    "window empty": (ValueError, lambda: traffic(window=(1, 1)), "start before end", "(1.0, 1.0)", "swap or widen"),
    "window nan": (ValueError, lambda: traffic(window=(0, NAN)), "window[1] must be finite", "nan",
                   "give (start, end)"),
    "window number": (ValueError, lambda: traffic(window=40.0), "1 dimension(s)", "shape ()", "give (start, end)"),
    "target": (ValueError, lambda: traffic(target=0.0), "target must be above 0", "0", "give Hz"),
    "standing alone": (TypeError, lambda: traffic(standing=FLOW), "standing must be of type tuple", "CrowdFlow",
                       "CrowdFlow.crowd"),
    "standing triple": (ValueError, lambda: traffic(standing=(1, 2, 3)), "must be a pair", "3 values",
                        "give (people, places)"),
    "standing strangers": (TypeError, lambda: traffic(standing=([], [])), "must be of type Crowd", "list",
                           "give (people, places)"),
    "standing nowhere": (ValueError, lambda: traffic(standing=(FLOW.crowd(BRIDGE, RNG)[0], [1.0])),
                         "one place per body", "30 bodies and 1 places", "give (people, places)"),
    "since nan": (ValueError, lambda: traffic().since(NAN), "time must be finite", "nan", "give s"),
    "nobody observed": (ValueError, lambda: traffic().since(1.0).observed(BRIDGE), "a walker or a window", "neither",
                        "give window=(start, end)"),
    "tuned to zero": (ValueError, lambda: traffic().tuned(0.0), "step_frequency must be above 0", "0", "mean step"),
    "tuned backwards": (ValueError, lambda: Traffic([walker(step_frequency=f) for f in (1.0, 3.0)]).tuned(0.5),
                        "every step frequency must be above 0", "-0.5 Hz for walker 0", "tune to a higher"),
    "uneven arrays": (ValueError, lambda: walkers(offset=[0.0]), "must have the same length", "{",
                      "one value per walker"),
    "walkers' weight": (ValueError, lambda: walkers(weight=[700.0, 0.0]), "weight[1] must be above 0", "0",
                        "one weight"),
    "walkers' draws": (ValueError, lambda: walkers(forces=(YoungForce(),)), "of shapes [(2, 4)]", "[(2, 0)]",
                       "rng.random"),
    "walkers' models": (ValueError, lambda: walkers(model=np.array([0, 1])), "of shapes [(1, 0)]", "[(2, 0)]",
                        "draw them"),
    "positions": (ValueError, lambda: walkers().position([[1.0]]), "1 dimension(s)", "shape (1, 1)", "list of seconds"),
}


@pytest.mark.parametrize("name", CROWD)
def test_the_crowd_refuses(name):
    refused(*CROWD[name])


# prediction

def asked(model="MF", bridge=BRIDGE, who=None, **options):
    return predict(model, bridge, traffic() if who is None else who, **options)


PREDICTION = {
    "model": (ValueError, lambda: asked("FEM"), "model must be one of 'SF', 'MF', 'MFAM', 'PMC'", "'FEM'", "choose"),
    "model's case": (ValueError, lambda: asked("mf"), "model must be one of", "'mf'", "choose one"),
    "tuned model": (ValueError, lambda: tune("FEM", BRIDGE, traffic()), "model must be one of", "'FEM'", "choose one"),
    "bridge": (TypeError, lambda: asked(bridge=50.0), "bridge must be of type Footbridge", "float", "by its modes"),
    "tuned bridge": (TypeError, lambda: tune("MF", 50.0, traffic()), "must be of type Footbridge", "float",
                     "by its modes"),
    "traffic": (TypeError, lambda: asked(who=FLOW), "traffic must be of type Traffic", "CrowdFlow", "CrowdFlow.sample"),
    "tuned traffic": (TypeError, lambda: tune("MF", BRIDGE, [walker()]), "must be of type Traffic", "list",
                      "Traffic([walker])"),
    "uneven times": (ValueError, lambda: asked(timepts=[0, 1, 3]), "must increase evenly", "steps from 1 to 2 s",
                     "linspace"),
    "times reversed": (ValueError, lambda: asked(timepts=[2, 1, 0]), "must increase evenly", "steps from -1 to -1",
                       "linspace"),
    "times at rest": (ValueError, lambda: asked(timepts=[1, 1]), "must increase evenly", "steps from 0 to 0",
                      "linspace"),
    "one time": (ValueError, lambda: asked(timepts=[1.0]), "at least two times", "1", "give an array"),
    "a number": (ValueError, lambda: asked(timepts=1.0), "1 dimension(s)", "shape ()", "evenly spaced"),
    "times nan": (ValueError, lambda: asked(timepts=[0, NAN]), "timepts[1] must be finite", "nan", "evenly spaced"),
    "warm-up": (ValueError, lambda: asked(warm_up=-1), "warm_up must be at least 0", "-1", "give s"),
    "warm-up of drawn traffic": (ValueError, lambda: asked(who=FLOW.sample(BRIDGE, rng=RNG), warm_up=-1),
                                 "warm_up must be at least 0", "-1", "give s"),
    "warm-up nan": (ValueError, lambda: asked(warm_up=NAN), "warm_up must be at least 0", "nan", "give s"),
    "sense": (ValueError, lambda: asked(sense_at=[51.0]), "sense_at must lie on the deck", "sense_at[0] = (51, 0)",
              "move it"),
    "another bridge": (ValueError, lambda: asked("PMC", Footbridge.simply_supported(
        length=10.0, width=3.0, mass=1e4, frequency=2.0, damping=0.01), FLOW.sample(BRIDGE,
        rng=np.random.default_rng(1))),
        "standing must lie on the deck", "standing[", "move it"),
}


@pytest.mark.parametrize("name", PREDICTION)
def test_the_prediction_refuses(name):
    refused(*PREDICTION[name])


# assessment

ASSESSMENT = {
    "bridge": (TypeError, lambda: assess(50.0, FLOW), "bridge must be of type Footbridge", "float", "by its modes"),
    "flow": (TypeError, lambda: assess(BRIDGE, 1.0), "flow must be of type CrowdFlow", "float", "CrowdFlow(density=…)"),
    "force": (TypeError, lambda: assess(BRIDGE, FLOW, force=0.4), "force must be of type WalkingForce", "float",
              "HarmonicForce"),
    "rule": (TypeError, lambda: assess(BRIDGE, FLOW, rule=MeanRule()), "must be of type PercentileRule", "MeanRule",
             "tolerance="),
    "seed": (ValueError, lambda: assess(BRIDGE, FLOW, seed=-1), "seed must be at least 0", "-1", "give 0, 1"),
    "executor": (TypeError, lambda: assess(BRIDGE, FLOW, executor=4), "must be of type Executor", "int",
                 "concurrent.futures"),
    "model": (ValueError, lambda: PeakTrial(model="FEM", bridge=BRIDGE, flow=FLOW), "model must be one of", "'FEM'",
              "choose"),
    "trial's flow": (TypeError, lambda: PeakTrial(model="MF", bridge=BRIDGE, flow=traffic()),
                     "must be of type CrowdFlow",
                     "Traffic",
                     "CrowdFlow(persons=…)"),
    "mode": (ValueError, lambda: EffectiveTrial(bridge=BRIDGE, flow=FLOW, mode=1), "below the number of modes 1", "1",
             "count modes from 0"),
    "study's bridge": (TypeError, lambda: study_effective(50.0, FLOW), "must be of type Footbridge", "float",
                       "by its modes"),
    "study's mode": (ValueError, lambda: study_effective(BRIDGE, FLOW, mode=3), "number of modes 1", "3",
                     "count modes"),
    "guide": (ValueError, lambda: guide_value(BRIDGE, FLOW, guide="iso"), "guide must be one of", "'iso'",
              "choose one"),
    "guide's flow": (TypeError, lambda: guide_value(BRIDGE, 0.2), "flow must be of type CrowdFlow", "float",
                     "CrowdFlow(density=…)"),
    "obstructed": (ValueError, lambda: guide_value(BRIDGE, CrowdFlow(density=1.6)), "density must lie in (0, 1.5]",
                   "1.6",
                   "walking is obstructed"),
}


@pytest.mark.parametrize("name", ASSESSMENT)
def test_the_assessment_refuses(name):
    refused(*ASSESSMENT[name])


@pytest.mark.parametrize("flow", [CrowdFlow(density=5.39), CrowdFlow(persons=1, step_frequency=(0.5, 0.0)),
                                  CrowdFlow(density=0.2, speed=10, step_frequency=3.5)])
def test_what_lies_just_inside_is_taken(flow):
    assert flow.speed_on(BRIDGE) > 0
    assert len(flow.crowd(BRIDGE, RNG)[0]) == flow.persons_on(BRIDGE)


@pytest.mark.parametrize(("call", "message"), [
    (lambda: hsi.interconnect([1, 2]), "syslist must be of type InputOutputSystem, got int; give a list of control"),
    (lambda: hsi.interconnect(None), "syslist must be of type Sequence, got NoneType; give a list of control systems"),
    (lambda: hsi.Crowd.of(None), "bodies must be of type Sequence, got NoneType; give a sequence of Pedestrian"),
    (lambda: hsi.Pedestrian().ss(ports=None), r"ports must be \('y', 'v', 'a'\) or \('y', 'v'\), got None; choose"),
    (lambda: hsi.reference_bridge().ss(at=[25.0], ports=7), r"ports must be .*, got 7; choose one of these"),
    (lambda: hsi.reference_bridge().participation([25.0] * 3, ["vertical", "lateral"]),
     "direction must be one for all positions or one each, got 2 for 3 positions; match them"),
    (lambda: hsi.CrowdFlow(persons=10).density_on(3), "bridge must be of type Footbridge, got int; describe the"),
    (lambda: hsi.couple(hsi.reference_bridge(), name=3), "name must be of type str, got int; give a word"),
    (lambda: hsi.PercentileRule(percentile=0.95), r"percentile must lie in \[1, 100\), got 0.95; give percent"),
    (lambda: hsi.MeasuredBridge(response=ct.frd(np.ones((2, 2, 5)), np.arange(1.0, 6.0)), positions=[25.0, 25.0],
                                modal_mass=1.0),
     r"positions must differ, got positions\[1\] = \(25, 0\) m a second time; leave one of the two channels out"),
])
def test_what_used_to_fail_below_is_refused_above(call, message):
    with pytest.raises((TypeError, ValueError), match=message):
        call()

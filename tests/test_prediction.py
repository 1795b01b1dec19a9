"""Predictions against the closed form of one crossing force, and against the host's own solver.

Closed form: a mode z″ + 2ξωz′ + ω²z = (P/m) cos(Ωt + θ) sin(jπvt/L) is driven by two harmonics at Ω ± jπv/L from
rest for 0 ≤ t ≤ L/v, and vibrates freely after. Host: `control.forced_response` of the very system that responds.
"""

import json
import pickle

import control as ct
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from hsictrl import (
    CrowdFlow,
    Footbridge,
    HarmonicForce,
    Mode,
    Pedestrian,
    Population,
    Prediction,
    SineShape,
    Traffic,
    Walker,
    YoungForce,
    ZivanovicForce,
    couple,
    effective,
    predict,
    reference_bridge,
    simulate,
    tune,
)
from hsictrl.bridge import Shape
from hsictrl.prediction import predict_tuned

LENGTH, MASS = 50.0, 25e3
NOBODY = (Population.walking().sample(0, np.random.default_rng(0)), np.empty((0, 2)))


def walker(**changes):
    return Walker(**({"force": HarmonicForce([0.43]), "step_frequency": 2.0, "speed": 1.25} | changes))


def closed_form(times, bridge, one, x=LENGTH / 2):
    """Acceleration at x under the first harmonic of one walker, mode by mode."""
    force = one.force.lines([one.step_frequency], [one.weight], np.empty((1, 0)))
    load, t = force.coefficients[0, 0] * np.exp(2j * np.pi * one.step_frequency * one.arrival), times - one.arrival
    return sum(np.sin((j + 1) * np.pi * x / bridge.length) * crossing(t, mode, load, one, (j + 1) * np.pi)
               for j, mode in enumerate(bridge.modes))


def crossing(t, mode, load, one, half_waves):
    """z″(t) of a mode crossed by Re load exp(iΩt) from t = 0 on, all in complex exponentials."""
    omega, xi, end = 2 * np.pi * mode.frequency, mode.damping, mode.shape.length / one.speed
    shift, pole = half_waves / end, -xi * omega + 1j * omega * np.sqrt(1 - xi**2)
    # cos(Ωt + θ) sin(qt) = ½ Re{−i exp[i(Ω + q)t + iθ] + i exp[i(Ω − q)t + iθ]}
    rates = 2j * np.pi * one.step_frequency + 1j * shift * np.array([1, -1])
    amplitudes = load / (2 * mode.modal_mass) * np.array([-1j, 1j]) / (rates**2 + 2 * xi * omega * rates + omega**2)

    def steady(time, order):
        return sum(a * rate**order * np.exp(rate * time) for a, rate in zip(amplitudes, rates, strict=True)).real

    def free(time, order, z, dz):
        amplitude = z + 1j * (pole.real * z - dz) / pole.imag
        return (amplitude * pole**order * np.exp(pole * time)).real

    start = -steady(0.0, 0), -steady(0.0, 1)
    left = [steady(end, order) + free(end, order, *start) for order in (0, 1)]
    on, off = np.clip(t, 0, end), np.clip(t - end, 0, None)
    return np.where(t < 0, 0.0, np.where(t <= end, steady(on, 2) + free(on, 2, *start), free(off, 2, *left)))


def accelerations(*arguments, **options):
    return np.asarray(predict(*arguments, **options).response.y)


def relative(found, expected):
    return np.max(np.abs(found - expected)) / np.max(np.abs(expected))


def test_the_closed_form_solves_the_equation_of_motion():
    """Duhamel's integral by the trapezoidal rule on 200 000 points, against a slip in the closed form itself."""
    bridge, one = reference_bridge(frequency=2.0), walker(step_frequency=1.9, arrival=1.0)
    mode, now = bridge.modes[0], 33.3
    tau = np.linspace(1.0, now, 200_001)
    push = 301 * np.cos(2 * np.pi * 1.9 * tau) * np.sin(np.pi * 1.25 * (tau - 1.0) / LENGTH) / MASS
    omega, decay = mode.omega * np.sqrt(1 - mode.damping**2), mode.damping * mode.omega
    kernel = (1j * np.exp((-decay + 1j * omega) * (now - tau)) * (-decay + 1j * omega)**2 / omega).real
    by_hand = push[-1] - np.trapezoid(kernel * push, tau)
    assert closed_form(np.array([now]), bridge, one)[0] == pytest.approx(by_hand, rel=1e-6)


# MF against the closed form

CROSSINGS = [      # f_B, ξ_B, f_s, phase, arrival, speed, error at 0.01 s
    pytest.param(2.0, 0.005, 2.0, 0.0, 0.0, 1.25, 1e-6, id="resonant"),
    pytest.param(2.0, 0.002, 2.0, 1.0, 3.337, 1.34, 1e-6, id="light damping"),
    pytest.param(2.0, 0.0, 2.0, 0.4, 1.234, 1.25, 1e-6, id="no damping"),
    pytest.param(1.0, 0.02, 1.0, 0.3, 0.0, 1.1, 1e-6, id="low frequency"),
    pytest.param(2.4, 0.3, 2.4, 0.3, -5.0, 0.8, 1e-5, id="heavy damping"),
    # off resonance the response is small and the kinks of stepping on and off weigh more
    pytest.param(2.0, 0.005, 1.9, 0.7, 3.3, 1.25, 5e-6, id="near resonance"),
    pytest.param(5.0, 0.005, 2.5, 1.0, 3.337, 1.0577, 1e-4, id="far below resonance"),
]


@pytest.mark.parametrize(("frequency", "damping", "step", "phase", "arrival", "speed", "error"), CROSSINGS)
def test_one_force_crosses_as_in_closed_form(frequency, damping, step, phase, arrival, speed, error):
    bridge = reference_bridge(frequency=frequency, damping=damping)
    one = walker(force=HarmonicForce([0.43], phases=[phase]), step_frequency=step, arrival=arrival, speed=speed)
    times = arrival - 20.0 + 0.01 * np.arange(round(100 * (LENGTH / speed + 60)))
    expected = closed_form(times, bridge, one)
    found = accelerations("MF", bridge, Traffic([one]), timepts=times)[0]
    assert relative(found, expected) < error
    before = times < arrival - 0.5
    assert np.max(np.abs(found[before])) < error * np.max(np.abs(expected))
    after = times > arrival + LENGTH / speed + 0.5
    assert np.max(np.abs((found - expected)[after])) < error * np.max(np.abs(expected))


@pytest.mark.parametrize(("frequency", "damping", "step", "error"), [
    (2.0, 0.005, 2.0, 1e-5), (2.0, 0.0, 2.0, 1e-5), (2.0, 0.005, 1.9, 1e-4), (1.0, 0.02, 1.0, 5e-5),
    (3.25, 0.002, 2.5, 1e-3),
])
def test_default_grid_and_its_peak(frequency, damping, step, error):
    bridge, one = reference_bridge(frequency=frequency, damping=damping), walker(step_frequency=step, arrival=0.777)
    result = predict("MF", bridge, Traffic([one]))
    times = result.response.time
    assert (times[0], times[-1]) == (0.777, pytest.approx(40.777))
    assert np.diff(times).max() <= 1 / (40 * frequency) * (1 + 1e-9)
    dense = np.linspace(times[0], times[-1], 400_001)
    peak = np.max(np.abs(closed_form(dense, bridge, one)))
    assert np.max(np.abs(result.response.outputs - closed_form(times, bridge, one))) < error * peak
    assert result.peak_acceleration == pytest.approx(peak, rel=1e-3)


@pytest.mark.parametrize(("step", "damping"), [(2.0, 0.005), (1.7, 0.0), (2.2, 0.02)])
def test_error_falls_with_the_square_of_the_step(step, damping):
    bridge, one = reference_bridge(frequency=2.0, damping=damping), walker(step_frequency=step)
    sizes = np.array([0.02, 0.01, 0.005, 0.0025])

    def error(size):     # the worst of several places of the kinks between the samples
        grids = [size * (k + 0.03) + np.arange(-1.0, 60.0, size) for k in np.arange(8) / 8]
        return max(np.max(np.abs(accelerations("MF", bridge, Traffic([one]), timepts=t)[0]
                                 - closed_form(t, bridge, one))[t > 41]) for t in grids)

    order = np.polyfit(np.log(sizes), np.log([error(size) for size in sizes]), 1)[0]
    assert order == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("n_modes", [2, 3])
def test_several_modes_and_several_points_in_closed_form(n_modes):
    bridge = Footbridge.simply_supported(length=LENGTH, width=3.0, mass=2 * MASS, frequency=1.9, n_modes=n_modes,
                                         damping=[0.005, 0.01, 0.003][:n_modes])
    one, points = walker(step_frequency=1.85, arrival=0.5), [12.5, 20.0, 40.0]
    times = np.arange(-2.0, 60.0, 0.005)
    found = predict("MF", bridge, Traffic([one]), timepts=times, sense_at=points).response
    assert found.output_labels == ["a[0]", "a[1]", "a[2]"]
    for x, signal in zip(points, found.y, strict=True):
        assert relative(signal, closed_form(times, bridge, one, x)) < 1e-5


@settings(deadline=None, derandomize=True, max_examples=40)
@given(frequency=st.floats(1.0, 6.0), damping=st.floats(0.0, 0.2), step=st.floats(0.8, 2.5), phase=st.floats(-3, 3),
       speed=st.floats(0.5, 3.0), arrival=st.floats(-30.0, 30.0), weight=st.floats(1.0, 2000.0))
def test_any_crossing_in_closed_form(frequency, damping, step, phase, speed, arrival, weight):
    bridge = reference_bridge(frequency=frequency, damping=damping)
    one = walker(force=HarmonicForce([0.43], phases=[phase]), step_frequency=step, speed=speed, arrival=arrival,
                 weight=weight)
    times = np.linspace(arrival - 5.0, arrival + LENGTH / speed + 20.0, 5001)
    found = accelerations("MF", bridge, Traffic([one]), timepts=times)[0]
    # in units of P/m; a kink is missed by at most its step of slope, πv/L, times the length of a step
    error = np.max(np.abs(found - closed_form(times, bridge, one))) / (0.43 * weight / MASS)
    assert error < np.pi * speed / LENGTH * np.diff(times).max()


# PMC and MF against the host

BODIES = Population.walking().sample(10, np.random.default_rng(5))


def mixed_traffic(**options):
    forces = [HarmonicForce([0.43, 0.1], phases=[0.3, 1.0]), ZivanovicForce(), YoungForce()]
    return Traffic([walker(body=BODIES[i], force=forces[i % 3], weight=600.0 + 30 * i, step_frequency=1.7 + 0.05 * i,
                           speed=1.0 + 0.08 * i, arrival=3.1 * i - 7.3, offset=0.2 * i - 1.0) for i in range(10)],
                   rng=np.random.default_rng(8), **options)


def host(system, traffic, times, step):
    """`control.forced_response` under forces at n_m points that do to the modes what the walkers do."""
    bridge, walkers = system.bridge, traffic.walkers
    points = np.arange(1, bridge.n_modes + 1) * bridge.length / (bridge.n_modes + 1)
    driven = couple(bridge, system.people, system.positions, force_at=points, sense_at=system.sense_at)
    refined = round((times[1] - times[0]) / step)
    fine = np.linspace(times[0], times[-1], (len(times) - 1) * refined + 1)
    modal = np.zeros((bridge.n_modes, len(fine)))
    for who, lines in walkers.lines():
        for k, force in zip(who, lines.at(fine), strict=True):
            x = walkers.speed[k] * (fine - walkers.arrival[k])
            rows = [np.sin(j * np.pi * x / bridge.length) for j in range(1, bridge.n_modes + 1)]
            modal += np.where((x >= 0) & (x <= bridge.length), rows, 0.0) * force
    at_points = np.sin(np.outer(np.arange(1, bridge.n_modes + 1), points) * np.pi / bridge.length)
    response = ct.forced_response(driven, fine, np.linalg.solve(at_points, modal), squeeze=False)
    return response.outputs[:, ::refined]


@pytest.mark.parametrize("n_modes", [1, 2])
@pytest.mark.parametrize("model", ["MF", "PMC"])
def test_a_crowd_is_the_host_s_forced_response(model, n_modes):
    bridge = Footbridge.simply_supported(length=LENGTH, width=3.0, mass=2 * MASS, frequency=1.9, damping=0.005,
                                         n_modes=n_modes)
    traffic, times = mixed_traffic(), np.arange(-8.0, 50.0, 0.02)
    result = predict(model, bridge, traffic, timepts=times, sense_at=[15.0, 25.0])
    assert len(result.system.people) == (10 if model == "PMC" else 0)
    steps = [0.02, 0.01, 0.005]
    differences = [relative(result.response.y, host(result.system, traffic, times, step)) for step in steps]
    assert differences[-1] < 1e-3
    # the host holds forces linear between its steps, an error of second order
    slope = np.polyfit(np.log(steps), np.log(differences), 1)[0]
    assert slope == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize(("damping", "body", "step"), [
    pytest.param(0.005, Pedestrian(mass=700.0, damping=0.0), 2.0, id="undamped"),
    pytest.param(0.005, Pedestrian(mass=5.0, frequency=2.0, damping=0.0), 2.0, id="undamped and in tune"),
    pytest.param(0.005, Pedestrian(mass=5000.0, frequency=2.0, damping=0.9), 2.0, id="heavy"),
    # here the body rings on long after the bridge
    pytest.param(0.05, Pedestrian(mass=70.0, frequency=3.0, damping=0.0), 3.0, id="ringing"),
    pytest.param(0.1, Pedestrian(mass=20.0, frequency=2.3, damping=0.01), 2.3, id="ringing a little"),
])
def test_odd_bodies_against_the_host(damping, body, step):
    bridge, times = reference_bridge(frequency=2.0, damping=damping), np.arange(0.0, 60.0, 0.01)
    traffic = Traffic([walker(body=body, step_frequency=step)])
    result = predict("PMC", bridge, traffic, timepts=times)
    assert relative(result.response.y, host(result.system, traffic, times, 0.001)) < 1e-4


def test_without_anybody_standing_pmc_is_mf():
    bridge, traffic = reference_bridge(frequency=2.0), mixed_traffic(standing=NOBODY)
    np.testing.assert_array_equal(accelerations("PMC", bridge, traffic), accelerations("MF", bridge, traffic))
    assert tune("PMC", bridge, traffic).target == tune("MF", bridge, traffic).target == 2.0


# superposition

@pytest.mark.parametrize("model", ["MF", "PMC"])
def test_walkers_add_up_and_weights_multiply(model):
    bridge, times = reference_bridge(frequency=2.0), np.arange(0.0, 60.0, 0.02)
    standing = CrowdFlow(density=0.2).crowd(bridge, np.random.default_rng(2))
    one, two = walker(speed=1.3), walker(force=HarmonicForce([0.2, 0.1]), arrival=4.0, offset=1.0)
    heavy = walker(speed=1.3, weight=1400.0)
    alone, other, both, double = (
        accelerations(model, bridge, Traffic(people, standing=standing), timepts=times)
        for people in ([one], [two], [one, two], [heavy]))
    assert relative(alone + other, both) < 1e-7
    assert relative(2 * alone, double) < 1e-12


def test_walkers_beside_the_deck_do_nothing():
    bridge, times = reference_bridge(frequency=2.0), np.arange(0.0, 45.0, 0.02)
    on, edge, beside = walker(offset=0.0), walker(offset=-1.5), walker(offset=1.51, weight=5000.0)
    alone = accelerations("MF", bridge, Traffic([on]), timepts=times)
    np.testing.assert_array_equal(accelerations("MF", bridge, Traffic([edge]), timepts=times), alone)
    np.testing.assert_array_equal(accelerations("MF", bridge, Traffic([on, beside]), timepts=times), alone)
    assert not np.any(accelerations("PMC", bridge, Traffic([beside]), timepts=times))


def test_a_mode_that_moves_sideways_feels_no_vertical_force():
    lateral = Mode(frequency=1.0, damping=0.0, modal_mass=MASS, shape=SineShape(LENGTH, direction="lateral"))
    bridge = reference_bridge(frequency=2.0)
    both = Footbridge(modes=[*bridge.modes, lateral], length=LENGTH, width=3.0, mass=2 * MASS)
    times = np.arange(0.0, 45.0, 0.02)
    one, two = (accelerations("MF", deck, Traffic([walker()]), timepts=times) for deck in (bridge, both))
    assert relative(two, one) < 1e-6


# warm-up and length of the record

def test_a_longer_warm_up_changes_no_more_than_what_has_decayed():
    bridge = reference_bridge(frequency=2.0, damping=0.005)
    reaching_far = reference_bridge(frequency=2.0, damping=0.001)
    traffic = CrowdFlow(density=1.0).sample(reaching_far, rng=np.random.default_rng(3), force=YoungForce())
    short, usual, long = (predict("MF", bridge, traffic, warm_up=warm_up) for warm_up in (0.0, None, 390.0))
    times, decay = usual.response.time, 0.005 * 2 * np.pi * 2.0
    peak = long.peak_acceleration
    missed = [np.asarray(one.response.outputs - long.response.outputs) for one in (short, usual)]
    assert np.max(np.abs(missed[0])) > 0.1 * peak
    # a vibration before the window may have been stronger than in it: twice, to be safe
    assert 1e-5 * peak < np.max(np.abs(missed[1])) < 2 * np.exp(-5) * peak
    # what is missed is the free vibration after those who left before the warm-up
    envelopes = [np.max(np.abs(missed[1][(times > start) & (times < start + 2)])) for start in (5.0, 35.0)]
    assert np.log(envelopes[0] / envelopes[1]) == pytest.approx(30 * decay, rel=0.02)


@pytest.mark.parametrize("model", ["MF", "PMC"])
def test_warm_up_by_hand_equals_the_default_of_the_design(model):
    bridge, flow = reference_bridge(frequency=2.0, damping=0.002), CrowdFlow(persons=5)     # 5/(ξω) is above T
    traffic = flow.sample(bridge, rng=np.random.default_rng(3), force=YoungForce())
    found = effective(couple(bridge, *traffic.standing_on(bridge))) if model == "PMC" else bridge.modes[0]
    warm_up = max(50 / flow.speed_on(bridge), 5 / (2 * np.pi * found.frequency * found.damping))
    np.testing.assert_array_equal(accelerations(model, bridge, traffic),
                                  accelerations(model, bridge, traffic, warm_up=warm_up * (1 + 1e-12)))


def test_records_do_not_come_round():
    bridge = Footbridge.simply_supported(length=200.0, width=3.0, mass=4 * MASS, frequency=2.0, damping=0.005)
    drawn = CrowdFlow(density=1.0).sample(bridge, rng=np.random.default_rng(4))     # 2 Hz: the lines repeat at 50 s
    end = drawn.window[1]
    traffic = Traffic(drawn.walkers, window=drawn.window, target=drawn.target)      # by hand: seen beyond its window
    times = np.arange(0.0, end, 0.02)
    usual, longer = (accelerations("MF", bridge, traffic, timepts=t)[0] for t in (times, np.arange(0, 3 * end, 0.02)))
    assert relative(longer[:len(times)], usual) < 1e-6         # whatever the period of the transform
    period = round(50.0 / 0.02)
    assert np.max(np.abs(usual[period:] - usual[:-period])) > 0.5 * np.max(np.abs(usual))


def test_drawn_traffic_is_not_seen_where_it_was_not_drawn():
    traffic = CrowdFlow(density=0.5).sample(reference_bridge(), rng=np.random.default_rng(4))
    end = traffic.window[1]
    for times in (np.linspace(0.0, 2 * end, 101), np.linspace(-1.0, end, 101)):
        with pytest.raises(ValueError, match=r"timepts must lie in the window of the traffic, 0 to .* stay inside"):
            predict("MF", reference_bridge(), traffic, timepts=times)
    with pytest.raises(ValueError, match=r"at most the 79.5775 s for which .* drawn, got 100000; leave it out"):
        predict("MF", reference_bridge(), traffic, warm_up=1e5)


def test_a_window_leaves_walkers_made_by_hand_in_place():
    """An undamped bridge rings on: the window after a crossing shows what the record without one shows."""
    bridge, one = reference_bridge(damping=0.0), Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
    times = np.linspace(100.0, 140.0, 4001)
    alone = predict("MF", bridge, Traffic([one]), timepts=times).response.outputs
    windowed = predict("MF", bridge, Traffic([one], window=(100.0, 140.0)), timepts=times).response.outputs
    assert np.max(np.abs(alone)) > 1.0
    np.testing.assert_allclose(windowed, alone, atol=1e-6 * np.max(np.abs(alone)))


@pytest.mark.parametrize("damping", [[0.005, 0.0], [0.005, 0.8]])
def test_a_mode_without_a_peak_does_not_stop_pmc(damping):
    """Mode 2 has no peak to read, or a node where the walker stands; against the host."""
    bridge = Footbridge.simply_supported(length=50.0, width=3.0, mass=MASS, frequency=2.0, damping=damping, n_modes=2)
    one = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
    times = np.linspace(0.0, 40.0, 8001)
    found = predict("PMC", bridge, Traffic([one]), timepts=times)
    modal = [mode.shape(1.25 * times) * 280.0 * np.cos(4 * np.pi * times) for mode in bridge.modes]
    points = np.array([12.5, 25.0])                 # forces there that make the same modal forces
    shapes = np.array([mode.shape(points) for mode in bridge.modes])
    system = couple(bridge, *Traffic([one]).standing_on(bridge), force_at=points)
    host = ct.forced_response(system, times, np.linalg.solve(shapes, modal)).outputs
    assert np.max(np.abs(found.response.outputs - host.ravel())) < 1e-3 * np.max(np.abs(host))


def test_a_lateral_bridge_is_refused():
    sway = Mode(frequency=1.0, damping=0.01, modal_mass=25e3, shape=SineShape(50.0, direction="lateral"))
    bridge = Footbridge(modes=[sway], length=50.0, width=3.0, mass=50e3)
    one = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
    with pytest.raises(ValueError, match=r"the first mode must move vertically, got a shape .*; walking forces"):
        predict("MF", bridge, Traffic([one]))


# tuning

@pytest.mark.parametrize(("frequency", "harmonic"), [(2.0, 1), (3.25, 2), (5.6, 3)])
@pytest.mark.parametrize("density", [0.2, 1.0])
def test_each_model_is_tuned_to_its_own_resonance(frequency, harmonic, density):
    bridge = reference_bridge(frequency=frequency)
    traffic = CrowdFlow(density=density).sample(bridge, rng=np.random.default_rng(6))
    loaded = effective(couple(bridge, *traffic.standing_on(bridge))).frequency
    assert tune("MF", bridge, traffic).target == pytest.approx(frequency / harmonic)
    assert tune("PMC", bridge, traffic).target == pytest.approx(loaded / np.ceil(loaded / 2.5))
    assert loaded != frequency


def test_default_grid_resolves_the_highest_mode():
    bridge = Footbridge.simply_supported(length=LENGTH, width=3.0, mass=2 * MASS, frequency=0.8, n_modes=3,
                                         damping=0.003)
    one = walker(step_frequency=3.2)      # in resonance with the second mode
    result = predict("MF", bridge, Traffic([one]), sense_at=[12.5])
    expected = closed_form(result.response.time, bridge, one, 12.5)
    assert relative(result.response.outputs, expected) < 1e-3


@pytest.mark.parametrize("n_modes", [1, 3])
@pytest.mark.parametrize("model", ["MF", "PMC"])
def test_tuned_at_once_is_tuned_and_predicted(model, n_modes):
    bridge = Footbridge.simply_supported(length=LENGTH, width=3.0, mass=2 * MASS, frequency=2.0, damping=0.005,
                                         n_modes=n_modes)
    traffic = CrowdFlow(density=0.5).sample(bridge, rng=np.random.default_rng(6))
    at_once, apart = predict_tuned(model, bridge, traffic), predict(model, bridge, tune(model, bridge, traffic))
    np.testing.assert_array_equal(at_once.response.y, apart.response.y)


def test_predictions_never_retune_and_pass_remarks_on():
    bridge, fast = reference_bridge(frequency=3.0), Traffic([walker(step_frequency=3.0)])
    result = predict("MF", bridge, fast)
    assert result.remarks == fast.remarks
    assert "3.00 Hz lies outside" in result.remarks[0]
    expected = closed_form(result.response.time, bridge, walker(step_frequency=3.0))
    assert relative(result.response.outputs, expected) < 1e-3


# what comes out

def test_the_response_is_the_host_s_own():
    result = predict("PMC", reference_bridge(frequency=2.0), Traffic([walker()]))
    response = result.response
    assert isinstance(response, ct.TimeResponseData)
    assert (response.output_labels, response.outputs.shape) == (["a[0]"], response.time.shape)
    assert (response.sysname, response.title) == ("PMC", "PMC: acceleration")
    again = pickle.loads(pickle.dumps(result))
    np.testing.assert_array_equal(again.response.y, response.y)
    assert str(again) == f"PMC: {result.peak_acceleration:.3f} m/s²"
    assert json.dumps(result.peak_acceleration)


def test_times_are_given_back_as_asked_for():
    times = np.linspace(10.0, 12.0, 21)
    response = predict("MF", reference_bridge(frequency=2.0), Traffic([walker()]), timepts=times).response
    np.testing.assert_array_equal(response.time, times)
    coarse = accelerations("MF", reference_bridge(frequency=2.0), Traffic([walker()]), timepts=[10.0, 11.0])[0]
    np.testing.assert_allclose(coarse, [response.outputs[0], response.outputs[10]], rtol=1e-4)


def test_the_first_mode_is_read_at_its_antinode():
    bridge = Footbridge.beam(spans=[20.0, 30.0, 20.0], width=3.0, mass=70e3, frequency=2.5, damping=0.005)
    shape: Shape = bridge.modes[0].shape
    top = minimize_scalar(lambda x: -abs(float(shape(x))), bounds=(20.0, 50.0), options={"xatol": 1e-10}).x
    usual = accelerations("MF", bridge, Traffic([walker()]))
    assert relative(accelerations("MF", bridge, Traffic([walker()]), sense_at=[top]), usual) < 1e-9


def signal(*values, step=0.1):
    times = step * np.arange(len(values[0]))
    return Prediction(model="MF", system=couple(reference_bridge()), remarks=(),
                      response=ct.TimeResponseData(times, np.array(values), issiso=False))


def test_a_peak_between_samples_is_the_parabola_s():
    times = np.arange(20.0)
    parabola = 3.0 - (times - 7.3)**2
    assert signal(parabola).peak_acceleration == pytest.approx(np.max(np.abs(parabola)))      # at the end, −133.89
    assert signal(np.maximum(parabola, -1.0)).peak_acceleration == pytest.approx(3.0, rel=1e-12)
    assert signal(np.minimum(-parabola, 1.0)).peak_acceleration == pytest.approx(3.0, rel=1e-12)
    assert signal(np.zeros(20), np.maximum(parabola, -1.0)).peak_acceleration == pytest.approx(3.0, rel=1e-12)


def test_a_peak_of_few_samples_a_period_is_the_parabola_s_too():
    """Its neighbours may have the other sign."""
    steep = np.maximum(3.0 - 3.0 * (np.arange(20.0) - 7.3)**2, -2.5)
    assert signal(steep).peak_acceleration == pytest.approx(3.0, rel=1e-12)


@pytest.mark.parametrize("values", [[1.0, 0.9, 0.799], [-0.799, -0.9, -1.0], [0.0, 1.0], [-1.0, 0.0, 0.0, 0.0]])
def test_a_peak_at_the_edge_is_not_extrapolated(values):
    assert signal(values).peak_acceleration == 1.0


@pytest.mark.parametrize("phase", np.linspace(0, 2 * np.pi, 7))
def test_the_peak_of_a_sampled_sine(phase):
    times = np.arange(0, 10, 1 / 40)
    assert signal(np.sin(2 * np.pi * times + phase)).peak_acceleration == pytest.approx(1.0, abs=2e-5)


def test_mc_keeps_the_states_and_the_step_of_its_simulation():
    bridge = reference_bridge(frequency=2.0)
    found = predict("MC", bridge, CrowdFlow(persons=15).sample(bridge, rng=np.random.default_rng(1)))
    by_hand = simulate(found.system)
    assert (found.step, found.error) == (by_hand.step, by_hand.error)
    np.testing.assert_array_equal(found.response.x, by_hand.response.x)
    assert found.response.state_labels == ["z[0]", "dz[0]"]
    assert predict("MF", bridge, found.system.traffic).step is None

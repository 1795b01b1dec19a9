"""The models SF and MFAM against closed forms, the host's own solver, and bridges made by hand.

Closed form: a mode of modal mass m answers a force P exp(iΩt) at its antinode with the acceleration
−Ω²/(ω² − Ω² + 2iξωΩ) P/m exp(iΩt), which is i P/(2ξm) exp(iΩt) in resonance (eq. 16).
"""

import pickle

import control as ct
import numpy as np
import pytest

from hsictrl import (
    Crowd,
    CrowdFlow,
    Footbridge,
    HarmonicForce,
    Pedestrian,
    Population,
    Traffic,
    Walker,
    YoungForce,
    ZivanovicForce,
    couple,
    effective,
    predict,
    reference_bridge,
    tune,
)
from hsictrl.prediction import ASSUMPTIONS, MODELS, predict_tuned

LENGTH, MASS = 50.0, 25e3
TIMES = np.arange(3.0, 23.0, 0.01)


def walker(**changes):
    return Walker(**({"force": HarmonicForce([0.43]), "step_frequency": 2.0, "speed": 1.25} | changes))


def people(n, **changes):
    return Crowd.of([Pedestrian(**changes)] * n)


def at(*places):
    """A standing crowd at these places."""
    return people(len(places)), np.array([(x, 0.0) for x in places])


def beam(**changes):
    return Footbridge.simply_supported(**({"length": LENGTH, "width": 3.0, "mass": 2 * MASS, "frequency": 2.0,
                                           "damping": 0.01, "n_modes": 3} | changes))


def accelerations(*arguments, **options):
    return np.asarray(predict(*arguments, **options).response.y)


def relative(found, expected):
    return np.max(np.abs(found - expected)) / np.max(np.abs(expected))


def accelerance(frequency, bridge):
    """Of the first mode at its antinode, written out [1/kg]."""
    mode, s = bridge.modes[0], 2j * np.pi * np.asarray(frequency)
    omega = 2 * np.pi * mode.frequency
    return s**2 / (s**2 + 2 * mode.damping * omega * s + omega**2) / mode.modal_mass


# SF in closed form

@pytest.mark.parametrize("damping", [0.002, 0.005, 0.02])
def test_one_walker_in_resonance_reaches_p_over_2_xi_m(damping):
    bridge = reference_bridge(frequency=2.0, damping=damping)
    result = predict("SF", bridge, Traffic([walker()], standing=at(25.0)), timepts=TIMES)
    amplitude = 0.43 * 700 / (2 * damping * MASS)
    assert relative(result.response.y[0], -amplitude * np.sin(4 * np.pi * TIMES)) < 1e-9
    usual = predict("SF", bridge, Traffic([walker()], standing=at(25.0)))
    assert usual.peak_acceleration == pytest.approx(amplitude, rel=2e-5)      # read between 40 samples a period
    assert not result.remarks


def test_the_place_weighs_the_force_by_the_shape_and_the_sensor_the_response():
    bridge = reference_bridge(frequency=2.0)
    result = predict("SF", bridge, Traffic([walker()], standing=at(10.0)), timepts=TIMES, sense_at=[25.0, 40.0])
    amplitude = 0.43 * 700 / (2 * 0.005 * MASS) * np.sin(np.pi * 10 / 50)
    for x, signal in zip([25.0, 40.0], result.response.y, strict=True):
        assert relative(signal, -amplitude * np.sin(np.pi * x / 50) * np.sin(4 * np.pi * TIMES)) < 1e-9
    assert result.response.output_labels == ["a[0]", "a[1]"]


@pytest.mark.parametrize("frequency", [2.0, 3.25, 5.0])
@pytest.mark.parametrize("density", [0.2, 1.0])
def test_a_crowd_is_the_sum_of_its_steady_states(frequency, density):
    bridge = reference_bridge(frequency=frequency)
    drawn = CrowdFlow(density=density).sample(bridge, rng=np.random.default_rng(1), force=YoungForce())
    n, walkers, (_, places) = round(150 * density), drawn.walkers, drawn.standing_on(bridge)
    expected = np.zeros_like(TIMES)
    assert np.all(np.diff(walkers.arrival) > 0)
    for f, u, x in zip(walkers.step_frequency[-n:], walkers.draws[0][-n:], places[:, 0], strict=True):
        h = np.arange(1, 5)
        factors = np.array([min(0.37 * (f - 0.95), 0.5), *([0.054, 0.026, 0.010] + np.array([.0044, .0050, .0051])
                                                           * h[1:] * f)])
        force = 700 * factors * np.exp(2j * np.pi * (u - 0.5)) * np.sin(np.pi * x / LENGTH)
        expected += np.real((force * accelerance(h * f, bridge)) @ np.exp(2j * np.pi * np.outer(h * f, TIMES)))
    assert relative(accelerations("SF", bridge, drawn, timepts=TIMES)[0], expected) < 1e-8


def test_an_undamped_bridge_off_resonance():
    bridge = reference_bridge(frequency=2.0, damping=0.0)
    found = accelerations("SF", bridge, Traffic([walker(step_frequency=1.5)], standing=at(25.0)), timepts=TIMES)
    expected = -301 / MASS * 1.5**2 / (2.0**2 - 1.5**2) * np.cos(3 * np.pi * TIMES)
    assert relative(found[0], expected) < 1e-9


@pytest.mark.parametrize(("frequency", "step"), [(2.0, 2.0), (3.25, 1.625), (5.0 / 3, 5.0 / 3 * (1 + 1e-13))])
def test_an_undamped_bridge_in_resonance_is_refused(frequency, step):
    traffic = Traffic([walker(step_frequency=step, force=YoungForce())], rng=np.random.default_rng(1))
    for given in (traffic, Traffic(traffic.walkers, standing=at(25.0))):
        with pytest.raises(ValueError, match=r"a steady state needs damping .*, got 0 % and both at .* Hz; give the"):
            predict("SF", reference_bridge(frequency=frequency, damping=0.0), given)


# SF against other roads

# Živanović et al. (2007), table of the main harmonics: Σ a exp{−[(i − b)/c]²} at the centre i of each
GAUSSIANS_AT_CENTRE = [sum(a * np.exp(-((i - b) / c)**2) for a, b, c in terms) for i, terms in enumerate([
    [(0.7852, 0.9999, 0.008314), (0.0206, 1.034, 0.2524), (0.1074, 1.001, 0.03653)],
    [(0.5130, 2.000, 0.01105), (0.1330, 1.957, 0.2632), (-0.04984, 1.882, 0.05807)],
    [(0.3908, 3.000, 0.009560), (0.1567, 3.000, 0.05525), (0.06866, 2.957, 0.5607)],
    [(0.3255, 4.000, 0.008797), (0.1647, 4.001, 0.06641), (0.06888, 3.991, 0.3750)],
    [(0.2806, 4.999, 0.007939), (0.1584, 5.004, 0.07825), (0.07289, 4.987, 0.4501)]], start=1)]


def main_harmonics(lines, times):
    """Forces of walkers by their lines at h f_s, which in the narrow-band model are W DLF_h times the Gaussians."""
    narrow_band = lines.spacing < 1
    h = np.arange(1, 6) if narrow_band else np.arange(1, lines.coefficients.shape[1] + 1)
    kept = lines.coefficients[:, np.round(h / lines.spacing).astype(int) - lines.first]
    turns = np.multiply.outer(np.multiply.outer(lines.step_frequency, h), times)
    return np.einsum("kh,kht->kt", kept / (GAUSSIANS_AT_CENTRE if narrow_band else 1), np.exp(2j * np.pi * turns)).real


def test_several_modes_are_the_host_s_forced_response_once_it_has_settled():
    bridge, points = beam(frequency=1.9, damping=0.05, n_modes=2), [15.0, 25.0]
    forces = [HarmonicForce([0.43, 0.1], phases=[0.3, 1.0]), ZivanovicForce(), YoungForce()]
    places = np.array([5.0, 12.5, 20.0, 31.0, 44.0, 47.0])
    traffic = Traffic([walker(force=forces[i % 3], weight=600.0 + 30 * i, step_frequency=1.7 + 0.08 * i, arrival=i)
                       for i in range(6)], rng=np.random.default_rng(8), standing=at(*places))
    times = np.arange(0.0, 60.0, 0.02)
    settled = times > 40.0                                       # exp(−0.05 · 2π · 1.9 · 40) = 4e-11
    steady = accelerations("SF", bridge, traffic, timepts=times, sense_at=points)[:, settled]

    def difference(refined):
        fine = np.linspace(times[0], times[-1], (len(times) - 1) * refined + 1)
        load = np.empty((6, len(fine)))
        for who, lines in traffic.walkers.lines():
            load[who] = main_harmonics(lines, fine)
        response = ct.forced_response(couple(bridge, force_at=places, sense_at=points), fine, load, squeeze=False)
        return relative(steady, response.outputs[:, ::refined][:, settled])

    # the host holds forces linear between its steps, an error of second order
    differences = [difference(refined) for refined in (4, 8, 16)]
    assert differences[-1] < 2e-4
    np.testing.assert_allclose(np.log2(np.divide(differences[:-1], differences[1:])), 2.0, atol=0.1)


@pytest.mark.parametrize("force", [HarmonicForce([0.43, 0.1]), YoungForce()])
def test_a_very_slow_crossing_is_steady_at_midspan(force):
    bridge = reference_bridge(frequency=2.0, damping=0.05)
    traffic = Traffic([walker(force=force, speed=0.05)], rng=np.random.default_rng(2))     # 1000 s
    times = np.arange(499.0, 501.0, 0.005)
    steady, moving = (accelerations(model, bridge, traffic, timepts=times) for model in ("SF", "MF"))
    assert relative(moving, steady) < 2e-4          # (πv/(Lξω))² = 2.5e-5, and a slope over a second


# who steps in place

def superposed(bridge, *walkers_and_places):
    """Superposition of single walkers."""
    return sum(accelerations("SF", bridge, Traffic([one], standing=at(x)), timepts=TIMES)
               for one, x in walkers_and_places)


def test_walkers_made_by_hand_step_where_they_are_at_mid_window():
    bridge = reference_bridge(frequency=2.0)
    on = [walker(arrival=0.0), walker(step_frequency=1.9, arrival=6.0, offset=1.0)]
    off = [walker(arrival=15.0), walker(arrival=-50.0), walker(offset=1.6)]
    traffic = Traffic([on[0], off[0], on[1], *off[1:]], window=(8.0, 16.0))
    expected = superposed(bridge, (on[0], 1.25 * 12), (on[1], 1.25 * 6))
    assert relative(accelerations("SF", bridge, traffic, timepts=TIMES), expected) < 1e-9


@pytest.mark.parametrize("model", ["SF", "MFAM", "PMC"])
def test_whoever_stands_for_the_crowd_stands_on_the_deck(model):
    with pytest.raises(ValueError, match=r"must lie on the deck, .* got .*\[0\] = \(95, 0\); move it"):
        predict(model, reference_bridge(frequency=2.0), Traffic([walker()], standing=at(95.0)))


def test_the_last_to_arrive_take_the_places_of_the_standing_crowd():
    bridge = reference_bridge(frequency=2.0)
    early, middle, late = (walker(step_frequency=f, arrival=t) for f, t in ((1.8, 0.0), (1.9, 5.0), (2.1, 9.0)))
    traffic = Traffic([late, early, middle], standing=at(10.0, 30.0))
    expected = superposed(bridge, (middle, 10.0), (late, 30.0))
    result = predict("SF", bridge, traffic, timepts=TIMES)
    assert relative(result.response.y, expected) < 1e-9
    assert not result.remarks


def test_places_stay_empty_where_too_few_walk_and_the_remarks_say_so():
    bridge = reference_bridge(frequency=2.0)
    result = predict("SF", bridge, Traffic([walker()], standing=at(10.0, 30.0, 20.0)), timepts=TIMES)
    assert relative(result.response.y, superposed(bridge, (walker(), 10.0))) < 1e-9
    few = "only 1 of 3 standing places could be taken, since no more walkers arrive"
    assert result.remarks == (few,)
    fast = predict("SF", bridge, Traffic([walker(step_frequency=3.0)], standing=at(10.0, 30.0, 20.0)))
    assert fast.remarks == ("the mean step frequency 3.00 Hz lies outside 1.0–2.5 Hz, where people walk", few)


@pytest.mark.parametrize("standing", [at(10.0), at()])
def test_nobody_moves_nothing(standing):
    nobody = Traffic(Traffic([walker()]).walkers.part([]), window=(0.0, 10.0), target=2.0, standing=standing)
    assert not np.any(accelerations("SF", reference_bridge(), nobody))
    alone = Traffic([walker()], standing=at())
    assert not np.any(accelerations("SF", reference_bridge(), alone))


def test_places_off_the_deck_are_refused():
    with pytest.raises(ValueError, match=r"places must lie on the deck.*got places\[0\] = \(60, 0\); move it"):
        predict("SF", reference_bridge(), Traffic([walker()], standing=at(60.0)))


def test_the_walkers_of_sf_are_those_of_mf():
    bridge = reference_bridge(frequency=2.0)
    traffic = CrowdFlow(density=0.2).sample(bridge, rng=np.random.default_rng(3))
    walkers, places = traffic.stopped_on(bridge)
    np.testing.assert_array_equal(walkers.step_frequency, traffic.walkers.step_frequency[-30:])
    np.testing.assert_array_equal(walkers.draws[0], traffic.walkers.draws[0][-30:])
    np.testing.assert_array_equal(places, traffic.standing_on(bridge)[1])


def test_nothing_warms_up():
    bridge, traffic = reference_bridge(), Traffic([walker()], standing=at(20.0))
    np.testing.assert_array_equal(accelerations("SF", bridge, traffic, warm_up=1e3),
                                  accelerations("SF", bridge, traffic))
    with pytest.raises(ValueError, match=r"warm_up must be at least 0, got -1; give s"):
        predict("SF", bridge, traffic, warm_up=-1.0)


# MFAM

def crowded(n=150, mass=70.0, density=1.0, seed=2, **options):
    """Traffic at a density, with n bodies of a mass in the place of its standing crowd."""
    bridge = reference_bridge(**options)
    drawn = CrowdFlow(density=density).sample(bridge, rng=np.random.default_rng(seed), force=YoungForce())
    places = np.column_stack([(np.arange(n) + 0.5) * LENGTH / max(n, 1), np.zeros(n)])
    return bridge, Traffic(drawn.walkers, window=drawn.window, target=drawn.target,
                           standing=(people(n, mass=mass), places))


def test_a_person_per_square_metre_by_hand():
    loaded = reference_bridge(frequency=2.0).with_crowd_mass(150 * 70.0)
    [mode] = loaded.modes
    assert mode.modal_mass == pytest.approx(30_250.0, rel=1e-14)
    assert mode.frequency == pytest.approx(2.0 * np.sqrt(25 / 30.25), rel=1e-14) == pytest.approx(1.8182, abs=5e-5)
    assert (mode.damping, loaded.mass) == (0.005, 60_500.0)


@pytest.mark.parametrize("ends", [("pinned", "pinned"), ("clamped", "pinned")])
@pytest.mark.parametrize("spans", [[50.0], [20.0, 30.0]])
def test_a_uniform_beam_with_a_uniform_mass_is_a_heavier_beam(spans, ends):
    beam = {"spans": spans, "width": 3.0, "damping": [0.005, 0.01, 0.02], "ends": ends, "n_modes": 3}
    loaded = Footbridge.beam(mass=50e3, frequency=2.0, **beam).with_crowd_mass(13e3)
    heavier = Footbridge.beam(mass=63e3, frequency=2.0 * np.sqrt(50 / 63), **beam)
    for found, expected in zip(loaded.modes, heavier.modes, strict=True):
        assert found.frequency == pytest.approx(expected.frequency, rel=1e-12)
        assert found.modal_mass == pytest.approx(expected.modal_mass, rel=1e-12)
        assert found.damping == expected.damping
        np.testing.assert_allclose(found.shape([7.0, 33.0]), expected.shape([7.0, 33.0]), rtol=1e-12)
    assert loaded.mass == heavier.mass


def test_bodies_that_are_far_stiffer_than_the_bridge_are_added_mass():
    bridge = beam(damping=1e-4)
    stiff, x = Pedestrian(frequency=5000.0), (np.arange(150) + 0.5) / 3
    poles = ct.poles(couple(bridge, stiff, x))
    found = np.sort(np.abs(poles[(np.abs(poles) < 2 * np.pi * 100) & (poles.imag > 0)])) / (2 * np.pi)
    expected = [mode.frequency for mode in bridge.with_crowd_mass(150 * 70.0).modes]
    np.testing.assert_allclose(found, expected, rtol=1e-4)


@pytest.mark.parametrize(("n", "mass"), [(150, 70.0), (40, 93.0)])
def test_mfam_is_mf_on_a_bridge_made_by_hand(n, mass):
    bridge, traffic = crowded(n, mass, frequency=3.25)
    modal_mass = MASS + n * mass / 2
    by_hand = reference_bridge(frequency=3.25 * np.sqrt(MASS / modal_mass), modal_mass=modal_mass)
    times = np.arange(0.0, 40.0, 0.01)
    found, expected = predict("MFAM", bridge, traffic, timepts=times), predict("MF", by_hand, traffic, timepts=times)
    assert relative(found.response.y, expected.response.y) < 1e-9
    assert (found.model, found.response.sysname, found.system.nstates) == ("MFAM", "MFAM", 2)
    assert predict("MFAM", bridge, traffic).peak_acceleration == pytest.approx(
        predict("MF", by_hand, traffic).peak_acceleration, rel=1e-9)
    assert tune("MFAM", bridge, traffic).target == pytest.approx(tune("MF", by_hand, traffic).target, rel=1e-12)


@pytest.mark.parametrize("traffic", [crowded(n=0)[1], Traffic([walker()], standing=at())])
def test_without_anybody_standing_mfam_is_mf(traffic):
    bridge = reference_bridge(frequency=2.0)
    np.testing.assert_array_equal(accelerations("MFAM", bridge, traffic), accelerations("MF", bridge, traffic))
    assert tune("MFAM", bridge, traffic).target == tune("MF", bridge, traffic).target == 2.0


def test_bodies_weigh_what_they_weigh():
    bridge = reference_bridge(frequency=2.0)
    standing = Crowd.of([Pedestrian(mass=50.0), Pedestrian(mass=250.0)]), np.array([[1.0, 0.0], [25.0, 0.0]])
    [mode] = predict("MFAM", bridge, Traffic([walker()], standing=standing)).system.bridge.modes
    assert mode.modal_mass == pytest.approx(MASS + 150.0)      # evenly spread, wherever they stand


@pytest.mark.parametrize(("mass", "message"), [
    (-70.0, r"mass must be at least 0, got -70; give kg"), (np.nan, r"mass must be at least 0, got nan; give kg"),
])
def test_a_negative_crowd_is_refused(mass, message):
    with pytest.raises(ValueError, match=message):
        reference_bridge().with_crowd_mass(mass)


# all models

@pytest.mark.parametrize(("frequency", "harmonic", "loaded_harmonic"), [(2.0, 1, 1), (3.25, 2, 2), (5.3, 3, 2)])
def test_step_frequencies_meet_the_model_s_own_resonance(frequency, harmonic, loaded_harmonic):
    bridge, traffic = crowded(frequency=frequency)
    loaded = frequency * np.sqrt(25 / 30.25)
    assert tune("SF", bridge, traffic).target == tune("MF", bridge, traffic).target
    assert tune("SF", bridge, traffic).target == pytest.approx(frequency / harmonic)
    assert tune("MFAM", bridge, traffic).target == pytest.approx(loaded / loaded_harmonic)
    found = effective(couple(bridge, *traffic.standing_on(bridge))).frequency
    assert tune("PMC", bridge, traffic).target == pytest.approx(found / np.ceil(found / 2.5))


@pytest.mark.parametrize("model", MODELS)
def test_tuned_at_once_is_tuned_and_predicted(model):
    bridge, traffic = crowded(frequency=2.0, density=0.3)
    at_once, apart = predict_tuned(model, bridge, traffic), predict(model, bridge, tune(model, bridge, traffic))
    np.testing.assert_array_equal(at_once.response.y, apart.response.y)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(at_once)).response.y, at_once.response.y)


@pytest.mark.parametrize("model", MODELS)
def test_weights_multiply(model):
    bridge, standing = reference_bridge(frequency=2.0), at(10.0)
    single, double = (accelerations(model, bridge, Traffic([walker(weight=w)], standing=standing), timepts=TIMES)
                      for w in (700.0, 1400.0))
    assert relative(2 * single, double) < 1e-12


@pytest.mark.parametrize("model", MODELS)
def test_the_order_is_the_one_of_table_2(model):
    system = predict(model, beam(), Traffic([walker(), walker()], standing=at(10.0, 20.0))).system
    assert system.nstates == {"2 n_m": 2 * 3, "2(n_m + n_H)": 2 * (3 + 2)}[ASSUMPTIONS[model].order]


def test_assumptions_are_those_of_tables_1_and_2():
    printed = """
        stationary force model | SF | stationary | disregarded | 2 n_m | No
        moving force model | MF | moving | disregarded | 2 n_m | No
        moving force model with added mass | MFAM | moving | uniformly distributed crowd mass | 2 n_m | No
        pseudo moving crowd model | PMC | moving | stationary human body models | 2(n_m + n_H) | No
        moving crowd model | MC | moving | moving human body models | 2(n_m + n_H) | Yes"""
    rows = [[cell.strip() for cell in line.split("|")] for line in printed.strip().splitlines()]
    assert rows == [[a.name, model, a.fixed_driver, a.interaction, a.order, "Yes" if a.time_variant else "No"]
                    for model, a in ASSUMPTIONS.items()]
    assert set(MODELS) <= set(ASSUMPTIONS)


def test_intra_person_variability_can_be_left_out_of_any_model():
    """Figure 8: the same walkers, drawn with and without it from the same random numbers."""
    bridge, flow = reference_bridge(frequency=2.0), CrowdFlow(density=0.2)
    whole, alike = (flow.sample(bridge, rng=np.random.default_rng(4), force=force)
                    for force in (ZivanovicForce(), ZivanovicForce().periodic()))
    np.testing.assert_array_equal(whole.walkers.draws[0], alike.walkers.draws[0])
    np.testing.assert_array_equal(accelerations("SF", bridge, whole), accelerations("SF", bridge, alike))
    assert relative(accelerations("MF", bridge, alike, timepts=TIMES),
                    accelerations("MF", bridge, whole, timepts=TIMES)) > 0.05


def test_populations_of_different_weight_share_one_crowd():
    bridge = reference_bridge(frequency=2.0)
    population = Population(frequency=(3.25, 0.32), damping=(0.30, 0.05), mass=95.0)
    traffic = CrowdFlow(persons=20, population=population).sample(bridge, rng=np.random.default_rng(5))
    [mode] = predict("MFAM", bridge, traffic).system.bridge.modes
    assert mode.modal_mass == pytest.approx(MASS + 20 * 95.0 / 2)

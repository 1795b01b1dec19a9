"""Tuned mass dampers against the classical theory, Appendix A written out, and the host's own integration."""

import copy
import pickle
from dataclasses import replace
from itertools import product

import control as ct
import numpy as np
import pytest
from second_road import appendix_a, dense, on_coordinate, peaks, sines, transfer

import hsictrl as hsi
from hsictrl.cli.description import read_description
from hsictrl.cli.study import read_study
from hsictrl.prediction import models, tuned_peaks

RATIOS = (0.005, 0.02, 0.1, 0.5)
DAMPINGS = (0.0, 0.01, 0.0857, 0.3, 0.7, 0.999)
X = (np.arange(75) + 0.5) * 50 / 75
CROWD = [hsi.Pedestrian(mass=70.0 * 75 / 2)]     # at midspan: 75 that are spread over the deck
TMD = hsi.Absorber(mass=500.0, frequency=1.95, damping=0.08)


def undamped(**changes):
    return hsi.reference_bridge(**{"frequency": 2.0, "damping": 0.0, **changes})


def two_modes():
    return hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=0.005, n_modes=2)


def accelerance(bridge, body, omega, at=25.0):
    return np.abs(hsi.couple(bridge, body, [at])(1j * omega))


def fixed_points(ratio, tuning):
    """Where damping makes no difference, over the mode's frequency: g⁴(2 + μ)/2 − g²(1 + f²(1 + μ)) + f² = 0."""
    return np.sqrt(np.roots([1 + ratio / 2, -(1 + tuning**2 * (1 + ratio)), tuning**2]))


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("damping", DAMPINGS)
def test_den_hartog_makes_both_fixed_points_as_high_as_the_theory_says(ratio, damping):
    bridge, sized = undamped(), hsi.Absorber.den_hartog(undamped(), mass_ratio=ratio)
    body = hsi.Absorber(mass=sized.mass, frequency=sized.frequency, damping=damping)
    omega = bridge.omega[0] * fixed_points(ratio, 1 / (1 + ratio))
    static = 1 / (25e3 * bridge.omega[0]**2)
    np.testing.assert_allclose(accelerance(bridge, body, omega) / omega**2 / static, np.sqrt(1 + 2 / ratio), rtol=1e-9)


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize("damping", DAMPINGS)
def test_warburton_does_so_for_the_acceleration(ratio, damping):
    bridge, sized = undamped(), hsi.Absorber.warburton(undamped(), mass_ratio=ratio)
    body = hsi.Absorber(mass=sized.mass, frequency=sized.frequency, damping=damping)
    omega = bridge.omega[0] * fixed_points(ratio, (1 + ratio)**-0.5)
    np.testing.assert_allclose(accelerance(bridge, body, omega) * 25e3, np.sqrt(2 / (ratio * (1 + ratio))), rtol=1e-9)


def test_the_closed_form_is_that_of_the_book():
    """c/(2 m Ω_n) = √(3μ/(8(1 + μ)³)), and a frequency Ω_n/(1 + μ) (Den Hartog, 1956, section 3.3)."""
    sized = hsi.Absorber.den_hartog(undamped(), mass_ratio=0.05)
    assert sized.mass == pytest.approx(0.05 * 25e3)
    assert sized.frequency == pytest.approx(2.0 / 1.05)
    assert sized.damping_coefficient / (2 * sized.mass * 4 * np.pi) == pytest.approx(np.sqrt(0.15 / (8 * 1.05**3)))


def test_the_peaks_of_the_displacement_are_hardly_higher_than_the_fixed_points():
    ratio, bridge = 0.02, undamped()
    system = dense(bridge, [hsi.Absorber.den_hartog(bridge, mass_ratio=ratio)], [25.0])
    omega = 4 * np.pi * np.linspace(0.5, 1.5, 20_001)
    highest = max(abs(transfer(system, 1j * w)[0]) / w**2 for w in omega[5000:15_000:2]) * 25e3 * bridge.omega[0]**2
    assert 1.0 < highest / np.sqrt(1 + 2 / ratio) < 1.003


def test_away_from_the_antinode_the_mass_grows_with_the_modal_mass_that_moves_there():
    bridge, ratio = undamped(), 0.02
    sized = hsi.Absorber.den_hartog(bridge, mass_ratio=ratio, at=10.0)
    assert sized.mass == pytest.approx(ratio * 25e3 / np.sin(np.pi / 5)**2)
    omega = bridge.omega[0] * fixed_points(ratio, 1 / (1 + ratio))
    found = accelerance(bridge, sized, omega, at=10.0) / omega**2 * 25e3 * bridge.omega[0]**2
    np.testing.assert_allclose(found, np.sqrt(1 + 2 / ratio), rtol=1e-9)


def test_a_higher_mode_and_another_direction_have_their_own():
    second = hsi.Absorber.den_hartog(two_modes(), mass_ratio=0.02, mode=1)
    assert (second.mass, second.frequency) == pytest.approx((500.0, 8.0 / 1.02))
    eeklo = hsi.eeklo_bridge()
    sideways = hsi.Absorber.warburton(eeklo, mass_ratio=0.02, direction="lateral")
    damped = hsi.effective(eeklo.with_absorbers(sideways, at=[eeklo.modes[0].shape.antinode]))
    assert hsi.effective(eeklo).damping < np.sqrt(0.02 * 1.02 / 8) < damped.damping      # of an undamped mode


@pytest.mark.parametrize("ratio", RATIOS[:3])
def test_tuned_lies_between_the_bound_of_the_fixed_points_and_the_closed_form(ratio):
    """Every absorber's response goes through the fixed points of its frequency; Warburton's are the lowest."""
    bridge, bound = undamped(), np.sqrt(2 / (ratio * (1 + ratio))) / 25e3
    highest = [peaks(dense(bridge, [body], [25.0]))[0][1] for body in (
        hsi.Absorber.tuned(bridge, mass_ratio=ratio), hsi.Absorber.warburton(bridge, mass_ratio=ratio))]
    assert bound < highest[0] < highest[1]
    assert highest[1] / bound - 1 < 0.2 * ratio


@pytest.mark.parametrize("people", [[], CROWD])
def test_no_neighbour_of_the_tuned_absorber_has_a_lower_peak(people):
    """Dense matrices of Appendix A."""
    bridge, x = hsi.reference_bridge(frequency=2.0), [25.0] * len(people)
    best = hsi.Absorber.tuned(bridge, people, x, mass_ratio=0.02)

    def highest(frequency, damping):
        body = hsi.Absorber(mass=best.mass, frequency=frequency, damping=damping)
        return peaks(dense(bridge, [body, *people], [25.0, *x]), low=1.0, high=6.0, points=4000)[0][1]

    lowest = highest(best.frequency, best.damping)
    around = [highest(best.frequency * f, best.damping * d)
              for f, d in product((0.998, 1.0, 1.002), (0.99, 1.0, 1.01)) if (f, d) != (1.0, 1.0)]
    assert min(around) > lowest * (1 + 1e-6)


def test_with_the_crowd_on_the_deck_the_absorber_sized_with_it_is_the_better_one():
    bridge = hsi.reference_bridge(frequency=2.0)
    without, within = (hsi.Absorber.tuned(bridge, *people, mass_ratio=0.01) for people in ((), (CROWD, [25.0])))
    occupied, empty = ([hsi.effective(hsi.couple(bridge.with_absorbers(body, at=[25.0]), *people)).damping
                        for body in (without, within)] for people in ((CROWD, [25.0]), ()))
    assert occupied[1] > occupied[0]
    assert empty[0] > empty[1]


def test_it_is_a_body_like_any_other():
    same = hsi.Pedestrian(mass=TMD.mass, frequency=TMD.frequency, damping=TMD.damping, sprung_ratio=1.0)
    s = 1j * TMD.omega
    assert TMD.apparent_mass(s) == pytest.approx(TMD.mass * (1 - 0.5j / TMD.damping), rel=1e-12)
    np.testing.assert_array_equal(TMD.ss(ports=("y", "v")).A, same.ss(ports=("y", "v")).A)
    assert hsi.Crowd.of([TMD, hsi.Pedestrian()])[0] == same
    bodies, places = [hsi.Pedestrian(), TMD, hsi.Pedestrian(mass=90.0)], [10.0, 25.0, 31.0]
    occupied, expected = hsi.couple(two_modes(), bodies, places), dense(two_modes(), bodies, places)
    omega = np.geomspace(1, 100, 50)
    np.testing.assert_allclose(occupied(1j * omega), expected(1j * omega), rtol=1e-9)


def test_a_measured_bridge_takes_it_as_a_body():
    bridge, hertz = hsi.reference_bridge(frequency=2.0), np.linspace(1.5, 2.5, 501)
    measured = hsi.MeasuredBridge(response=hsi.frf(bridge, hertz), positions=[25.0], modal_mass=25e3)
    found = hsi.couple(measured, TMD, [25.0]).frdata
    np.testing.assert_allclose(found.ravel(), dense(bridge, [TMD], [25.0])(2j * np.pi * hertz), rtol=1e-9)


def test_fixed_to_the_bridge_it_is_what_it_is_beside_the_crowd():
    bridge, people = two_modes(), hsi.Population.walking().sample(5, np.random.default_rng(1))
    places, omega = np.array([5.0, 12.0, 26.0, 30.0, 44.0]), np.geomspace(1, 100, 50)
    other = hsi.Absorber(mass=99.0, frequency=8.0, damping=0.0)
    fixed = bridge.with_absorbers(TMD, at=[25.0]).with_absorbers([other], at=[[12.0, 1.0]])
    system, beside = hsi.couple(fixed, people, places), dense(bridge, [TMD, other, *people], [25.0, 12.0, *places])
    np.testing.assert_allclose(system(1j * omega), beside(1j * omega), rtol=1e-9)
    np.testing.assert_allclose(copy.deepcopy(system).A, system.A, rtol=0)
    blocks = system.interconnected()
    assert [block.name for block in blocks.syslist[:5]] == ["mode0", "mode1", "absorber0", "absorber1", "walker0"]
    np.testing.assert_allclose(blocks(1j * omega), beside(1j * omega), rtol=1e-9)


@pytest.mark.parametrize("body", [TMD, hsi.Pedestrian(mass=500.0)])
def test_the_bridge_as_a_block_has_it_inside(body):
    bridge, at, omega = two_modes().with_absorbers(body, at=[20.0]), [25.0, 10.0], np.geomspace(1, 100, 50)
    plant, walker = bridge.ss(at=at), hsi.Pedestrian().ss()
    assert plant.state_labels == ["z[0]", "z[1]", "dz[0]", "dz[1]", "u[0]", "du[0]"]
    loop = ct.feedback(plant, ct.append(walker, walker), sign=+1)
    expected = ct.ss(*appendix_a(two_modes(), [body, *[hsi.Pedestrian()] * 2], sines(bridge, [20.0, *at]),
                                 sines(bridge, at), sines(bridge, at)))
    np.testing.assert_allclose(loop(1j * omega)[[2, 5]], expected(1j * omega), rtol=1e-9)
    short = bridge.ss(at=at, ports=("y", "v"))
    np.testing.assert_allclose(short(1j * omega), plant(1j * omega)[[0, 1, 3, 4]], rtol=1e-12)


def walker(**changes):
    values = {"step_frequency": 1.9, "speed": 5.0, **changes}
    return hsi.Walker(force=hsi.HarmonicForce([0.43]), **values)


@pytest.mark.parametrize(("model", "standing"), [("MF", False), ("MFAM", False), ("PMC", True)])
def test_the_models_have_it(model, standing):
    """Host's own integration of Appendix A under the modal force sin(πvt/L) G α cos(2πf t)."""
    bridge = hsi.reference_bridge(frequency=2.0, damping=0.005)
    people, places = hsi.Crowd(mass=[70.0] * 15, frequency=3.25, damping=0.3), X[::5]
    traffic = hsi.Traffic([walker()], window=(0.0, 12.0), standing=(people, np.column_stack([places, 0 * places])))
    found = hsi.predict(model, bridge.with_absorbers(TMD, at=[20.0]), traffic).response
    deck = bridge.with_crowd_mass(people.mass.sum()) if model == "MFAM" else bridge
    system = on_coordinate(deck, [TMD, *(people if standing else ())], [20.0, *(places if standing else ())])
    time = np.linspace(0.0, 12.0, 24_001)
    on = np.where(time <= 10.0, np.sin(np.pi * time / 10.0), 0.0)
    expected = ct.forced_response(system, time, on * 700 * 0.43 * np.cos(2 * np.pi * 1.9 * time)).outputs
    error = np.interp(found.time, time, expected) - np.ravel(found.outputs)
    assert np.max(np.abs(error)) < 2e-3 * np.max(np.abs(expected))


def test_what_is_left_of_a_vibration_dies_as_its_slowest_pole():
    """Where two peaks share the motion, ξ_eff is twice the damping of either pole."""
    bridge, weak = undamped(), hsi.Absorber(mass=500.0, frequency=1.96, damping=0.01)
    system = hsi.couple(bridge.with_absorbers(weak, at=[25.0]))
    slowest = -max(dense(bridge, [weak], [25.0]).poles().real)
    assert models._slowest_decay(system, models._resonances(system)) == pytest.approx(slowest, rel=1e-9)
    by_the_peak = hsi.effective(system)
    assert by_the_peak.damping * 2 * np.pi * by_the_peak.frequency > 1.5 * slowest


def test_the_steady_state_has_it():
    bridge = hsi.reference_bridge(frequency=2.0, damping=0.0).with_absorbers(TMD, at=[25.0])
    traffic = hsi.Traffic([walker(step_frequency=2.0)], window=(4.0, 6.0))       # stands at midspan
    expected = 700 * 0.43 * abs(transfer(dense(bridge, [TMD], [25.0]), 4j * np.pi)[0])
    assert hsi.predict("SF", bridge, traffic).peak_acceleration == pytest.approx(expected, rel=1e-4)


def test_a_mode_that_the_absorber_does_not_damp_has_no_steady_state():
    bridge = hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=0.5, damping=[0.005, 0.0],
                                             n_modes=2)
    traffic = hsi.Traffic([walker(step_frequency=2.0)], window=(4.0, 6.0))
    with pytest.raises(ValueError, match=r"a steady state needs damping .*at 2 Hz"):
        hsi.predict("SF", bridge.with_absorbers(TMD, at=[25.0]), traffic)     # a node of the second mode


def test_people_walk_over_a_bridge_that_has_it():
    bridge = two_modes().with_absorbers([TMD, hsi.Absorber(mass=200.0, frequency=7.8, damping=0.1)], at=[25.0, 13.0])
    traffic = hsi.Traffic([walker(), walker(arrival=1.1, speed=8.0)])
    crowd, time = hsi.moving_crowd(bridge, traffic, convective=True), np.linspace(0, 3, 301)
    assert crowd.nstates == 2 * (2 + 2 + 2)
    tight = {"rtol": 1e-7, "atol": 1e-10}
    expected = ct.input_output_response(crowd.to_nlsys(), time, 0, solve_ivp_kwargs=tight).outputs
    found = hsi.simulate(crowd, time).response.outputs
    assert np.max(np.abs(found - expected)) < 1e-5 * np.max(np.abs(expected))


def test_nobody_walks_and_it_still_moves():
    """The moving system without walkers is the LTI one."""
    bridge, time = two_modes().with_absorbers(TMD, at=[25.0]), np.linspace(0, 5, 1001)
    force = 1000 * np.sin(2 * np.pi * 1.9 * time)
    crowd = hsi.moving_crowd(bridge, hsi.Traffic([walker(arrival=-100.0)]))
    expected = ct.forced_response(dense(two_modes(), [TMD], [25.0]), time, force).outputs
    found = hsi.simulate(crowd, time, force, initial_state=0).response.outputs
    assert np.max(np.abs(found - expected)) < 1e-6 * np.max(np.abs(expected))
    assert crowd.at(0.0).people.mass.tolist() == [500.0]


def test_prediction_by_the_moving_crowd_has_it():
    bridge = hsi.reference_bridge(frequency=2.0, damping=0.005)
    traffic = hsi.CrowdFlow(density=0.2).sample(bridge, rng=np.random.default_rng(1))
    without, within = (hsi.predict("MC", one, traffic).peak_acceleration
                       for one in (bridge, bridge.with_absorbers(TMD, at=[25.0])))
    assert within < 0.7 * without


def test_an_assessment_has_it_and_says_that_the_guide_has_not():
    bridge = hsi.Footbridge.simply_supported(length=10.0, width=3.0, mass=50e3, frequency=2.0, damping=0.01)
    found = hsi.assess(bridge.with_absorbers(TMD, at=[5.0]), hsi.CrowdFlow(density=0.1),
                       rule=hsi.PercentileRule(tolerance=0.5))
    assert "the guide's value is that of the bridge without its absorbers" in found.remarks
    assert found.effective.estimate[1] > np.sqrt(0.02 * 1.02 / 8)       # an undamped mode can have that much


@pytest.mark.parametrize("model", ["MF", "PMC"])
def test_the_spectral_estimate_has_it(model):
    """An absorber without mass changes nothing, one of 2 % lowers the response; steps meet the highest peak."""
    bridge, flow = hsi.reference_bridge(frequency=2.0, damping=0.005), hsi.CrowdFlow(density=0.5)
    bare, nothing, damped = (hsi.spectral_estimate(model, one, flow) for one in (
        bridge, bridge.with_absorbers(hsi.Absorber(mass=1e-6, frequency=1.95, damping=0.08), at=[25.0]),
        bridge.with_absorbers(TMD, at=[25.0])))
    assert nothing.rms == pytest.approx(bare.rms, rel=1e-3)
    assert damped.rms < 0.9 * bare.rms
    highest = peaks(dense(bridge, [TMD], [25.0]))[0][0] if model == "MF" else hsi.effective(damped.system).frequency
    assert damped.step_frequency[0] == pytest.approx(highest, rel=1e-6)


def test_a_bridge_with_absorbers_is_a_value():
    bridge = two_modes().with_absorbers(TMD, at=[25.0])
    assert pickle.loads(pickle.dumps(bridge)) == bridge == two_modes().with_absorbers([TMD], at=[[25.0, 0.0]])
    assert bridge != two_modes()
    assert bridge.with_crowd_mass(70.0).absorbers == bridge.absorbers


@pytest.mark.parametrize(("make", "error", "message"), [
    (lambda: hsi.Absorber(mass=500.0, frequency=2.0, damping=8.6), ValueError,
     r"damping must lie in \[0, 1\), got 8.6; give a fraction, not percent"),
    (lambda: hsi.Absorber(mass=0, frequency=2.0, damping=0.1), ValueError, "mass must be above 0, got 0; give kg"),
    (lambda: hsi.Absorber(mass=1, frequency=2.0, damping=0.1, direction="up"), ValueError, "direction must be one of"),
    (lambda: hsi.Absorber.den_hartog(undamped(), mass_ratio=2), ValueError,
     r"mass_ratio must lie in \(0, 1\], got 2; give a fraction, not percent"),
    (lambda: hsi.Absorber.den_hartog("bridge", mass_ratio=0.02), TypeError, "bridge must be of type Footbridge, got s"),
    (lambda: hsi.Absorber.tuned(two_modes(), mass_ratio=0.02, mode=1, at=25.0), ValueError,
     r"the mode must move at the absorber's place, got mode 1 at rest in the vertical direction at \(25, 0\) m; move"),
    (lambda: hsi.Absorber.warburton(undamped(), mass_ratio=0.02, direction="lateral"), ValueError, "at rest in the la"),
    (lambda: hsi.Absorber.den_hartog(undamped(), mass_ratio=0.02, at=60.0), ValueError, "at must lie on the deck"),
    (lambda: hsi.Absorber.den_hartog(undamped(), mass_ratio=0.02, at=[1.0, 2.0, 3.0]), ValueError, "at must be one p"),
    (lambda: undamped().with_absorbers(TMD, at=[60.0]), ValueError, r"at must lie on the deck.* got at\[0\] = \(60"),
    (lambda: undamped().with_absorbers([TMD], at=[10.0, 20.0]), ValueError,
     "absorbers and places must be as many, got 1 and 2; give one place"),
    (lambda: undamped().with_absorbers(500.0, at=[10.0]), TypeError, "absorbers must be of type list or tuple, got fl"),
    (lambda: replace(undamped(), absorbers=TMD), TypeError, "absorbers must be of type list or tuple, got Abs"),
    (lambda: replace(undamped(), absorbers=[TMD]), TypeError, "absorbers must be of type tuple, got Absorber; use"),
    (lambda: replace(undamped(), absorbers=[(TMD,)]), ValueError, "absorbers must be pairs of a body and its place"),
    (lambda: undamped().with_absorbers([500.0], at=[10.0]), TypeError, "absorbers must be of type Body, got float"),
    (lambda: hsi.couple(undamped().with_absorbers(TMD, at=[10.0]), TMD, [60.0]), ValueError, r"positions\[0\] = \(60"),
    (lambda: tuned_peaks(["MF"], [undamped().with_absorbers(TMD, at=[25.0])], hsi.Traffic([walker()])), ValueError,
     "bridges must have no absorbers, got 1; use predict"),
])
def test_refusals(make, error, message):
    with pytest.raises(error, match=message):
        make()


DESCRIBED = """\
[bridge]
kind = "reference"
[[absorbers]]
mass = 500
frequency = 1.95
damping = 0.08
at = 25.0
[[absorbers]]
mass = 200
frequency = 7.8
damping = 0.1
at = [13.0, 0.5]
"""


def test_a_description_holds_them(tmp_path):
    path = tmp_path / "bridge.toml"
    path.write_text(DESCRIBED)
    other = hsi.Absorber(mass=200, frequency=7.8, damping=0.1)
    assert read_description(path).bridge == hsi.reference_bridge().with_absorbers([TMD, other], at=[[25, 0], [13, 0.5]])
    path.write_text("absorbers = [{mass = 500, frequency = 1.95, damping = 0.08, at = 25}]")
    assert read_description(path).bridge == hsi.reference_bridge().with_absorbers(TMD, at=[25.0])


@pytest.mark.parametrize(("old", "new", "message"), [
    ("damping = 0.1", "damping = 10", r"line 11, \[absorbers\] damping: damping must lie in \[0, 1\), got 10; give"),
    ("damping = 0.08", "damping = 8", r"line 6, \[absorbers\] damping: damping must"),
    ("at = 25.0", "at = 60", r"line 7, \[absorbers\] at: at must lie on the deck"),
    ("at = [13.0, 0.5]", "at = [13.0, 0.5, 1]", r"line 12, \[absorbers\] at: at must be a place x or \[x, y\], got"),
    ("mass = 200\n", "", r"line 8, \[absorbers\]: the table must hold .*, got no 'mass'; add it"),
    ("mass = 200", "masse = 200", r"line 9, \[absorbers\] masse: key must be one of"),
])
def test_what_a_description_must_not_hold(tmp_path, old, new, message):
    path = tmp_path / "bridge.toml"
    path.write_text(DESCRIBED.replace(old, new))
    with pytest.raises(ValueError, match=message):
        read_description(path)


def test_a_sweep_takes_them_bridge_by_bridge(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(DESCRIBED + "[sweep]\ndamping = [0.005, 0.01]\nmodel = ['MF']\ndensity = [0.2]\n")
    study = read_study(path)
    trial = study.trial(density=0.2, frequency=2.0, force="zivanovic")
    expected = [hsi.predict("MF", one, hsi.tune("MF", one, study.flows[0.2].sample(one, rng=np.random.default_rng(3))))
                for one in study.bridges(2.0)]
    assert all(len(one.absorbers) == 2 for one in study.bridges(2.0))
    np.testing.assert_allclose(trial(np.random.default_rng(3)), [one.peak_acceleration for one in expected], rtol=1e-9)


def test_of_two_equal_peaks_the_lower_frequency_is_taken():
    bridge = hsi.reference_bridge(frequency=2.0, damping=0.005)
    tuned = hsi.Absorber.tuned(bridge, mass_ratio=0.01)
    for detuned in (1 - 1e-6, 1.0, 1 + 1e-6):
        found = hsi.effective(hsi.couple(bridge, replace(tuned, frequency=detuned * tuned.frequency), [25.0]))
        [(frequency, height)] = found.competing
        assert found.frequency < 2.0 < frequency
        assert height == pytest.approx(found.peak, rel=1e-3)

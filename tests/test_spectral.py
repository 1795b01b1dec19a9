"""The spectral road, link by link against closed forms and the host, and as a whole against Monte Carlo."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import control as ct
import numpy as np
import pytest
from scipy.integrate import dblquad
from scipy.signal import lfilter
from scipy.stats import truncnorm

from hsictrl import (
    Absorber,
    CrowdFlow,
    Footbridge,
    HarmonicForce,
    Mode,
    Pedestrian,
    Population,
    SineShape,
    YoungForce,
    ZivanovicForce,
    couple,
    effective,
    frf,
    reference_bridge,
    spectral_estimate,
    trial_rng,
)
from hsictrl.assessment import PeakTrial
from hsictrl.bridge import Shape
from hsictrl.crowd.average import mean_crowd
from hsictrl.prediction.estimate import response_density
from hsictrl.prediction.extremes import envelope_correlation, peak_factor
from hsictrl.prediction.shotnoise import Band, StepRule, mean_square_lines, modal_spectrum
from hsictrl.walking.narrowband import kerr_factor

BRIDGE, FLOW = reference_bridge(frequency=2.0, damping=0.005), CrowdFlow(density=0.5)
KEPT = Path(__file__).parents[1] / "docs" / "spectral_error.json"
WEIGHT, LENGTH, MASS = 700.0, 50.0, 25e3


# the force

def test_lines_of_a_harmonic_hold_its_variance():
    """Živanović et al. (2007): the first factor is Kerr's cubic times N(1, 0.16), the second N(0.07, 0.03)."""
    force = ZivanovicForce(scaling="variance")
    frequencies, power = mean_square_lines(force, WEIGHT, StepRule(2.0, 0.0), crossing=40.0)
    second = truncnorm(-0.07 / 0.03, np.inf, loc=0.07, scale=0.03)
    expected = {1: kerr_factor(2.0)**2 * (1 + 0.16**2), 2: second.var() + second.mean()**2}
    for harmonic, factor in expected.items():
        own = (frequencies >= 2 * (harmonic - 0.25) - 1e-9) & (frequencies < 2 * (harmonic + 0.25) - 1e-9)
        assert power[own].sum() == pytest.approx(WEIGHT**2 * factor, rel=0.01)


def test_step_frequencies_are_those_of_the_normal():
    """Young's third harmonic below: its factor is linear in f_s; E f = 3·2.0, Var f = (3·0.175)²."""
    frequencies, power = mean_square_lines(YoungForce(), 1.0, StepRule(2.0, 0.175), crossing=40.0)
    third, share = frequencies[:, 2], power[:, 2]
    assert share.sum() == pytest.approx((0.026 + 0.0050 * 6.0)**2 + (0.0050 * 3 * 0.175)**2, rel=1e-4)
    factor = (0.026 + 0.0050 * third)**2
    probability = share / factor
    assert probability.sum() == pytest.approx(1.0, rel=1e-4)
    assert np.sum(probability * (third - 6.0)**2) == pytest.approx((3 * 0.175)**2, rel=1e-3)


def one_line(band, frequency=2.0):
    """A line of mean square 1 on the grid."""
    return band.deposited(np.array([round(frequency / band.step) * band.step]), np.ones(1))


def test_a_crossing_smears_a_line_as_a_half_sine_does():
    """Its transform is (2T/π) cos(πfT)/(1 − 4f²T²); of a line of mean square 1, λ/2 of the square is left."""
    band = Band.over(11.0, crossing=40.0, decay=0.05)
    found = modal_spectrum(BRIDGE, LENGTH / 40.0, 0.3, one_line(band), band)[:, 0, 0]
    line = round(2.0 / band.step) * band.step
    for offset in (0, 7, 12, 20, 31):
        at = round(line / band.step) + offset
        f, T = band.frequencies[at] - line, 40.0
        smear = 2 * T / np.pi * np.cos(np.pi * f * T) / (1 - 4 * f**2 * T**2)
        assert found[at].real == pytest.approx(0.3 / 2 * smear**2 / MASS, rel=1e-3, abs=1e-5 * T**2 / MASS)


def test_the_variance_of_the_modal_force_is_campbell_s():
    """λ E∫φ²F² dt/m = n_H/2 · Σ E|c|²/2 / m for half sines."""
    lines, power = mean_square_lines(ZivanovicForce(), WEIGHT, StepRule(2.0, 0.175), crossing=40.0)
    band = Band.over(float(lines.max()), 40.0, 0.05)
    found = modal_spectrum(BRIDGE, LENGTH / 40.0, 75 / 40.0, band.deposited(lines, power), band)
    assert np.sum(found.real) * band.step == pytest.approx(75 / 2 * power.sum() / 2 / MASS, rel=1e-4)


class Torsion(Shape):
    """sin(πx/L) y/(w/2) of a deck 3 m wide."""

    length, antinode, mean_square, mean_absolute = LENGTH, (25.0, 1.5), 0.0, 0.0

    def __call__(self, x, y=0.0, direction="vertical"):
        return np.sin(np.pi * np.asarray(x) / LENGTH) * np.asarray(y) / 1.5 * (direction == "vertical")


TURNING = Footbridge(length=LENGTH, width=3.0, mass=50e3, modes=[
    Mode(frequency=2.0, damping=0.005, modal_mass=MASS, shape=one) for one in (SineShape(LENGTH), Torsion())])


def test_walkers_cross_anywhere_across_the_deck():
    """Of a torsional mode a third of the variance, E (2y/w)² = 1/3, and no product with the upright one."""
    band = Band.over(4.0, 40.0, 0.05)
    found = modal_spectrum(TURNING, LENGTH / 40.0, 0.3, one_line(band), band).sum(axis=0) * band.step
    np.testing.assert_allclose(found, 0.3 * 40.0 / 4 / MASS * np.diag([1, 1 / 3]), atol=1e-9)


# the response

def test_white_noise_on_one_mode():
    """σ² = π f S/(4 ξ m²) for a one-sided S, the acceleration of a lightly damped mode."""
    bridge, band = reference_bridge(frequency=2.0, damping=0.001), Band.over(2.0, 40.0, 0.001 * 4 * np.pi)
    density = response_density(couple(bridge), np.full((band.count, 1, 1), 3.0 / MASS, dtype=complex), band)
    assert np.sum(density) * band.step == pytest.approx(np.pi * 2.0 * 3.0 / (4 * 0.001 * MASS**2), rel=2e-3)


@pytest.mark.parametrize("people", [0, 40])
def test_the_system_is_the_one_that_the_host_sees(people):
    bodies, places = CrowdFlow(persons=max(people, 1)).crowd(BRIDGE, np.random.default_rng(1))
    system = couple(BRIDGE, bodies.part(slice(people)), places[:people])
    band = Band.over(8.0, 40.0, 0.05)
    found = response_density(system, np.ones((band.count, 1, 1), dtype=complex), band)[1:]
    expected = np.abs(frf(system, band.frequencies[1:]).frdata[0, 0])**2 * MASS
    np.testing.assert_allclose(found, expected, rtol=2e-5)


def response_energy(bridge, frequency, speed):
    """∫a² dt at midspan of one walker with the force cos(2πft + θ), mean over θ, by the host."""
    settled = bridge.length / speed + 10 / np.min(bridge.damping * bridge.omega)
    times = np.arange(0.0, settled, 0.004)
    load = np.exp(2j * np.pi * frequency * times) * (speed * times <= bridge.length)
    total = np.zeros_like(load)
    for mode in bridge.modes:
        sensor, push = mode.shape(bridge.length / 2), mode.shape(speed * times)
        for part, unit in ((load.real, 1), (load.imag, 1j)):
            total += unit * sensor * ct.forced_response(mode.ss(), times, part * push / mode.modal_mass).outputs[2]
    return np.sum(np.abs(total)**2) / 2 * 0.004


@pytest.mark.parametrize("frequency", [1.9, 0.96])
def test_the_variance_of_the_response_is_campbell_s(frequency):
    """Equal walkers on three modes: λ Σ_h A_h² ∫a_h² dt; Young's mean factors by hand."""
    bridge = Footbridge.simply_supported(length=20.0, width=3.0, mass=20e3, frequency=1.95, damping=0.02, n_modes=3)
    flow = CrowdFlow(persons=20, speed=1.25, step_frequency=frequency)
    f = frequency * np.arange(1, 5)
    factors = [0.37 * (f[0] - 0.95), 0.054 + 0.0044 * f[1], 0.026 + 0.0050 * f[2], 0.010 + 0.0051 * f[3]]
    energies = [response_energy(bridge, harmonic, 1.25) for harmonic in f]
    found = spectral_estimate("MF", bridge, flow, force=YoungForce())
    assert found.rms == pytest.approx(math.sqrt(20 / 16.0 * WEIGHT**2 * np.square(factors) @ energies), rel=3e-3)


# the crowd

def test_the_mean_crowd_is_the_mean():
    """n E[α] E[φ²], the first by adaptive quadrature over truncated normals."""
    people, places = mean_crowd(BRIDGE, FLOW)
    assert people.mass.sum() == pytest.approx(75 * 70.0)
    densities = [truncnorm(-mean / spread, (high - mean) / spread, loc=mean, scale=spread).pdf
                 for mean, spread, high in ((3.25, 0.32, np.inf), (0.30, 0.05, 1.0))]

    def integrand(damping, frequency, part):
        body = Pedestrian(frequency=frequency, damping=damping).apparent_mass(2j * np.pi * 2.9)
        return getattr(complex(body), part) * densities[0](frequency) * densities[1](damping)

    mean = [dblquad(integrand, 2.0, 4.5, 0.1, 0.5, args=(part,), epsrel=1e-5)[0] for part in ("real", "imag")]
    found = couple(BRIDGE, people, places).condensed.apparent_mass(2j * np.pi * 2.9)[0, 0, 0]
    assert found == pytest.approx(75 * complex(*mean) / 2 / MASS, rel=3e-3)


def test_the_mean_crowd_leans_no_way():
    """A torsional shape y/(w/2): mean square 1/3, a third of what is upright, and no product of the two."""
    mass = couple(TURNING, *mean_crowd(TURNING, FLOW)).condensed.apparent_mass(0)[0].real
    np.testing.assert_allclose(mass, 75 * 70 / 2 / MASS * np.diag([1, 1 / 3]), atol=1e-9)


def test_the_mean_crowd_resonates_where_crowds_do_on_average():
    found = effective(spectral_estimate("PMC", BRIDGE, FLOW).system)
    crowds = [effective(couple(BRIDGE, *FLOW.crowd(BRIDGE, trial_rng(1, i)))) for i in range(40)]
    frequencies, dampings = np.array([[*one] for one in crowds]).T
    assert found.frequency == pytest.approx(frequencies.mean(), rel=2e-3)
    assert found.damping == pytest.approx(dampings.mean(), rel=0.03)


def test_a_population_without_spread_and_a_mass_with_it():
    population = Population(frequency=5.0, damping=0.4, mass=(80.0, 10.0))
    people, _ = mean_crowd(BRIDGE, CrowdFlow(persons=10, population=population))
    assert people.mass.sum() == pytest.approx(800.0)
    assert set(people.frequency) == {5.0}


# the peak

def test_an_envelope_that_does_not_change_is_one_rayleigh_variable():
    assert peak_factor(95.0, np.ones(100), 1.0, 1e-9) == pytest.approx(math.sqrt(-2 * math.log(0.05)), rel=1e-6)


def vanmarcke(level, crossings, bandwidth):
    """Vanmarcke (1975), double barrier, with q^1.2 and a random start: probability to stay below."""
    growth = math.expm1(level**2 / 2)
    clumped = -math.expm1(-math.sqrt(math.pi / 2) * bandwidth**1.2 * level)
    return -math.expm1(-level**2 / 2) * math.exp(-crossings * clumped / growth)


@pytest.mark.parametrize(("damping", "periods"), [(0.01, 100), (0.05, 100), (0.02, 1000)])
def test_of_an_oscillator_under_white_noise_as_vanmarcke_says(damping, periods):
    """q² = 4ξ/π; at the same level, so that the agreement does not hang on how steep a distribution is."""
    f = np.arange(200_000) / 20_000.0
    density = 1 / ((1 - f**2)**2 + (2 * damping * f)**2)
    found = peak_factor(95.0, *envelope_correlation(density, f[1]), duration=float(periods))
    levels = np.linspace(2.0, 6.0, 801)
    below = [vanmarcke(level, 2.0 * periods, math.sqrt(4 * damping / math.pi)) for level in levels]
    assert found == pytest.approx(np.interp(0.95, below, levels), rel=0.05)


@pytest.mark.parametrize("duration", [5.0, 50.0, 500.0])
def test_of_an_oscillator_under_white_noise_as_it_is(duration):
    """1 Hz, 1 %: a discrete recursion with the poles of the oscillator, 1500 windows of as many seconds."""
    step, rate = 0.04, 0.02 * np.pi
    pole = np.exp((-rate + 2j * np.pi) * step)
    count, n = 1500, int(duration / step)
    noise = np.random.default_rng(3).standard_normal((count, n + int(8 / rate / step)))
    signal = np.abs(lfilter([1.0], [1, -2 * pole.real, abs(pole)**2], noise)[:, -n:])
    turn = np.exp(-2j * np.pi * np.arange(50_000) / 1e5)
    spectrum = np.abs(1 - 2 * pole.real * turn + abs(pole)**2 * turn**2)**-2
    rms = math.sqrt(np.sum(spectrum) / 50_000)
    peaks = np.percentile(signal.max(axis=1) / rms, [90, 95])
    correlation = envelope_correlation(spectrum, 1 / step / 1e5)
    found = [peak_factor(percentile, *correlation, duration) for percentile in (90.0, 95.0)]
    np.testing.assert_allclose(found, peaks, rtol=0.05)


# as a whole

@pytest.mark.parametrize(("model", "density", "frequency", "damping"), [
    ("MF", 0.5, 2.0, 0.02), ("PMC", 0.5, 2.0, 0.005), ("PMC", 1.5, 3.25, 0.005)])
def test_monte_carlo_finds_the_same(model, density, frequency, damping):
    """Rms within four standard errors; a95 within a distribution-free interval and 10 % of model error."""
    bridge, flow = reference_bridge(frequency=frequency, damping=damping), CrowdFlow(density=density)
    trial, found = PeakTrial(model=model, bridge=bridge, flow=flow), spectral_estimate(model, bridge, flow)
    drawn = [trial.prediction(trial_rng(11, i)) for i in range(60)]
    squares = np.array([np.mean(one.response.y**2) for one in drawn])
    assert abs(found.rms**2 - squares.mean()) < 4 * squares.std() / math.sqrt(60)
    peaks = np.sort([one.peak_acceleration for one in drawn])
    assert 0.9 * peaks[51] < found.acceleration < 1.1 * peaks[-1]      # the 52nd and the last of 60: 99 % and 95 %


def test_the_map_of_errors_still_holds():
    """Every fourth of the cells of which trials are kept: rms without bias, a95 within 10 % in the median cell."""
    errors = []
    for row in json.loads(KEPT.read_text())[::4]:
        model, frequency, density, damping, _ = row["cell"]
        bridge = reference_bridge(frequency=frequency, damping=damping)
        found, (square, peak) = spectral_estimate(model, bridge, CrowdFlow(density=density)), np.array(row["trials"]).T
        errors.append([found.rms / math.sqrt(square.mean()) - 1, found.acceleration / np.percentile(peak, 95) - 1])
    rms, a95 = np.array(errors).T
    assert abs(rms.mean()) < 0.025      # Monte Carlo's own standard error of this mean is 0.7 %
    assert np.median(abs(a95)) < 0.10


def test_what_is_returned_hangs_together():
    found = spectral_estimate("PMC", BRIDGE, FLOW)
    assert found.acceleration == found.peak_factor * found.rms
    assert found.rms**2 == pytest.approx(np.trapezoid(found.density, found.frequencies), rel=1e-6)
    assert found.duration == LENGTH / FLOW.speed_on(BRIDGE)
    assert found.step_frequency == (effective(found.system).frequency, 0.175)
    row = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert (row["a_m_per_s2"], row["percentile"], row["remarks"]) == (found.acceleration, 95.0, "")
    with pytest.raises(ValueError, match="read-only"):
        found.density[0] = 1.0


def test_weights_masses_and_percentiles():
    usual = spectral_estimate("MF", BRIDGE, FLOW)
    heavier = spectral_estimate("MF", reference_bridge(frequency=2.0, modal_mass=2 * MASS), FLOW)
    stronger = spectral_estimate("MF", BRIDGE, CrowdFlow(density=0.5, weight=2 * WEIGHT))
    assert heavier.acceleration == pytest.approx(usual.acceleration / 2, rel=1e-9)
    assert stronger.acceleration == pytest.approx(2 * usual.acceleration, rel=1e-9)
    assert spectral_estimate("MF", BRIDGE, FLOW, percentile=50).acceleration < usual.acceleration


def test_a_step_frequency_by_hand_is_not_retuned():
    found = spectral_estimate("PMC", BRIDGE, CrowdFlow(density=0.5, step_frequency=(1.8, 0.1)))
    assert found.step_frequency == (1.8, 0.1)


@pytest.mark.parametrize(("mass", "remarked"), [(30e3, True), (50e3, False), (20e3, False)])
def test_where_crowds_take_different_harmonics_is_remarked(mass, remarked):
    """Of the cells of the maps at 2.7 Hz, 0.5 /m² and 2 %, the estimate is off in that of 30 t, by −74 %."""
    bridge = reference_bridge(frequency=2.7, damping=0.02, modal_mass=mass)
    remarks = spectral_estimate("PMC", bridge, CrowdFlow(density=0.5)).remarks
    assert [("harmonic 1 and the next to harmonic 2" in one) for one in remarks] == [True] * remarked


def test_where_nobody_walks_is_remarked():
    [remark] = spectral_estimate("PMC", reference_bridge(frequency=1.0), FLOW).remarks
    assert remark.endswith("lies outside 1.0–2.5 Hz, where people walk")


SWAY = Mode(frequency=1.0, damping=0.01, modal_mass=MASS, shape=SineShape(LENGTH, direction="lateral"))
LATERAL = Footbridge(modes=[SWAY], length=LENGTH, width=3.0, mass=50e3)


@pytest.mark.parametrize(("changes", "error", "message"), [
    ({"model": "MC"}, ValueError, "model must be one of 'MF', 'PMC', got 'MC'"),
    ({"bridge": None}, TypeError, "bridge must be of type Footbridge"),
    ({"flow": 0.5}, TypeError, r"flow must be of type CrowdFlow, got float; use CrowdFlow\(density=…\)"),
    ({"force": "Young"}, TypeError, "force must be of type WalkingForce, got str; use YoungForce or ZivanovicForce"),
    ({"force": HarmonicForce([0.4])}, ValueError, "a spectrum needs walkers with random phases, got those of Harmonic"),
    ({"percentile": 100.0}, ValueError, r"percentile must lie in \(0, 100\), got 100; give 95"),
    ({"bridge": reference_bridge(damping=0.0)}, ValueError, r"damping\[0\] must lie in \(0, 1\), got 0; nothing"),
    ({"bridge": reference_bridge(damping=1e-7)}, ValueError, "damping must settle a vibration within a spectrum of"),
    ({"bridge": BRIDGE.with_absorbers(Absorber(mass=250.0, frequency=2.0, damping=0.0), at=[25.0])}, ValueError,
     r"damping of absorbers and people\[0\] must lie in \(0, 1\), got 0; nothing settles without"),
    ({"model": "PMC", "flow": CrowdFlow(density=0.5, population=replace(Population.walking(), damping=(0.0, 0.0)))},
     ValueError, r"damping of absorbers and people\[0\] must lie in \(0, 1\), got 0; nothing settles without"),
    ({"bridge": LATERAL}, ValueError, "the first mode must move vertically"),
    ({"flow": CrowdFlow(density=0.001)}, ValueError, "density must put at least one person on the deck of 150 m²"),
])
def test_refusals(changes, error, message):
    given = {"model": "MF", "bridge": BRIDGE, "flow": FLOW} | changes
    with pytest.raises(error, match=message):
        spectral_estimate(given.pop("model"), given.pop("bridge"), given.pop("flow"), **given)

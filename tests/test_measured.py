"""A measured bridge against the modal bridge from which its measurement is synthesised."""

import copy
import pickle

import control as ct
import matplotlib as mpl
import numpy as np
import pytest
from scipy import signal
from second_road import sines

import hsictrl as hsi

mpl.use("Agg")
fine = 2 * np.pi * np.linspace(1.0, 4.0, 3001)
POINTS = [12.0, 25.0, 33.0]


def beam(n_modes=1, damping=0.005):
    return hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=damping,
                                           n_modes=n_modes)


def accelerance(bridge, points, omega):
    """Σ_j −ω²φ_jφ_jᵀ/(ω_j² − ω² + 2iξ_jω_jω), the sum over modes written out (eq. 15)."""
    rows, w = sines(bridge, points), omega[:, None]
    share = -w**2 / (bridge.omega**2 - w**2 + 2j * bridge.damping * bridge.omega * w)
    return np.einsum("pj,wj,qj->pqw", rows, share, rows)


def measured(bridge, points, omega=fine, **changed):
    """Scaled to one at the first point, the modal mass is m_B/φ(x₀)²."""
    response = ct.frd(accelerance(bridge, points, omega), omega)
    mass = 25e3 / np.sin(np.pi * points[0] / 50)**2
    return hsi.MeasuredBridge(**{"response": response, "positions": points, "modal_mass": mass} | changed)


def crowd(n, points, seed=0):
    rng = np.random.default_rng(seed)
    return hsi.Population.walking().sample(n, rng), rng.choice(points, n)


# --- the same bridge by two descriptions ----------------------------------------------------------


@pytest.mark.parametrize("n_modes", [1, 3])
@pytest.mark.parametrize("points", [[25.0], POINTS], ids=["1 point", "3 points"])
@pytest.mark.parametrize("n", [0, 1, 20])
def test_an_occupied_measurement_is_the_occupied_bridge(n_modes, points, n):
    """On the lines of the measurement, between all of its points."""
    bridge, (people, x) = beam(n_modes), crowd(n, points)
    found = hsi.couple(measured(bridge, points), people, x, force_at=points, sense_at=points)
    expected = ct.frequency_response(hsi.couple(bridge, people, x, force_at=points, sense_at=points), fine).frdata
    assert np.abs(found.frdata - expected).max() <= 1e-10 * np.abs(expected).max()
    assert found.input_labels == [f"F[{i}]" for i in range(len(points))]
    assert found.output_labels == [f"a[{i}]" for i in range(len(points))]


def test_points_are_chosen_among_the_measured():
    bridge, (people, x) = beam(2), crowd(6, POINTS)
    found = hsi.couple(measured(bridge, POINTS), people, x, force_at=[33.0], sense_at=[25.0, 12.0])
    expected = ct.frequency_response(hsi.couple(bridge, people, x, force_at=[33.0], sense_at=[25.0, 12.0]), fine).frdata
    assert np.abs(found.frdata - expected).max() <= 1e-10 * np.abs(expected).max()


def test_one_body_at_many_places_and_several_at_one():
    bridge, x = beam(), [25.0, 25.0, 33.0]
    found = hsi.couple(measured(bridge, POINTS), hsi.Pedestrian(), x, force_at=[25.0], sense_at=[25.0])
    expected = hsi.couple(bridge, hsi.Pedestrian(), x)(1j * fine)
    np.testing.assert_allclose(found.frdata[0, 0], expected, rtol=1e-9)


@pytest.mark.parametrize("n", [0, 15, 60])
@pytest.mark.parametrize("method", ["peak", "halfpower"])
@pytest.mark.parametrize("points", [[25.0], POINTS], ids=["1 point", "3 points"])
def test_effective_properties_of_a_measurement(n, method, points):
    """Between the lines as well: to 1e-6 of the modal bridge; off the antinode the modal mass makes up for it."""
    bridge, (people, x) = beam(), crowd(n, points)
    found = hsi.effective(hsi.couple(measured(bridge, points), people, x), method=method)
    expected = hsi.effective(hsi.couple(bridge, people, x), method=method)
    assert found.frequency == pytest.approx(expected.frequency, rel=1e-6)
    assert found.damping == pytest.approx(expected.damping, rel=1e-6)
    assert found.peak == pytest.approx(expected.peak * np.sin(np.pi * points[0] / 50)**2, rel=1e-6)


def test_effective_properties_are_read_at_the_first_point_whatever_else_is_asked_for():
    people, x = crowd(15, POINTS)
    here = hsi.couple(measured(beam(), POINTS), people, x)
    there = hsi.couple(measured(beam(), POINTS), people, x, force_at=[33.0], sense_at=[25.0, 33.0])
    assert hsi.effective(here) == hsi.effective(there)


def test_a_coarse_measurement_is_refined_with_its_order():
    """The slope of a cubic spline through 1/H has order 3, and so has the place of the peak."""
    people, x = crowd(60, [25.0])
    truth = hsi.effective(hsi.couple(beam(), people, x)).frequency
    lines = np.array([16, 32, 64, 128])
    grids = [2 * np.pi * np.linspace(1.2, 3.6, n + 1) for n in lines]
    errors = [abs(hsi.effective(hsi.couple(measured(beam(), [25.0], grid), people, x)).frequency - truth)
              for grid in grids]
    assert -np.polyfit(np.log(lines), np.log(errors), 1)[0] == pytest.approx(3.0, abs=0.5), errors


def test_an_empty_measured_bridge_needs_no_couple():
    """f_B/√(1−2ξ²) and ξ√(1−ξ²), from the measurement alone."""
    found = hsi.effective(measured(beam(), [25.0]))
    assert tuple(found) == pytest.approx((2 / np.sqrt(1 - 2 * 0.005**2), 0.005 * np.sqrt(1 - 0.005**2)), rel=1e-7)


def test_a_band_chooses_the_mode():
    bridge = hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=1.2, damping=0.01, n_modes=2)
    bench = measured(bridge, [12.5], 2 * np.pi * np.linspace(0.5, 7, 6501), modal_mass=25e3)
    found = hsi.effective(bench, band=(4.0, 6.0))
    assert found.frequency == pytest.approx(4.8, rel=5e-3)          # the first mode's tail moves it a little
    assert found.damping == pytest.approx(0.01, rel=5e-2)
    assert len(hsi.effective(bench).competing) == 1


def test_frf_gives_lines_of_the_measurement():
    people, x = crowd(15, [25.0])
    bench = measured(beam(), [25.0])
    lines = bench.response.omega[[3, 100, 700]]
    found = hsi.frf(hsi.couple(bench, people, x), lines / (2 * np.pi))
    np.testing.assert_allclose(found.frdata[0, 0], hsi.couple(beam(), people, x)(1j * lines), rtol=1e-10)
    np.testing.assert_allclose(found.omega, lines)


def test_bodies_of_the_other_direction_couple_to_nothing():
    bench, lateral = measured(beam(), [25.0]), hsi.Pedestrian(direction="lateral")
    np.testing.assert_array_equal(hsi.couple(bench, lateral, [25.0]).frdata, hsi.couple(bench).frdata)
    sideways = measured(beam(), [25.0], direction="lateral")
    np.testing.assert_array_equal(hsi.couple(sideways, lateral, [25.0]).frdata,
                                  hsi.couple(bench, hsi.Pedestrian(), [25.0]).frdata)


def test_a_record_of_a_hammer_test_gives_the_same():
    """The measurement made as in the field: an impulse response, its spectrum by FFT, then people on it."""
    bridge, rate, n = beam(damping=0.02), 64.0, 2**14
    plant = bridge.ss(at=[25.0])["v[0]", "F[0]"]
    t = np.arange(n) / rate
    _, free = signal.impulse((plant.A, plant.B, plant.C, plant.D), T=t)
    hertz = np.fft.rfftfreq(n, 1 / rate)
    lines = slice(np.searchsorted(hertz, 1.0), np.searchsorted(hertz, 3.0))
    free[0] /= 2                                            # the trapezoidal rule's half weight at the jump
    response = (2j * np.pi * hertz * np.fft.rfft(free) / rate)[lines]
    bench = hsi.MeasuredBridge(response=ct.frd(response, 2 * np.pi * hertz[lines]), positions=[25.0], modal_mass=25e3)
    people, x = crowd(15, [25.0])
    found, expected = hsi.effective(hsi.couple(bench, people, x)), hsi.effective(hsi.couple(bridge, people, x))
    assert found.frequency == pytest.approx(expected.frequency, rel=1e-3)
    assert found.damping == pytest.approx(expected.damping, rel=1e-2)


# --- a citizen of the host ------------------------------------------------------------------------


@pytest.mark.parametrize("way", [lambda s: pickle.loads(pickle.dumps(s)), copy.copy, copy.deepcopy],
                         ids=["pickle", "copy", "deepcopy"])
def test_an_occupied_measurement_travels(way):
    people, x = crowd(3, POINTS)
    occupied = hsi.couple(measured(beam(), POINTS), people, x, name="deck")
    twin = way(occupied)
    assert type(twin) is hsi.OccupiedMeasurement
    np.testing.assert_array_equal(twin.frdata, occupied.frdata)
    assert (twin.name, twin.input_labels, hsi.effective(twin)) == ("deck", ["F[0]"], hsi.effective(occupied))


def test_an_occupied_measurement_serves_the_host():
    occupied = hsi.couple(measured(beam(), [25.0]), hsi.Pedestrian(), [25.0])
    assert isinstance(occupied, ct.FrequencyResponseData)
    np.testing.assert_array_equal(ct.bode_plot(occupied).lines[0, 0][0].get_data()[0], fine)
    np.testing.assert_allclose((2 * occupied).frdata, 2 * occupied.frdata)


# --- refusals: the rule, the value, the remedy ----------------------------------------------------

BENCH = {"response": ct.frd(np.ones((2, 2, 5)), np.arange(1.0, 6.0)), "positions": [10.0, 20.0], "modal_mass": 1.0}


def bench(**changed):
    return hsi.MeasuredBridge(**BENCH | changed)


@pytest.mark.parametrize(("make", "error", "message"), [
    (lambda: bench(response=np.ones(5)), TypeError,
     "response must be of type FrequencyResponseData, got ndarray; use control."),
    (lambda: bench(positions=[10.0]), ValueError,
     r"response must have a row and a column for each of the 1 positions, got shape \(2, 2\); measure the force"),
    (lambda: bench(positions=[]), ValueError, r"positions must hold at least 1 place\(s\), got 0; give x"),
    (lambda: bench(response=ct.frd(np.ones((2, 2, 3)), [1.0, 2.0, 3.0])), ValueError,
     "the response's omega must hold at least 4 frequencies, got 3; measure at more"),
    (lambda: bench(response=ct.frd(np.ones((2, 2, 6)), [1.0, 2.0, 4.0, 3.0, 5.0, 4.0])), ValueError,
     r"the response's omega\[3\] must be above omega\[2\], got 3 rad/s after 4 rad/s; sort the record by frequency"),
    (lambda: bench(response=ct.frd(np.ones((2, 2, 5)), [1.0, 2.0, 2.0, 3.0, 4.0])), ValueError,
     r"the response's omega\[2\] must be above omega\[1\], got 2 rad/s after 2 rad/s; .* give each once"),
    (lambda: bench(response=ct.frd(np.ones((2, 2, 5)), np.arange(5.0))), ValueError,
     r"the response's omega\[0\] must be above 0, got 0; leave out 0 rad/s"),
    (lambda: bench(response=ct.frd(np.full((2, 2, 5), np.nan), np.arange(1.0, 6.0))), ValueError,
     "response must be finite, got NaN or infinity; leave out the frequencies"),
    (lambda: bench(modal_mass=-1.0), ValueError, "modal_mass must be above 0, got -1; give kg"),
    (lambda: bench(direction="up"), ValueError, "direction must be one of 'vertical', 'lateral', got 'up'; choose one"),
    (lambda: hsi.couple(bench(), hsi.Pedestrian(), [10.0, 15.0]), ValueError,
     r"positions must be among the measured points, got positions\[1\] = \(15, 0\) m; move it to the nearest point"),
    (lambda: hsi.couple(bench(), force_at=[11.0]), ValueError,
     r"force_at must be among .* force_at\[0\] = \(11, 0\) m"),
    (lambda: hsi.couple(bench(), sense_at=[10.0, 9.0]), ValueError,
     r"sense_at must be among .* sense_at\[1\] = \(9, 0"),
    (lambda: hsi.couple(bench(), [hsi.Pedestrian()] * 3, [10.0]), ValueError, "got 3 bodies and 1 positions; give one"),
    (lambda: hsi.effective(measured(beam(), [25.0]), method="pole"), ValueError,
     "method='pole' needs a bridge described by modes, got a measured one; use 'peak' or 'halfpower'"),
    (lambda: hsi.effective(measured(beam(), [25.0]), mode=1), ValueError,
     "mode must be 0 for a measured bridge, got 1; choose the peak with band="),
    (lambda: hsi.effective(measured(beam(), [25.0]), band=(5.0, 7.0)), ValueError,
     r"band must .* Hz; swap or widen it"),
    (lambda: hsi.effective(measured(beam(), [25.0]), band=(3.0, 9.0)), ValueError,
     "must hold a peak .* 3 and 4 Hz; wid"),
    (lambda: hsi.frf(measured(beam(), [25.0]), [0.5, 2.0]), ValueError,
     "frequencies must be lines of the measurement, got 0.5 Hz, whose nearest line is 1 Hz; take them"),
])
def test_refusals(make, error, message):
    with pytest.raises(error, match=message):
        make()

"""Effective properties and responses against closed forms, plain systems, and the design's numbers."""

import json
from types import SimpleNamespace

import control as ct
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eig
from scipy.optimize import brentq, minimize_scalar
from second_road import dense, expanded, on_coordinate, peaks, slope, transfer

import hsictrl as hsi

quick = settings(deadline=None, derandomize=True, max_examples=25)


def beam(n_modes=1, frequency=2.0, damping=0.005):
    return hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=frequency, damping=damping,
                                           n_modes=n_modes)


def walkers(n, seed=0, population=None):
    rng = np.random.default_rng(seed)
    return (population or hsi.Population.walking()).sample(n, rng), rng.uniform(0, 50, n)


def spread(n):
    return (np.arange(n) + 0.5) * 50 / n


# --- published numbers and closed forms -----------------------------------------------------------


def test_fifteen_walkers_on_the_reference_bridge():
    """The design's section 4: peak 1.97085 Hz, 0.75822 %; pole 1.9707 Hz, 0.7296 %."""
    occupied = hsi.couple(hsi.reference_bridge(frequency=2.0, damping=0.005), hsi.Pedestrian(), spread(15))
    frequency, damping = hsi.effective(occupied)
    assert (round(frequency, 5), round(100 * damping, 5)) == (1.97085, 0.75822)
    frequency, damping = hsi.effective(occupied, method="pole")
    assert (round(frequency, 4), round(100 * damping, 4)) == (1.9707, 0.7296)


@quick
@given(frequency=st.floats(0.5, 8), damping=st.floats(1e-5, 0.55), mass=st.floats(1e3, 1e6))
def test_the_empty_bridge_has_its_exact_peak(frequency, damping, mass):
    """The maximum of (15) with β²: ξ_eff = ξ√(1−ξ²), f_eff = f_B/√(1−2ξ²), where (16) puts it at ω_B."""
    found = hsi.effective(hsi.reference_bridge(frequency=frequency, damping=damping, modal_mass=mass))
    assert found.frequency == pytest.approx(frequency / np.sqrt(1 - 2 * damping**2), rel=1e-10)
    assert found.damping == pytest.approx(damping * np.sqrt(1 - damping**2), rel=1e-10)
    assert found.peak == pytest.approx(1 / (2 * damping * np.sqrt(1 - damping**2) * mass), rel=1e-10)
    assert found.competing == ()


@quick
@given(frequency=st.floats(0.5, 8), damping=st.floats(1e-4, 0.1))
def test_the_pole_of_the_empty_bridge_is_the_mode(frequency, damping):
    found = hsi.effective(hsi.reference_bridge(frequency=frequency, damping=damping), method="pole")
    assert tuple(found) == pytest.approx((frequency, damping), rel=1e-10)


@pytest.mark.parametrize("damping", [0.002, 0.02, 0.15])
def test_half_power_of_the_empty_bridge(damping):
    """β⁴/((1−β²)² + 4ξ²β²) = max/2 is a quadratic in β²; its roots are the closed form."""
    half = 1 / (8 * damping**2 * (1 - damping**2))
    squares = np.roots([1 - 1 / half, -(2 - 4 * damping**2), 1])
    width = abs(np.diff(np.sqrt(squares)))[0] * np.sqrt(1 - 2 * damping**2) / 2
    found = hsi.effective(hsi.reference_bridge(damping=damping), method="halfpower")
    assert found.damping == pytest.approx(width, rel=1e-9)
    assert found.frequency == pytest.approx(2 / np.sqrt(1 - 2 * damping**2), rel=1e-10)


def test_frf_of_the_empty_bridge_is_equation_15():
    """With the β² that the printed numerator lacks, over a Hz axis."""
    hertz = np.linspace(0.1, 6.0, 60)
    response = hsi.frf(hsi.reference_bridge(frequency=2.0, damping=0.005), hertz)
    beta = hertz / 2.0
    expected = -beta**2 / 25e3 / (1 - beta**2 + 2j * 0.005 * beta)
    np.testing.assert_allclose(response.frdata[0, 0], expected, rtol=1e-10)
    np.testing.assert_array_equal(response.omega, 2 * np.pi * hertz)
    assert (response.input_labels, response.output_labels) == (["F[0]"], ["a[0]"])
    assert isinstance(response, ct.FrequencyResponseData)


def test_frf_of_an_occupied_bridge_is_equation_14():
    bridge, (people, x), hertz = beam(3), walkers(8), np.geomspace(0.5, 25, 40)
    places = {"force_at": [10.0, 25.0], "sense_at": [20.0]}
    plain = dense(bridge, people, x, **places)
    expected = np.stack([plain(2j * np.pi * f) for f in hertz], axis=-1)
    found = hsi.frf(hsi.couple(bridge, people, x, **places), hertz).frdata
    assert np.abs(found - expected).max() <= 1e-10 * np.abs(expected).max()


# --- the peak -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("n_modes", "mode"), [(1, 0), (3, 0), (3, 1), (3, 2)])
@pytest.mark.parametrize("n", [1, 15, 40])
def test_peak_is_that_of_a_plain_system(n_modes, n, mode):
    """Against a dense grid and the zero of d|H|²/dω, and scipy's minimiser, over the plain matrices of (A.7)."""
    bridge, (people, x) = beam(n_modes), walkers(n, seed=n)
    found = hsi.effective(hsi.couple(bridge, people, x), mode=mode)
    plain = on_coordinate(bridge, people, x, mode)
    frequency, height = peaks(plain)[0]
    assert found.frequency == pytest.approx(frequency, rel=1e-9)
    assert found.peak == pytest.approx(height, rel=1e-10)
    assert found.damping == pytest.approx(1 / (2 * 25e3 * height), rel=1e-10)       # (17)
    lowest = minimize_scalar(lambda f: -abs(transfer(plain, 2j * np.pi * f)[0]), method="bounded",
                             bounds=(frequency - 0.05, frequency + 0.05), options={"xatol": 1e-12})
    assert found.peak == pytest.approx(-lowest.fun, rel=1e-9)


@pytest.mark.parametrize("seed", range(2))
def test_two_peaks_compete_where_a_mode_shifts(seed):
    """225 walkers at f_B 3.7 Hz (section 3.3): all local maxima of the plain system, highest first."""
    bridge, (people, x) = beam(frequency=3.7), walkers(225, seed)
    found = hsi.effective(hsi.couple(bridge, people, x))
    expected = peaks(on_coordinate(bridge, people, x), 0.5, 15.0, 4000)
    assert len(expected) == 2
    assert [(found.frequency, found.peak), *found.competing] == [pytest.approx(peak, rel=1e-8) for peak in expected]
    assert "competing peaks at" in str(found)


@quick
@given(seed=st.integers(0, 10**6), n=st.integers(0, 30), frequency=st.floats(0.5, 9), n_modes=st.integers(1, 2))
def test_no_higher_peak_lies_anywhere(seed, n, frequency, n_modes):
    """The search band is chosen, not given: nothing outside it or between its grid points may be higher."""
    rng = np.random.default_rng(seed)
    people = hsi.Crowd(mass=rng.uniform(30, 400, n), frequency=rng.uniform(0.5, 12, n),
                       damping=rng.uniform(0.05, 0.9, n), sprung_ratio=rng.uniform(0.3, 1, n))
    bridge, x = beam(n_modes, frequency), rng.uniform(0, 50, n)
    found = hsi.effective(hsi.couple(bridge, people, x))
    plain = on_coordinate(bridge, people, x)
    assert np.abs(expanded(plain)(np.geomspace(0.02, 200, 20_000))[0]).max() <= found.peak * (1 + 1e-9)
    assert abs(transfer(plain, 2j * np.pi * found.frequency)[0]) == pytest.approx(found.peak, rel=1e-9)


@pytest.mark.parametrize("band", [(1.99, 2.5), (1.0, 2.001), (1.9999, 2.0002), (2.0, 9.0), (0.01, 2.0001)])
def test_a_band_holds_a_peak_however_near_to_its_end(band):
    """f_eff = 2/√(1−2ξ²) = 2.00005 Hz lies inside every one of these."""
    assert hsi.effective(beam(), band=band).frequency == pytest.approx(2 / np.sqrt(1 - 2 * 0.005**2), rel=1e-10)


@pytest.mark.parametrize("n_modes", [1, 2])
def test_every_local_maximum_is_listed(n_modes):
    """Light absorbers split a mode into many narrow peaks: all those of the plain system, highest first."""
    bridge, x = beam(n_modes), [22.0, 24.0, 26.0, 28.0, 30.0]
    people = hsi.Crowd(mass=[100.0, 150.0, 200.0, 150.0, 100.0], frequency=[1.85, 1.95, 2.0, 2.05, 2.2], damping=0.004)
    found = hsi.effective(hsi.couple(bridge, people, x))
    expected = peaks(on_coordinate(bridge, people, x))
    assert len(expected) >= 6
    assert [(found.frequency, found.peak), *found.competing] == [pytest.approx(peak, rel=1e-8) for peak in expected]


def test_a_band_chooses_among_competing_peaks():
    bridge, (people, x) = beam(frequency=3.7), walkers(225)
    occupied = hsi.couple(bridge, people, x)
    first = hsi.effective(occupied)
    second = hsi.effective(occupied, band=(first.competing[0][0] - 0.3, first.competing[0][0] + 0.3))
    assert (second.frequency, second.peak) == pytest.approx(first.competing[0], rel=1e-9)
    assert second.competing == ()


def test_a_peak_of_a_higher_mode_is_read_on_its_own_coordinate():
    """The second mode's node at midspan hides it from a force there, not from `effective`."""
    found = hsi.effective(beam(2), mode=1)
    assert found.frequency == pytest.approx(8 / np.sqrt(1 - 2 * 0.005**2), rel=1e-10)
    assert found.damping == pytest.approx(0.005 * np.sqrt(1 - 0.005**2), rel=1e-10)


def test_where_force_and_sensor_stand_changes_nothing():
    bridge, (people, x) = beam(2), walkers(5)
    here, there = hsi.couple(bridge, people, x), hsi.couple(bridge, people, x, force_at=[3.0], sense_at=[7.0, 9.0])
    assert hsi.effective(here) == hsi.effective(there)


@pytest.mark.parametrize("n_modes", [1, 2])
def test_an_undamped_body_at_the_end_of_the_band_is_no_obstacle(n_modes):
    """The deck under it stands still at 2 Hz, and the peaks beside it are those of the plain system."""
    body = hsi.Pedestrian(mass=200.0, frequency=2.0, damping=0.0)
    found = hsi.effective(hsi.couple(beam(n_modes), body, [25.0]), band=(2.0, 3.0))
    expected = next(peak for peak in peaks(on_coordinate(beam(n_modes), [body], [25.0])) if 2.0 < peak[0] < 3.0)
    assert (found.frequency, found.peak) == pytest.approx(expected, rel=1e-9)


# --- pole and half-power --------------------------------------------------------------------------


def modal_residue(plain):
    """Dominant oscillating pole of a plain system, by |residue/Re p| with scipy's left and right eigenvectors."""
    poles, left, right = eig(plain.A, left=True, right=True)
    norms = np.einsum("ij,ij->j", left.conj(), right)
    residues = (plain.C @ right)[0] * (left.conj().T @ plain.B)[:, 0] / norms
    upper = poles.imag > 0
    return poles[upper][np.argmax(np.abs(residues / poles.real)[upper])]


@quick
@given(seed=st.integers(0, 10**6), n=st.integers(0, 20), frequency=st.floats(1, 6), n_modes=st.integers(1, 3))
def test_pole_is_the_dominant_one_of_the_plain_system(seed, n, frequency, n_modes):
    rng = np.random.default_rng(seed)
    people = hsi.Crowd(mass=rng.uniform(50, 900, n), frequency=frequency * rng.uniform(0.6, 1.6, n),
                       damping=rng.uniform(0.01, 0.5, n))
    bridge, x = beam(n_modes, frequency), rng.uniform(0, 50, n)
    for mode in range(n_modes):
        found = hsi.effective(hsi.couple(bridge, people, x), mode=mode, method="pole")
        pole = modal_residue(on_coordinate(bridge, people, x, mode))
        assert found.frequency == pytest.approx(abs(pole) / (2 * np.pi), rel=1e-9)
        assert found.damping == pytest.approx(-pole.real / abs(pole), rel=1e-7)
        assert found.peak == hsi.effective(hsi.couple(bridge, people, x), mode=mode).peak


@pytest.mark.parametrize("n_modes", [1, 2, 3])
def test_repeated_poles_of_bodies_that_do_not_couple_are_left_aside(n_modes):
    """40 identical bodies have 40 − n_m poles of their own; a bridge of one heavy body per combination is the truth."""
    bridge, x = beam(n_modes, 3.25), spread(40)
    found = hsi.effective(hsi.couple(bridge, hsi.Pedestrian(), x), method="pole")
    # to even places Σφφᵀ is N/(2m_B) times the identity: every mode has one body of half the crowd at its antinode
    one = hsi.Pedestrian(mass=40 * 70.0 / 2)
    expected = modal_residue(on_coordinate(beam(frequency=3.25), [one], [25.0]))
    assert found.frequency == pytest.approx(abs(expected) / (2 * np.pi), rel=1e-8)
    assert found.damping == pytest.approx(-expected.real / abs(expected), rel=1e-8)


def test_an_undamped_body_that_no_mode_moves_has_no_say():
    """Its pole on the axis belongs to the lateral direction."""
    lateral = hsi.Pedestrian(damping=0.0, direction="lateral")
    found = hsi.effective(hsi.couple(beam(), lateral, [25.0]), method="pole")
    assert tuple(found) == pytest.approx((2.0, 0.005), rel=1e-9)


@pytest.mark.parametrize(("n", "frequency"), [(0, 2.0), (10, 2.0), (60, 3.25), (100, 2.5)])
def test_half_power_is_where_the_plain_response_crosses(n, frequency):
    bridge, (people, x) = beam(frequency=frequency), walkers(n, seed=3)
    plain = on_coordinate(bridge, people, x)
    at, grid = expanded(plain), np.geomspace(0.3, 30, 5000)
    top, height = peaks(plain, 0.5, 15.0, 4000)[0]

    def excess(f):
        return np.abs(at(f)[0]) - height / np.sqrt(2)

    below = grid[excess(grid) < 0]
    low = brentq(excess, below[below < top].max(), top, xtol=1e-13)
    high = brentq(excess, top, below[below > top].min(), xtol=1e-13)
    found = hsi.effective(hsi.couple(bridge, people, x), method="halfpower")
    assert found.damping == pytest.approx((high - low) / (2 * top), rel=1e-8)
    assert found.frequency == pytest.approx(top, rel=1e-9)


def test_the_three_definitions_agree_for_a_light_mode_only():
    """Closed forms differ by O(ξ²) for the empty bridge; for 75 walkers at 3.25 Hz they are far apart."""
    methods, crowded = ("peak", "pole", "halfpower"), hsi.couple(beam(frequency=3.25), *walkers(75))
    alone = [hsi.effective(hsi.reference_bridge(damping=0.002), method=method).damping for method in methods]
    assert alone == pytest.approx([0.002] * 3, rel=1e-4)
    dampings = [hsi.effective(crowded, method=method).damping for method in methods]
    assert max(dampings) > 1.05 * min(dampings)


def test_effective_properties_unpack_print_and_export():
    found = hsi.effective(beam())
    frequency, damping = found
    assert (frequency, damping) == (found.frequency, found.damping)
    assert str(found) == "2.0001 Hz, 0.500 % (peak), |H| = 0.004 m/s² per N"
    row = json.loads(json.dumps(hsi.effective(hsi.couple(beam(frequency=3.7), *walkers(225))).to_dict()))
    assert set(row) == {"frequency_hz", "damping", "peak_m_per_s2_per_n", "method", "competing", "mixing"}
    assert len(row["competing"][0]) == 2


# --- many bridges under one crowd -----------------------------------------------------------------


@pytest.mark.parametrize(("n", "seed", "damping"), [
    (0, 0, None), (1, 1, None), (15, 2, None), (75, 3, None), (225, 4, None), (75, 5, 0.1), (75, 6, 0.01)])
def test_map_equals_effective_bridge_by_bridge(n, seed, damping):
    people, x = walkers(n, seed)
    if damping:
        people = hsi.Crowd(mass=people.mass, frequency=people.frequency, damping=damping)
    frequencies, dampings = np.linspace(1.0, 6.0, 26), [0.002, 0.02]
    f, xi = hsi.effective_map(hsi.couple(beam(), people, x).condensed, frequencies, dampings)
    assert f.shape == xi.shape == (26, 2)
    single = np.array([[tuple(hsi.effective(hsi.couple(beam(frequency=a, damping=b), people, x))) for b in dampings]
                       for a in frequencies])
    np.testing.assert_allclose(f, single[:, :, 0], rtol=1.5e-7)
    np.testing.assert_allclose(xi, single[:, :, 1], rtol=1e-7)


def test_map_at_a_row_of_bridges_of_any_size():
    crowd = hsi.couple(beam(), *walkers(15)).condensed
    f, xi = hsi.effective_map(crowd, [2.0], [0.005])
    assert f.shape == xi.shape == (1, 1)
    np.testing.assert_allclose([f[0, 0], xi[0, 0]], tuple(hsi.effective(hsi.couple(beam(), *walkers(15)))), rtol=1e-7)


# --- sensitivities --------------------------------------------------------------------------------


@pytest.mark.parametrize(("n_modes", "mode"), [(1, 0), (3, 0), (3, 1), (3, 2)])
@pytest.mark.parametrize("frequency", [2.0, 3.25])
def test_sensitivities_are_central_differences(n_modes, mode, frequency):
    """Richardson-extrapolated central differences of the plain system's own peak, for every parameter of every body."""
    rng = np.random.default_rng(1)
    names = ("mass", "frequency", "damping", "sprung_ratio")
    values = dict(zip(names, (rng.uniform(50, 100, 4), rng.uniform(2.5, 4, 4), rng.uniform(0.2, 0.4, 4),
                              rng.uniform(0.8, 0.95, 4)), strict=True))
    bridge, x = beam(n_modes, frequency), rng.uniform(5, 45, 4)
    slopes = hsi.effective_sensitivity(hsi.couple(bridge, hsi.Crowd(**values), x), mode=mode)
    assert slopes.parameters == names
    assert slopes.frequency.shape == slopes.damping.shape == (4, 4)
    start = hsi.effective(hsi.couple(bridge, hsi.Crowd(**values), x), mode=mode).frequency

    def read(name, body, step):
        moved = {key: value.copy() for key, value in values.items()}
        moved[name][body] += step
        people = [SimpleNamespace(**{key: value[i] for key, value in moved.items()}) for i in range(4)]
        plain = on_coordinate(bridge, people, x, mode)

        f = brentq(lambda f: slope(*transfer(plain, 2j * np.pi * f)), 0.98 * start, 1.02 * start, xtol=1e-14)
        return np.array([f, 1 / (2 * 25e3 * abs(transfer(plain, 2j * np.pi * f)[0]))])

    def difference(name, body, step):
        return (read(name, body, step) - read(name, body, -step)) / (2 * step)

    for column, name in enumerate(names):
        for body in range(4):
            step = 1e-3 * values[name][body]
            expected = (4 * difference(name, body, step) - difference(name, body, 2 * step)) / 3
            found = [slopes.frequency[body, column], slopes.damping[body, column]]
            scale = np.abs([slopes.frequency[:, column], slopes.damping[:, column]]).max(axis=1)
            np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-6 * scale.min())


def test_nobody_has_no_sensitivity():
    slopes = hsi.effective_sensitivity(hsi.couple(beam()))
    assert slopes.frequency.shape == slopes.damping.shape == (0, 4)


# --- refusals: the rule, the value, the remedy ----------------------------------------------------


@pytest.mark.parametrize(("make", "error", "message"), [
    (lambda: hsi.effective(ct.ss(-1, 1, 1, 0)), TypeError,
     "system must be of type OccupiedBridge .*, got StateSpace; make one"),
    (lambda: hsi.effective(beam(), method="circle"), ValueError,
     "method must be one of 'peak', .*, got 'circle'; choose"),
    (lambda: hsi.effective(beam(), mode=1), ValueError, "mode must be below the number of modes 1, got 1; count modes"),
    (lambda: hsi.effective(beam(), mode=-1), ValueError, "mode must be at least 0, got -1; count modes from 0"),
    (lambda: hsi.effective(beam(), mode=0.0), TypeError, "mode must be a whole number, got 0.0; count modes from 0"),
    (lambda: hsi.effective(beam(), band=(3.0, 1.0)), ValueError,
     r"band must be \(low, high\) with low below high, got \(3, 1\) Hz; swap or widen it"),
    (lambda: hsi.effective(beam(), band=(0.0, 3.0)), ValueError,
     r"band\[0\] must be above 0, got 0; give \(low, high\)"),
    (lambda: hsi.effective(beam(), band=3.0), ValueError, r"band must have 1 dimension\(s\), got shape \(\); give"),
    (lambda: hsi.effective(beam(), band=(1.0, 2.0, 3.0)), ValueError, r"band must hold two frequencies, got 3; give"),
    (lambda: hsi.effective(beam(), band=(1.0, 1.9)), ValueError,
     "the band must hold a peak of .H., got none between 1 and 1.9 Hz; widen it, or draw frf"),
    (lambda: hsi.effective(beam(), band=(2.1, 9.0)), ValueError, "got none between 2.1 and 9 Hz; widen it"),
    (lambda: hsi.effective(beam(damping=0.0)), ValueError,
     "effective properties need damping, got a peak of .H. without bound .*2.* Hz; give the bridge a damping ratio"),
    (lambda: hsi.effective(hsi.couple(beam(damping=0.0), hsi.Pedestrian(damping=0.0), [25.0]), method="pole"),
     ValueError, "effective properties need damping, got a peak of .H. without bound"),
    (lambda: hsi.effective(hsi.reference_bridge(damping=0.4), method="halfpower"), ValueError,
     "half-power damping needs .H. to fall to 1/√2 of the peak on both sides, got none between .* Hz; use method="),
    (lambda: hsi.frf(beam(), [0.0, 1.0]), ValueError, r"frequencies\[0\] must be above 0, got 0; give an increasing"),
    (lambda: hsi.frf(beam(), [1.0, np.nan]), ValueError, r"frequencies\[1\] must be above 0, got nan; give an increas"),
    (lambda: hsi.frf(beam(), [1.0, 3.0, 2.0]), ValueError,
     "frequencies must increase, got 2 Hz after 3 Hz; give at le"),
    (lambda: hsi.frf(beam(), []), ValueError, "frequencies must increase, got none; give at least one, and sort them"),
    (lambda: hsi.frf(beam(), 2.0), ValueError, r"frequencies must have 1 dimension\(s\), got shape \(\); give an incr"),
    (lambda: hsi.frf("bridge", [2.0]), TypeError, r"system must be .*, got str; make one with couple\("),
    (lambda: hsi.effective_sensitivity(beam()), TypeError,
     "occupied must be of type OccupiedBridge, got Footbridge; make one"),
    (lambda: hsi.effective_map(hsi.couple(beam()), [2.0], [0.01]), TypeError,
     r"crowd must be of type CondensedCrowd, got OccupiedBridge; give couple\(bridge, people, positions\).condensed"),
    (lambda: hsi.effective_map(hsi.couple(beam(2)).condensed, [2.0], [0.01]), ValueError,
     r"the crowd must stand on one mode, got 2; use effective\(\)"),
    (lambda: hsi.effective_map(hsi.couple(beam()).condensed, [2.0], [1.0]), ValueError,
     r"dampings\[0\] must lie in \[0"),
    (lambda: hsi.effective_map(hsi.couple(beam()).condensed, [-2.0], [0.1]), ValueError,
     r"frequencies\[0\] must be abo"),
    (lambda: hsi.effective_map(hsi.couple(beam(), hsi.Pedestrian(damping=0.001), [25.0]).condensed, [2.0], [0.1]),
     ValueError, r"the crowd's damping\[0\] must be at least 0.005, got 0.001; use effective\(\)"),
    (lambda: hsi.effective_map(hsi.couple(beam(), hsi.Pedestrian(), [25.0]).condensed, [2.0], [0.005, 0.8]), ValueError,
     r"every bridge must have a peak of \|H\|, got one without; use effective\(\) for each"),
])
def test_refusals(make, error, message):
    with pytest.raises(error, match=message):
        make()

"""Loop gain and sensitivity against ratios of responses, the host's own feedback, and Bode's integrals."""

import copy
import pickle

import control as ct
import numpy as np
import pytest
from second_road import dense, distance, expanded, on_coordinate

import hsictrl as hsi


def beam(n_modes=1, damping=0.005):
    return hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=damping,
                                           n_modes=n_modes)


def crowded(n=40, n_modes=1, seed=0, **population):
    rng = np.random.default_rng(seed)
    people = hsi.Population(**({"frequency": (3.25, 0.32), "damping": (0.3, 0.05)} | population)).sample(n, rng)
    return hsi.couple(beam(n_modes), people, rng.uniform(0, 50, n))


HERTZ = np.linspace(0.5, 8.0, 301)
S = 2j * np.pi * HERTZ


# --- sensitivity ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("n", [1, 15, 225])
def test_sensitivity_is_the_ratio_of_responses(n):
    occupied = crowded(n)
    ratio = hsi.frf(occupied, HERTZ).frdata[0, 0] / hsi.frf(occupied.bridge, HERTZ).frdata[0, 0]
    assert hsi.sensitivity(occupied)(S) == pytest.approx(ratio, rel=1e-12)


def test_sensitivity_is_the_ratio_of_plain_systems():
    """Both responses by the dense matrices of Appendix A."""
    occupied = crowded(15)
    with_crowd = dense(occupied.bridge, list(occupied.people), occupied.positions[:, 0])
    without = dense(occupied.bridge, [], [])
    assert hsi.sensitivity(occupied)(S) == pytest.approx(with_crowd(S) / without(S), rel=1e-11)


def test_with_several_modes_the_occupied_bridge_is_the_empty_one_behind_the_sensitivity():
    """H_occupied = φ G S φᵀ between any two points."""
    occupied = hsi.couple(*(lambda o: (o.bridge, o.people, o.positions))(crowded(15, n_modes=3)),
                          force_at=[10.0, 30.0], sense_at=[20.0])
    bridge, left = occupied.bridge, hsi.sensitivity(occupied)(S)
    plant = S**2 / (S**2 + np.multiply.outer(2 * bridge.damping * bridge.omega, S) + bridge.omega[:, None]**2)
    rows = bridge.participation([20.0]), bridge.participation([10.0, 30.0])
    found = np.einsum("oj,jw,jkw,ik->oiw", rows[0], plant, left, rows[1])
    truth = ct.ss(occupied.A, occupied.B, occupied.C, occupied.D)(S)
    assert np.max(np.abs(found - truth)) < 1e-11 * np.max(np.abs(truth))


def test_its_diagonal_is_the_ratio_on_the_modes_own_coordinates():
    occupied = crowded(15, n_modes=2)
    for mode in (0, 1):
        at = [expanded(on_coordinate(occupied.bridge, bodies, x, mode)) for bodies, x in (
            (list(occupied.people), occupied.positions[:, 0]), ([], []))]
        assert hsi.sensitivity(occupied)(S)[mode, mode] == pytest.approx(at[0](HERTZ)[0] / at[1](HERTZ)[0], rel=1e-9)


@pytest.mark.parametrize("n_modes", [1, 3])
def test_poles_of_the_sensitivity_are_those_of_the_occupied_bridge(n_modes):
    occupied = crowded(15, n_modes)
    assert distance(hsi.sensitivity(occupied).poles(), occupied.poles()) < 1e-9


def test_an_empty_bridge_is_left_alone():
    left = hsi.sensitivity(hsi.couple(beam(2)))
    assert left(S) == pytest.approx(np.broadcast_to(np.eye(2)[:, :, None], (2, 2, len(S))))


def test_over_periods_the_crowd_gives_what_it_takes():
    """∫ ln|S| dω/ω² = 0 (Bode's integral about zero): the crowd begins as a mass, L = O(s²)."""
    left = hsi.sensitivity(crowded(15))
    omega = np.geomspace(1e-2, 1e4, 100_001)
    area = np.log(np.abs(left(1j * omega))) / omega           # per d ln ω
    assert abs(np.trapezoid(area, np.log(omega))) < 1e-3 * np.trapezoid(np.abs(area), np.log(omega))


def test_over_frequency_the_dampers_decide():
    """∫ ln|S/S(∞)| dω = −(π/2) lim s(L − L(∞))/(1 + L(∞)) (Bode's integral): (Σφ²c − 2ξω Σφ²m₀)/(1 + Σφ²m₀)."""
    occupied = crowded(15)
    left, rows, people = hsi.sensitivity(occupied), occupied.condensed.rows[:, 0], occupied.people
    omega = np.geomspace(1e-2, 1e6, 100_001)
    logs = np.log(np.abs(left(1j * omega)) / left.D[0, 0])
    mass, dashpots, (mode,) = rows**2 @ people.unsprung_mass, rows**2 @ people.damping_coefficient, beam().modes
    expected = -np.pi / 2 * (dashpots - 2 * mode.damping * mode.omega * mass) / (1 + mass)
    assert np.trapezoid(logs * omega, np.log(omega)) == pytest.approx(expected, rel=1e-4)


# --- bands --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("damping", [0.0, 0.005, 0.1])
def test_bodies_that_are_all_mass_amplify_up_to_a_closed_form(damping):
    """|−ω² + iγω + ω_B²| = |−ω²(1 + μ) + iγω + ω_B²| at ω_B/√(1 + μ/2), whatever the damping."""
    rigid = hsi.Pedestrian(sprung_ratio=1e-12)
    bands = hsi.amplified_bands(hsi.couple(beam(damping=damping), [rigid] * 100, [25.0] * 100), band=(0.5, 3.0))
    edge = 2.0 / np.sqrt(1 + 0.28 / 2)
    assert bands.amplified == pytest.approx(np.array([[0.5, edge]]), rel=1e-12)
    assert bands.reduced == pytest.approx(np.array([[edge, 3.0]]), rel=1e-12)


@pytest.mark.parametrize(("n_modes", "mode"), [(1, 0), (3, 1)])
def test_bands_are_those_of_a_fine_grid(n_modes, mode):
    """Sign and largest value of H_occupied/H_empty on the mode's coordinate by plain systems."""
    occupied = crowded(60, n_modes)
    bands = hsi.amplified_bands(occupied, mode=mode, band=(0.5, 15.0))
    hertz = np.linspace(0.5, 15.0, 20_001)
    bodies = (list(occupied.people), occupied.positions[:, 0]), ([], [])
    with_crowd, without = (expanded(on_coordinate(occupied.bridge, *each, mode))(hertz)[0] for each in bodies)
    size = np.abs(with_crowd / without)
    inside = np.any((hertz[:, None] > bands.amplified[:, 0]) & (hertz[:, None] < bands.amplified[:, 1]), axis=1)
    near = np.min(np.abs(np.subtract.outer(hertz, np.vstack([bands.amplified, bands.reduced]).ravel())), axis=1) < 1e-9
    assert np.array_equal(inside[~near], size[~near] > 1)
    assert bands.largest == pytest.approx(size.max(), rel=1e-4)
    assert bands.largest_at == pytest.approx(hertz[np.argmax(size)], abs=1e-3)


def test_of_two_sharp_peaks_the_higher_one_is_the_largest():
    """Poles of bridge and absorber: |S| within a thousandth of each, by poles and zeros."""
    bridge = beam(damping=0.001).with_absorbers(hsi.Absorber(mass=500.0, frequency=1.9, damping=0.0), at=[25.0])
    occupied = hsi.couple(bridge)
    poles = occupied.poles()[occupied.poles().imag > 0]
    hertz = np.multiply.outer(poles.imag / (2 * np.pi), np.linspace(0.999, 1.001, 4001)).ravel()
    pole = (1j * 2 * np.pi * hertz[:, None]) - np.r_[poles, poles.conj()]
    omega, s = bridge.omega[0], 2j * np.pi * hertz
    empty = s**2 + 2 * 0.001 * omega * s + omega**2
    size = np.abs(empty * (s**2 + (2 * np.pi * 1.9)**2) / np.prod(pole, axis=1))
    bands = hsi.amplified_bands(occupied)
    assert bands.largest == pytest.approx(size.max(), rel=1e-6)
    assert bands.largest_at == pytest.approx(hertz[np.argmax(size)], abs=1e-6)


def test_nobody_changes_nothing():
    bands = hsi.amplified_bands(hsi.couple(beam()))
    assert (len(bands.amplified), len(bands.reduced), bands.largest) == (0, 0, 1.0)
    assert str(bands) == "the crowd changes nothing"


def test_bands_refusals():
    occupied = crowded(2)
    with pytest.raises(ValueError, match=r"band must be \(low, high\) with low below high, got \[3.0, 2.0\]"):
        hsi.amplified_bands(occupied, band=(3.0, 2.0))
    with pytest.raises(ValueError, match="mode must be below the number of modes 1, got 1"):
        hsi.amplified_bands(occupied, mode=1)
    with pytest.raises(TypeError, match="occupied must be of type OccupiedBridge"):
        hsi.amplified_bands(beam())


# --- loop gain ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("n_modes", [1, 3])
def test_loop_gain_is_crowd_times_plant_by_the_hosts_blocks(n_modes):
    """A G from one block per mode and per walker: the modes' accelerations through the bodies, back onto the modes."""
    occupied = crowded(4, n_modes)
    rows, s = occupied.condensed.rows, S[::30]
    plant = [mode.ss()(s)[2, 0] for mode in occupied.bridge.modes]
    bodies = [body.ss()(s)[0] for body in occupied.people]          # from y, v, a to the force on the deck
    held = [-(f[0] / s**2 + f[1] / s + f[2]) for f in bodies]
    truth = np.einsum("kj,kw,ki,iw->jiw", rows, held, rows, plant)
    found = hsi.loop_gain(occupied)(s).reshape(truth.shape)
    assert np.max(np.abs(found - truth)) < 1e-11 * np.max(np.abs(truth))


@pytest.mark.parametrize("n_modes", [1, 3])
def test_condensed_responses_are_those_of_the_state_equations(n_modes):
    gain = hsi.loop_gain(crowded(15, n_modes))
    for system in (gain, hsi.sensitivity(gain.occupied)):
        plain = ct.ss(system.A, system.B, system.C, system.D)(S)
        assert np.max(np.abs(system(S) - plain)) < 1e-11 * np.max(np.abs(plain))


def test_the_host_closes_the_loop_to_the_same_poles():
    gain = hsi.loop_gain(crowded(6, n_modes=2))
    closed = ct.feedback(ct.ss([], [], [], np.eye(2)), gain)
    assert distance(closed.poles(), gain.occupied.poles()) < 1e-9


def test_nyquist_counts_no_encirclement():
    response = ct.nyquist_response(hsi.loop_gain(crowded(15)))
    assert response.count == 0


def test_without_damping_the_host_knows_the_limits():
    """At the poles of an undamped mode and of an undamped body S falls to zero."""
    body = hsi.Pedestrian(frequency=3.0, damping=0.0)
    occupied = hsi.couple(beam(damping=0.0), body, [20.0])
    left = hsi.sensitivity(occupied)
    assert abs(left(1j * beam().omega[0])) < 1e-9
    assert abs(left(1j * body.omega)) < 1e-9
    assert np.isinf(abs(hsi.loop_gain(occupied)(1j * beam().omega[0], warn_infinite=False)))


def test_measured_bridges_have_both():
    """Of a bridge measured at one point, the ratio of its responses; at two, H_occupied = H S."""
    plant = beam(2).ss(at=[12.0, 25.0])[["a[0]", "a[1]"], ["F[0]", "F[1]"]]
    measured = hsi.MeasuredBridge(response=ct.frequency_response(plant, 2 * np.pi * HERTZ), positions=[12.0, 25.0],
                                  modal_mass=25e3)
    occupied = hsi.couple(measured, [hsi.Pedestrian()] * 3, [12.0, 12.0, 25.0],
                          force_at=[12.0, 25.0], sense_at=[12.0, 25.0])
    left = hsi.sensitivity(occupied)
    product = np.einsum("ijw,jkw->ikw", measured.response.frdata, left.frdata)
    assert product == pytest.approx(occupied.frdata, rel=1e-11)
    assert left.output_labels == ["net[0]", "net[1]"]
    modelled = hsi.loop_gain(hsi.couple(beam(2), [hsi.Pedestrian()] * 3, [12.0, 12.0, 25.0]))
    determinants = [np.linalg.det(np.eye(2) + np.moveaxis(gain, -1, 0)) for gain in (
        hsi.loop_gain(occupied).frdata, modelled(S))]
    assert determinants[0] == pytest.approx(determinants[1], rel=1e-9)


@pytest.mark.parametrize("make", [hsi.loop_gain, hsi.sensitivity])
def test_copies_keep_names_and_frequency_responses(make):
    system = make(crowded(3, n_modes=2))
    system.update_names(inputs=["a", "b"])
    for twin in (copy.deepcopy(system), pickle.loads(pickle.dumps(system))):
        assert type(twin) is type(system)
        assert (twin.name, twin.input_labels) == (system.name, ["a", "b"])
        assert np.array_equal(twin(S), system(S))


@pytest.mark.parametrize("make", [hsi.loop_gain, hsi.sensitivity])
def test_a_table_of_frequencies_is_refused(make):
    with pytest.raises(ValueError, match=r"x must be one number or one row, got shape \(2, 3\); ravel it"):
        make(crowded(3)).horner(np.ones((2, 3)))


@pytest.mark.parametrize("make", [hsi.loop_gain, hsi.sensitivity])
def test_only_occupied_bridges_have_a_loop(make):
    with pytest.raises(TypeError, match=r"occupied must be of type .* or OccupiedMeasurement, got Footbridge"):
        make(beam())
    with pytest.raises(TypeError, match="name must be of type str"):
        make(crowded(2), name=3)


@pytest.mark.parametrize(("ask", "remedy"), [
    (lambda bridge: hsi.root_locus(bridge, hsi.Pedestrian(), [20.0]), "give them as the first bodies"),
    (lambda bridge: hsi.pole_scatter(bridge, hsi.CrowdFlow(persons=3), rng=np.random.default_rng(1)),
     r"take poles from couple\(bridge, \*flow.crowd\(bridge, rng\)\)"),
    (hsi.passivity, "certify them as bodies")])
def test_absorbers_are_refused_where_modes_are_all_that_is_seen(ask, remedy):
    bridge = beam().with_absorbers(hsi.Absorber(mass=500.0, frequency=1.96, damping=0.09), at=[25.0])
    with pytest.raises(ValueError, match=rf"bridge must have no absorbers, got 1; {remedy}"):
        ask(bridge)


def test_a_locus_with_an_absorber_as_its_first_body_ends_at_the_poles_of_a_bridge_that_has_it():
    absorber, people = hsi.Absorber(mass=500.0, frequency=1.96, damping=0.09), hsi.Population.walking()
    crowd, places = people.sample(5, np.random.default_rng(2)), np.linspace(5.0, 45.0, 5)
    locus = hsi.root_locus(beam(), hsi.Crowd.of([absorber]) + crowd, [25.0, *places])
    occupied = hsi.couple(beam().with_absorbers(absorber, at=[25.0]), crowd, places)
    assert distance(locus.poles[-1], occupied.poles()) < 1e-9

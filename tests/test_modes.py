"""Several modes, and two that are close: effective properties against dense matrices and closed forms."""

import control as ct
import numpy as np
import pytest
from second_road import appendix_a, expanded, peaks

import hsictrl as hsi

ALONG = np.linspace(0.0, 50.0, 51)
WAVES = {"bending": hsi.SineShape(50.0), "second": hsi.SineShape(50.0, 2), "torsion": hsi.SampledShape(
    x=ALONG, y=[-1.5, 1.5], vertical=np.outer(np.sin(np.pi * ALONG / 50), [-1, 1]))}
BY_HAND = {"bending": lambda x, y: np.sin(np.pi * x / 50), "second": lambda x, y: np.sin(2 * np.pi * x / 50),
           "torsion": lambda x, y: -y / 1.5 * np.sin(np.pi * x / 50)}     # one at its antinode, y = −1.5 m
MASSES = {"bending": 25e3, "second": 25e3, "torsion": 25e3 / 3}
X = (np.arange(15) + 0.5) * 50 / 15
ONE_SIDE = np.column_stack([X, np.full(15, 0.75)])


def close(spacing, kinds=("bending", "torsion"), damping=0.005):
    """Two modes, the second higher by a part of the first's 2 Hz."""
    modes = [hsi.Mode(frequency=f, damping=damping, modal_mass=MASSES[kind], shape=WAVES[kind])
             for f, kind in zip((2.0, 2.0 * (1 + spacing)), kinds, strict=True)]
    return hsi.Footbridge(modes=modes, length=50.0, width=3.0, mass=50e3)


def on_coordinate(bridge, kinds, people, places, mode):
    """Appendix A, dense, from a force on a mode's own coordinate to its acceleration there."""
    x, y = places.T
    rows = np.column_stack([BY_HAND[kind](x, y) / np.sqrt(MASSES[kind]) for kind in kinds])
    own = np.eye(2)[mode:mode + 1] / np.sqrt(MASSES[kinds[mode]])
    return ct.ss(*appendix_a(bridge, list(people), rows, own, own))


def strongest(system):
    """Frequency and damping of the pole whose part of the response, |residue/Re p|, is the largest."""
    poles, vectors = np.linalg.eig(system.A)
    parts = np.abs((system.C @ vectors)[0] * np.linalg.solve(vectors, system.B)[:, 0] / poles.real)
    best = poles[np.argmax(np.where(poles.imag > 0, parts, 0.0))]
    return abs(best) / (2 * np.pi), -best.real / abs(best)


@pytest.mark.parametrize("kinds", [("bending", "torsion"), ("bending", "second"), ("torsion", "second")])
@pytest.mark.parametrize("mode", [0, 1])
def test_five_percent_apart_effective_properties_follow_each_mode(kinds, mode):
    bridge, rng = close(0.05, kinds), np.random.default_rng(4)
    people = hsi.Population.walking().sample(15, rng)
    places = np.column_stack([rng.uniform(0, 50, 15), rng.uniform(-0.5, 1.5, 15)])
    system, occupied = on_coordinate(bridge, kinds, people, places, mode), hsi.couple(bridge, people, places)
    found = hsi.effective(occupied, mode=mode)
    frequency, peak = peaks(system)[0]
    np.testing.assert_allclose((found.frequency, found.peak), (frequency, peak), rtol=1e-8)
    assert found.damping == pytest.approx(1 / (2 * MASSES[kinds[mode]] * peak), rel=1e-8)
    pole = hsi.effective(occupied, mode=mode, method="pole")
    np.testing.assert_allclose(tuple(pole), strongest(system), rtol=1e-8)
    assert found.frequency == pytest.approx(pole.frequency, rel=1e-3)
    assert found.damping == pytest.approx(pole.damping, rel=0.2)
    assert found.mixing < 0.5


def test_each_has_its_own():
    found = [hsi.effective(hsi.couple(close(0.05), hsi.Pedestrian(), ONE_SIDE), mode=mode) for mode in (0, 1)]
    assert [round(one.frequency, 3) for one in found] == [1.966, 2.083]


@pytest.mark.parametrize("spacing", [0.05, 0.005, 0.0])
def test_a_crowd_as_heavy_on_both_sides_leaves_the_modes_alone(spacing):
    """The sum of φ₁φ₂ over the people is zero: two bridges of one mode each, however close."""
    bridge, places = close(spacing), np.array([[x, y] for x in X for y in (-0.75, 0.75)])
    for mode in (0, 1):
        alone = hsi.Footbridge(modes=[bridge.modes[mode]], length=50.0, width=3.0, mass=50e3)
        found, expected = (hsi.effective(hsi.couple(one, hsi.Pedestrian(), places), mode=index)
                           for one, index in ((bridge, mode), (alone, 0)))
        np.testing.assert_allclose(tuple(found), tuple(expected), rtol=1e-9)
        assert found.mixing < 1e-12


def test_of_two_equal_modes_the_people_choose_the_combinations():
    """Equal people at one side feel a (cos θ, sin θ) combination; its partner does not move them, and has 2 Hz, 0.5 %.

    The first coordinate's response is cos²θ times that of a mode with the people, and sin²θ times that of an empty one.
    """
    body = hsi.Pedestrian(mass=280.0)
    occupied, row = hsi.couple(close(0.0), body, ONE_SIDE), np.array([1 / np.sqrt(25e3), 0.5 / np.sqrt(25e3 / 3)])
    shares = row[::-1]**2 / (row @ row)      # of the partner on each coordinate

    def accelerance(s, mass):
        return s**2 / (s**2 * (1 + mass) + 2 * 0.005 * 4 * np.pi * s + (4 * np.pi)**2)

    for mode in (0, 1):
        found = hsi.effective(occupied, mode=mode)
        s = 2j * np.pi * found.frequency
        felt = body.apparent_mass(s) * np.sum(np.sin(np.pi * X / 50)**2) * (row @ row)
        both = shares[mode] * accelerance(s, 0.0) + (1 - shares[mode]) * accelerance(s, felt)
        assert found.peak * MASSES[("bending", "torsion")[mode]] == pytest.approx(abs(both), rel=1e-9)
        assert found.frequency == pytest.approx(2.0, rel=1e-3)
        assert found.damping == pytest.approx(0.005 / shares[mode], rel=0.05)
        assert found.mixing == pytest.approx(np.sqrt(1 / shares[mode] - 1), rel=0.1)
    assert "; another mode moves 11" in str(hsi.effective(occupied, mode=0))


def test_mixing_is_the_motion_of_the_other_mode_where_this_one_is_driven():
    occupied = hsi.couple(close(0.02), hsi.Pedestrian(), ONE_SIDE)
    people = [hsi.Pedestrian()] * 15
    for mode in (0, 1):
        found, s = hsi.effective(occupied, mode=mode), 2j * np.pi * hsi.effective(occupied, mode=mode).frequency
        x, y = ONE_SIDE.T
        rows = np.column_stack([BY_HAND[kind](x, y) / np.sqrt(MASSES[kind]) for kind in ("bending", "torsion")])
        both = ct.ss(*appendix_a(close(0.02), people, rows, np.eye(2)[mode:mode + 1], np.eye(2)))
        motion = np.abs(both(s))[:, 0]
        assert found.mixing == pytest.approx(motion[1 - mode] / motion[mode], rel=1e-9)


@pytest.mark.parametrize("spacing", [0.1, 0.05, 0.03, 0.02])
@pytest.mark.parametrize("mode", [0, 1])
def test_mixing_says_how_much_too_high_the_damping_by_the_peak_is(spacing, mode):
    """A pole that moves both modes as 1 : m has a share 1/(1 + m²) of its peak on the first coordinate."""
    occupied, alone = hsi.couple(close(spacing), hsi.Pedestrian(), ONE_SIDE), hsi.Footbridge(
        modes=[close(spacing).modes[mode]], length=50.0, width=3.0, mass=50e3)
    by_mass, both = (hsi.effective(one, mode=index).damping / hsi.effective(one, mode=index, method="pole").damping
                     for one, index in ((hsi.couple(alone, hsi.Pedestrian(), ONE_SIDE), 0), (occupied, mode)))
    assert both / by_mass == pytest.approx(1 + hsi.effective(occupied, mode=mode).mixing**2, rel=0.02)


@pytest.mark.parametrize("spacing", [0.05, 0.02, 0.01])
@pytest.mark.parametrize("mode", [0, 1])
def test_the_pole_of_a_mode_is_never_that_of_the_bodies(spacing, mode):
    """Sixty equal bodies have 59 poles of their own, where the dynamic stiffness has no bound but in one direction."""
    people, places = [hsi.Pedestrian()] * 60, np.column_stack([(np.arange(60) + 0.5) * 50 / 60, np.full(60, 0.75)])
    found = hsi.effective(hsi.couple(close(spacing), people, places), mode=mode, method="pole")
    one = hsi.Pedestrian(mass=70.0 * 30)     # the same on both coordinates, at midspan
    system = on_coordinate(close(spacing), ("bending", "torsion"), [one], np.array([[25.0, 0.75]]), mode)
    np.testing.assert_allclose(tuple(found), strongest(system), rtol=1e-6)


def test_a_measured_point_cannot_tell_modes_within_their_bandwidth():
    """Two equal modes at one point, apart by r bandwidths 2ξf: two peaks at one, one at a half."""
    for bandwidths, n_peaks in ((4.0, 2), (1.0, 2), (0.5, 1)):
        modes = [hsi.Mode(frequency=f, damping=0.005, modal_mass=25e3, shape=WAVES["bending"])
                 for f in (2.0, 2.0 * (1 + 0.01 * bandwidths))]
        bridge = hsi.Footbridge(modes=modes, length=50.0, width=3.0, mass=50e3)
        response = ct.frequency_response(hsi.couple(bridge), 2 * np.pi * np.linspace(1.8, 2.3, 2001))
        found = hsi.effective(hsi.MeasuredBridge(response=response, positions=[25.0], modal_mass=25e3))
        assert 1 + len(found.competing) == n_peaks
        assert found.mixing == 0.0
        assert found.frequency == pytest.approx(peaks_of_two(0.01 * bandwidths), rel=1e-4)


def peaks_of_two(spacing):
    """Frequency of the highest |Σ −ω²/(ω_j² − ω² + 2iξω_jω)| on a fine grid [Hz]."""
    f, hertz = 2.0 * np.array([[1.0], [1 + spacing]]), np.linspace(1.9, 2.2, 300_001)
    return hertz[np.argmax(np.abs(np.sum(hertz**2 / (f**2 - hertz**2 + 2j * 0.005 * f * hertz), axis=0)))]


# --- several modes at once through everything -------------------------------------------------------


def test_the_moving_crowd_moves_both():
    """Bending and torsion, walkers on one side, against the host's integration."""
    walkers = [hsi.Walker(force=hsi.HarmonicForce([0.43]), step_frequency=2.05, speed=8.0, arrival=t, offset=1.0)
               for t in (0.0, 0.7)]
    crowd, time = hsi.moving_crowd(close(0.05), hsi.Traffic(walkers)), np.linspace(0, 2.5, 251)
    edges = [[25.0, -1.5], [25.0, 1.5]]
    tight = {"rtol": 1e-7, "atol": 1e-10}
    expected = ct.input_output_response(crowd.to_nlsys(sense_at=edges), time, 0, solve_ivp_kwargs=tight).outputs
    found = hsi.simulate(crowd, time, sense_at=edges).response.outputs
    assert np.max(np.abs(found - expected)) < 1e-5 * np.max(np.abs(expected))
    assert np.max(np.abs(expected[0] - expected[1])) > 0.1 * np.max(np.abs(expected))


@pytest.mark.parametrize("model", ["SF", "MF", "MFAM", "PMC", "MC"])
def test_steps_are_tuned_to_either_mode(model):
    bridge = close(0.05)
    traffic = hsi.CrowdFlow(density=0.5).sample(bridge, rng=np.random.default_rng(1))
    carriers = {"SF": bridge, "MF": bridge, "MFAM": bridge.with_crowd_mass(75 * 70.0)}
    for mode in (0, 1):
        system = carriers.get(model) or hsi.couple(bridge, *traffic.standing_on(bridge))
        expected = hsi.effective(system, mode=mode).frequency
        assert hsi.tune(model, bridge.led_by(mode), traffic).target == pytest.approx(expected, rel=1e-4)


def test_studies_and_instants_know_modes():
    bridge, flow = close(0.05), hsi.CrowdFlow(density=0.1)
    rule = hsi.MeanRule(tolerance=0.5)
    first, second = (hsi.study_effective(bridge, flow, mode=mode, rule=rule).estimate for mode in (0, 1))
    assert np.all(first[0] < 2.0)
    assert np.all(second[0] > 2.0)
    traffic = flow.sample(bridge, rng=np.random.default_rng(1))
    crowd = hsi.moving_crowd(bridge, traffic)
    low, high = (hsi.effective_along(crowd, [1.0, 20.0], mode=mode)[0] for mode in (0, 1))
    assert np.all(low < 2.0)
    assert np.all(high > 2.0)


@pytest.mark.parametrize(("make", "error", "message"), [
    (lambda: hsi.effective(close(0.05), mode=2), ValueError, "mode must be below the number of modes 2, got 2"),
    (lambda: hsi.effective_map(hsi.couple(close(0.05), hsi.Pedestrian(), [25.0]).condensed, [2.0], [0.005]), ValueError,
     "the crowd must stand on one mode, got 2; use effective"),
])
def test_refusals(make, error, message):
    with pytest.raises(error, match=message):
        make()


def test_peaks_of_the_second_road_are_those_of_a_fine_grid():
    """The other tests lean on it where two peaks stand side by side."""
    system = on_coordinate(close(0.02), ("bending", "torsion"), [hsi.Pedestrian()] * 15, ONE_SIDE, 0)
    hertz = np.linspace(1.9, 2.1, 20_001)
    size = np.abs(expanded(system)(hertz)[0])
    tops = hertz[1:-1][(size[1:-1] > size[:-2]) & (size[1:-1] > size[2:])]
    np.testing.assert_allclose(sorted(f for f, _ in peaks(system)[:2]), tops, atol=2e-5)

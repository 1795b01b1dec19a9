"""Traffic against eqs. 9 and 10 and section 2.2 of Van Nimmen et al. (2017), and against scipy.stats."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import chi2, expon, kstest, norm, truncnorm, uniform

from hsictrl import (
    CrowdFlow,
    HarmonicForce,
    Pedestrian,
    Population,
    Traffic,
    Walker,
    Walkers,
    YoungForce,
    ZivanovicForce,
    reference_bridge,
    resonant_step_frequency,
    weidmann_speed,
)
from hsictrl._draws import truncated_normal

BRIDGE = reference_bridge(frequency=2.0)     # 50 m × 3 m
COSINE = HarmonicForce([0.43])
QUICK = settings(deadline=None, derandomize=True, max_examples=50)


def rng(seed=1):
    return np.random.default_rng(seed)


def drawn(flow, seed=1, bridge=BRIDGE, force=COSINE):
    return flow.sample(bridge, rng=rng(seed), force=force)


def walker(**changes):
    return Walker(**({"force": COSINE, "step_frequency": 2.0, "speed": 1.25} | changes))


def columns(traffic):
    """All that is drawn for each walker but the force itself."""
    walkers, bodies = traffic.walkers, traffic.walkers.bodies
    return np.column_stack([walkers.arrival, walkers.offset, walkers.step_frequency, walkers.speed, walkers.weight,
                            bodies.frequency, bodies.damping, bodies.mass])


# speed, head count and step frequency

@pytest.mark.parametrize("density", [0.2, 0.5, 1.0, 1.5])
def test_weidmann_speed_by_hand(density):
    by_hand = 1.34 * (1 - math.exp(-0.354 * 5.4 * (1 / density - 1 / 5.4)))     # eq. 9 with v₀ = 1.34 m/s
    assert weidmann_speed(density) == pytest.approx(by_hand, rel=1e-14)
    assert CrowdFlow(density=density).speed_on(BRIDGE) == pytest.approx(by_hand, rel=1e-14)


def test_weidmann_speed_runs_from_free_flow_to_the_jam():
    assert weidmann_speed(1e-3) == 1.34
    # near the jam 1 − exp(−γ(d_jam/d − 1)) ≈ γ (d_jam − d)/d_jam
    assert weidmann_speed(5.4 - 1e-6) == pytest.approx(1.34 * 0.354 * 1e-6 / 5.4, rel=1e-5)


@pytest.mark.parametrize(("density", "persons"), [(0.2, 30), (0.5, 75), (0.8, 120), (1.0, 150), (1.5, 225)])
def test_head_counts_of_section_4_2(density, persons):
    flow = CrowdFlow(density=density)
    assert flow.persons_on(BRIDGE) == persons
    assert CrowdFlow(persons=persons).density_on(BRIDGE) == pytest.approx(density)
    people, places = flow.crowd(BRIDGE, rng())
    assert (len(people), len(places)) == (persons, persons)


@pytest.mark.parametrize(("frequency", "step", "harmonic"), [
    (1.0, 1.0, 1), (2.5, 2.5, 1), (2.5001, 1.25005, 2), (5.0, 2.5, 2), (5.01, 1.67, 3),
    (7.5, 2.5, 3), (1e-14, 1e-14, 1),
])
def test_resonant_step_frequency_of_section_2_2(frequency, step, harmonic):
    found, h = resonant_step_frequency(frequency)
    assert (found, h) == (pytest.approx(step, rel=1e-12), harmonic)


@pytest.mark.parametrize(("density", "spread"), [(0.2, 0.175), (0.8, 0.175), (0.999, 0.175), (1.0, 0.0), (1.5, 0.0)])
def test_step_frequencies_scatter_in_sparse_streams_only(density, spread):
    steps = np.concatenate([drawn(CrowdFlow(density=density), seed).walkers.step_frequency for seed in range(60)])
    if spread:
        assert kstest(steps, norm(2.0, spread).cdf).pvalue > 0.01
        assert np.std(steps) == pytest.approx(spread, rel=3 / np.sqrt(2 * len(steps)))
    else:
        np.testing.assert_array_equal(steps, 2.0)


def test_step_frequency_given_by_hand_overrides_the_rule():
    np.testing.assert_array_equal(drawn(CrowdFlow(density=0.2, step_frequency=1.8)).walkers.step_frequency, 1.8)
    pair = drawn(CrowdFlow(density=1.5, step_frequency=(1.8, 0.1)))
    assert pair.target == 1.8
    assert kstest(pair.walkers.step_frequency, norm(1.8, 0.1).cdf).pvalue > 0.01


# arrivals

@pytest.mark.parametrize("flow", [CrowdFlow(density=0.2), CrowdFlow(persons=15), CrowdFlow(density=0.07)], ids=str)
def test_arrivals_are_a_poisson_process_of_eq_10(flow):
    crossing = 50.0 / flow.speed_on(BRIDGE)
    mean, trials = 150.0 * flow.density_on(BRIDGE), 400          # n_H = A d arrive within T, 10.5 people too
    arrivals = [drawn(flow, seed).walkers.arrival for seed in range(trials)]
    counts = np.array([np.sum(times >= 0) for times in arrivals])
    assert abs(counts.sum() - trials * mean) < 3 * np.sqrt(trials * mean)
    dispersion = np.sum((counts - mean)**2) / mean               # χ² if the variance equals the mean
    assert 0.005 < chi2(trials).cdf(dispersion) < 0.995
    # the last gaps before T alone: the start of the record cuts long ones off
    gaps = np.concatenate([np.diff(np.append(times, crossing))[-8:] for times in arrivals])
    assert kstest(gaps, expon(scale=crossing / mean).cdf).pvalue > 0.01


def test_a_deck_without_half_a_person_on_average_may_stay_empty():
    traffic = drawn(CrowdFlow(density=1e-6))
    assert (len(traffic.walkers), len(traffic.standing_on(BRIDGE)[0]), str(traffic)) == (0, 0, "0 walkers at 2.00 Hz")


@pytest.mark.parametrize("damping", [0.005, 0.02, 0.2])
def test_arrivals_reach_from_the_filling_of_the_deck_to_the_end_of_the_window(damping):
    bridge, flow = reference_bridge(frequency=2.0, damping=damping), CrowdFlow(density=1.0)
    crossing = 50.0 / flow.speed_on(bridge)
    earliest = -(crossing + max(crossing, 5 / (damping * 4 * np.pi)))        # section 3 of the design
    traffic = drawn(flow, bridge=bridge)
    arrival = traffic.walkers.arrival
    assert traffic.observed(bridge) == (0.0, pytest.approx(crossing))
    assert np.all(np.diff(arrival) > 0)
    assert earliest < arrival[0] < earliest + 5
    assert crossing - 5 < arrival[-1] < crossing


def test_lateral_offsets_and_standing_places_are_uniform():
    offsets = np.concatenate([drawn(CrowdFlow(density=1.0), seed).walkers.offset for seed in range(5)])
    assert kstest(offsets, uniform(-1.5, 3.0).cdf).pvalue > 0.01
    places = np.concatenate([drawn(CrowdFlow(density=1.5), seed).standing_on(BRIDGE)[1] for seed in range(10)])
    assert kstest(places[:, 0], uniform(0.0, 50.0).cdf).pvalue > 0.01
    assert kstest(places[:, 1], uniform(-1.5, 3.0).cdf).pvalue > 0.01
    assert abs(np.corrcoef(places.T)[0, 1]) < 0.06               # 2.8 standard deviations of 2250 independent pairs


# common random numbers

@pytest.mark.parametrize("force", [ZivanovicForce(), YoungForce()], ids=lambda force: type(force).__name__)
@pytest.mark.parametrize("density", [0.2, 1.0])
def test_a_longer_reach_only_adds_earlier_walkers(density, force):
    short, long = (drawn(CrowdFlow(density=density), 7, reference_bridge(frequency=2.0, damping=xi), force)
                   for xi in (0.005, 0.001))
    n = len(short.walkers)
    assert len(long.walkers) > 2 * n
    np.testing.assert_array_equal(columns(long)[-n:], columns(short))
    np.testing.assert_array_equal(long.walkers.draws[0][-n:], short.walkers.draws[0])
    for a, b in zip(long.standing_on(BRIDGE), short.standing_on(BRIDGE), strict=True):
        np.testing.assert_array_equal(getattr(a, "frequency", a), getattr(b, "frequency", b))


def test_neither_force_nor_population_moves_the_other_draws():
    flow = CrowdFlow(density=0.5)
    one, other = drawn(flow, force=YoungForce()), drawn(flow, force=ZivanovicForce())
    np.testing.assert_array_equal(columns(one), columns(other))
    np.testing.assert_array_equal(one.standing_on(BRIDGE)[1], other.standing_on(BRIDGE)[1])
    np.testing.assert_array_equal(one.standing_on(BRIDGE)[0].damping, other.standing_on(BRIDGE)[0].damping)
    upright = drawn(CrowdFlow(density=0.5, population=Population.standing()))
    np.testing.assert_array_equal(columns(one)[:, :5], columns(upright)[:, :5])
    assert np.all(upright.walkers.bodies.frequency != one.walkers.bodies.frequency)


def test_the_standing_crowd_is_not_made_of_the_walkers():
    traffic = drawn(CrowdFlow(density=1.0))
    assert not set(traffic.standing_on(BRIDGE)[0].frequency) & set(traffic.walkers.bodies.frequency)


def test_two_calls_on_one_generator_differ_and_two_equal_generators_agree():
    generator, flow = rng(), CrowdFlow(density=0.2)
    first, second = (flow.sample(BRIDGE, rng=generator, force=COSINE) for _ in range(2))
    assert first.walkers.arrival[-1] != second.walkers.arrival[-1]
    np.testing.assert_array_equal(columns(first), columns(drawn(flow)))


# tuning

@pytest.mark.parametrize("mean", [1.0, 1.7, 2.4])
def test_tuned_walkers_keep_all_but_their_step(mean):
    traffic = drawn(CrowdFlow(density=0.2), force=ZivanovicForce())
    tuned = traffic.tuned(mean)
    assert tuned.target == mean
    laws = [truncnorm(-m / 0.175, np.inf, loc=m, scale=0.175) for m in (2.0, mean)]     # the same quantiles
    expected = laws[1].isf(laws[0].sf(traffic.walkers.step_frequency))
    np.testing.assert_allclose(tuned.walkers.step_frequency, expected, atol=1e-12)
    np.testing.assert_array_equal(np.delete(columns(tuned), 2, axis=1), np.delete(columns(traffic), 2, axis=1))
    assert np.shares_memory(tuned.walkers.draws[0], traffic.walkers.draws[0])
    np.testing.assert_array_equal(tuned.walkers.draws[0], traffic.walkers.draws[0])
    assert tuned.standing_on(BRIDGE)[0] is traffic.standing_on(BRIDGE)[0]


def test_nobody_steps_backwards_however_low_the_tuning():
    """Far down the law N(0.3, 0.175) loses a twentieth to its truncation at zero; quantiles keep their order."""
    traffic = drawn(CrowdFlow(density=0.8))
    low = traffic.tuned(0.3).walkers.step_frequency
    assert low.min() > 0
    np.testing.assert_array_equal(np.argsort(low), np.argsort(traffic.walkers.step_frequency))
    law = truncnorm(-0.3 / 0.175, np.inf, loc=0.3, scale=0.175)
    assert kstest(low, law.cdf).pvalue > 0.01


def test_tuning_is_the_draw_at_another_frequency():
    elsewhere = drawn(CrowdFlow(density=0.2), bridge=reference_bridge(frequency=1.8, damping=0.005 / 0.9))
    tuned = drawn(CrowdFlow(density=0.2)).tuned(1.8)      # ξω is the same on both bridges, and so the reach
    np.testing.assert_allclose(columns(tuned), columns(elsewhere), rtol=1e-14, atol=1e-13)


@pytest.mark.parametrize(("mean", "remarks"), [(0.99, 1), (1.0, 0), (2.0, 0), (2.5, 0), (2.51, 1), (3.9, 1)])
def test_step_frequencies_beyond_walking_are_reported_not_refused(mean, remarks):
    traffic = drawn(CrowdFlow(density=1.0)).tuned(mean)
    assert len(traffic.remarks) == remarks
    if remarks:
        assert traffic.remarks[0].startswith(f"the mean step frequency {mean:.2f} Hz lies outside 1.0–2.5 Hz")


# made by hand

def test_traffic_by_hand_stands_where_it_walks_at_mid_window():
    early, late, beside = walker(arrival=-20.0), walker(arrival=20.0, offset=1.0), walker(offset=-1.5)
    traffic = Traffic([early, late, beside], window=(0.0, 40.0))      # at 20 s: x = 50, 0 and 25 m
    people, places = traffic.standing_on(BRIDGE)
    np.testing.assert_array_equal(places, [[50.0, 0.0], [0.0, 1.0], [25.0, -1.5]])
    assert len(people) == 3
    assert len(Traffic([early, late, beside], window=(0.0, 41.0)).standing_on(BRIDGE)[0]) == 2


def test_those_who_walk_beside_the_deck_do_not_stand_on_it():
    bodies = [Pedestrian(mass=60.0), Pedestrian(mass=80.0)]
    traffic = Traffic([walker(body=bodies[0], offset=1.6), walker(body=bodies[1], offset=-1.5)])
    people, places = traffic.standing_on(BRIDGE)
    np.testing.assert_array_equal(people.mass, [80.0])
    np.testing.assert_array_equal(places, [[25.0, -1.5]])


def test_two_walkers_are_counted_by_hand():
    """50 m at 1.25 m/s take 40 s, at 2 m/s 25 s: on the deck from 0 to 40 s and from 10 to 35 s, ends included."""
    traffic = Traffic([walker(), walker(arrival=10.0, speed=2.0), walker(offset=1.6)])    # the last one walks beside it
    times = [-0.1, 0.0, 9.9, 10.0, 34.9, 35.0, 35.1, 40.0, 40.1]
    assert traffic.persons_on(BRIDGE, times).tolist() == [0, 1, 1, 2, 2, 2, 1, 1, 0]


def test_people_are_counted_where_the_deck_carries_them():
    traffic = drawn(CrowdFlow(density=0.5))
    times = np.linspace(-50.0, 30.0, 41)
    counted = [int(BRIDGE.carries(traffic.walkers.places(t)).sum()) for t in times]
    assert traffic.persons_on(BRIDGE, times).tolist() == counted


def test_traffic_by_hand_is_observed_from_first_arrival_to_last_departure():
    slow, fast = walker(arrival=3.0, speed=0.5), walker(arrival=1.0, speed=2.0)
    assert Traffic([slow, fast]).observed(BRIDGE) == (1.0, 103.0)
    assert Traffic([slow, fast], window=(5.0, 9.0)).observed(BRIDGE) == (5.0, 9.0)


def test_traffic_of_nobody_needs_a_target():
    nobody = Walkers.of([walker()]).part(np.array([], dtype=int))
    with pytest.raises(ValueError, match="target must be given where there are no walkers, got None; give target"):
        Traffic(nobody, window=(0.0, 10.0))
    assert Traffic(nobody, window=(0.0, 10.0), target=2.0).target == 2.0


def test_walkers_go_in_and_come_out_as_they_are():
    given_ = [walker(body=Pedestrian(mass=60.0 + i), force=force, weight=600.0 + i, speed=1.0 + i, arrival=1.0 * i,
                     offset=0.1 * i) for i, force in enumerate([COSINE, YoungForce(), COSINE])]
    walkers = Walkers.of(given_, rng())
    assert list(walkers) == given_
    assert walkers.forces == (COSINE, YoungForce())
    np.testing.assert_array_equal(walkers.model, [0, 1, 0])


@QUICK
@given(which=st.lists(st.integers(0, 5), max_size=8))
def test_a_part_has_the_forces_of_the_whole(which):
    forces = [COSINE, YoungForce(), ZivanovicForce(), YoungForce(), COSINE, ZivanovicForce()]
    whole = Walkers.of([walker(force=force, weight=600.0 + i, step_frequency=1.5 + i / 10)
                        for i, force in enumerate(forces)], rng())
    times, part = np.linspace(0.0, 3.0, 7), whole.part(np.array(which, dtype=int))
    expected, found = np.zeros((6, 7)), np.zeros((len(which), 7))
    for target, walkers in ((expected, whole), (found, part)):
        for who, force in walkers.lines():
            target[who] = force.at(times)
    np.testing.assert_allclose(found, expected[which], rtol=0, atol=1e-9)


def test_since_keeps_the_window_and_the_late():
    traffic = drawn(CrowdFlow(density=0.2))
    late = traffic.since(-10.0)
    assert late.window == traffic.window
    np.testing.assert_array_equal(columns(late), columns(traffic)[traffic.walkers.arrival >= -10.0])


# draws

@QUICK
@given(draw=st.floats(0.0, 1.0, exclude_max=True), mean=st.floats(0.01, 10.0), spread=st.floats(0.01, 2.0))
def test_truncated_normal_is_the_quantile_of_scipy(draw, mean, spread):
    found = float(truncated_normal(mean, spread, np.array([draw]))[0])
    assert 0 <= found < np.inf
    if 1e-6 < draw < 1 - 1e-6:
        assert found == pytest.approx(truncnorm(-mean / spread, np.inf, mean, spread).ppf(draw), rel=1e-6, abs=1e-9)


def test_a_draw_of_zero_is_a_body_all_the_same():
    assert truncated_normal(3.25, 0.32, np.array([0.0]))[0] > 0
    assert 0 < truncated_normal(0.3, 0.05, np.array([0.0]), high=1.0)[0] < 0.3


def test_what_was_drawn_cannot_be_changed_afterwards():
    rule, traffic = [2.0, 0.1], CrowdFlow(density=0.2).sample(BRIDGE, rng=np.random.default_rng(1))
    stream = CrowdFlow(density=0.2, step_frequency=rule)
    rule[0] = 99.0
    assert stream.step_frequency == (2.0, 0.1)
    with pytest.raises(AttributeError):
        traffic.window = (3.0, 1.0)
    for array in (traffic.walkers.model, traffic.walkers.draws[0], traffic.walkers.arrival):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_a_bridge_that_hardly_settles_is_refused_before_anything_is_drawn():
    """Two crossings at least, or one and five time constants: 1/(1e-6 · 4π) s each."""
    bridge = reference_bridge(frequency=2.0, damping=1e-6)
    flow = CrowdFlow(persons=15, speed=1.25)
    persons = 15 * (2 + 5 / (1e-6 * 4 * np.pi) / 40)
    with pytest.raises(ValueError, match=re.escape(f"got {persons:.3g} in 3.98e+05 s; give every")):
        flow.sample(bridge, rng=np.random.default_rng(1))
    assert flow.drawn_from(reference_bridge(damping=0.0)) == -80.0

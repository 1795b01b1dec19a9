"""Reduced crowds against the bare formulas, exact mergers, dense matrices of Appendix A, and their own bound."""

import pickle

import control as ct
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.optimize import check_grad
from second_road import appendix_a, sines

import hsictrl as hsi
from hsictrl.pedestrian import fit as fitting
from hsictrl.pedestrian.bound import largest_difference

OMEGA = 2 * np.pi * np.unique(np.concatenate([np.geomspace(0.1, 100, 200), np.linspace(0.5, 9, 3000)]))


def beam(frequency=2.0, damping=0.005, n_modes=1, mass=50e3):
    return hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=mass, frequency=frequency, damping=damping,
                                           n_modes=n_modes)


def walkers(seed, n=225):
    rng = np.random.default_rng(seed)
    return hsi.Population.walking().sample(n, rng), rng.uniform(0, 50, n)


def apparent(bridge, people, places, omega=OMEGA):
    """Σ φφᵀ (m₀ + m₁(c s + k)/(m₁s² + c s + k)), written down as it stands in (A.2) and (A.3)."""
    s, rows = 1j * omega[:, None], bridge.participation(places, people.direction)
    k, c, m1, m0 = people.stiffness, people.damping_coefficient, people.sprung_mass, people.unsprung_mass
    pairs = np.einsum("ki,kj->kij", rows, rows).reshape(len(rows), -1)
    return ((m0 + m1 * (c * s + k) / (m1 * s**2 + c * s + k)) @ pairs).reshape(-1, *2 * rows.shape[1:])


def error_between(bridge, mass, other, omega=OMEGA):
    """Largest difference of (1 + A + 2ξω_B/s + ω_B²/s²)⁻¹ over the frequencies, relative to the largest."""
    s = 1j * omega[:, None]
    own = (1 + 2 * bridge.damping * bridge.omega / s + (bridge.omega / s) ** 2)[:, :, None] * np.eye(bridge.n_modes)
    X, Y = np.linalg.inv(own + mass), np.linalg.inv(own + other)
    return largest(Y - X) / largest(X)


def largest(matrices):
    return np.abs(matrices).max() if matrices.shape[1] == 1 else np.linalg.norm(matrices, 2, axis=(1, 2)).max()


def true_error(bridge, full, small, omega=OMEGA):
    return error_between(bridge, *(apparent(bridge, *crowd, omega) for crowd in (full, small)), omega)


def errors_over(frequencies, full, small):
    """Errors on bridges of several frequencies, which feel the same apparent masses."""
    masses = [apparent(beam(), *crowd) for crowd in (full, small)]
    return np.array([error_between(beam(frequency), *masses) for frequency in frequencies])


# --- the aim ---------------------------------------------------------------------------------------

@pytest.mark.parametrize("seed", range(3))
def test_order_8_serves_every_bridge_from_1_to_6_hz(seed):
    people, places = walkers(seed)
    small = people.reduced(order=8, bridge=beam(), positions=places)
    assert small.order == 8
    frequencies = np.linspace(1, 6, 21)
    errors = errors_over(frequencies, (people, places), small)
    bounds = np.array([small.bound(beam(frequency)) for frequency in frequencies])
    assert np.all(errors <= 0.01)
    assert np.all(errors <= bounds)
    assert np.all(bounds <= 1.2 * errors)       # a bound far off would be of no use


@pytest.mark.parametrize("batch", range(10))
def test_the_bound_holds_in_200_random_crowds_which_stay_passive(batch):
    for seed in range(20 * batch, 20 * batch + 20):
        rng = np.random.default_rng([seed, 1])
        (people, places), order = walkers(seed), int(rng.choice([2, 4, 6, 8, 8, 8, 10]))
        bridge = beam(rng.uniform(1, 6), damping=rng.uniform(0.002, 0.02), mass=rng.uniform(30e3, 100e3))
        small = people.reduced(order=order, bridge=bridge, positions=places)
        bound = small.bound(bridge)
        assert true_error(bridge, (people, places), small) <= bound
        assert order < 8 or bound <= 0.01
        assert np.all(apparent(bridge, *small).imag <= 0)       # no power comes out: Re(F v*) = ω Im(A) |v|²


def test_the_occupied_bridge_is_that_of_appendix_a():
    """From force to acceleration, by the host and the whole crowd's dense matrices."""
    (people, places), bridge = walkers(4), beam(3.0)
    occupied = hsi.couple(bridge, *people.reduced(order=8, bridge=bridge, positions=places))
    assert occupied.nstates == 10
    antinode, omega = sines(bridge, 25.0), 2 * np.pi * np.linspace(1, 6, 40)
    whole = ct.ss(*appendix_a(bridge, list(people), sines(bridge, places), antinode, antinode))
    theirs = ct.frequency_response(whole, omega).frdata
    assert_allclose(ct.frequency_response(occupied, omega).frdata, theirs, rtol=0, atol=1e-3 * np.abs(theirs).max())


def test_poles_of_a_reduced_loop_are_stable():
    for seed in range(20):
        (people, places), bridge = walkers(seed), beam(2.0, damping=0.0)
        assert np.all(hsi.couple(bridge, *people.reduced(order=6, bridge=bridge, positions=places)).poles().real < 0)


# --- what is kept exactly --------------------------------------------------------------------------

@pytest.mark.parametrize("order", [2, 4, 10])
def test_static_and_unsprung_mass_are_kept(order):
    (people, places), bridge = walkers(1), beam()
    small = people.reduced(order=order, bridge=bridge, positions=places)
    for omega, mass in ((1e-6, people.mass), (1e9, people.unsprung_mass)):
        kept = apparent(bridge, *small, np.array([omega]))[0, 0, 0].real
        assert kept == pytest.approx(mass @ sines(bridge, places)[:, 0] ** 2, rel=1e-9)


def test_bodies_that_move_alike_are_merged_exactly():
    """Three kinds of people, with masses and unsprung shares of their own, at 90 places: 6 states hold them."""
    rng = np.random.default_rng(0)
    kind, places = rng.integers(0, 3, 90), rng.uniform(0, 50, 90)
    people = hsi.Crowd(mass=rng.uniform(50, 100, 90), frequency=np.array([2.0, 3.0, 5.0])[kind],
                       damping=np.array([0.2, 0.3, 0.4])[kind], sprung_ratio=rng.uniform(0.8, 1.0, 90))
    for order in (6, 10):
        small = people.reduced(order=order, bridge=beam(), positions=places)
        assert small.order == len(small.people) * 2 == 6
        assert true_error(beam(), (people, places), small) < 1e-13
        assert small.bound(beam()) < 1e-11


def test_equal_bodies_on_two_modes_need_three_places():
    """Symmetric 2 × 2 matrices have three entries, so that three places do (Carathéodory)."""
    places, bridge = np.random.default_rng(0).uniform(0, 50, 60), beam(n_modes=2)
    people = hsi.Crowd(mass=[70.0] * 60, frequency=3.25, damping=0.3)
    small = people.reduced(order=6, bridge=bridge, positions=places)
    assert small.order == 6
    assert true_error(bridge, (people, places), small) < 1e-13


def test_a_crowd_that_is_small_enough_stays_as_it_is():
    people, places = walkers(0, n=3)
    small = people.reduced(order=6, bridge=beam(), positions=places)
    assert_allclose(np.sort(small.people.mass), 70.0)
    assert sorted(small.positions[:, 0]) == sorted(places)


def test_those_on_nodes_have_no_say():
    people, places = walkers(0, n=40)
    places[::2] = 50.0 * (np.arange(20) % 2)
    lone = hsi.Crowd(mass=people.mass[1::2], frequency=people.frequency[1::2], damping=people.damping[1::2])
    assert_allclose(people.reduced(order=4, bridge=beam(), positions=places).people.mass,
                    lone.reduced(order=4, bridge=beam(), positions=places[1::2]).people.mass, rtol=1e-6)


def test_reduced_bodies_stand_where_some_stood():
    people, places = walkers(0)
    small = people.reduced(order=10, bridge=beam(), positions=places)
    assert set(small.positions[:, 0]) <= set(places)


def test_the_same_crowd_gives_the_same_reduction():
    people, places = walkers(0)
    one, other = (people.reduced(order=8, bridge=beam(f), positions=places).people.frequency for f in (1.0, 6.0))
    assert_allclose(one, other, rtol=0)     # whatever the bridge's frequency


# --- the fit ---------------------------------------------------------------------------------------

def test_order_2_is_closer_than_the_mean_oscillator():
    """The equivalent oscillator of the literature has the crowd's modal mass and its mean frequency and damping."""
    (people, places), bridge = walkers(0), beam()
    share = sines(bridge, places)[:, 0] ** 2 * people.mass
    mean = hsi.Crowd(mass=share.sum() * 25e3, frequency=np.average(people.frequency, weights=share),
                     damping=np.average(people.damping, weights=share)), [25.0]
    small = people.reduced(order=2, bridge=bridge, positions=places)
    fitted, by_means = (errors_over(range(1, 7), (people, places), crowd).max() for crowd in (small, mean))
    assert fitted < by_means / 2


def test_more_states_mean_less_error():
    people, places = walkers(2)
    small = [people.reduced(order=order, bridge=beam(), positions=places) for order in (2, 4, 6, 8, 10)]
    errors = [errors_over(range(1, 7), (people, places), crowd).max() for crowd in small]
    assert np.all(np.diff(errors) < 0)


def test_slopes_of_the_fit_are_those_of_differences():
    rng = np.random.default_rng(0)
    task = fitting._Fit(np.linspace(5, 40, 7), rng.normal(size=(3, 3)), rng.normal(size=(7, 3)) + 1j,
                        rng.uniform(1, 2, 7), np.array([1.0, 0.1]), np.array([6.0, 0.8]))
    for row in range(0, 42, 5):
        for point in rng.normal(size=(3, 9)):
            assert check_grad(lambda x, row=row: task.residuals(x)[row], lambda x, row=row: task.slopes(x)[row],
                              point) < 1e-5


def test_light_absorbers_among_walkers_are_found():
    """A sharp resonance beside a broad one."""
    people, places = walkers(0, n=100)
    rng = np.random.default_rng(0)
    crowd = hsi.Crowd(mass=np.r_[people.mass, [500.0, 400.0]], frequency=np.r_[people.frequency, [2.0, 2.02]],
                      damping=np.r_[people.damping, [0.005, 0.005]])
    places = np.r_[places, rng.uniform(20, 30, 2)]
    small = crowd.reduced(order=6, bridge=beam(), positions=places)
    assert small.bound(beam()) < 0.04
    assert small.people.frequency[np.argmin(small.people.damping)] == pytest.approx(2.01, rel=0.01)


# --- several modes, and directions -----------------------------------------------------------------

@pytest.mark.parametrize(("n_modes", "order"), [(2, 20), (3, 30)])
def test_several_modes_within_percents(n_modes, order):
    for seed in range(2):
        (people, places), bridge = walkers(seed), beam(n_modes=n_modes)
        small = people.reduced(order=order, bridge=bridge, positions=places)
        error = true_error(bridge, (people, places), small, 2 * np.pi * np.geomspace(0.5, 60, 3000))
        assert error <= small.bound(bridge) <= 0.01


def test_vertical_and_lateral_bodies_are_reduced_together():
    """The Eeklo bridge's second mode sways and twists, so that both kinds of body move with it."""
    rng, bridge = np.random.default_rng(0), hsi.eeklo_bridge()
    up, side = (population.sample(60, rng) for population in (hsi.Population.walking(), hsi.Population.lateral()))
    people = hsi.Crowd.of([*up, *side])
    places = np.column_stack([rng.uniform(1, 41, 120), rng.uniform(-1.4, 1.4, 120)])
    small = people.reduced(order=24, bridge=bridge, positions=places)
    error = true_error(bridge, (people, places), small)
    assert error <= small.bound(bridge) <= 0.05
    assert set(small.people.direction) == {"vertical", "lateral"}


# --- the bound -------------------------------------------------------------------------------------

bodies = st.builds(hsi.Pedestrian, mass=st.floats(20, 3000), frequency=st.floats(0.5, 10), damping=st.floats(0.02, 0.9),
                   sprung_ratio=st.floats(0.05, 1.0))
crowds = st.lists(st.tuples(bodies, st.floats(1, 49)), min_size=1, max_size=5)


@settings(max_examples=60)
@given(crowds, crowds, st.floats(0.5, 8), st.floats(0.0, 0.1), st.integers(1, 3))
def test_the_bound_holds_for_any_two_crowds(full, small, frequency, damping, n_modes):
    bridge = beam(frequency, damping, n_modes)
    pairs = [(hsi.Crowd.of([body for body, _ in crowd]), [x for _, x in crowd]) for crowd in (full, small)]
    bound = largest_difference(bridge.omega, bridge.damping, *(
        (people, bridge.participation(places)) for people, places in pairs))
    assert bound >= true_error(bridge, *pairs, 2 * np.pi * np.geomspace(0.1, 100, 3000))


def test_the_bound_is_tight_where_the_difference_is_a_mass():
    """Rigid bodies, to all purposes: 1/(1 + A + …) with A = μ and μ + δ."""
    bridge, stiff = beam(2.0, damping=0.02), {"frequency": 200.0, "damping": 0.9, "sprung_ratio": 1e-6}
    mu, delta = 0.1, 1e-4
    full, small = ((hsi.Crowd(mass=share * 25e3, **stiff), sines(bridge, 25.0)) for share in (mu, mu + delta))
    beta = np.linspace(0.5, 1.5, 200_001)
    X, other = (1 / (1 + share - 2j * 0.02 / beta - 1 / beta**2) for share in (mu, mu + delta))
    exact = np.abs(other - X).max() / np.abs(X).max()
    assert exact <= largest_difference(bridge.omega, bridge.damping, full, small) <= 1.02 * exact


def test_nothing_is_proven_for_an_undamped_bridge_under_others_than_its_crowd():
    """The rest of the crowd stands on nodes of the bridge that is asked about, so that its peak has no bound."""
    people = hsi.Crowd(mass=[70.0, 80.0, 90.0], frequency=[3.0, 3.2, 3.4], damping=0.3)
    small = people.reduced(order=2, bridge=beam(), positions=[10.0, 25.0, 40.0])
    assert small.bound(beam(damping=0.0)) < np.inf
    far = hsi.ReducedCrowd(people=hsi.Crowd(mass=[1e5], frequency=3.0, damping=0.3), positions=np.array([[25.0, 0.0]]),
                           full_people=people, full_positions=np.array([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]))
    assert far.bound(beam()) == np.inf


def test_crowds_that_no_mode_feels_do_not_differ():
    people, ends = hsi.Crowd(mass=[70.0, 80.0], frequency=3.0, damping=0.3), np.zeros((2, 2))
    idle = hsi.ReducedCrowd(people=people.part([0]), positions=ends[:1], full_people=people, full_positions=ends)
    assert idle.bound(beam()) < 1e-12


def test_absorbers_of_the_bridge_take_part_in_the_bound():
    """A heavy one of little damping makes a resonance of its own, higher up, where the crowds differ more."""
    people = hsi.Crowd(mass=70.0, frequency=np.linspace(2.0, 5.0, 40), damping=0.3)
    bare = beam(0.5, damping=0.05)
    bridge = bare.with_absorbers(hsi.Absorber(mass=10e3, frequency=3.0, damping=0.05), at=[25.0])
    small = people.reduced(order=4, bridge=bridge, positions=np.full(40, 25.0))
    (fixed, there), omega = bridge.fixed, 2 * np.pi * np.linspace(0.2, 9, 5000)
    masses = (apparent(bare, fixed + crowd, np.vstack([there, places]), omega)
              for crowd, places in ((people, small.full_positions), small))
    exact = error_between(bare, *masses, omega)
    assert 2 * small.bound(bare) < exact <= small.bound(bridge) < 2 * exact


# --- refusals and manners --------------------------------------------------------------------------

@pytest.mark.parametrize(("order", "rule"), [
    (3, "order must be even, got 3; a body has two states"), (0, "order must be at least 2, got 0"),
    (22, "order must be at most 20 for 10 bodies, got 22; there is nothing to reduce")])
def test_orders_that_no_crowd_has(order, rule):
    people, places = walkers(0, n=10)
    with pytest.raises(ValueError, match=rule):
        people.reduced(order=order, bridge=beam(), positions=places)


def test_an_order_that_is_no_whole_number():
    people, places = walkers(0, n=10)
    with pytest.raises(TypeError, match=r"order must be a whole number, got 4\.0"):
        people.reduced(order=4.0, bridge=beam(), positions=places)


def test_too_few_states_for_the_modes():
    people, places = walkers(0)
    with pytest.raises(ValueError, match="order must be at least 6 for 2 modes, got 4; give more states"):
        people.reduced(order=4, bridge=beam(n_modes=2), positions=places)


def test_what_is_no_bridge_of_modes():
    people, places = walkers(0, n=10)
    omega = 2 * np.pi * np.linspace(1, 3, 50)
    measured = hsi.MeasuredBridge(response=ct.frequency_response(beam().ss(at=[25.0])["a[0]", "F[0]"], omega),
                                  positions=[25.0], modal_mass=25e3)
    with pytest.raises(TypeError, match="ModalBridge, got MeasuredBridge; describe the bridge by modes"):
        people.reduced(order=4, bridge=measured, positions=places)


def test_places_off_the_deck_and_too_few_of_them():
    people, places = walkers(0, n=10)
    with pytest.raises(ValueError, match="must be as many, got 10 bodies and 9 positions; give one position per body"):
        people.reduced(order=4, bridge=beam(), positions=places[:9])
    with pytest.raises(ValueError, match="deck"):
        people.reduced(order=4, bridge=beam(), positions=places + 100)


def test_a_body_without_damping():
    people = hsi.Crowd(mass=[70.0] * 3, frequency=[3.0, 3.1, 3.2], damping=[0.3, 0.0, 0.2])
    with pytest.raises(ValueError, match=r"damping\[1\] must be above 0, got 0; .* couple it as it is"):
        people.reduced(order=2, bridge=beam(), positions=[10.0, 20.0, 30.0])


def test_a_crowd_on_nodes():
    people = hsi.Crowd(mass=[70.0] * 3, frequency=3.0, damping=0.3)
    with pytest.raises(ValueError, match="somebody must take part in a mode"):
        people.reduced(order=2, bridge=beam(), positions=[0.0, 0.0, 0.0])


def test_a_reduced_crowd_travels_to_workers():
    people, places = walkers(0)
    small = people.reduced(order=8, bridge=beam(), positions=places)
    assert pickle.loads(pickle.dumps(small)).bound(beam()) == small.bound(beam())

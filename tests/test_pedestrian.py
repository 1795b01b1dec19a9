"""Bodies against closed forms, the equations of motion (A.2)-(A.3), and scipy's truncated normals."""

import pickle
from dataclasses import FrozenInstanceError

import control as ct
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

import hsictrl as hsi

quick = settings(deadline=None, derandomize=True, max_examples=60)
bodies = st.builds(
    hsi.Pedestrian, mass=st.floats(20, 150), frequency=st.floats(0.5, 10), damping=st.floats(0.0, 0.99),
    sprung_ratio=st.floats(0.05, 1.0))


def crowd(n=4, seed=0):
    rng = np.random.default_rng(seed)
    return hsi.Crowd(mass=rng.uniform(50, 100, n), frequency=rng.uniform(2, 6, n), damping=rng.uniform(0.1, 0.5, n),
                     sprung_ratio=rng.uniform(0.8, 0.99, n))


# --- one body -------------------------------------------------------------------------------------


def test_defaults_are_the_walker_of_section_2_2():
    body = hsi.Pedestrian()
    omega = 2 * np.pi * 3.25
    assert (body.mass, body.frequency, body.damping, body.sprung_ratio) == (70.0, 3.25, 0.30, 0.95)
    assert body.sprung_mass == pytest.approx(66.5, rel=1e-15)
    assert body.unsprung_mass == pytest.approx(3.5, rel=1e-14)
    assert body.stiffness == pytest.approx(66.5 * omega**2, rel=1e-15)
    assert body.damping_coefficient == pytest.approx(2 * 0.30 * 66.5 * omega, rel=1e-15)


@quick
@given(body=bodies, hertz=st.floats(0.05, 30))
def test_apparent_mass_solves_the_equations_of_motion(body, hertz):
    """(A.3) is solved for u_H1 under a unit acceleration of the deck; (A.2) gives the force on it."""
    s = 2j * np.pi * hertz * (1 + 1e-3j)         # beside the axis, where undamped bodies have no pole
    deck = 1 / s**2
    k, c, m1 = body.stiffness, body.damping_coefficient, body.sprung_mass
    u = (k + c * s) * deck / (m1 * s**2 + c * s + k)
    force_on_deck = (k + c * s) * (u - deck) - body.unsprung_mass
    assert body.apparent_mass(s) == pytest.approx(-force_on_deck, rel=1e-9)


@quick
@given(body=bodies)
def test_limits_of_the_apparent_mass(body):
    """The whole mass at 0 Hz, the unsprung mass at infinite frequency (design, section 4)."""
    assert body.apparent_mass(0) == pytest.approx(body.mass, rel=1e-12)
    far = 1e7j * body.omega
    assert body.apparent_mass(far) == pytest.approx(body.unsprung_mass, abs=1e-6 * body.mass)


@quick
@given(body=bodies.filter(lambda body: body.damping > 1e-9), hertz=st.floats(0.05, 30))
def test_a_body_never_gives_energy(body, hertz):
    """The mean power into the body is Re(α a v*)/2 = −ω Im α |v|²/2, so that Im α(iω) ≤ 0."""
    alpha = complex(body.apparent_mass(2j * np.pi * hertz))
    assert alpha.imag <= 1e-12 * abs(alpha)


@quick
@given(body=bodies, hertz=st.floats(0.05, 30))
def test_block_pushes_back_with_the_apparent_mass(body, hertz):
    """With y, v, a = 1, s, s² the force is −s²α(s)."""
    s = 2j * np.pi * hertz * (1 + 1e-3j)
    block = body.ss()
    force = (block.D + block.C @ np.linalg.solve(s * np.eye(2) - block.A, block.B)) @ [1, s, s**2]
    expected = -s**2 * body.apparent_mass(s)
    assert force[0] == pytest.approx(expected, rel=1e-8, abs=1e-9 * body.stiffness)


def test_block_without_unsprung_mass_does_without_acceleration():
    body = hsi.Pedestrian(sprung_ratio=1.0)
    block = body.ss(ports=("y", "v"), name="me")
    assert (block.input_labels, block.output_labels, block.state_labels) == (["y", "v"], ["F"], ["u", "du"])
    assert block.name == "me"
    whole = body.ss()
    np.testing.assert_array_equal(block.B, whole.B[:, :2])
    np.testing.assert_array_equal(whole.D[:, 2], 0)


def test_a_body_is_frozen_equal_by_value_and_travels():
    body = hsi.Pedestrian(mass=80, direction="lateral")
    assert pickle.loads(pickle.dumps(body)) == body != hsi.Pedestrian(mass=80)
    assert isinstance(body.mass, float)
    with pytest.raises(FrozenInstanceError):
        body.mass = 3.0
    assert str(body) == "80 kg at 3.25 Hz, 30.0 %, 95 % sprung, lateral"


# --- many bodies ----------------------------------------------------------------------------------


def test_crowd_and_bodies_are_two_views_of_the_same():
    people = crowd(5)
    again = hsi.Crowd.of(list(people))
    for name in ("mass", "frequency", "damping", "sprung_ratio", "direction", "stiffness", "damping_coefficient",
                 "sprung_mass", "unsprung_mass", "omega"):
        np.testing.assert_array_equal(getattr(people, name), getattr(again, name))
        np.testing.assert_array_equal(getattr(people, name), [getattr(body, name) for body in people])
    assert people[-1] == list(people)[4]
    assert len(hsi.Crowd.of([])) == 0


@pytest.mark.parametrize("which", [slice(1, 4), [0, 3], np.array([True, False, False, True, True]), slice(0)],
                         ids=["slice", "indices", "mask", "nobody"])
def test_part_keeps_the_bodies_chosen(which):
    people = crowd(5)
    assert list(people.part(which)) == [people[i] for i in np.arange(5)[which]]


def test_scalars_serve_every_body_and_arrays_are_read_only():
    source = np.array([70.0, 80.0])
    people = hsi.Crowd(mass=source, frequency=3.25, damping=0.3, direction="lateral")
    source[0] = 1.0
    assert people[0] == hsi.Pedestrian(mass=70.0, direction="lateral")
    for name in ("mass", "frequency", "direction"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(people, name)[0] = getattr(people, name)[1]


def test_crowd_prints_what_it_holds_and_travels():
    assert str(hsi.Crowd.of([])) == "nobody"
    people = hsi.Crowd(mass=[70.0, 80.0], frequency=[2.0, 3.0], damping=[0.2, 0.4])
    assert str(people) == "2 bodies, 150 kg, 2.00–3.00 Hz, 20–40 %"
    assert list(pickle.loads(pickle.dumps(people))) == list(people)


@pytest.mark.parametrize(("ports", "sprung_ratio"), [(("y", "v", "a"), 0.9), (("y", "v"), 1.0)])
def test_block_of_a_crowd_is_the_hosts_append(ports, sprung_ratio):
    """Against `control.append` of the single blocks."""
    people = hsi.Crowd(mass=[60.0, 70.0, 80.0], frequency=[2.0, 3.0, 4.0], damping=[0.2, 0.3, 0.4],
                       sprung_ratio=sprung_ratio)
    block, host = people.ss(ports=ports, name="all"), ct.append(*(body.ss(ports=ports) for body in people))
    for part in "ABCD":
        np.testing.assert_array_equal(getattr(block, part), getattr(host, part))
    assert block.name == "all"
    assert block.input_labels == [f"{port}[{i}]" for i in range(3) for port in ports]
    assert block.output_labels == ["F[0]", "F[1]", "F[2]"]
    assert block.state_labels == ["u[0]", "du[0]", "u[1]", "du[1]", "u[2]", "du[2]"]


# --- populations ----------------------------------------------------------------------------------


@pytest.mark.parametrize(("population", "frequency", "damping", "direction"), [
    (hsi.Population.walking(), (3.25, 0.32), (0.30, 0.05), "vertical"),        # section 2.2
    (hsi.Population.standing(), (5.7, 0.56), (0.44, 0.07), "vertical"),        # section 3.4
    (hsi.Population.lateral(), (0.75, 0.125), (0.30, 0.05), "lateral"),        # ours, see its docstring
], ids=["walking", "standing", "lateral"])
def test_populations_of_the_paper(population, frequency, damping, direction):
    people = population.sample(4000, np.random.default_rng(7))
    for drawn, (mean, spread) in ((people.frequency, frequency), (people.damping, damping)):
        assert drawn.mean() == pytest.approx(mean, abs=4 * spread / np.sqrt(4000))
        assert drawn.std() == pytest.approx(spread, rel=4 / np.sqrt(2 * 4000))
    assert set(people.direction) == {direction}
    np.testing.assert_array_equal(people.mass, 70.0)
    np.testing.assert_array_equal(people.sprung_ratio, 0.95)


def test_lateral_frequencies_lie_in_the_papers_range():
    """Section 3.4: 95 % between 0.5 and 1.0 Hz."""
    mean, spread = hsi.Population.lateral().frequency
    share = np.diff(stats.norm.cdf([0.5, 1.0], mean, spread))[0]
    assert share == pytest.approx(0.95, abs=0.01)


@pytest.mark.parametrize(("name", "mean", "spread", "high"), [
    ("frequency", 1.0, 0.8, np.inf), ("damping", 0.3, 0.4, 1.0), ("damping", 0.0, 0.2, 1.0),
    ("damping", 0.9, 0.3, 1.0), ("mass", 70.0, 60.0, np.inf)])
def test_draws_follow_the_truncated_normal(name, mean, spread, high):
    """Kolmogorov-Smirnov against scipy.stats.truncnorm, where the truncation bites."""
    values = {"frequency": 3.25, "damping": 0.3, "mass": 70.0} | {name: (mean, spread)}
    drawn = getattr(hsi.Population(**values).sample(5000, np.random.default_rng(11)), name)
    law = stats.truncnorm(-mean / spread, (high - mean) / spread, loc=mean, scale=spread)
    assert stats.kstest(drawn, law.cdf).pvalue > 0.01
    assert stats.kstest(drawn, stats.norm(mean, spread).cdf).pvalue < 1e-6       # the twin that must fail
    assert drawn.mean() == pytest.approx(law.mean(), abs=4 * law.std() / np.sqrt(5000))


def test_properties_are_drawn_independently():
    population = hsi.Population(frequency=(3, 0.3), damping=(0.3, 0.05), mass=(70, 10))
    people = population.sample(4000, np.random.default_rng(3))
    correlation = np.corrcoef([people.frequency, people.damping, people.mass]) - np.eye(3)
    assert np.abs(correlation).max() < 4 / np.sqrt(4000)


def test_same_seed_same_people_and_more_people_change_none():
    population = hsi.Population(frequency=(3, 0.3), damping=(0.3, 0.05), mass=(70, 10))
    ten, five, other = (population.sample(n, np.random.default_rng(seed)) for n, seed in ((10, 1), (5, 1), (10, 2)))
    assert list(ten.part(slice(5))) == list(five)
    assert list(ten) == list(population.sample(10, np.random.default_rng(1)))
    assert list(ten) != list(other)
    assert len(population.sample(0, np.random.default_rng(1))) == 0


# --- refusals: the rule, the value, the remedy ----------------------------------------------------

rng = np.random.default_rng(0)


@pytest.mark.parametrize(("make", "error", "message"), [
    (lambda: hsi.Pedestrian(damping=5.0), ValueError, r"damping must lie in \[0, 1\), got 5; give a fraction, not pe"),
    (lambda: hsi.Pedestrian(damping=-0.1), ValueError, r"damping must lie in \[0, 1\), got -0.1; give a fraction"),
    (lambda: hsi.Pedestrian(damping=1.0), ValueError, r"damping must lie in \[0, 1\), got 1; give a fraction"),
    (lambda: hsi.Population(frequency=3.0, damping=(0.3, 5.0)), ValueError,
     "spread of damping must be below 1, got 5; give a fraction, not percent"),
    (lambda: hsi.Pedestrian(mass=0), ValueError, "mass must be above 0, got 0; give kg"),
    (lambda: hsi.Pedestrian(mass=np.nan), ValueError, "mass must be above 0, got nan; give kg"),
    (lambda: hsi.Pedestrian(frequency=np.inf), ValueError, "frequency must be finite, got inf; give Hz"),
    (lambda: hsi.Pedestrian(frequency="3 Hz"), TypeError, "frequency must be real numbers, got '3 Hz'; give Hz"),
    (lambda: hsi.Pedestrian(frequency=[3.0, 4.0]), ValueError, r"frequency must be one number, .* \(2,\); give Hz"),
    (lambda: hsi.Pedestrian(mass=True), TypeError, "mass must be real numbers, got True; give kg"),
    (lambda: hsi.Pedestrian(sprung_ratio=95), ValueError, r"sprung_ratio must lie in \(0, 1\], got 95; give a fracti"),
    (lambda: hsi.Pedestrian(sprung_ratio=0), ValueError, r"sprung_ratio must lie in \(0, 1\], got 0; give a fraction"),
    (lambda: hsi.Pedestrian(direction="up"), ValueError,
     "direction must be one of 'vertical', 'lateral', got 'up'; ch"),
    (lambda: hsi.Pedestrian().ss(ports=("y", "v")), ValueError, r"ports must hold 'a' .* 3.5 kg; add 'a', or set spr"),
    (lambda: hsi.Pedestrian().ss(ports=("y", "y")), ValueError, r"ports must be \('y', 'v', 'a'\) or .*; choose one"),
    (lambda: hsi.Pedestrian().ss(ports=("v", "y", "a")), ValueError,
     "ports must be .* got .'v', 'y', 'a'.; choose one"),
    (lambda: crowd().ss(ports=("y", "v")), ValueError, "ports must hold 'a' .* kg; add 'a', or set sprung_ratio=1"),
    (lambda: hsi.Crowd.of([]).ss(), ValueError, "a block must hold at least one body, got none; leave an empty crowd"),
    (lambda: hsi.Crowd(mass=[70, 80], frequency=[3, 3, 3], damping=0.3), ValueError,
     r"must have the same length, got shapes \(2,\), \(3,\).*; give one value per body, or a scalar for all"),
    (lambda: hsi.Crowd(mass=[70, -1], frequency=3, damping=0.3), ValueError,
     r"mass\[1\] must be above 0, got -1; give"),
    (lambda: hsi.Crowd(mass=[[70.0]], frequency=3, damping=0.3), ValueError,
     r"a crowd must be one row of bodies, got shape \(1, 1\); give arrays of shape \(n,\)"),
    (lambda: hsi.Crowd(mass=[70], frequency=3, damping=0.3, direction=["up"]), ValueError, "got 'up'; choose one of"),
    (lambda: hsi.Crowd.of([70.0]), TypeError, "bodies must be of type Body, got float; give a sequence of"),
    (lambda: crowd()[:2], TypeError, r"index must be a whole number, got slice\(None, 2.*; take several .* part"),
    (lambda: hsi.Population(frequency=(3, -1), damping=0.3), ValueError,
     r"frequency\[1\] must be at least 0, got -1; give a value, or \(mean, standard deviation\)"),
    (lambda: hsi.Population(frequency=(3, 1, 1), damping=0.3), ValueError,
     r"frequency must be a value or \(mean, standard deviation\), got shape \(3,\)"),
    (lambda: hsi.Population(frequency=3, damping=(30, 5)), ValueError, "damping must be below 1, got 30; give a fract"),
    (lambda: hsi.Population(frequency=0, damping=0.3), ValueError, "frequency must be above 0, got 0; give a value"),
    (lambda: hsi.Population.walking().sample(-1, rng), ValueError, "n must be at least 0, got -1; give the number of"),
    (lambda: hsi.Population.walking().sample(2.0, rng), TypeError, "n must be a whole number, got 2.0; give the numb"),
    (lambda: hsi.Population.walking().sample(2, 5), TypeError, "rng must be of type Generator, got int; give numpy.r"),
])
def test_refusals(make, error, message):
    with pytest.raises(error, match=message):
        make()


def test_crowds_add_up():
    people, others = (hsi.Crowd(mass=mass, frequency=3.0, damping=0.3, direction=direction)
                      for mass, direction in (([70.0, 80.0], "vertical"), ([90.0], "lateral")))
    assert list(people + others) == [*people, *others]
    with pytest.raises(TypeError, match="unsupported operand"):
        people + others[0]


def test_a_word_of_ports_is_as_good_as_a_list():
    people = hsi.Crowd(mass=[70.0, 80.0], frequency=3.25, damping=0.3)
    assert people.ss(ports="yva").input_labels == people.ss().input_labels

"""Root loci against the poles of `couple`, closed forms, and the host's own road."""

from dataclasses import replace

import control as ct
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from second_road import appendix_a, distance, sines

import hsictrl as hsi
from hsictrl.loop import locus as module
from hsictrl.loop import secular
from hsictrl.loop.branches import all_followed

BODY = hsi.Pedestrian()
SWEPT = {"mass": np.geomspace(5, 500, 7), "frequency": np.linspace(1, 6, 7), "damping": np.linspace(0, 0.95, 7),
         "sprung_ratio": np.linspace(0.1, 1, 7)}


def beam(n_modes=1, damping=0.005):
    return hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=damping,
                                           n_modes=n_modes)


def spread(n):
    return (np.arange(n) + 0.5) * 50 / n


def present(locus, k):
    poles = locus.poles[k]
    return poles[np.isfinite(poles)]


def drawn(n, seed=0):
    rng = np.random.default_rng(seed)
    return hsi.Population.walking().sample(n, rng), rng.uniform(0, 50, n)


# --- over the number of people ---------------------------------------------------------------------------


@pytest.mark.parametrize("n_modes", [1, 3])
def test_equal_walkers_have_the_poles_of_couple_at_each_integer(n_modes):
    x = np.random.default_rng(1).permutation(spread(60))
    locus = hsi.root_locus(beam(n_modes), BODY, x)
    for k in range(61):
        assert distance(present(locus, k), hsi.couple(beam(n_modes), BODY, x[:k]).poles()) < 1e-9


def test_225_equal_walkers_have_the_poles_of_couple():
    """The benchmark compares all 226."""
    locus = hsi.root_locus(beam(), BODY, spread(225))
    assert distance(present(locus, 225), hsi.couple(beam(), BODY, spread(225)).poles()) < 1e-9


def test_on_one_mode_equal_walkers_have_the_roots_of_a_quartic():
    """(s² + γs + ω² + s²μm₀/m)(s² + cs + k) + s²μ(m₁/m)(cs + k), written out by powers; the rest at 3.25 Hz, 30 %."""
    locus = hsi.root_locus(beam(), BODY, [25.0] * 100)
    (mode,), omega = beam().modes, 2 * np.pi * 3.25
    c, square = 2 * 0.3 * omega, omega**2
    for k in (1, 10, 100):
        unsprung, sprung = k * 3.5 / 25e3, k * 66.5 / 25e3
        quartic = np.polyadd(np.polymul([1 + unsprung, 2 * mode.damping * mode.omega, mode.omega**2], [1, c, square]),
                             [sprung * c, sprung * square, 0, 0])
        assert distance(locus.poles[k, :4], np.roots(quartic)) < 1e-9
        assert locus.frequency[k, 4:2 + 2 * k] == pytest.approx(np.full(2 * k - 2, 3.25), rel=1e-12)
        assert locus.damping[k, 4:2 + 2 * k] == pytest.approx(np.full(2 * k - 2, 0.30), rel=1e-12)
        assert np.all(np.isnan(locus.poles[k, 2 + 2 * k:]))


@pytest.mark.parametrize("n_modes", [1, 3])
def test_a_random_crowd_has_the_poles_of_appendix_a(n_modes):
    people, x = drawn(60)
    bridge = beam(n_modes)
    locus = hsi.root_locus(bridge, people, x)
    middle = sines(bridge, 25.0)
    for k in (0, 1, 2, 10, 30, 60):
        dense = appendix_a(bridge, list(people)[:k], sines(bridge, x[:k]), middle, middle)[0]
        assert distance(present(locus, k), np.linalg.eigvals(dense)) < 1e-9


CROWDS = {
    "equal bodies": {"frequency": np.full(12, 3.25)},
    "two kinds": {"frequency": np.tile([2.0, 3.25], 6)},
    "nearly equal": {"frequency": 3.25 + 1e-7 * np.arange(12)},
    "without damping": {"frequency": np.linspace(1, 6, 12), "damping": 0.0},
    "nearly critical": {"frequency": np.linspace(1, 6, 12), "damping": 0.99},
    "heavy": {"frequency": np.linspace(1, 6, 12), "mass": 5e3},
    "lateral": {"frequency": np.linspace(1, 6, 12), "direction": "lateral"},
    "all mass": {"frequency": np.linspace(1, 6, 12), "sprung_ratio": 1e-13},
}


@pytest.mark.parametrize("n_modes", [1, 2])
@pytest.mark.parametrize("crowd", CROWDS)
def test_crowds_of_all_kinds_have_the_poles_of_couple(crowd, n_modes):
    people = hsi.Crowd(**{"mass": 70.0, "damping": 0.3} | CROWDS[crowd])
    x = np.concatenate([[0.0, 1e-9, 50.0], spread(9)])        # on a support, and next to it
    locus = hsi.root_locus(beam(n_modes), people, x)
    for k in (1, 3, 7, 12):
        truth = hsi.couple(beam(n_modes), people.part(slice(k)), x[:k]).poles()
        assert distance(present(locus, k), truth) < 1e-9


@settings(deadline=None, max_examples=20)
@given(seed=st.integers(0, 10**6), n=st.integers(1, 25), n_modes=st.integers(1, 3), mass=st.floats(1, 300),
       damping=st.floats(0, 0.99))
def test_any_crowd_has_the_poles_of_couple(seed, n, n_modes, mass, damping):
    people, x = drawn(n, seed)
    people = replace(people, mass=mass, damping=damping)
    truth = hsi.couple(beam(n_modes), people, x).poles()
    assert distance(present(hsi.root_locus(beam(n_modes), people, x), n), truth) < 1e-9


@pytest.mark.parametrize("n_modes", [1, 3])
def test_the_iteration_settles_without_the_host(monkeypatch, n_modes):
    """In three rounds or so per newcomer, also where some of the bodies are alike."""
    people, x = drawn(40)
    kinds = np.array([2.0, 3.0, 4.0])[np.arange(40) % 3]
    monkeypatch.setattr(module, "couple", None)
    monkeypatch.setattr(secular, "ROUNDS", 8)
    for crowd in (people, replace(people, frequency=kinds, damping=0.3)):
        assert np.isfinite(hsi.root_locus(beam(n_modes), crowd, x).poles[-1]).all()


def test_a_pole_found_twice_is_noticed(monkeypatch):
    people, x = drawn(4)
    rows = beam().participation(x)
    equation = secular.Secular(beam(), people, rows)
    poles = hsi.couple(beam(), people, x).poles()
    assert equation.trace == pytest.approx(poles.sum().real, rel=1e-12)
    twice = np.append(poles[:-1], poles[0])
    monkeypatch.setattr(secular, "_zeros", lambda secular, guess: twice)
    assert secular.secular_poles(equation, poles) is None


def test_branches_are_found_again_when_their_order_is_lost():
    """Four points that pass each other in the plane, dealt out anew each time."""
    rng, t = np.random.default_rng(0), np.linspace(0, 1, 50)[:, None]
    branches = np.array([0, 1, 2j, 1 + 2j]) + t * np.array([1 + 0.5j, -1 - 0.5j, 1 - 1j, 0])
    found = all_followed(rng.permuted(branches, axis=1), branches[0])
    assert np.array_equal(found, branches)


def test_where_two_are_nearest_to_one_the_least_way_is_taken():
    assert all_followed(np.array([[1.2, 3.0 + 0j]]), np.array([0.0, 1.0 + 0j])).tolist() == [[1.2, 3.0]]
    assert all_followed(np.array([[3.0, 1.2 + 0j]]), np.array([0.0, 1.0 + 0j])).tolist() == [[1.2, 3.0]]


def test_where_the_iteration_does_not_settle_the_host_answers(monkeypatch):
    people, x = drawn(8)
    expected = hsi.root_locus(beam(), people, x).poles
    monkeypatch.setattr(module, "secular_poles", lambda secular, guess: None)
    found = hsi.root_locus(beam(), people, x)
    assert all(distance(present(found, k), expected[k][np.isfinite(expected[k])]) < 1e-9 for k in range(9))


@pytest.mark.parametrize("people", [BODY, drawn(60)[0]])
def test_branches_are_continuous(people):
    """A newcomer of 0.3 % of the modal mass moves no pole by more than a few per mille, and its own starts at home."""
    locus = hsi.root_locus(beam(), people, np.random.default_rng(0).permutation(spread(60)))
    assert np.nanmax(np.abs(np.diff(locus.poles, axis=0))) < 0.01 * 2 * np.pi * 3.25
    conjugates = locus.poles[:, 0::2] - locus.poles[:, 1::2].conj()
    assert np.nanmax(np.abs(conjugates)) < 1e-9


# --- over a parameter ------------------------------------------------------------------------------------


@pytest.mark.parametrize("parameter", SWEPT)
@pytest.mark.parametrize(("people", "n"), [("body", 15), ("body", 1), ("crowd", 15)])
def test_over_a_parameter_the_poles_are_those_of_couple(parameter, people, n):
    bridge, x = beam(2), spread(n)
    given = BODY if people == "body" else drawn(n)[0]
    locus = hsi.root_locus(bridge, given, x, parameter=parameter, values=SWEPT[parameter])
    for value, poles in zip(SWEPT[parameter], locus.poles, strict=True):
        truth = hsi.couple(bridge, replace(given, **{parameter: value}), x).poles()
        assert distance(poles, truth) < 1e-9


def test_one_column_is_one_branch():
    """The bridge's own branch begins and ends at the bridge's pole as the bodies grow ever lighter."""
    locus = hsi.root_locus(beam(), drawn(15)[0], spread(15), parameter="mass", values=[70.0, 30.0, 10.0, 1.0, 1e-6])
    assert abs(locus.poles[-1, 0] - beam().omega[0] * (-0.005 + 1j * np.sqrt(1 - 0.005**2))) < 1e-6
    assert np.all(np.diff(locus.frequency[:, 0]) > 0)


# --- the host's road ---------------------------------------------------------------------------------------


def test_the_hosts_locus_loses_the_poles_of_fifteen_bodies():
    """A root of multiplicity 14 scatters by some ε^(1/14) = 8 % where rounding moves the coefficients by ε."""
    occupied = hsi.couple(beam(), BODY, spread(15))
    gain = hsi.loop_gain(occupied)
    hosts = ct.root_locus_map(ct.ss(gain.A, gain.B, gain.C, gain.D), np.array([0.0, 1.0])).loci[1]
    error = distance(hosts, occupied.poles()) / (2 * np.pi * 3.25)
    assert 0.03 < error < 0.5
    ours = hsi.root_locus(beam(), BODY, spread(15)).poles[15]
    assert distance(ours, occupied.poles()) / (2 * np.pi * 3.25) < 1e-12


def test_the_host_draws_our_locus():
    locus = hsi.root_locus(beam(), BODY, spread(15))
    data = locus.to_map()
    assert np.array_equal(data.loci, locus.poles, equal_nan=True)
    assert distance(data.poles, hsi.couple(beam()).poles()) < 1e-12
    assert data.plot().axes.size == 1


# --- refusals ------------------------------------------------------------------------------------------------


def test_refusals():
    bridge, x = beam(), [20.0, 30.0]
    with pytest.raises(TypeError, match="bridge must be of type Footbridge"):
        hsi.root_locus("bridge", BODY, x)
    with pytest.raises(TypeError, match="people must be of type Crowd or Pedestrian, got list"):
        hsi.root_locus(bridge, [BODY], [20.0])
    with pytest.raises(ValueError, match="people and positions must be as many, got 3 bodies and 2 positions"):
        hsi.root_locus(bridge, drawn(3)[0], x)
    with pytest.raises(ValueError, match="positions must lie on the deck"):
        hsi.root_locus(bridge, BODY, [60.0])
    with pytest.raises(ValueError, match="parameter and values must be given together"):
        hsi.root_locus(bridge, BODY, x, parameter="mass")
    with pytest.raises(ValueError, match="parameter must be one of 'mass', 'frequency', 'damping', 'sprung_ratio'"):
        hsi.root_locus(bridge, BODY, x, parameter="height", values=[1.0])
    with pytest.raises(ValueError, match=r"damping\[1\] must lie in \[0, 1\), got 5"):
        hsi.root_locus(bridge, BODY, x, parameter="damping", values=[0.1, 5.0])
    with pytest.raises(ValueError, match="values must hold at least 1"):
        hsi.root_locus(bridge, BODY, x, parameter="damping", values=[])

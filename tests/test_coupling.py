"""The occupied bridge against dense (A.7)-(A.10), the host's feedback, published numbers and structural truths."""

import copy
import pickle

import control as ct
import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import signal
from scipy.linalg import block_diag
from second_road import appendix_a, dense, distance, sines

import hsictrl as hsi

mpl.use("Agg")
quick = settings(deadline=None, derandomize=True, max_examples=40)
omega = 2 * np.pi * np.geomspace(0.2, 30, 200)
bodies = st.builds(
    hsi.Pedestrian, mass=st.floats(20, 150), frequency=st.floats(0.5, 10), damping=st.floats(0.001, 0.99),
    sprung_ratio=st.floats(0.05, 1.0))
crowds = st.lists(st.tuples(bodies, st.floats(0, 50)), max_size=8)
dampings = st.lists(st.floats(0.001, 0.5), min_size=1, max_size=3)


def beam(n_modes=1, frequency=2.0, damping=0.005, mass=50e3):
    return hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=mass, frequency=frequency, damping=damping,
                                           n_modes=n_modes)


def crowd(n, seed=0):
    """Random bodies, no two alike, at random places."""
    rng = np.random.default_rng(seed)
    people = hsi.Crowd(mass=rng.uniform(50, 100, n), frequency=rng.uniform(2, 6, n), damping=rng.uniform(0.1, 0.5, n),
                       sprung_ratio=rng.uniform(0.8, 0.99, n))
    return people, rng.uniform(0, 50, n)


def spread(n):
    return (np.arange(n) + 0.5) * 50 / n


def response(system, omega=omega):
    """Frequency response by (14), solve by solve, whatever the class of the system does."""
    eye = np.eye(system.nstates)
    return np.stack([system.D + system.C @ np.linalg.solve(1j * w * eye - system.A, system.B) for w in omega], axis=-1)


def assert_same(system, other, tolerance=1e-11):
    """Poles, and responses relative to their peak."""
    ours, theirs = response(system), response(other)
    assert np.abs(ours - theirs).max() <= tolerance * np.abs(theirs).max()
    assert distance(np.linalg.eigvals(system.A), np.linalg.eigvals(other.A)) <= tolerance * np.abs(other.poles()).max()


# --- published numbers and numbers of the design ---------------------------------------------------


def test_poles_of_a_beam_with_rayleigh_damping():
    """Four published pole pairs of a 50 m beam with one 80 kg body at midspan (design, section 4)."""
    w = 2 * np.pi * np.array([2.0, 8.0, 18.0])
    alpha, beta = np.linalg.solve(np.array([1 / (2 * w[:2]), w[:2] / 2]).T, [0.005, 0.005])
    bridge = beam(n_modes=3, damping=alpha / (2 * w) + beta * w / 2, mass=50.0 * 500.0)
    occupied = hsi.couple(bridge, hsi.Pedestrian(mass=80.0, frequency=2.0, damping=0.3, sprung_ratio=1.0), [25.0])
    printed = np.array([-0.13091509 + 12.52344242j, -3.72545816 + 12.04548351j,
                        -0.25132741 + 50.26485413j, -1.09276615 + 113.09491717j])
    assert distance(ct.poles(occupied), np.concatenate([printed, printed.conj()])) < 1e-8


@pytest.mark.parametrize("places", [spread(15), np.random.default_rng(0).uniform(0, 50, 15)], ids=["even", "random"])
def test_only_one_combination_of_identical_bodies_couples(places):
    """N − 1 poles at exactly 3.25 Hz and 30 %; the bridge's own at 1.9707 Hz, 0.7296 % for even places."""
    poles = ct.poles(hsi.couple(beam(), hsi.Pedestrian(), places))
    own = 2 * np.pi * 3.25 * (-0.30 + 1j * np.sqrt(1 - 0.30**2))
    assert np.sum(np.abs(poles - own) < 1e-9 * abs(own)) == 14
    if places[0] == spread(15)[0]:
        bridge_pole = min(poles[poles.imag > 0], key=lambda p: -p.real)
        assert abs(bridge_pole) / (2 * np.pi) == pytest.approx(1.9707, abs=5e-5)
        assert -bridge_pole.real / abs(bridge_pole) == pytest.approx(0.007296, abs=5e-7)


# --- five roads to the same system ----------------------------------------------------------------


@pytest.mark.parametrize("n_modes", [1, 2, 4])
@pytest.mark.parametrize("n", [1, 7, 20])
def test_couple_is_appendix_a(n_modes, n):
    """Against dense (A.5)-(A.10), matrix by matrix and state by state."""
    bridge, (people, x) = beam(n_modes), crowd(n, seed=n)
    occupied, plain = hsi.couple(bridge, people, x), dense(bridge, people, x)
    for part in "ABCD":
        ours, theirs = getattr(occupied, part), getattr(plain, part)
        np.testing.assert_allclose(ours, theirs, atol=1e-13 * np.abs(theirs).max(), err_msg=part)
    assert_same(occupied, plain)


@pytest.mark.parametrize("n_modes", [1, 3])
def test_couple_is_the_hosts_feedback(n_modes):
    """Against `control.feedback` of the bridge's block and the bodies' appended blocks, unsprung masses and all."""
    bridge, (people, x) = beam(n_modes), crowd(6)
    occupied = hsi.couple(bridge, people, x, force_at=x, sense_at=x)
    plant = bridge.ss(at=x)
    for feedback in (ct.append(*(body.ss() for body in people)), people.ss()):
        loop = ct.feedback(plant, feedback, sign=+1)
        assert_same(occupied, ct.ss(loop.A, loop.B, loop.C[2::3], loop.D[2::3]))


def test_couple_is_the_hosts_feedback_at_the_level_of_modes():
    """Modal force to modal acceleration, the body weighed by φ = 1/√m_B on its way in and out."""
    bridge, body, phi = beam(), hsi.Pedestrian(), 1 / np.sqrt(25e3)
    loop = ct.feedback(bridge.modes[0].ss(), phi * body.ss() * (phi * np.eye(3)), sign=+1)
    assert_same(hsi.couple(bridge, body, [25.0]), ct.ss(loop.A, loop.B * phi, phi * loop.C[2:], phi**2 * loop.D[2:]))


@pytest.mark.parametrize("n_modes", [1, 3])
def test_couple_is_the_interconnection_of_blocks(n_modes):
    """Against `hsi.interconnect` by base names; the host's own refuses the loop (see test_interconnect)."""
    bridge, (people, x) = beam(n_modes), crowd(5)
    loop = hsi.interconnect(
        [bridge.ss(at=x), people.ss()],
        connections=[["crowd.y", "bridge.y"], ["crowd.v", "bridge.v"], ["crowd.a", "bridge.a"],
                     ["bridge.F", "crowd.F"]], inplist=["bridge.F"], outlist=["bridge.a"])
    assert_same(hsi.couple(bridge, people, x, force_at=x, sense_at=x), loop)


@pytest.mark.parametrize("n_modes", [1, 3])
@pytest.mark.parametrize("n", [0, 1, 6])
def test_interconnected_is_the_same_system_in_blocks(n_modes, n, capsys):
    bridge, (people, x) = beam(n_modes), crowd(n)
    occupied = hsi.couple(bridge, people, x, force_at=[10.0, 25.0], sense_at=[20.0], name="taken")
    blocks = occupied.interconnected()
    assert_same(blocks, occupied)
    assert isinstance(blocks, ct.LinearICSystem)
    assert [block.name for block in blocks.syslist] == [f"mode{j}" for j in range(n_modes)] + [
        f"walker{k}" for k in range(n)]
    assert (blocks.name, blocks.input_labels, blocks.output_labels) == ("taken", ["F[0]", "F[1]"], ["a[0]"])
    assert len(set(blocks.state_labels)) == 2 * (n_modes + n)
    blocks.connection_table()
    table = capsys.readouterr().out
    assert all(f"p[{k}]" in table for k in range(n))


# --- the fast frequency response ------------------------------------------------------------------


@pytest.mark.parametrize("n_modes", [1, 2, 4])
@pytest.mark.parametrize(("force_at", "sense_at"), [
    (None, None), ([10.0], [10.0, 31.0]), ([5.0, 20.0, 25.0], [33.0]), ([[5.0, 1.5], [40.0, 0.0]], [40.0, 5.0])])
def test_frequency_response_is_that_of_the_plain_matrices(n_modes, force_at, sense_at):
    """`ct.frequency_response` of the condensed system against that of a plain `ct.ss`."""
    bridge, (people, x) = beam(n_modes), crowd(9)
    occupied = hsi.couple(bridge, people, x, force_at=force_at, sense_at=sense_at)
    line = [None if at is None else np.reshape(at, (len(at), -1))[:, 0] for at in (force_at, sense_at)]
    fast = ct.frequency_response(occupied, omega).frdata
    slow = ct.frequency_response(dense(bridge, people, x, *line), omega).frdata
    assert fast.shape == slow.shape
    assert np.abs(fast - slow).max() <= 1e-10 * np.abs(slow).max()


def test_frequency_response_takes_the_fast_road(monkeypatch):
    """The host's own evaluation is not called at all."""
    occupied = hsi.couple(beam(2), *crowd(9))
    expected = response(occupied)
    monkeypatch.setattr(ct.StateSpace, "horner", lambda *a, **k: pytest.fail("the host's road was taken"))
    np.testing.assert_allclose(ct.frequency_response(occupied, omega).frdata, expected, rtol=1e-9)


@pytest.mark.parametrize("s", [0.0, 1.0, -0.5 + 3j, 2j * np.pi * 2.0, 100 + 1j, 1e6j])
def test_transfer_function_anywhere(s):
    bridge, (people, x) = beam(2), crowd(4)
    plain = dense(bridge, people, x)
    assert hsi.couple(bridge, people, x)(s) == pytest.approx(plain(s), rel=1e-10, abs=1e-18)


def test_a_constant_force_accelerates_nothing():
    assert hsi.couple(beam(2), *crowd(4))(0) == 0
    assert ct.dcgain(hsi.couple(beam(2), *crowd(4))) == pytest.approx(0, abs=1e-18)


def test_at_a_pole_the_host_answers():
    """A pole of an undamped bridge: infinite, with the host's warning."""
    bridge = beam(damping=0.0)
    occupied, plain = hsi.couple(bridge), dense(bridge, [], [])
    pole = 2j * np.pi * 2.0
    with pytest.warns(RuntimeWarning, match="singular matrix"):
        expected = plain(pole)
    with pytest.warns(RuntimeWarning, match="singular matrix"):
        assert np.isinf(occupied(pole)) == np.isinf(expected) == True  # noqa: E712
    assert np.isfinite(occupied(1j * np.array([1.0, 2.0]))).all()


@pytest.mark.parametrize("n_modes", [1, 2, 3])
@pytest.mark.parametrize("beside", [0.0, 1e-15, 1e-12, 1e-8, -1e-6])
def test_at_and_beside_the_frequency_of_an_undamped_body(n_modes, beside):
    """Its apparent mass has a pole there; the bridge has none, and stands still under it."""
    bridge, body = beam(n_modes), hsi.Pedestrian(frequency=2.0, damping=0.0)
    s = 2j * np.pi * 2.0 * (1 + beside) * np.ones(1)
    occupied, plain = hsi.couple(bridge, body, [20.0]), dense(bridge, [body], [20.0])
    scale = abs(plain(2.2j * np.pi))
    assert abs(occupied(s) - response(plain, s.imag)[0, 0])[0] <= 1e-10 * scale
    if n_modes == 1:
        assert abs(occupied(2j * np.pi * 2.0)) < 1e-12 * scale


@pytest.mark.parametrize("shape", [(2, 2), (1, 3)])
def test_points_of_evaluation_are_a_row(shape):
    with pytest.raises(ValueError, match=r"must be one number or one row, got shape .*; ravel it"):
        hsi.couple(beam()).horner(np.ones(shape))


# --- structural truths ----------------------------------------------------------------------------


@pytest.mark.parametrize("n_modes", [1, 3])
@pytest.mark.parametrize("nobody", [(), [], hsi.Crowd.of([]), hsi.Pedestrian()], ids=["tuple", "list", "crowd", "body"])
def test_nobody_leaves_the_empty_bridge(n_modes, nobody):
    bridge = beam(n_modes)
    empty = hsi.couple(bridge, nobody, [])
    plant = bridge.ss(at=[25.0])["a[0]", "F[0]"]
    assert_same(empty, plant)
    np.testing.assert_allclose(empty(1j * omega), response(plant)[0, 0], rtol=1e-10)


@quick
@given(body=bodies, x=st.floats(1, 49), n=st.integers(2, 9), n_modes=st.integers(1, 3))
def test_equal_bodies_at_one_place_are_one_heavy_body(body, x, n, n_modes):
    heavy = hsi.Pedestrian(mass=n * body.mass, frequency=body.frequency, damping=body.damping,
                           sprung_ratio=body.sprung_ratio)
    many, one = hsi.couple(beam(n_modes), body, [x] * n), hsi.couple(beam(n_modes), heavy, [x])
    expected = response(one)
    assert np.abs(many(1j * omega) - expected).max() <= 1e-10 * np.abs(expected).max()


@quick
@given(crowd=crowds)
def test_apparent_mass_of_a_crowd_at_both_ends(crowd):
    """The whole mass at 0 Hz, the unsprung mass at infinity, each weighed by φ² = sin²(πx/L)/m_B."""
    people, x = [body for body, _ in crowd], np.array([x for _, x in crowd])
    condensed = hsi.couple(beam(), people, x).condensed
    share = np.sin(np.pi * x / 50)**2 / 25e3
    for s, masses in ((0, [body.mass for body in people]), (1e9j, [body.unsprung_mass for body in people])):
        assert condensed.apparent_mass(s)[0, 0, 0] == pytest.approx(share @ np.array(masses), rel=1e-6, abs=1e-9)


def test_apparent_mass_of_a_crowd_adds_up():
    """Σ φφᵀα(s) over the single bodies' closed form; its slope by central differences."""
    people, x = crowd(6)
    condensed, rows = hsi.couple(beam(3), people, x).condensed, sines(beam(3), x)
    s, h = -0.3 + 11j, 1e-4

    def total(s):
        return sum(np.outer(row, row) * body.apparent_mass(s) for body, row in zip(people, rows, strict=True))

    np.testing.assert_allclose(condensed.apparent_mass(s)[0], total(s), rtol=1e-12)
    np.testing.assert_allclose(condensed.apparent_mass_slope(s), (total(s + h) - total(s - h)) / (2 * h), rtol=1e-6)


@quick
@given(crowd=crowds, dampings=dampings, frequency=st.floats(0.5, 8))
def test_no_crowd_ever_adds_energy(crowd, dampings, frequency):
    """Passivity: the mobility between any set of points has a non-negative Hermitian part on the whole axis."""
    bridge = beam(len(dampings), frequency, dampings)
    points = [7.0, 25.0, 41.0]
    occupied = hsi.couple(bridge, [body for body, _ in crowd], [x for _, x in crowd], force_at=points, sense_at=points)
    mobility = np.moveaxis(ct.frequency_response(occupied, omega).frdata / (1j * omega), -1, 0)
    power = np.linalg.eigvalsh((mobility + mobility.conj().swapaxes(1, 2)) / 2)
    assert np.all(power[:, 0] >= -1e-12 * np.abs(mobility).max(axis=(1, 2)))


@quick
@given(crowd=crowds, dampings=dampings, frequency=st.floats(0.5, 8))
def test_every_pole_is_stable(crowd, dampings, frequency):
    bridge = beam(len(dampings), frequency, dampings)
    poles = ct.poles(hsi.couple(bridge, [body for body, _ in crowd], [x for _, x in crowd]))
    assert poles.real.max() < 0


def test_without_damping_energy_is_kept():
    """All poles on the axis: an undamped crowd on an undamped bridge neither takes nor gives."""
    people, x = crowd(6)
    undamped = hsi.Crowd(mass=people.mass, frequency=people.frequency, damping=0.0)
    poles = ct.poles(hsi.couple(beam(3, damping=0.0), undamped, x))
    assert np.abs(poles.real).max() < 1e-10 * np.abs(poles).max()


def test_a_lateral_body_does_not_feel_a_vertical_mode():
    """Its own poles stay, and so do the bridge's; with one of each, only the vertical one is felt."""
    lateral, vertical = hsi.Pedestrian(direction="lateral"), hsi.Pedestrian(mass=90.0)
    for people, x, felt in (([lateral], [25.0], []), ([lateral, vertical], [25.0, 20.0], [vertical])):
        expected = response(dense(beam(), felt, [20.0] * len(felt)))[0, 0]
        np.testing.assert_allclose(hsi.couple(beam(), people, x)(1j * omega), expected, rtol=1e-9)
    own = 2 * np.pi * 3.25 * (-0.30 + 1j * np.sqrt(1 - 0.30**2))
    assert np.abs(ct.poles(hsi.couple(beam(), lateral, [25.0])) - own).min() < 1e-12 * abs(own)


def test_a_lateral_body_feels_a_lateral_mode():
    """A bridge that moves sideways under lateral bodies is the same mathematics as one that moves up and down."""
    mode = {"frequency": 0.8, "damping": 0.01, "modal_mass": 25e3}
    vertical = hsi.Mode(shape=hsi.SineShape(50.0), **mode | {"frequency": 2.0})
    lateral = hsi.Mode(shape=hsi.SineShape(50.0, direction="lateral"), **mode)
    bridge = hsi.Footbridge(modes=[vertical, lateral], length=50.0, width=3.0, mass=50e3)
    people = [hsi.Pedestrian(frequency=0.75, direction="lateral"), hsi.Pedestrian()]
    phi = np.sin(np.pi * np.array([20.0, 30.0]) / 50) / np.sqrt(25e3)
    rows, axis = np.array([[0, phi[0]], [phi[1], 0]]), np.eye(2) / np.sqrt(25e3)
    plain = ct.ss(*appendix_a(bridge, people, rows, axis[:1], axis[:1]))
    assert_same(hsi.couple(bridge, people, [20.0, 30.0]), plain)


# --- a citizen of the host ------------------------------------------------------------------------


@pytest.fixture
def occupied():
    return hsi.couple(beam(2), *crowd(5), force_at=[20.0, 25.0], sense_at=[25.0, 30.0], name="deck")


@pytest.fixture
def siso():
    return hsi.couple(beam(2), *crowd(5))


def test_names_of_all_signals_and_states(occupied):
    assert occupied.name == "deck"
    assert occupied.input_labels == ["F[0]", "F[1]"]
    assert occupied.output_labels == ["a[0]", "a[1]"]
    assert occupied.state_labels == (["z[0]", "z[1]"] + [f"u[{k}]" for k in range(5)]
                                     + ["dz[0]", "dz[1]"] + [f"du[{k}]" for k in range(5)])
    assert len(set(occupied.state_labels)) == occupied.nstates == 14


def test_states_are_those_of_equation_a_7(occupied):
    """The derivative of z is dz, of u du; the deck's acceleration reads z and dz through Φ."""
    index = occupied.find_state
    for base, n in (("z", 2), ("u", 5)):
        for i in range(n):
            row = np.zeros(14)
            row[index(f"d{base}[{i}]")] = 1
            np.testing.assert_array_equal(occupied.A[index(f"{base}[{i}]")], row)


@pytest.mark.parametrize("way", [
    lambda system: pickle.loads(pickle.dumps(system)), copy.copy, copy.deepcopy,
    lambda system: system.copy(name="deck")],
    ids=["pickle", "copy.copy", "copy.deepcopy", "copy()"])
def test_a_copy_is_whole_and_its_own(occupied, way):
    occupied.update_names(inputs=["p", "q"], states=[f"state{i}" for i in range(14)])
    before, twin = occupied.A.copy(), way(occupied)
    assert type(twin) is hsi.OccupiedBridge
    for labels in ("name", "input_labels", "output_labels", "state_labels"):
        assert getattr(twin, labels) == getattr(occupied, labels)
    for part in "ABCD":
        np.testing.assert_array_equal(getattr(twin, part), getattr(occupied, part))
    np.testing.assert_array_equal(twin.horner(1j), occupied.horner(1j))
    with pytest.raises(ValueError, match="read-only"):    # the condensed response would not follow
        twin.A[:] = 0
    twin.A = np.zeros_like(before)
    np.testing.assert_array_equal(occupied.A, before)
    # the host keeps the right-hand side apart from A
    assert np.any(occupied.dynamics(0, np.ones(14), np.ones(2)))


def test_copy_takes_a_new_name(occupied):
    assert (occupied.copy(name="twin").name, occupied.name) == ("twin", "deck")


def test_prints_well(occupied):
    text = str(occupied)
    assert "<OccupiedBridge> deck: 5 bodies" in text
    assert "mode 1: 8.000 Hz" in text
    assert "States (14): ['z[0]', 'z[1]', 'u[0]', 'u[1]', …, 'du[3]', 'du[4]']" in text
    assert max(map(len, text.splitlines())) < 100
    assert repr(occupied) == "<OccupiedBridge deck: ['F[0]', 'F[1]'] -> ['a[0]', 'a[1]'], 14 states>"


def test_bode_plot_draws_the_response(siso):
    plot = ct.bode_plot(siso, omega)
    x, y = plot.lines[0, 0][0].get_data()
    expected = response(dense(beam(2), *crowd(5)))[0, 0]
    np.testing.assert_allclose(x, omega)
    np.testing.assert_allclose(y, np.abs(expected), rtol=1e-9)


def test_nyquist_plot_draws_the_response(siso):
    assert ct.nyquist_plot(siso, omega).axes.size == 1
    curve = ct.nyquist_response(siso, omega)
    plain = dense(beam(2), *crowd(5))
    expected = [(plain.D + plain.C @ np.linalg.solve(s * np.eye(14) - plain.A, plain.B))[0, 0] for s in curve.contour]
    np.testing.assert_allclose(curve.response, expected, rtol=1e-9)
    assert curve.count == 0


def test_singular_values_are_those_of_the_plain_system(occupied):
    plain = dense(beam(2), *crowd(5), [20.0, 25.0], [25.0, 30.0])
    ours = ct.singular_values_response(occupied, omega).frdata[:, 0]
    theirs = np.linalg.svd(np.moveaxis(response(plain), -1, 0), compute_uv=False).T
    np.testing.assert_allclose(ours, theirs, rtol=1e-7, atol=1e-9 * theirs.max())


def test_forced_response_is_scipys(siso):
    """Against scipy.signal.lsim of the dense matrices, linear between samples as the host's is."""
    t = np.linspace(0, 4, 801)
    force = 700 * np.sin(2 * np.pi * 1.9 * t)
    plain = dense(beam(2), *crowd(5))
    _, expected, _ = signal.lsim((plain.A, plain.B, plain.C, plain.D), force, t)
    result = ct.forced_response(siso, t, force)
    np.testing.assert_allclose(result.outputs, expected, atol=1e-10 * np.abs(expected).max())
    assert (result.input_labels, result.output_labels, result.state_labels) == (
        siso.input_labels, siso.output_labels, siso.state_labels)


def test_sampling_maps_poles_exponentially(siso):
    sampled = ct.sample_system(siso, 0.01)
    assert distance(ct.poles(sampled), np.exp(0.01 * ct.poles(dense(beam(2), *crowd(5))))) < 1e-10
    assert (sampled.input_labels, sampled.output_labels, sampled.state_labels) == (
        siso.input_labels, siso.output_labels, siso.state_labels)


def test_feedback_and_indexing_give_plain_systems(occupied, siso):
    """1/(1 + kH) of the plain response, with k a damper on the acceleration's integral left out: a gain."""
    loop = ct.feedback(siso, 50.0)
    h = response(dense(beam(2), *crowd(5)))[0, 0]
    np.testing.assert_allclose(response(loop)[0, 0], h / (1 + 50 * h), rtol=1e-9)
    part = occupied["a[1]", "F[0]"]
    assert (part.input_labels, part.output_labels) == (["F[0]"], ["a[1]"])
    np.testing.assert_allclose(response(part)[0, 0], response(occupied)[1, 0], rtol=1e-12)
    assert type(loop) is type(part) is type(siso * 2) is ct.StateSpace


def test_response_to_modal_forces(occupied):
    """Σ over force points of Φᵀp must give what the force points give."""
    forces = np.random.default_rng(0).normal(size=(2, len(omega)))
    modal = sines(beam(2), [20.0, 25.0]).T @ forces
    expected = np.einsum("oiw,iw->ow", response(occupied), forces)
    np.testing.assert_allclose(occupied.respond(1j * omega, modal), expected, atol=1e-12 * np.abs(expected).max())


def test_dynamic_stiffness_is_the_schur_complement(siso):
    """Static condensation of the dense s²M + sC + K of (A.9), (A.10) onto the modes."""
    bridge, (people, x), s = beam(2), crowd(5), -0.2 + 13j
    rows = sines(bridge, x)
    M_H, K_H = np.diag(people.sprung_mass), np.diag(people.stiffness)
    C_H, M_H0 = np.diag(people.damping_coefficient), np.diag(people.unsprung_mass)
    w = 2 * np.pi * np.array([2.0, 8.0])
    modes = s**2 * (np.eye(2) + rows.T @ M_H0 @ rows) + s * np.diag(0.01 * w) + np.diag(w**2)
    spring = s * C_H + K_H
    whole = np.block([[modes + rows.T @ spring @ rows, -rows.T @ spring], [-spring @ rows, s**2 * M_H + spring]])
    schur = whole[:2, :2] - whole[:2, 2:] @ np.linalg.solve(whole[2:, 2:], whole[2:, :2])
    np.testing.assert_allclose(siso.dynamic_stiffness(s)[0], schur, rtol=1e-10, atol=1e-9)


def test_block_diagonal_bodies_travel_in_the_systems_order():
    """Bodies' part of A: each reads its own u and du only."""
    people, x = crowd(4)
    A = hsi.couple(beam(), people, x).A
    np.testing.assert_allclose(A[6:, 1:5], -block_diag(*people.omega**2), rtol=1e-14)


# --- refusals: the rule, the value, the remedy ----------------------------------------------------


@pytest.mark.parametrize(("make", "error", "message"), [
    (lambda: hsi.couple("bridge"), TypeError, "bridge must be of type Footbridge or MeasuredBridge, got str; describe"),
    (lambda: hsi.couple(beam(), hsi.Pedestrian(), [60.0]), ValueError,
     r"positions must lie on the deck, 0 ≤ x ≤ 50 .*, got positions\[0\] = \(60, 0\); move it, or leave it out"),
    (lambda: hsi.couple(beam(), hsi.Pedestrian(), [[25.0, -2.0]]), ValueError, r"got positions\[0\] = \(25, -2\); mov"),
    (lambda: hsi.couple(beam(), hsi.Pedestrian(), [np.nan]), ValueError, r"positions\[0\] must be finite, got nan; g"),
    (lambda: hsi.couple(beam(), hsi.Pedestrian(), ["mid"]), TypeError, "positions must be real numbers, got .*; give"),
    (lambda: hsi.couple(beam(), force_at=[-1.0]), ValueError,
     r"force_at must lie on the deck.*force_at\[0\] = \(-1, 0"),
    (lambda: hsi.couple(beam(), sense_at=[51.0]), ValueError,
     r"sense_at must lie on the deck.*sense_at\[0\] = \(51, 0"),
    (lambda: hsi.couple(beam(), force_at=[]), ValueError, "force_at must hold at least 1 place.s., got 0; give x"),
    (lambda: hsi.couple(beam(), sense_at=[]), ValueError, "sense_at must hold at least 1 place.s., got 0; give x"),
    (lambda: hsi.couple(beam(), [hsi.Pedestrian()] * 2, [20.0]), ValueError,
     "people and positions must be as many, got 2 bodies and 1 positions; give one position per body"),
    (lambda: hsi.couple(beam(), hsi.Crowd.of([]), [20.0]), ValueError, "got 0 bodies and 1 positions; give one posit"),
    (lambda: hsi.couple(beam(), 75, [20.0]), TypeError, "people must be .*, got int; give a Crowd, a Pedestrian or a"),
    (lambda: hsi.couple(beam(), [70.0], [20.0]), TypeError, "bodies must be of type Body, got float; give a sequence"),
])
def test_refusals(make, error, message):
    with pytest.raises(error, match=message):
        make()

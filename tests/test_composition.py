"""Occupied bridges in company: controllers, inerters, nonlinear bodies, sampled time, and the host's plots."""

from __future__ import annotations

import copy
import pickle

import control as ct
import matplotlib as mpl
import numpy as np
import pytest
from scipy import signal
from scipy.integrate import solve_ivp
from second_road import appendix_a, dense, distance, peaks, sines

import hsictrl as hsi

mpl.use("Agg")
BRIDGE = hsi.reference_bridge(frequency=2.0)
PEOPLE = hsi.Crowd(mass=[60.0, 75.0, 90.0], frequency=[2.9, 3.2, 3.6], damping=[0.25, 0.3, 0.35])
PLACES = np.array([12.0, 20.0, 33.0])
DAMPER = hsi.Absorber(mass=250.0, frequency=1.95, damping=0.1)
OMEGA = 2 * np.pi * np.linspace(0.5, 6.0, 301)


def crowd(n: int) -> tuple[hsi.Crowd, np.ndarray]:
    return hsi.Population.walking().sample(n, np.random.default_rng(1)), (np.arange(n) + 0.5) * 50 / max(n, 1)


def response(system: ct.StateSpace) -> np.ndarray:
    """C(iω − A)⁻¹B + D, solve by solve."""
    eye = np.eye(system.nstates)
    return np.stack([system.D + system.C @ np.linalg.solve(1j * w * eye - system.A, system.B) for w in OMEGA], axis=-1)


# --- an active mass damper ------------------------------------------------------------------------


def active_damper() -> ct.StateSpace:
    """A sprung mass on the deck, and an actuator between the two: force u on the mass, −u on the deck."""
    passive, m = DAMPER.ss(ports=("y", "v")), DAMPER.sprung_mass
    return ct.ss(passive.A, np.hstack([passive.B, [[0], [1 / m]]]), passive.C, np.hstack([passive.D, [[-1.0]]]),
                 inputs=["y", "v", "u"], outputs=["F"], states=["s", "ds"], name="damper")


def open_loop() -> ct.StateSpace:
    """Bridge, people and damper, from the actuator and a force at midspan to the acceleration there and all states."""
    plant, damper = BRIDGE.ss(at=[*PLACES, 25.0]), active_damper()
    motion = [[f"crowd.{port}[{k}]", f"bridge.{port}[{k}]"] for k in range(3) for port in "yva"]
    force = [[f"bridge.F[{k}]", f"crowd.F[{k}]"] for k in range(3)]
    joined = hsi.interconnect(
        [plant, PEOPLE.ss(), damper],
        connections=[*motion, *force, ["bridge.F[3]", "damper.F"], ["damper.y", "bridge.y[3]"],
                     ["damper.v", "bridge.v[3]"]],
        inplist=["damper.u", "bridge.F[3]"], inputs=["u", "F"], outlist=["bridge.a[3]"], outputs=["a"],
        name="open")
    labels = joined.state_labels
    return ct.ss(joined.A, joined.B, np.vstack([joined.C, np.eye(len(labels))]),
                 np.vstack([joined.D, np.zeros((len(labels), 2))]), inputs=["u", "F"], outputs=["a", *labels],
                 states=labels, name="open")


def by_hand() -> tuple[np.ndarray, np.ndarray]:
    """A of Appendix A with the damper as one more body, and B of the actuator: −φ/M on the mode, 1/m on the mass."""
    bodies, x = [*PEOPLE, DAMPER], np.append(PLACES, 25.0)
    rows = sines(BRIDGE, x)
    A, push, _, _ = appendix_a(BRIDGE, bodies, rows, rows[3:], rows[3:])
    B = -push
    B[-1] += 1 / DAMPER.sprung_mass
    return A, B


def gains(design: str) -> tuple[ct.StateSpace, np.ndarray]:
    """State feedback by the host's design functions, for the states in the order of the interconnection."""
    plant = open_loop()
    B = plant.B[:, :1]
    if design == "lqr":
        motion = plant.C[:1]     # weigh the deck's acceleration against the actuator's force
        return plant, np.asarray(ct.lqr(plant.A, B, 1e8 * (motion.T @ motion) + 1e-6 * np.eye(10), [[1.0]])[0])
    wanted = np.linalg.eigvals(plant.A)
    slow = np.argsort(-wanted.real)[:2]
    wanted[slow] = 2 * np.pi * 2.0 * np.array([-0.05 + 0.9987j, -0.05 - 0.9987j])
    return plant, np.asarray(ct.place(plant.A, B, wanted))


@pytest.mark.parametrize("design", ["lqr", "place"])
def test_poles_with_an_active_damper_are_those_of_a_less_bk(design: str) -> None:
    """By `hsi.interconnect` and by `ct.feedback`, against A − BK of matrices written by hand, and the poles placed."""
    plant, K = gains(design)
    labels = plant.state_labels
    controller = ct.ss([], [], [], -K, inputs=labels, outputs=["u"], name="controller")
    joined = hsi.interconnect([plant, controller], inplist=["open.F"], outlist=["open.a"], inputs=["F"],
                              outputs=["a"], check_unused=False)
    states = plant[labels, "u"]
    fed = ct.feedback(states, controller, sign=+1)
    order = [labels.index(name) for name in (
        ["bridge_z[0]"] + [f"crowd_u[{k}]" for k in range(3)] + ["damper_s"]
        + ["bridge_dz[0]"] + [f"crowd_du[{k}]" for k in range(3)] + ["damper_ds"])]
    A, B = by_hand()
    expected = np.linalg.eigvals(A - B @ K[:, order])
    for closed in (joined, fed):
        assert distance(ct.poles(closed), expected) < 1e-9 * np.abs(expected).max()
    assert expected.real.max() < np.linalg.eigvals(A).real.max()      # it damps
    assert (joined.input_labels, joined.output_labels) == (["F"], ["a"])


def test_placed_poles_are_where_they_were_asked_for() -> None:
    plant, K = gains("place")
    closed = np.linalg.eigvals(plant.A - plant.B[:, :1] @ K)
    asked = 2 * np.pi * 2.0 * (-0.05 + 0.9987j)
    assert np.abs(closed - asked).min() < 1e-6 * abs(asked)


def test_a_damper_without_a_signal_is_one_more_body() -> None:
    """The actuator at rest: `couple` with the damper among the people."""
    occupied = hsi.couple(BRIDGE, [*PEOPLE, DAMPER], [*PLACES, 25.0])
    plant = open_loop()["a", "F"]
    ours, theirs = response(plant)[0, 0], occupied(1j * OMEGA)
    assert np.abs(ours - theirs).max() < 1e-11 * np.abs(theirs).max()


# --- an inerter -----------------------------------------------------------------------------------


def inerter(b: float) -> ct.StateSpace:
    return ct.ss([], [], [], [[-b]], inputs=["a"], outputs=["F"], name="inerter")


@pytest.mark.parametrize("x", [25.0, 10.0])
@pytest.mark.parametrize("way", ["interconnect", "feedback"])
def test_an_inerter_to_the_ground_adds_modal_mass(x: float, way: str) -> None:
    """Force −b a on the deck: m + bφ² at the same spring and dashpot, f and ξ fall by √(m/(m + bφ²))."""
    b, m, share = 2000.0, 25e3, np.sin(np.pi * x / 50)**2
    plant = BRIDGE.ss(at=[x])
    if way == "interconnect":
        closed = hsi.interconnect(
            [plant, inerter(b)], connections=[["bridge.F", "inerter.F"], ["inerter.a", "bridge.a"]],
            inplist=["bridge.F"], outlist=["bridge.a"], ignore_outputs=["y[0]", "v[0]"])
    else:
        closed = ct.feedback(plant["a[0]", "F[0]"], -inerter(b))
    heavy, omega, gamma = m + b * share, 4 * np.pi, 2 * 0.005 * 4 * np.pi
    s = 1j * OMEGA
    expected = share * s**2 / (heavy * s**2 + m * (gamma * s + omega**2))
    np.testing.assert_allclose(response(closed)[0, 0], expected, rtol=1e-10)


def test_the_host_refuses_an_inerter_on_an_accelerance() -> None:
    with pytest.raises(RuntimeError, match="algebraic loop"):
        ct.interconnect([BRIDGE.ss(at=[25.0]), inerter(2000.0)], inplist=["bridge.F"], outlist=["bridge.a"],
                        connections=[["bridge.F", "inerter.F"], ["inerter.a", "bridge.a"]],
                        ignore_outputs=["y[0]", "v[0]"])


# --- a nonlinear body -----------------------------------------------------------------------------


def hardening(cubic: float, body: hsi.Absorber = DAMPER) -> ct.NonlinearIOSystem:
    """A sprung mass on k q + k₃ q³, where q is how far the deck is ahead of it."""
    m, c, k = body.sprung_mass, body.damping_coefficient, body.stiffness

    def pull(x: np.ndarray, u: np.ndarray) -> float:
        q, dq = u[0] - x[0], u[1] - x[1]
        return k * q + cubic * q**3 + c * dq

    return ct.nlsys(lambda t, x, u, params: [x[1], pull(x, u) / m], lambda t, x, u, params: [-pull(x, u)],
                    inputs=["y", "v"], outputs=["F"], states=["u", "du"], name="body")


def nonlinear_loop(cubic: float, plant: ct.StateSpace | None = None) -> ct.InterconnectedSystem:
    plant = BRIDGE.ss(at=[25.0]) if plant is None else plant
    return hsi.interconnect(
        [plant, hardening(cubic)],
        connections=[["bridge.F[0]", "body.F"], ["body.y", "bridge.y[0]"], ["body.v", "bridge.v[0]"]],
        inplist=["bridge.F[0]"], outlist=["bridge.a[0]"], inputs=["F"], outputs=["a"], name="loop")


TIMES = np.linspace(0.0, 6.0, 601)
FORCE = 300.0 * np.sin(2 * np.pi * 1.9 * TIMES)
TIGHT = {"rtol": 1e-9, "atol": 1e-12, "max_step": 0.01}


def solved(system: ct.InterconnectedSystem) -> np.ndarray:
    return np.asarray(ct.input_output_response(system, TIMES, FORCE, solve_ivp_kwargs=TIGHT).outputs)


def test_a_nonlinear_body_in_its_linear_limit_is_coupled() -> None:
    loop, coupled = nonlinear_loop(0.0), hsi.couple(BRIDGE, DAMPER, [25.0])
    expected = ct.forced_response(coupled, TIMES, FORCE).outputs
    np.testing.assert_allclose(solved(loop), expected, atol=1e-6 * np.abs(expected).max())
    linear = ct.linearize(nonlinear_loop(2e9), np.zeros(4), [0.0])       # at rest a cubic spring has no stiffness
    assert distance(ct.poles(linear), ct.poles(coupled)) < 1e-4


def test_a_cubic_spring_is_what_its_equations_say() -> None:
    """Against bridge and body written out and solved by scipy; the spring stiffens by more than a half."""
    cubic, m, w, phi = 2e9, DAMPER.sprung_mass, 4 * np.pi, 1 / np.sqrt(25e3)

    def rates(t: float, x: np.ndarray) -> list[float]:
        q, dq = phi * x[0] - x[2], phi * x[1] - x[3]
        pull = DAMPER.stiffness * q + cubic * q**3 + DAMPER.damping_coefficient * dq
        drive = np.interp(t, TIMES, FORCE) - pull
        return [x[1], phi * drive - 0.01 * w * x[1] - w**2 * x[0], x[3], pull / m]

    found = solve_ivp(rates, (0.0, 6.0), np.zeros(4), t_eval=TIMES, **TIGHT)
    expected = phi * np.array([rates(t, x)[1] for t, x in zip(TIMES, found.y.T, strict=True)])
    stretch = np.abs(phi * found.y[0] - found.y[2]).max()
    assert cubic * stretch**2 > 0.5 * DAMPER.stiffness
    np.testing.assert_allclose(solved(nonlinear_loop(cubic)), expected, atol=1e-6 * np.abs(expected).max())


def test_unsprung_mass_beside_a_nonlinear_body() -> None:
    """The linear part of a body closes the algebraic loop first; then nothing nonlinear lies on it."""
    plant = BRIDGE.ss(at=[25.0])
    loaded = hsi.interconnect(
        [plant, inerter(12.0)], connections=[["bridge.F", "inerter.F"], ["inerter.a", "bridge.a"]],
        inplist=["bridge.F"], inputs=["F[0]"], outlist=["bridge.y", "bridge.v", "bridge.a"],
        outputs=["y[0]", "v[0]", "a[0]"], name="bridge")
    whole = hsi.Pedestrian(mass=DAMPER.mass + 12.0, frequency=DAMPER.frequency, damping=DAMPER.damping,
                           sprung_ratio=DAMPER.mass / (DAMPER.mass + 12.0))
    expected = ct.forced_response(hsi.couple(BRIDGE, whole, [25.0]), TIMES, FORCE).outputs
    np.testing.assert_allclose(solved(nonlinear_loop(0.0, loaded)), expected, atol=1e-6 * np.abs(expected).max())


# --- discrete time --------------------------------------------------------------------------------


@pytest.mark.parametrize(("method", "interpolated"), [("zoh", False), ("foh", True)])
def test_sampled_at_the_instants_it_is_the_continuous_system(method: str, interpolated: bool) -> None:
    """Under steps between samples, and under ramps, which is what `ct.forced_response` takes; against scipy's lsim."""
    step, occupied = 0.02, hsi.couple(BRIDGE, PEOPLE, PLACES)
    times = step * np.arange(300)
    force = np.append(0.0, np.random.default_rng(0).normal(size=299))    # ramps begin at rest
    plain = dense(BRIDGE, PEOPLE, PLACES)
    expected = signal.lsim((plain.A, plain.B, plain.C, plain.D), force, times, interp=interpolated)[1]
    sampled = ct.sample_system(occupied, step, method=method)
    assert sampled.dt == step
    found = ct.forced_response(sampled, times, force).outputs
    np.testing.assert_allclose(found, expected, atol=1e-10 * np.abs(expected).max())


def test_tustins_rule_warps_frequencies() -> None:
    """Its response at ω is the continuous one at (2/h) tan(ωh/2), and with prewarping exact at one frequency."""
    step, occupied = 0.05, hsi.couple(BRIDGE, PEOPLE, PLACES)
    warped = 2 / step * np.tan(OMEGA * step / 2)
    sampled = ct.sample_system(occupied, step, method="bilinear")
    expected = dense(BRIDGE, PEOPLE, PLACES)(1j * warped)
    np.testing.assert_allclose(sampled(np.exp(1j * OMEGA * step)), expected, rtol=1e-8)
    at = 4 * np.pi
    prewarped = ct.sample_system(occupied, step, method="bilinear", prewarp_frequency=at)
    assert prewarped(np.exp(1j * at * step)) == pytest.approx(dense(BRIDGE, PEOPLE, PLACES)(1j * at), rel=1e-9)


def test_a_sampled_controller_closes_around_a_sampled_bridge() -> None:
    """Acceleration feedback with a delay of one step: H/(1 + g z⁻¹ H) on the unit circle."""
    step, gain = 0.01, 4000.0
    plant = ct.sample_system(hsi.couple(BRIDGE, PEOPLE, PLACES), step, name="plant")
    controller = ct.ss([[0.0]], [[1.0]], [[-gain]], [[0.0]], step, inputs=["a"], outputs=["F"], name="controller")
    loop = hsi.interconnect(
        [plant, controller], connections=[["plant.F[0]", "controller.F"], ["controller.a", "plant.a[0]"]],
        inplist=["plant.F[0]"], outlist=["plant.a[0]"], inputs=["F"], outputs=["a"])
    z = np.exp(1j * OMEGA * step)
    h = np.array([(plant.C @ np.linalg.solve(one * np.eye(8) - plant.A, plant.B) + plant.D)[0, 0] for one in z])
    np.testing.assert_allclose(loop(z), h / (1 + gain * h / z), rtol=1e-8)
    assert (loop.dt, loop.output_labels) == (step, ["a"])


# --- names ----------------------------------------------------------------------------------------


@pytest.fixture
def renamed() -> hsi.OccupiedBridge:
    occupied = hsi.couple(BRIDGE, PEOPLE, PLACES, force_at=[10.0, 25.0], sense_at=[25.0, 30.0], name="deck")
    occupied.update_names(inputs=["shaker", "walkers"], outputs=["midspan", "quarter"])
    return occupied


@pytest.mark.parametrize("through", [
    lambda system: system.interconnected(), lambda system: copy.deepcopy(system.interconnected()),
    lambda system: pickle.loads(pickle.dumps(system)).interconnected(), lambda system: ct.sample_system(system, 0.01),
    lambda system: hsi.frf(system, [1.0, 2.0]), lambda system: ct.frequency_response(system, OMEGA)],
    ids=["blocks", "copied blocks", "pickled", "sampled", "frf", "frequency response"])
def test_names_survive(renamed: hsi.OccupiedBridge, through) -> None:
    found = through(renamed)
    assert (found.input_labels, found.output_labels) == (["shaker", "walkers"], ["midspan", "quarter"])


def test_signals_are_chosen_by_name_from_every_form(renamed: hsi.OccupiedBridge) -> None:
    for form in (renamed, renamed.interconnected(), ct.frequency_response(renamed, OMEGA)):
        part = form["quarter", "shaker"]
        assert (part.input_labels, part.output_labels) == (["shaker"], ["quarter"])
        values = part.frdata[0, 0] if isinstance(part, ct.FrequencyResponseData) else response(part)[0, 0]
        np.testing.assert_allclose(values, response(renamed)[1, 0], rtol=1e-9)
    record = ct.forced_response(renamed, TIMES, np.vstack([FORCE, 0 * FORCE]))
    assert (record.input_labels, record.output_labels) == (["shaker", "walkers"], ["midspan", "quarter"])


def test_an_occupied_bridge_is_a_block_among_others(renamed: hsi.OccupiedBridge) -> None:
    """A sensor behind it, joined by name alone: the states tell whose they are."""
    sensor = ct.tf([40.0], [1.0, 40.0], inputs="midspan", outputs="reading", name="sensor")
    chain = hsi.interconnect([renamed, sensor], inputs=["shaker"], outputs=["reading"], check_unused=False)
    assert chain.state_labels[0] == "deck_z[0]"
    expected = 40 / (1j * OMEGA + 40) * response(renamed)[0, 0]
    np.testing.assert_allclose(response(chain)[0, 0], expected, rtol=1e-9)


# --- the host's plots -----------------------------------------------------------------------------


@pytest.mark.parametrize("n_modes", [1, 2, 3])
@pytest.mark.parametrize("n", [0, 1, 15])
@pytest.mark.parametrize("at", [[25.0], [10.0, 23.0], [7.0, 20.0, 31.0]], ids=len)
def test_zeros_are_those_of_the_plain_matrices(n_modes: int, n: int, at: list[float]) -> None:
    """Of the host's own pencil; at the origin, where it scatters them, there are two per port."""
    bridge = hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=0.005,
                                             n_modes=n_modes)
    occupied = hsi.couple(bridge, *crowd(n), force_at=at, sense_at=at)
    found, ports = occupied.zeros(), min(len(at), n_modes)
    assert len(found) == occupied.nstates
    assert np.sum(found == 0) == 2 * ports
    if len(at) <= n_modes:     # with more ports than modes the host's pencil is singular
        theirs = ct.StateSpace(occupied.A, occupied.B, occupied.C, occupied.D).zeros()
        assert distance(found, theirs) < 1e-3


def test_absorbers_of_the_bridge_have_zeros_too() -> None:
    """An absorber's own frequency, undamped: it holds the deck still there."""
    bridge = BRIDGE.with_absorbers(hsi.Absorber(mass=250.0, frequency=1.9, damping=0.0), at=[25.0])
    found = hsi.couple(bridge, PEOPLE, PLACES).zeros()
    assert np.abs(found - 2j * np.pi * 1.9).min() < 1e-12
    assert len(found) == 2 + 2 * 4


@pytest.mark.parametrize("n", [0, 15, 225])
def test_default_frequencies_hold_the_peak_and_little_else(n: int) -> None:
    """A decade beyond the slowest and the fastest pole, not down to the rounding of zeros at the origin."""
    occupied = hsi.couple(BRIDGE, *crowd(n))
    plot = ct.bode_plot(occupied)
    omega, size = plot.lines[0, 0][0].get_data()
    assert 0.9 < omega[0] < omega[-1] < 400
    expected = peaks(dense(BRIDGE, *crowd(n)), points=2000)[0][1]
    assert 0.9 * expected < size.max() <= expected
    assert plot.axes[1, 0].get_xlabel() == "Frequency [rad/s]"


def test_default_frequencies_with_more_sensors_than_forces() -> None:
    omega = ct.frequency_response(hsi.couple(BRIDGE, *crowd(15), sense_at=[10.0, 25.0])).omega
    assert 0.9 < omega[0] < omega[-1] < 400


def test_pole_zero_plot_marks_what_the_system_has() -> None:
    occupied = hsi.couple(BRIDGE, *crowd(15))
    plot = ct.pole_zero_map(occupied)
    assert distance(plot.poles, np.linalg.eigvals(occupied.A)) < 1e-12
    np.testing.assert_array_equal(plot.zeros, occupied.zeros())
    assert ct.pole_zero_plot(occupied).axes[0, 0].get_title() == ""


@pytest.mark.parametrize("n", [0, 15, 225])
def test_step_response_lasts_until_the_bridge_rests(n: int) -> None:
    """Until a thousandth of the slowest oscillation is left, with 12 samples a period or more."""
    occupied = hsi.couple(BRIDGE, *crowd(n))
    record = ct.step_response(occupied)
    slowest = max(ct.poles(occupied), key=lambda pole: pole.real)
    assert record.time[-1] == pytest.approx(np.log(1000) / -slowest.real, rel=1e-2)
    assert np.diff(record.time).max() < 2 * np.pi / abs(slowest) / 12
    assert record.outputs[0] == pytest.approx(occupied.D[0, 0])     # a force meets the mass first
    assert (record.plot().axes[0, 0].get_ylabel(), record.output_labels) == ("a[0]", ["a[0]"])


def test_a_measured_bridge_in_the_hosts_plots() -> None:
    """Of one force and one acceleration, the singular value is the modulus."""
    response = ct.frequency_response(BRIDGE.ss(at=[25.0])["a[0]", "F[0]"], OMEGA)
    measured = hsi.MeasuredBridge(response=response, positions=[25.0], modal_mass=25e3)
    occupied = hsi.couple(measured, PEOPLE, [25.0] * 3)
    expected = np.abs(hsi.couple(BRIDGE, PEOPLE, [25.0] * 3)(1j * OMEGA))
    np.testing.assert_allclose(ct.singular_values_response(occupied).frdata[0, 0], expected, rtol=1e-9)
    plots = ct.singular_values_response(occupied).plot(), ct.bode_plot(occupied)
    for plot in plots:
        omega, size = np.ravel(plot.lines)[0][0].get_data()
        np.testing.assert_allclose(omega, OMEGA)
        np.testing.assert_allclose(size, expected, rtol=1e-9)
    assert ct.nyquist_plot(occupied).axes.size == 1

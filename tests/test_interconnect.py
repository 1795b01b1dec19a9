"""`hsi.interconnect` against the host's own `interconnect`, `feedback` and `append`."""

import inspect

import control as ct
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from second_road import distance

import hsictrl as hsi

quick = settings(deadline=None, derandomize=True, max_examples=25)
pytestmark = pytest.mark.filterwarnings("ignore:Unused:UserWarning")


def random_block(name, states, inputs, outputs, seed, *, feedthrough, dt=0):
    """A stable block with labels u[i], y[j]; continuous, or discrete with dt > 0."""
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(states, states))
    A = A / (1.1 + np.abs(np.linalg.eigvals(A)).max()) if dt else A - (np.linalg.norm(A, 2) + 0.1) * np.eye(states)
    D = 0.3 * rng.normal(size=(outputs, inputs)) * feedthrough
    return ct.ss(A, rng.normal(size=(states, inputs)), rng.normal(size=(outputs, states)), D, dt, name=name,
                 inputs=[f"u[{i}]" for i in range(inputs)], outputs=[f"y[{j}]" for j in range(outputs)])


def gain(name, value):
    return ct.ss([], [], [], [[value]], name=name, inputs="in", outputs="out")


def assert_same(ours, theirs, tolerance=1e-12):
    for part in "ABCD":
        expected = getattr(theirs, part)
        np.testing.assert_allclose(getattr(ours, part), expected, err_msg=part,
                                   atol=tolerance * max(1, np.abs(expected).max(initial=0)))


def occupied_loop(join, unsprung):
    bridge, people = hsi.reference_bridge(frequency=2.0), hsi.Crowd(
        mass=[60.0, 80.0], frequency=[3.0, 4.0], damping=0.3, sprung_ratio=0.95 if unsprung else 1.0)
    ports = ("y", "v", "a") if unsprung else ("y", "v")
    plant, bodies = bridge.ss(at=[20.0, 25.0]), people.ss(ports=ports)
    return plant, bodies, join(
        [plant, bodies],
        connections=[["bridge.F", "crowd.F"], *([f"crowd.{port}", f"bridge.{port}"] for port in ports)],
        inplist=["bridge.F[0:2]"], outlist=["bridge.a"], inputs=["p[0]", "p[1]"], outputs=["acc[0]", "acc[1]"],
        name="loop")


# --- the same as the host wherever the host can ---------------------------------------------------


def test_signature_is_the_hosts():
    ours, theirs = (inspect.signature(f).parameters.values() for f in (hsi.interconnect, ct.interconnect))
    assert [(p.name, p.kind, p.default) for p in ours] == [(p.name, p.kind, p.default) for p in theirs]


@quick
@given(n=st.integers(1, 4), m=st.integers(1, 3), seed=st.integers(0, 10**6), dt=st.sampled_from([0, 0.1]))
def test_without_algebraic_loop_it_is_the_hosts(n, m, seed, dt):
    """Matrices and names of random loops of three blocks, one with a feedthrough, continuous and discrete."""
    blocks = [random_block(name, n, m, m, seed + i, feedthrough=i == 0, dt=dt) for i, name in enumerate("PQR")]
    asked = {"connections": [["P.u", "R.y"], ["Q.u", "P.y", "-R.y"], ["R.u", "Q.y"]], "inplist": ["P.u", "Q.u"],
             "outlist": ["R.y", "P.y"], "name": "loop"}
    ours, theirs = hsi.interconnect(blocks, **asked), ct.interconnect(blocks, **asked)
    assert_same(ours, theirs, 1e-9)              # the host differentiates numerically
    for labels in ("name", "input_labels", "output_labels", "state_labels", "dt"):
        assert getattr(ours, labels) == getattr(theirs, labels)
    for part in ("connect_map", "input_map", "output_map"):
        np.testing.assert_array_equal(getattr(ours, part), getattr(theirs, part))


def test_base_names_and_slices_of_vector_signals():
    """Bodies without unsprung mass make no algebraic loop: here the host is the second road."""
    (_, _, ours), (_, _, theirs) = (occupied_loop(join, unsprung=False) for join in (hsi.interconnect, ct.interconnect))
    assert_same(ours, theirs, 1e-9)
    assert ours.input_labels == theirs.input_labels == ["p[0]", "p[1]"]
    assert ours.output_labels == theirs.output_labels == ["acc[0]", "acc[1]"]


def test_signals_that_meet_by_name():
    """No connections given: the summing junction of the host's own examples."""
    plant = ct.tf([1], [1, 2, 1], inputs="u", outputs="y", name="P")
    control = ct.tf([2, 1], [1, 0], inputs="e", outputs="u", name="C")
    asked = {"inputs": "r", "outputs": "y", "name": "T"}
    junction = ct.summing_junction(inputs=["r", "-y"], output="e", name="sum")
    loop = hsi.interconnect([plant, control, junction], **asked)
    expected = ct.interconnect([plant, control, junction], **asked)
    assert_same(loop, expected, 1e-9)
    closed = ct.feedback(ct.tf([1], [1, 2, 1]) * ct.tf([2, 1], [1, 0]))
    assert distance(loop.poles(), closed.poles()) < 1e-9
    assert [block.name for block in loop.syslist] == ["P", "C", "sum"]
    assert all(isinstance(block, ct.StateSpace) for block in loop.syslist)


@pytest.mark.parametrize("join", [hsi.interconnect, ct.interconnect])
def test_the_same_object_twice_is_two_blocks(join):
    block = random_block("P", 2, 1, 1, 0, feedthrough=True)
    with pytest.warns(UserWarning, match="duplicate object found"):
        loop = join([block, block], connections=[[(1, 0), (0, 0)]], inplist=[(0, 0)], outlist=[(1, 0)])
    series = block * block
    np.testing.assert_allclose(loop(1j), series(1j), rtol=1e-9)
    assert loop.nstates == 4
    assert len(set(loop.state_labels)) == 4


def test_nothing_to_join_is_the_hosts_nothing():
    assert (hsi.interconnect([]).nstates, hsi.interconnect([]).shape) == (0, ct.interconnect([]).shape)


@pytest.mark.parametrize("join", [hsi.interconnect, ct.interconnect])
def test_unknown_keywords_are_refused(join):
    block = random_block("P", 1, 1, 1, 0, feedthrough=False)
    with pytest.raises(TypeError, match=r"unrecognized keyword.*typo"):
        join([block], inplist=["P.u"], outlist=["P.y"], typo=1)


@pytest.mark.parametrize("join", [hsi.interconnect, ct.interconnect])
def test_unknown_signals_are_refused(join):
    block = random_block("P", 1, 1, 1, 0, feedthrough=False)
    with pytest.raises(ValueError, match=r"P\.w"):
        join([block], connections=[["P.u", "P.w"]], inplist=["P.u"], outlist=["P.y"])


# --- what the host refuses ------------------------------------------------------------------------


def test_the_host_refuses_a_body_with_unsprung_mass():
    with pytest.raises(RuntimeError, match="algebraic loop"):
        occupied_loop(ct.interconnect, unsprung=True)


def test_a_body_with_unsprung_mass_is_closed_exactly():
    """Against `control.feedback`, which inverts the same loop."""
    plant, bodies, loop = occupied_loop(hsi.interconnect, unsprung=True)
    closed = ct.feedback(plant, bodies, sign=+1)
    assert_same(loop, ct.ss(closed.A, closed.B, closed.C[2::3], closed.D[2::3]))


@quick
@given(n=st.integers(0, 4), m=st.integers(1, 3), seed=st.integers(0, 10**6))
def test_any_well_posed_loop_is_the_hosts_feedback(n, m, seed):
    """Feedthrough in both directions, static blocks among them, against `control.feedback`."""
    P, K = (random_block(name, n, m, m, seed + i, feedthrough=True) for i, name in enumerate("PK"))
    loop = hsi.interconnect([P, K], connections=[["P.u", "-K.y"], ["K.u", "P.y"]], inplist=["P.u"],
                            outlist=["P.y"])
    assert_same(loop, ct.feedback(P, K), 1e-10)


def test_an_output_may_be_an_input_of_a_block():
    """The error e = 1/(1 + PK) r, sensitivity, as the input of the plant; the host's output map allows it."""
    P, K = (random_block(name, 2, 1, 1, i, feedthrough=True) for i, name in enumerate("PK"))
    loop = hsi.interconnect([P, K], connections=[["P.u", "-K.y"], ["K.u", "P.y"]], inplist=["P.u"], outlist=["P.u"])
    s = 0.3 + 2j
    assert loop(s) == pytest.approx(1 / (1 + P(s) * K(s)), rel=1e-10)


def test_nested_use():
    """An exact loop inside another one, the inner closed over two algebraic loops."""
    P, K, Q = (random_block(name, 2, 1, 1, i, feedthrough=True) for i, name in enumerate("PKQ"))
    wiring = {"connections": [["P.u", "-K.y"], ["K.u", "P.y"]], "inplist": ["P.u"], "outlist": ["P.y"]}
    inner = hsi.interconnect([P, K], inputs=["u"], outputs=["y"], name="inner", **wiring)
    outer = hsi.interconnect([inner, Q], connections=[["inner.u", "-Q.y"], ["Q.u", "inner.y"]],
                             inplist=["inner.u"], outlist=["inner.y"])
    assert_same(outer, ct.feedback(ct.feedback(P, K), Q), 1e-10)
    assert any(label.startswith("inner") for label in outer.state_labels)


def test_the_result_serves_the_hosts_nonlinear_tools():
    """Simulation, linearisation and the host's own interconnect no longer sweep through the blocks."""
    _, _, loop = occupied_loop(hsi.interconnect, unsprung=True)
    plain = ct.ss(loop.A, loop.B, loop.C, loop.D)
    t = np.linspace(0, 2, 201)
    force = 700 * np.vstack([np.sin(4 * np.pi * t), np.zeros_like(t)])
    expected = ct.forced_response(plain, t, force).outputs
    result = ct.input_output_response(loop, t, force, solve_ivp_kwargs={"rtol": 1e-9, "atol": 1e-12})
    np.testing.assert_allclose(result.outputs, expected, atol=1e-4 * np.abs(expected).max())
    np.testing.assert_allclose(ct.linearize(loop, np.zeros(6), np.zeros(2)).A, loop.A, atol=1e-6 * np.abs(loop.A).max())
    around = ct.interconnect([loop], inplist=["loop.p"], outlist=["loop.acc"])
    assert_same(around, plain, 1e-6)


def test_nonlinear_blocks_fall_through_to_the_host():
    """A saturated actuator: the host's own class, simulated as the host does."""
    plant = random_block("P", 2, 1, 1, 0, feedthrough=False)
    limit = ct.nlsys(None, lambda t, x, u, params: np.clip(u, -0.5, 0.5), inputs=["u"], outputs=["y"], name="limit")
    asked = {"connections": [["P.u", "limit.y"], ["limit.u", "-P.y"]], "inplist": ["limit.u"], "outlist": ["P.y"]}
    ours, theirs = hsi.interconnect([plant, limit], **asked), ct.interconnect([plant, limit], **asked)
    assert type(ours) is type(theirs) is ct.InterconnectedSystem
    t = np.linspace(0, 3, 31)
    results = [ct.input_output_response(loop, t, 2 * np.sin(t)).outputs for loop in (ours, theirs)]
    np.testing.assert_allclose(*results, rtol=1e-6, atol=1e-9)
    assert ours.syslist[0] is plant


# --- loops without solution -----------------------------------------------------------------------


def test_an_ill_posed_loop_is_refused_by_the_names_of_its_signals():
    """2 · 0.5 = 1 around the loop; a third block beside it is not to blame."""
    g, k = gain("g", 2.0), gain("k", 0.5)
    before, after = (random_block(name, 2, 1, 1, 0, feedthrough=True) for name in ("before", "after"))
    with pytest.raises(ValueError, match=r"must have a solution, got none through g\.in, k\.in; break it with dyn"):
        hsi.interconnect([before, g, after, k], inplist=["before.u"], outlist=["after.y"], connections=[
            ["g.in", "k.out", "before.y"], ["k.in", "g.out"], ["after.u", "g.out"]])


def test_a_negative_unsprung_mass_as_large_as_the_modal_mass_is_ill_posed():
    """Bodies cannot have one, a block made by hand can: 1 + m₀φ² = 0."""
    plant = hsi.reference_bridge(frequency=2.0).ss(at=[25.0])
    bad = ct.ss([], [], [], [[0, 0, 25e3]], inputs=["y", "v", "a"], outputs=["F"], name="bad")
    with pytest.raises(ValueError, match="got none through"):
        hsi.interconnect([plant, bad], connections=[["bridge.F", "bad.F"], ["bad.a", "bridge.a"]],
                         inplist=["bridge.F"], outlist=["bridge.a"])


def test_a_nearly_ill_posed_loop_is_still_solved():
    g, k = gain("g", 1.0), gain("k", 1 - 1e-9)
    loop = hsi.interconnect([g, k], connections=[["g.in", "k.out"], ["k.in", "g.out"]], inplist=["g.in"],
                            outlist=["g.out"])
    assert loop.D[0, 0] == pytest.approx(1e9, rel=1e-6)

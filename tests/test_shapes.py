"""Analytic mode shapes against closed forms, textbook values and a finite-element second road."""

import pickle
from dataclasses import FrozenInstanceError
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eigh
from scipy.optimize import brentq

from hsictrl._checks import DIRECTIONS
from hsictrl.bridge.beams import BeamShape, beam_modes
from hsictrl.bridge.shapes import Shape, SineShape

PP, CC, CP, PC = ("pinned", "pinned"), ("clamped", "clamped"), ("clamped", "pinned"), ("pinned", "clamped")
UNEQUAL = [12.0, 20.0, 7.5]


def wavenumbers(spans, ends=PP, n_modes=1):
    return np.array([shape.wavenumber for _, shape in beam_modes(spans, ends, n_modes)])


def fe_wavenumbers(spans, ends, n_modes, per_span=40):
    """Second road: Rayleigh-Ritz on cubic Hermite elements, EI = m = 1, so that omega = β²."""
    h = np.repeat(np.asarray(spans) / per_span, per_span)
    size = 2 * (h.size + 1)
    stiffness, mass = np.zeros((size, size)), np.zeros((size, size))
    for e, length in enumerate(h):
        scale = np.array([1, length, 1, length])
        k = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]) / length**3
        m = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) / 420
        here = slice(2 * e, 2 * e + 4)
        stiffness[here, here] += scale[:, None] * k * scale
        mass[here, here] += scale[:, None] * m * scale * length
    held = set(range(0, size, 2 * per_span))
    held |= {1} if ends[0] == "clamped" else set()
    held |= {size - 1} if ends[1] == "clamped" else set()
    free = np.setdiff1d(np.arange(size), list(held))
    squares = eigh(stiffness[np.ix_(free, free)], mass[np.ix_(free, free)], eigvals_only=True,
                   subset_by_index=(0, n_modes - 1))
    return squares**0.25


def integrate(f, edges, nodes=40):
    """Gauss-Legendre on each of the intervals between the edges."""
    at, weights = np.polynomial.legendre.leggauss(nodes)
    half = np.diff(edges)[:, None] / 2
    return float(np.sum(half * weights * f(np.asarray(edges)[:-1, None] + half * (1 + at))))


# --- closed forms and the literature --------------------------------------------------------------


def test_single_pinned_span_is_the_sine():
    modes = beam_modes([50.0], n_modes=30)
    x = np.linspace(-1.0, 51.0, 4001)
    for j, (ratio, shape) in enumerate(modes, start=1):
        sine = SineShape(50.0, j)
        assert ratio == pytest.approx(j**2, rel=1e-10)
        np.testing.assert_allclose(shape(x), sine(x), atol=1e-9)
        assert shape.antinode == pytest.approx(sine.antinode, abs=1e-6)
        assert shape.mean_square == pytest.approx(1 / 2, abs=1e-12)
        assert shape.mean_absolute == pytest.approx(2 / np.pi, abs=1e-12)


# Roots of cos λ cosh λ = 1 and of tan λ = tanh λ, as in Blevins, Formulas for Natural Frequency and Mode
# Shape (1979), table 8-1.
CLAMPED_CLAMPED = [4.730040744862704, 7.853204624095838, 10.995607838001671]
CLAMPED_PINNED = [3.926602312047919, 7.068582745628732, 10.210176122813031]


@pytest.mark.parametrize(
    ("ends", "printed"), [(CC, CLAMPED_CLAMPED), (CP, CLAMPED_PINNED), (PC, CLAMPED_PINNED)],
)
def test_single_span_constants(ends, printed):
    np.testing.assert_allclose(wavenumbers([2.5], ends, 3) * 2.5, printed, rtol=1e-13)


def test_clamped_span_has_the_textbook_shape():
    """cosh - cos - σ(sinh - sin), σ = 0.982502 for the first mode, of mean square one (Blevins 1979)."""
    shape, beta = BeamShape([1.0], CC), CLAMPED_CLAMPED[0]
    sigma = (np.cosh(beta) - np.cos(beta)) / (np.sinh(beta) - np.sin(beta))
    x = np.linspace(0, 1, 101)
    book = np.cosh(beta * x) - np.cos(beta * x) - sigma * (np.sinh(beta * x) - np.sin(beta * x))
    np.testing.assert_allclose(shape(x), book / book[50], atol=1e-12)
    assert sigma == pytest.approx(0.982502, abs=1e-6)
    assert shape.mean_square == pytest.approx(1 / book[50] ** 2, abs=1e-12)


def test_two_equal_pinned_spans_alternate_between_sines_and_clamped_pinned_spans():
    expected = np.sort(np.concatenate([np.pi * np.arange(1, 4), CLAMPED_PINNED]))
    np.testing.assert_allclose(wavenumbers([25.0, 25.0], n_modes=6) * 25, expected, rtol=1e-13)


def test_two_equal_spans_with_clamped_ends_include_modes_without_rotation_at_any_support():
    expected = np.sort(np.concatenate([CLAMPED_PINNED, CLAMPED_CLAMPED]))
    np.testing.assert_allclose(wavenumbers([25.0, 25.0], CC, 6) * 25, expected, rtol=1e-13)


@pytest.mark.parametrize("n_spans", [3, 4, 7])
def test_equal_spans_with_clamped_ends_include_every_clamped_span_mode(n_spans):
    found = wavenumbers([1.0] * n_spans, CC, 3 * n_spans)
    for constant in CLAMPED_CLAMPED:
        assert np.min(np.abs(found - constant)) < 1e-12


def test_three_equal_spans_against_blevins():
    """Blevins (1979) table 8-4 gives 3.14, 3.56 and 4.30 for βl; the higher digits from tan and tanh."""
    found = wavenumbers([1.0] * 3, n_modes=3)
    np.testing.assert_allclose(found, [3.14, 3.56, 4.30], atol=5e-3)
    np.testing.assert_allclose(found, [np.pi, *(periodic_beam(c) for c in (0.5, -0.5))], rtol=1e-13)


def periodic_beam(cosine):
    """N equal pinned spans: near(βl) = -far(βl) cos(kπ/N), the dispersion relation of the periodic beam."""
    def residual(beta):
        near = np.sin(beta) * np.cosh(beta) - np.cos(beta) * np.sinh(beta)
        return near - cosine * (np.sinh(beta) - np.sin(beta))
    return brentq(residual, 3.2, 4.6, xtol=1e-15)


def test_reversed_beam_is_the_mirror_image():
    x = np.linspace(0, sum(UNEQUAL), 301)
    for (ratio, shape), (mirrored, image) in zip(
        beam_modes(UNEQUAL, CP, 6), beam_modes(UNEQUAL[::-1], PC, 6), strict=True,
    ):
        assert ratio == pytest.approx(mirrored, rel=1e-12)
        np.testing.assert_allclose(np.abs(shape(x)), np.abs(image(sum(UNEQUAL) - x)), atol=1e-11)


def test_the_two_hundredth_mode_neither_overflows_nor_loses_its_shape():
    shape = BeamShape([1.0], CC, number=200)
    beta = 200.5 * np.pi  # asymptote of the clamped span, off by exp(-β)
    assert shape.wavenumber == pytest.approx(beta, rel=1e-13)
    x = np.linspace(0.05, 0.95, 1001)  # beyond the reach of the ends it is a sine
    expected = np.sin(beta * x - np.pi / 4)
    scale = np.dot(shape(x), expected) / np.dot(expected, expected)
    np.testing.assert_allclose(shape(x), scale * expected, atol=1e-10)


# --- the second road ------------------------------------------------------------------------------


@pytest.mark.parametrize("ends", [PP, CC, CP, PC])
def test_unequal_spans_against_finite_elements(ends):
    np.testing.assert_allclose(wavenumbers(UNEQUAL, ends, 9), fe_wavenumbers(UNEQUAL, ends, 9), rtol=1e-5)


@settings(deadline=None, max_examples=30)
@given(
    spans=st.lists(st.floats(0.2, 1.0), min_size=1, max_size=4),
    ends=st.sampled_from([PP, CC, CP, PC]),
)
def test_no_mode_is_missed(spans, ends):
    found = wavenumbers(spans, ends, 8)
    assert np.all(np.diff(found) > 0)
    np.testing.assert_allclose(found, fe_wavenumbers(spans, ends, 8), rtol=1e-4)


@pytest.mark.parametrize("ends", [PP, CP])
def test_shapes_are_orthogonal(ends):
    shapes = [shape for _, shape in beam_modes(UNEQUAL, ends, 7)]
    for i, one in enumerate(shapes):
        for other in shapes[:i]:
            overlap = integrate(lambda x, a=one, b=other: a(x) * b(x), one.supports)
            assert abs(overlap) < 1e-9


@pytest.mark.parametrize("number", [1, 2, 5])
def test_slope_and_moment_are_continuous_at_inner_supports(number):
    shape, h = BeamShape(UNEQUAL, CP, number), 0.02
    k = np.arange(8)
    for support in shape.supports[1:-1]:
        left, right = (taylor(shape, support, side * h * k) for side in (-1, 1))
        np.testing.assert_allclose(left, right, atol=1e-6)
        assert abs(left[0]) < 1e-10


def taylor(shape, support, away):
    """Value, slope and curvature at a support, by a polynomial through points on one side of it."""
    through = np.linalg.solve(np.vander(away, increasing=True), shape(support + away))
    return through[:3] * [1, 1, 2]


def test_ends_hold_what_their_names_say():
    shape, h = BeamShape(UNEQUAL, CP, 2), 1e-4
    end = shape.length
    assert abs(shape(h)) < 1e-8  # no slope
    curvature = (shape(end) - 2 * shape(end - h) + shape(end - 2 * h)) / h**2
    assert abs(shape(end - h)) > 1e-6
    assert abs(curvature) < 1e-4


# --- scale, means, evaluation ---------------------------------------------------------------------


@pytest.fixture(params=[
    lambda: SineShape(30.0), lambda: SineShape(30.0, 3),
    lambda: BeamShape(UNEQUAL), lambda: BeamShape(UNEQUAL, CC, 4), lambda: BeamShape([9, 1, 5], PC, 7),
], ids=["sine 1", "sine 3", "pinned 1", "clamped 4", "mixed 7"])
def shape(request):
    return request.param()


def test_largest_absolute_value_is_one_at_the_antinode(shape):
    x = np.linspace(0, shape.length, 200_001)
    assert np.max(np.abs(shape(x))) == pytest.approx(1.0, abs=1e-8)
    assert np.max(np.abs(shape(x))) <= 1 + 1e-12
    assert float(shape(*shape.antinode)) == pytest.approx(1.0, abs=1e-14)


def test_first_of_equal_antinodes():
    assert BeamShape([10.0, 10.0]).antinode == pytest.approx((5.0, 0.0), abs=1e-9)
    assert BeamShape([10.0] * 5, CC, 11).antinode[0] < 25.0


def test_means_against_fine_sums(shape):
    """Second road: the midpoint rule, of second order also over the kinks of |φ|."""
    n = 400_000
    x = (np.arange(n) + 0.5) * shape.length / n
    assert shape.mean_square == pytest.approx(np.mean(shape(x) ** 2), abs=1e-9)
    assert shape.mean_absolute == pytest.approx(np.mean(np.abs(shape(x))), abs=1e-9)


@pytest.mark.parametrize(("ends", "number"), [(PP, 1), (PC, 6), (CC, 9)])
def test_means_to_ten_digits(ends, number):
    shape = BeamShape(UNEQUAL, ends, number)
    edges = np.sort(np.concatenate([shape.supports, sign_changes(shape)]))
    areas = [abs(integrate(shape, interval)) for interval in pairwise(edges)]
    squares = integrate(lambda x: shape(x) ** 2, shape.supports, nodes=80)
    assert shape.mean_absolute == pytest.approx(sum(areas) / shape.length, abs=1e-11)
    assert shape.mean_square == pytest.approx(squares / shape.length, abs=1e-11)


def sign_changes(shape):
    x = np.setdiff1d(np.linspace(0, shape.length, 20_011), shape.supports)
    at = np.flatnonzero(np.diff(np.sign(shape(x))))
    return [brentq(shape, x[i], x[i + 1], xtol=1e-13) for i in at]


def test_off_the_deck_is_exactly_zero(shape):
    off = np.array([-np.inf, -1e3, -1e-12, np.nextafter(shape.length, np.inf), shape.length + 3.0, np.inf])
    assert np.all(shape(off) == 0.0)
    assert float(shape(shape.length / 7)) != 0.0


def test_an_unknown_place_stays_unknown(shape):
    assert np.isnan(shape(np.nan))


@pytest.mark.parametrize("moving", DIRECTIONS)
def test_the_other_direction_is_zero(moving):
    other = DIRECTIONS[1 - DIRECTIONS.index(moving)]
    for shape in (SineShape(10.0, direction=moving), BeamShape([4.0, 6.0], direction=moving)):
        assert abs(float(shape(2.0, 0.0, moving))) > 0.1
        assert np.array_equal(shape(np.array([2.0, 3.0]), 0.0, other), [0.0, 0.0])


def test_points_broadcast(shape):
    x = np.linspace(-2.0, shape.length + 2.0, 24)
    one_by_one = np.array([float(shape(place)) for place in x])
    np.testing.assert_array_max_ulp(shape(x) + 2.0, one_by_one + 2.0, 4)
    assert np.array_equal(shape(x.reshape(2, 3, 4)), shape(x).reshape(2, 3, 4))
    assert np.array_equal(shape(x[:, None], np.zeros(5)), np.repeat(shape(x)[:, None], 5, axis=1))
    assert shape(x[:, None], np.zeros(5), "lateral").shape == (24, 5)
    assert shape(1.0).shape == ()
    assert shape([]).shape == (0,)
    shape(x, np.zeros(24))[0] = 5.0  # the caller's own array


# --- objects --------------------------------------------------------------------------------------


def test_shapes_are_frozen_and_travel(shape):
    x = np.linspace(0, shape.length, 50)
    assert np.array_equal(pickle.loads(pickle.dumps(shape))(x), shape(x))
    with pytest.raises(FrozenInstanceError):
        shape.length = 3.0


def test_arrays_are_read_only():
    spans = np.array([4.0, 6.0])
    shape = BeamShape(spans)
    spans[0] = 100.0
    assert shape.length == 10.0
    for array in (shape.spans, shape.coefficients):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_the_interface_is_abstract():
    with pytest.raises(TypeError, match="abstract"):
        Shape()


@pytest.mark.parametrize(
    ("refused", "message"),
    [
        (lambda: beam_modes([10.0, 0.0]), r"spans\[1\] must be above 0, got 0; give a list"),
        (lambda: beam_modes([-3.0, 10.0]), r"spans\[0\] must be above 0, got -3"),
        (lambda: beam_modes([10.0, np.nan]), r"spans\[1\] must be above 0, got nan"),
        (lambda: beam_modes([]), "number of spans must be at least 1, got 0; give a list"),
        (lambda: beam_modes(50.0), r"spans must have 1 dimension\(s\), got shape \(\); give a list"),
        (lambda: beam_modes([10.0, 0.001]), r"spans\[1\] must be at least 0.01, got 0.001; leave out"),
        (lambda: beam_modes([10.0], ("pinned", "free")), "each of the ends must be one of .* got 'free'"),
        (lambda: beam_modes([10.0], ("pinned",)), "ends must be two, got 1; give one word for each end"),
        (lambda: beam_modes([10.0], n_modes=0), "n_modes must be at least 1, got 0; ask for one"),
        (lambda: beam_modes([1.0, *[0.2] * 40, 1.0], n_modes=2), "wavenumbers must differ by .* vary"),
        (lambda: BeamShape([10.0], number=0), "number must be at least 1, got 0; count the modes"),
        (lambda: BeamShape([10.0], direction="up"), "direction must be one of .* got 'up'"),
        (lambda: SineShape(0.0), "length must be above 0, got 0; give the length"),
        (lambda: SineShape(np.inf), "length must be finite, got inf"),
        (lambda: SineShape(10.0, 0), "number must be at least 1, got 0; count the half waves"),
        (lambda: SineShape(10.0, direction="up"), "direction must be one of"),
        (lambda: SineShape(10.0)(1.0, direction="z"), "direction must be one of .* got 'z'; choose"),
    ],
)
def test_refusals(refused, message):
    with pytest.raises(ValueError, match=message):
        refused()


@pytest.mark.parametrize(
    ("refused", "message"),
    [
        (lambda: beam_modes(["ten"]), "spans must be real numbers, got .'ten'.; give a list"),
        (lambda: beam_modes([10.0], "pinned"), "ends must be of type tuple or list, got str; give one"),
        (lambda: beam_modes([10.0], n_modes=2.0), "n_modes must be a whole number, got 2.0; ask for"),
    ],
)
def test_refusals_of_kind(refused, message):
    with pytest.raises(TypeError, match=message):
        refused()

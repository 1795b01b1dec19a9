"""The walking forces against hand calculation, published tables, Parseval and scipy.stats."""

import math
from dataclasses import fields

import numpy as np
import pytest
from scipy.stats import kstest, truncnorm

from hsictrl.walking import (
    ForceLines,
    HarmonicForce,
    MainHarmonics,
    WalkingForce,
    YoungForce,
    ZivanovicForce,
    kerr_factor,
    lines,
    narrowband,
)

NONE = np.empty((1, 0))
MODELS = [
    HarmonicForce([0.43, 0.08], phases=[0.3, -1.0]),
    YoungForce(),
    YoungForce(values="design"),
    ZivanovicForce(),
    ZivanovicForce(spacing=0.05, scaling="variance"),
    MainHarmonics(ZivanovicForce()),
]
ERRORS = [1e-10, 2e-10, 2e-10, 2e-5, 2e-5, 1e-9]  # of the grid, relative to the peak


def crowd(model: WalkingForce, n: int = 20, seed: int = 1) -> ForceLines:
    rng = np.random.default_rng(seed)
    return model.lines(rng.normal(2.0, 0.175, n), rng.uniform(500, 900, n), rng.random((n, model.n_draws)))


def one(model: WalkingForce, f_s: float = 2.0, *, weight: float = 700.0, draw: float = 0.3) -> ForceLines:
    return model.lines([f_s], [weight], np.full((1, model.n_draws), draw))


def comb(**changes: object) -> ForceLines:
    given = {"coefficients": [[301.0, 56.0]], "first": 1, "spacing": 1.0, "step_frequency": [2.0]}
    return ForceLines(**(given | changes))


# lines

def test_at_is_the_sum_of_cosines_written_out():
    lines = [[10 * np.exp(0.5j), 3 * np.exp(-1j)]]
    force = comb(coefficients=lines, first=3, spacing=0.25, step_frequency=[1.8])
    times = np.linspace(-3, 40, 1001)
    by_hand = (10 * np.cos(2 * np.pi * 0.75 * 1.8 * times + 0.5) + 3 * np.cos(2 * np.pi * 1.8 * times - 1))
    np.testing.assert_allclose(force.at(times)[0], by_hand, rtol=0, atol=1e-10)


@pytest.mark.parametrize(("model", "error"), list(zip(MODELS, ERRORS, strict=True)))
def test_grid_agrees_with_the_direct_sum(model, error):
    force, step = crowd(model), 0.01
    starts = np.random.default_rng(2).integers(-500, 20000, force.n_walkers)
    grid = force.on_grid(starts * step, 1500, step)
    for k, start in enumerate(starts):
        direct = force.at((start + np.arange(1500)) * step)[k]
        assert np.max(abs(grid[k] - direct)) < error * np.max(abs(direct))


def test_grid_gives_the_same_digits_for_a_walker_alone(monkeypatch):
    force = crowd(ZivanovicForce(), n=11)
    grid = force.on_grid(0.01 * np.arange(11), 400, 0.01)
    alone = comb(coefficients=force.coefficients[8:9], first=force.first, spacing=force.spacing,
                 step_frequency=force.step_frequency[8:9])
    np.testing.assert_array_equal(alone.on_grid([0.01 * 8], 400, 0.01)[0], grid[8])
    monkeypatch.setattr(lines, "WALKERS_AT_ONCE", 4)
    np.testing.assert_array_equal(force.on_grid(0.01 * np.arange(11), 400, 0.01), grid)


def test_grid_survives_the_seam_of_its_table():
    force = comb(step_frequency=[1.0])
    step = (1 - 1e-9) / lines.SMALLEST_TABLE  # samples just below every knot, the last one below the seam
    indices = np.arange(-3, 3)
    np.testing.assert_allclose(force.on_grid([-3 * step], 6, step), force.at(indices * step), rtol=1e-8)
    # just below zero, where the fraction of a period rounds to one
    np.testing.assert_allclose(force.on_grid([-1e-20], 2, 1e-20), [[357.0, 357.0]], rtol=1e-8)


def test_no_walkers_no_force():
    force = YoungForce().lines([], [], np.empty((0, 4)))
    assert force.on_grid([], 7, 0.01).shape == (0, 7)
    assert force.at([0.0, 1.0]).shape == (0, 2)
    assert force.highest_frequency == 0


def test_frequencies_and_the_highest_that_is_not_zero():
    force = comb(coefficients=[[1, 1, 0], [1, 0, 0]], first=2, spacing=0.5, step_frequency=[2.0, 2.2])
    np.testing.assert_allclose(force.frequencies, [[2, 3, 4], [2.2, 3.3, 4.4]])
    assert force.highest_frequency == 3
    assert force.n_walkers == 2


def test_lines_are_read_only_copies():
    coefficients = np.ones((1, 2), dtype=complex)
    force = comb(coefficients=coefficients)
    coefficients[0, 0] = 7
    assert force.coefficients[0, 0] == 1
    with pytest.raises(ValueError, match="read-only"):
        force.coefficients[0, 0] = 7
    with pytest.raises(ValueError, match="read-only"):
        force.step_frequency[0] = 7


# harmonic and Young

def test_harmonic_force_is_its_cosines():
    force = HarmonicForce([0.43, 0.08], phases=[0.2, 0.7]).lines([1.9], [650.0], NONE)
    t = np.linspace(0, 5, 501)
    by_hand = 650 * (0.43 * np.cos(2 * np.pi * 1.9 * t + 0.2) + 0.08 * np.cos(2 * np.pi * 3.8 * t + 0.7))
    np.testing.assert_allclose(force.at(t)[0], by_hand, atol=1e-9)


def test_harmonic_phases_default_to_zero_and_forces_compare():
    assert HarmonicForce([0.43, 0.08]) == HarmonicForce((0.43, 0.08), phases=[0, 0])


@pytest.mark.parametrize(("values", "step_frequency", "factors"), [
    # by hand, CCIP-016: harmonic h at h f_s, here 2, 4, 6, 8 Hz
    ("design", 2.0, [0.4305, 0.069 + 0.0056 * 4, 0.033 + 0.0064 * 6, 0.013 + 0.0065 * 8]),
    ("mean", 2.0, [0.3885, 0.054 + 0.0044 * 4, 0.026 + 0.0050 * 6, 0.010 + 0.0051 * 8]),
    ("design", 2.5, [0.56, 0.097, 0.081, 0.078]),   # 0.41 (2.5 - 0.95) = 0.6355, capped
    ("mean", 2.5, [0.50, 0.076, 0.0635, 0.061]),    # 0.37 (2.5 - 0.95) = 0.5735, capped
    ("mean", 0.5, [0.0, 0.0584, 0.0335, 0.0202]),   # never below zero
])
def test_young_factors(values, step_frequency, factors):
    force = one(YoungForce(values=values), step_frequency)
    np.testing.assert_allclose(abs(force.coefficients[0]), 700 * np.array(factors), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("model", [YoungForce(), ZivanovicForce()])
def test_phases_are_uniform_and_independent(model):
    lines = crowd(model, n=400).coefficients[:, :4]
    turns = np.angle(lines) / (2 * np.pi) + 0.5
    assert kstest(turns.ravel(), "uniform").pvalue > 1e-3
    assert np.max(abs(np.corrcoef(turns.T) - np.eye(4))) < 4 / math.sqrt(400)


def test_a_quarter_draw_is_a_quarter_turn_below_zero():
    angles = np.angle(YoungForce().lines([2.0], [700.0], [[0.25, 0.5, 0.625, 0.75]]).coefficients[0])
    np.testing.assert_allclose(angles, [-np.pi / 2, 0, np.pi / 4, np.pi / 2], atol=1e-12)


# Živanović

def bundles(force: ForceLines) -> np.ndarray:
    """Line amplitudes of sub 1, main 1, sub 2, …, shape (n, 10, lines of one)."""
    return abs(force.coefficients).reshape(force.n_walkers, 10, -1)


def load_factors(first: float, rest: list[float]) -> np.ndarray:
    """Factors of sub 1, main 1, …, by the five linear relations of Živanović et al. (2007)."""
    sub = [0.026 * first + 0.0031, 0.074 * first + 0.0100, 0.012 * first + 0.0160,
           0.013 * first + 0.0093, 0.015 * first + 0.0072]
    return np.column_stack([sub, [first, *rest]]).ravel()


def truncated(mean: float, std: float, draw: float) -> float:
    return truncnorm.ppf(draw, -mean / std, np.inf, loc=mean, scale=std)


def factors_by_hand(f: float, *draws: float) -> np.ndarray:
    """Load factors from truncnorm at step frequency f, for one draw each."""
    laws = [(1, 0.16), (0.07, 0.03), (0.05, 0.02), (0.05, 0.02), (0.03, 0.015)]
    first, *rest = (truncated(mean, std, draw) for (mean, std), draw in zip(laws, draws, strict=True))
    return load_factors((-0.2649 * f**3 + 1.3206 * f**2 - 1.7597 * f + 0.7613) * first, rest)


def test_kerr_by_hand_and_clipped():
    # at 2 Hz: -2.1192 + 5.2824 - 3.5194 + 0.7613
    np.testing.assert_allclose(kerr_factor([2.0, 3.5]), [0.4051, 0.0], atol=1e-12)


@pytest.mark.parametrize("spacing", [0.25, 0.05, 0.01, 0.0025])
def test_every_line_exactly_once_in_half_open_windows(spacing):
    force = one(ZivanovicForce(spacing=spacing, scaling="variance"), 1.0)
    np.testing.assert_allclose(force.frequencies[0], np.arange(0.25, 5.25 - spacing / 2, spacing), rtol=1e-12)
    assert np.all(force.coefficients != 0)


def test_published_force_has_500_lines_and_505_draws():
    assert ZivanovicForce().n_draws == 505
    assert one(ZivanovicForce()).coefficients.shape == (1, 500)


def test_published_amplitudes_by_hand():
    force = one(ZivanovicForce(), 2.0, draw=0.5)
    factors = factors_by_hand(2.0, *[0.5] * 5)
    # main 1 at f = 1.00, which is line 100, and sub 2 at its lower boundary f = 1.25, which is line 125
    main = (0.7852 * math.exp(-((1 - 0.9999) / 0.008314) ** 2)
            + 0.0206 * math.exp(-((1 - 1.034) / 0.2524) ** 2)
            + 0.1074 * math.exp(-((1 - 1.001) / 0.03653) ** 2))
    sub = (0.3024 * math.exp(-((1.25 - 1.5) / 0.008735) ** 2)
           + 0.1345 * math.exp(-((1.25 - 1.532) / 0.7233) ** 2))
    amplitude = dict(zip(range(25, 525), abs(force.coefficients[0]), strict=True))
    assert amplitude[100] == pytest.approx(700 * factors[1] * main, rel=1e-12)
    assert amplitude[125] == pytest.approx(700 * factors[2] * sub, rel=1e-12)


PRINTED = {  # a b c of each Gaussian, copied by machine from a second transcription of the published tables
    "MAIN": """0.7852  0.9999  0.008314  0.0206  1.034  0.2524  0.1074  1.001  0.03653
0.5130  2.000  0.01105  0.1330  1.957  0.2632  -0.04984  1.882  0.05807
0.3908  3.000  0.009560  0.1567  3.000  0.05525  0.06866  2.957  0.5607
0.3255  4.000  0.008797  0.1647  4.001  0.06641  0.06888  3.991  0.3750
0.2806  4.999  0.007939  0.1584  5.004  0.07825  0.07289  4.987  0.4501""",
    "SUB": """0.3406  0.4988  0.008337  0.2803  1.133  0.6388
0.3024  1.500  0.008735  0.1345  1.532  0.7233
0.2627  2.500  0.009748  0.2456  0.2312  2.932
0.2344  3.501  0.009898  0.2355  -1.576  7.050
0.2645  4.499  0.01019  0.2389  1.153  4.561""",
}


@pytest.mark.parametrize("name", PRINTED)
def test_tables_are_the_printed_ones(name):
    printed = np.array([row.split() for row in PRINTED[name].splitlines()], dtype=float)
    np.testing.assert_array_equal(np.reshape(getattr(narrowband, name), printed.shape), printed)


def gaussians(f: np.ndarray, terms: tuple) -> np.ndarray:
    return sum(a * np.exp(-(((f - b) / c) ** 2)) for a, b, c in terms)


@pytest.mark.parametrize(("table", "shift", "least", "most"), [
    (narrowband.MAIN, 0.25, 1.03, 1.07),
    (narrowband.SUB, 0.75, 0.96, 1.22),
])
def test_sums_of_squares_of_the_tables(table, shift, least, most):
    # printed for 51 lines, both boundaries included
    windows = [i - shift + 0.01 * np.arange(51) for i in range(1, 6)]
    sums = [np.sum(gaussians(f, terms) ** 2) for f, terms in zip(windows, table, strict=True)]
    assert round(min(sums), 2) == least
    assert round(max(sums), 2) == most


def test_published_shapes_are_the_tables_over_half_open_windows():
    shapes = bundles(one(ZivanovicForce(), draw=0.5))[0] / (700 * factors_by_hand(2.0, *[0.5] * 5)[:, None])
    for i in range(1, 6):
        for row, table, shift in [(2 * i - 2, narrowband.SUB, 0.75), (2 * i - 1, narrowband.MAIN, 0.25)]:
            expected = gaussians(i - shift + 0.01 * np.arange(50), table[i - 1])
            np.testing.assert_allclose(shapes[row], expected, rtol=1e-10)


@pytest.mark.parametrize("spacing", [0.01, 0.05, 0.0025])
def test_variance_scaling_keeps_the_variance_of_every_harmonic(spacing):
    force = one(ZivanovicForce(spacing=spacing, scaling="variance"), 1.8, draw=0.7)
    variances = (700 * factors_by_hand(1.8, *[0.7] * 5)) ** 2 / 2
    np.testing.assert_allclose(np.sum(bundles(force)[0] ** 2, axis=1) / 2, variances, rtol=1e-11)  # Parseval
    n = round(12 / spacing)  # more than twice the highest line, over exactly one period
    times = np.arange(n) / n / (spacing * 1.8)
    assert np.mean(force.at(times) ** 2) == pytest.approx(np.sum(variances), rel=1e-11)


def test_record_repeats_after_100_steps_and_not_before():
    force = crowd(ZivanovicForce(), n=1)
    f_s = force.step_frequency[0]
    times = np.linspace(0, 5, 101)
    record = force.at(times)
    assert np.allclose(record, force.at(times + 100 / f_s), atol=1e-7)
    for steps in range(1, 100):
        assert np.max(abs(record - force.at(times + steps / f_s))) > 0.05 * np.max(abs(record))


def test_load_factors_have_truncated_normal_laws():
    model, n = ZivanovicForce(scaling="variance"), 4000
    draws = np.random.default_rng(3).random((n, model.n_draws))
    force = model.lines(np.full(n, 2.0), np.full(n, 1.0), draws)
    factors = np.sqrt(np.sum(bundles(force) ** 2, axis=2))
    laws = {1: (0.4051, 0.16 * 0.4051), 3: (0.07, 0.03), 5: (0.05, 0.02), 7: (0.05, 0.02), 9: (0.03, 0.015)}
    for bundle, (mean, std) in laws.items():
        law = truncnorm(-mean / std, np.inf, loc=mean, scale=std)
        assert kstest(factors[:, bundle], law.cdf).pvalue > 1e-3
        assert np.mean(factors[:, bundle]) == pytest.approx(law.mean(), abs=4 * law.std() / math.sqrt(n))
        assert np.std(factors[:, bundle]) == pytest.approx(law.std(), rel=4 / math.sqrt(2 * n))


def test_load_factors_are_finite_at_the_ends_of_the_draws():
    for draw in 0.0, np.nextafter(1.0, 0.0):
        assert np.all(np.isfinite(one(ZivanovicForce(), draw=draw).coefficients))
    assert np.all(bundles(one(ZivanovicForce(), draw=0.0))[:, 1::2] < 1e-5)  # truncated at zero


def test_zivanovic_factors_follow_one_by_one_from_their_draws():
    draws = np.full((1, 505), 0.5)
    draws[0, :5] = [0.1, 0.3, 0.5, 0.7, 0.9]
    force = ZivanovicForce(scaling="variance").lines([2.1], [1.0], draws)
    factors = np.sqrt(np.sum(bundles(force)[0] ** 2, axis=1))
    np.testing.assert_allclose(factors, factors_by_hand(2.1, 0.1, 0.3, 0.5, 0.7, 0.9), rtol=1e-9)


def test_zivanovic_phases_follow_the_draws_after_the_fifth():
    draws = np.random.default_rng(6).random((1, 505))
    angles = np.angle(ZivanovicForce().lines([2.0], [700.0], draws).coefficients)
    np.testing.assert_allclose(angles, 2 * np.pi * (draws[:, 5:] - 0.5), atol=1e-9)


@pytest.mark.parametrize(("spacing", "scaling"), [(0.01, "published"), (0.05, "variance"), (0.25, "variance")])
def test_main_harmonics_have_the_factors_and_phases_of_the_narrow_band_force(spacing, scaling):
    model, draws = ZivanovicForce(spacing=spacing, scaling=scaling), np.random.default_rng(7).random((4, 505))
    draws, W, f_s = draws[:, :model.n_draws], np.array([600.0, 700.0, 800.0, 900.0]), np.array([1.6, 1.8, 2.0, 2.2])
    narrow, force = (m.lines(f_s, W, draws) for m in (model, model.periodic()))
    mean, std = np.array([1.0, 0.07, 0.05, 0.05, 0.03]), np.array([0.16, 0.03, 0.02, 0.02, 0.015])
    factors = truncnorm.ppf(draws[:, :5], -mean / std, np.inf, loc=mean, scale=std)
    factors[:, 0] *= -0.2649 * f_s**3 + 1.3206 * f_s**2 - 1.7597 * f_s + 0.7613
    np.testing.assert_allclose(abs(force.coefficients), W[:, None] * factors, rtol=1e-9)
    np.testing.assert_allclose(force.frequencies, np.outer(f_s, [1, 2, 3, 4, 5]), rtol=1e-15)
    for i in range(5):     # the line of the narrow band at the same frequency
        centre = np.argmin(abs(narrow.frequencies[0] - (i + 1) * f_s[0]))
        np.testing.assert_allclose(narrow.frequencies[:, centre], (i + 1) * f_s, rtol=1e-12)
        np.testing.assert_allclose(np.angle(force.coefficients[:, i]), np.angle(narrow.coefficients[:, centre]))


@pytest.mark.parametrize("model", MODELS)
def test_the_periodic_force_of_the_same_draws_repeats_with_every_step(model):
    periodic = model.periodic()
    assert periodic.n_draws == model.n_draws
    assert periodic.periodic() == periodic
    times = np.arange(0.0, 0.5, 0.01)
    force = one(periodic, 2.0)
    np.testing.assert_allclose(force.at(times), force.at(times + 7 / 2.0), rtol=0, atol=1e-9)


# every model

@pytest.mark.parametrize("model", MODELS)
def test_rows_do_not_depend_on_the_others(model):
    rng = np.random.default_rng(4)
    f_s, W, draws = rng.uniform(1.5, 2.5, 9), rng.uniform(500, 900, 9), rng.random((9, model.n_draws))
    whole = model.lines(f_s, W, draws).coefficients
    for rows in slice(4), [5, 2, 8]:
        np.testing.assert_array_equal(model.lines(f_s[rows], W[rows], draws[rows]).coefficients, whole[rows])


@pytest.mark.parametrize("model", MODELS)
def test_same_draws_retuned_keep_phases_and_weight_scales(model):
    draws = np.random.default_rng(5).random((1, model.n_draws))
    slow, fast = (model.lines([f], [700.0], draws).coefficients for f in (1.7, 2.2))
    np.testing.assert_allclose(np.angle(slow), np.angle(fast), atol=1e-12)
    np.testing.assert_allclose(model.lines([1.7], [350.0], draws).coefficients, slow / 2, rtol=1e-12)


def test_retuning_moves_only_kerr_and_the_sub_harmonics():
    slow, fast = (bundles(one(ZivanovicForce(), f))[0] for f in (1.7, 2.2))
    np.testing.assert_allclose(slow[3::2], fast[3::2], rtol=1e-12)
    np.testing.assert_allclose(fast[1] / slow[1], float(kerr_factor(2.2) / kerr_factor(1.7)), rtol=1e-12)


@pytest.mark.parametrize("model", MODELS)
def test_frozen_and_comparable(model):
    assert len({model, model}) == 1
    with pytest.raises(AttributeError):
        setattr(model, fields(model)[0].name, None)


def test_the_interface_cannot_be_instantiated():
    with pytest.raises(TypeError, match="abstract"):
        WalkingForce()


# refusals

@pytest.mark.parametrize(("call", "message"), [
    (lambda: HarmonicForce([]), "at least one harmonic, got none; give"),
    (lambda: HarmonicForce([-0.1]), r"factors\[0\] must be at least 0, got -0.1; .*phase of pi"),
    (lambda: HarmonicForce([0.4], phases=[0.0, 0.0]), r"phases must have shape \(1,\), got \(2,\)"),
    (lambda: YoungForce(values="max"), "values must be one of 'mean', 'design', got 'max'"),
    (lambda: ZivanovicForce(spacing=0.03, scaling="variance"), "whole number of lines, got 0.03; give 0.03125"),
    (lambda: ZivanovicForce(spacing=0.5), r"spacing must lie in \(0, 0.25\], got 0.5"),
    (lambda: ZivanovicForce(spacing=0.005), "must be 0.01 .* got 0.005; give scaling='variance'"),
    (lambda: ZivanovicForce(scaling="none"), "scaling must be one of 'published', 'variance'"),
    (lambda: MainHarmonics(YoungForce()), "narrow_band must be of type ZivanovicForce, got YoungForce; use Ziva"),
    (lambda: one(YoungForce(), draw=1.0), r"draws\[0, 0\] must lie in \[0, 1\), got 1; draw"),
    (lambda: one(YoungForce(), draw=-0.1), r"draws\[0, 0\] must lie in \[0, 1\), got -0.1"),
    (lambda: one(YoungForce(), 0.0), r"step_frequency\[0\] must be above 0, got 0"),
    (lambda: one(YoungForce(), weight=-700.0), r"weight\[0\] must be above 0, got -700; give N"),
    (lambda: YoungForce().lines([2.0], [700.0], [[0.5] * 3]), r"\(1, 4\), got \(1, 3\); give n_draws"),
    (lambda: YoungForce().lines([2.0], [700.0, 1.0], [[0.5] * 4]), r"weight must have shape \(1,\)"),
    (lambda: YoungForce().lines(2.0, [700.0], [[0.5] * 4]), r"step_frequency must have 1 dimension"),
    (lambda: kerr_factor(-1.0), "step_frequency must be above 0, got -1; give Hz"),
    (lambda: comb(first=0), "first must be at least 1, got 0; leave the static weight out"),
    (lambda: comb(first=1.5), "first must be a whole number, got 1.5"),
    (lambda: comb(spacing=0.0), "spacing must be above 0, got 0; give a fraction"),
    (lambda: comb(coefficients=[1.0, 2.0]), r"coefficients must be .* of shape \(2,\); give one row"),
    (lambda: comb(coefficients=[[np.nan]]), "coefficients must be finite, got nan or inf; give N"),
    (lambda: comb(step_frequency=[2.0, 2.0]), r"step_frequency must have shape \(1,\), got \(2,\)"),
    (lambda: comb().at(0.0), r"times must have 1 dimension\(s\), got shape \(\)"),
    (lambda: comb().on_grid([np.nan], 3, 0.01), r"start\[0\] must be finite, got nan; give s"),
    (lambda: comb().on_grid([0, 1], 3, 0.01), r"start must have shape \(1,\), got \(2,\)"),
    (lambda: comb().on_grid([0], -1, 0.01), "count must be at least 0, got -1"),
    (lambda: comb().on_grid([0], 3, 0.0), "step must be above 0, got 0; give s"),
])
def test_refusals(call, message):
    with pytest.raises((TypeError, ValueError), match=message):
        call()


# parts

def test_the_narrow_band_by_its_printed_formulas():
    """Amplitude W DLF D̄(f) of the line at the middle of main 1 and of sub 2, with median load factors."""
    force = one(ZivanovicForce(), f_s=1.8, weight=700.0, draw=0.5)
    amplitude = dict(zip(force.indices * 0.01, np.abs(force.coefficients[0]), strict=True))
    kerr = -0.2649 * 1.8**3 + 1.3206 * 1.8**2 - 1.7597 * 1.8 + 0.7613
    main = (0.7852 * np.exp(-((1 - 0.9999) / 0.008314)**2) + 0.0206 * np.exp(-((1 - 1.034) / 0.2524)**2)
            + 0.1074 * np.exp(-((1 - 1.001) / 0.03653)**2))
    sub = 0.3024 * np.exp(-((1.5 - 1.5) / 0.008735)**2) + 0.1345 * np.exp(-((1.5 - 1.532) / 0.7233)**2)
    assert amplitude[1.0] == pytest.approx(700 * kerr * main, rel=1e-9)
    assert amplitude[1.5] == pytest.approx(700 * (0.074 * kerr + 0.0100) * sub, rel=1e-9)


@pytest.mark.parametrize("f_s", [1.0, 2.0])
def test_parts_refuse_frequencies_of_others(f_s):
    with pytest.raises(ValueError, match=r"step_frequency must have shape \(1,\), got \(2,\); give one per walker"):
        YoungForce().parts([700.0], np.full((1, 4), 0.5)).at([f_s, f_s])

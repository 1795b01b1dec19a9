"""Truth: scipy's intervals, exact percentiles of known distributions, a twin of the rule that must fail."""

import io
import itertools
import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import FrozenInstanceError, dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from hsictrl.study import (
    AllRules,
    Judgement,
    MeanRule,
    PercentileRule,
    StopRule,
    monte_carlo,
    trial_rng,
)

SPREAD = 0.2
TRUE_95 = stats.lognorm(SPREAD).ppf(0.95)
FINITE = st.floats(-1e6, 1e6)


def lognormal(rng: np.random.Generator) -> float:
    return rng.lognormal(sigma=SPREAD)


def pair(rng: np.random.Generator) -> np.ndarray:
    return rng.normal([1.0, 5.0], [0.1, 0.3])


def fails_at_17(rng: np.random.Generator) -> float:
    value = rng.random()
    if value == trial_rng(1, 17).random():
        raise ZeroDivisionError("the deck is gone")
    return value


@dataclass(frozen=True)
class HalvedRule(StopRule):
    """The percentile rule broken on purpose: both ends of its interval come half way to the estimate."""

    labels = ("percentile 95",)
    least_trials = 72

    def judge(self, samples):
        judged = PercentileRule().judge(samples)
        low, high = (0.5 * (end + judged.estimate) for end in judged.interval)
        converged = max(high - judged.estimate, judged.estimate - low) <= 0.05 * judged.estimate
        return Judgement(
            estimate=judged.estimate, interval=(low, high), converged=converged, reason="broken on purpose"
        )


def coverage(rule: StopRule, repeats: int = 200) -> float:
    ensembles = (monte_carlo(lognormal, rule=rule, seed=seed) for seed in range(repeats))
    return np.mean([e.converged and e.interval[0] <= TRUE_95 <= e.interval[1] for e in ensembles])


def test_stopped_interval_covers_the_true_percentile() -> None:
    assert coverage(PercentileRule()) >= 0.90


def test_twin_with_half_the_interval_does_not_cover() -> None:
    assert coverage(HalvedRule()) < 0.90


@pytest.mark.parametrize("percentile", [5.0, 50.0, 95.0])
@pytest.mark.parametrize("confidence", [0.9, 0.95])
@pytest.mark.parametrize("n", [80, 500])
def test_percentile_interval_is_that_of_scipy(percentile: float, confidence: float, n: int) -> None:
    samples = trial_rng(1, n).rayleigh(size=n)
    judgement = PercentileRule(percentile=percentile, confidence=confidence).judge(samples)
    test = stats.quantile_test(samples, p=percentile / 100)
    assert judgement.interval == tuple(test.confidence_interval(confidence_level=confidence))


def test_percentile_estimate_is_that_of_matlab() -> None:
    # Matlab's documentation: the sorted samples are the 100 (i - 0.5)/n percentiles, linear between them
    assert PercentileRule(percentile=50).judge([3, 1, 4, 2, 5]).estimate == 3
    assert PercentileRule(percentile=80).judge([3, 1, 4, 2, 5]).estimate == 4.5


@pytest.mark.parametrize(("percentile", "confidence"), [(95.0, 0.95), (5.0, 0.95), (50.0, 0.95), (99.0, 0.9)])
def test_interval_exists_from_least_trials_on(percentile: float, confidence: float) -> None:
    rule = PercentileRule(percentile=percentile, confidence=confidence)
    for n, exists in [(rule.least_trials - 1, False), (rule.least_trials, True)]:
        test = stats.quantile_test(np.arange(n), p=percentile / 100)
        assert np.all(np.isfinite(test.confidence_interval(confidence_level=confidence))) == exists
        assert ("exists below" in rule.judge(np.arange(n)).reason) != exists


def test_below_72_trials_says_so() -> None:
    judgement = PercentileRule().judge(np.linspace(1.0, 1.01, 50))
    assert judgement.reason == "no 95 % interval of percentile 95 exists below 72 trials; got 50"
    assert not judgement.converged
    assert np.isnan(judgement.interval[1])


@pytest.mark.parametrize("sign", [1, -1])
def test_tolerance_is_a_fraction_of_the_estimate(sign: int) -> None:
    samples = sign * np.linspace(0.9, 1.1, 101)
    judged = PercentileRule(percentile=50).judge(samples)
    reach = max(abs(end - judged.estimate) for end in judged.interval) / abs(judged.estimate)
    assert PercentileRule(percentile=50, tolerance=reach * 1.001).judge(samples).converged
    assert not PercentileRule(percentile=50, tolerance=reach * 0.999).judge(samples).converged


def test_one_far_end_is_enough_to_go_on() -> None:
    samples = np.append(np.ones(99), 9.0)
    assert PercentileRule().judge(samples).interval == (1.0, 9.0)
    assert not PercentileRule().judge(samples).converged
    assert not PercentileRule(percentile=5).judge(20 - samples).converged


def test_mean_interval_is_students() -> None:
    samples = np.array([0.9, 1.0, 1.2, 1.3])
    reach = 3.182446 * np.sqrt((0.04 + 0.01 + 0.01 + 0.04) / 3) / 2  # t of 3 degrees of freedom, from tables
    judgement = MeanRule().judge(samples)
    assert judgement.estimate == pytest.approx(1.1)
    assert judgement.interval == pytest.approx((1.1 - reach, 1.1 + reach), rel=1e-6)


def test_mean_of_one_sample_has_no_interval() -> None:
    judgement = MeanRule().judge([1.0])
    assert (judgement.estimate, judgement.converged) == (1.0, False)
    assert judgement.reason == "no 95 % interval of mean exists below 2 trials; got 1"


def test_all_rules_need_the_trials_of_the_neediest() -> None:
    assert AllRules([MeanRule(), PercentileRule()]).least_trials == 72


def test_all_rules_wait_for_every_member() -> None:
    members = [MeanRule(tolerance=0.2), PercentileRule(percentile=95, tolerance=0.01)]
    samples = trial_rng(1, 0).normal(1.0, 0.3, size=200)
    judgement = AllRules(members).judge(samples)
    alone = [rule.judge(samples) for rule in members]
    assert [each.converged for each in alone] == [True, False]
    assert not judgement.converged
    assert judgement.reason == alone[1].reason
    assert list(judgement.estimate) == [each.estimate for each in alone]
    assert list(zip(*judgement.interval, strict=True)) == [each.interval for each in alone]


@given(st.lists(FINITE, min_size=72, max_size=300), st.floats(0.5, 0.99), st.floats(5, 95))
def test_estimate_lies_within_its_interval(samples: list[float], level: float, percentile: float) -> None:
    for rule in (PercentileRule(percentile=percentile, confidence=level), MeanRule(confidence=level)):
        judgement = rule.judge(samples)
        assert not judgement.estimate < judgement.interval[0]
        assert not judgement.estimate > judgement.interval[1]


def test_samples_come_in_index_order_and_each_can_be_rebuilt_alone() -> None:
    ensemble = monte_carlo(lognormal, seed=4)
    assert [lognormal(trial_rng(4, i)) for i in range(ensemble.n_trials)] == list(ensemble.samples)


def test_trials_are_spawned_as_numpy_spawns() -> None:
    children = np.random.SeedSequence(4).spawn(3)
    spawned = [np.random.default_rng(child).random() for child in children]
    assert [trial_rng(4, i).random() for i in range(3)] == spawned


def test_rule_looks_first_at_a_hundred_then_at_a_quarter_more() -> None:
    looks = []

    @dataclass(frozen=True)
    class Watcher(StopRule):
        labels = ("count",)
        least_trials = 1

        def judge(self, samples):
            looks.append(len(samples))
            return Judgement(estimate=0.0, interval=(0.0, 0.0), converged=False, reason="never")

    monte_carlo(lognormal, rule=Watcher(), max_trials=400)
    assert looks == [100, 150, 200, 250, 312, 390, 400]


def test_first_look_waits_until_the_interval_exists() -> None:
    constant = monte_carlo(lambda rng: 1.0, rule=PercentileRule(percentile=99))
    assert constant.n_trials == constant.rule.least_trials == 368
    assert constant.converged


def test_not_converged_keeps_its_samples_and_says_so() -> None:
    ensemble = monte_carlo(lambda rng: rng.standard_cauchy(), max_trials=150)
    assert (ensemble.converged, ensemble.n_trials) == (False, 150)
    assert ensemble.reason.startswith("stopped at max_trials=150: the 95 % interval of percentile 95 leaves")
    assert str(ensemble).endswith("150 trials, not converged")


def test_fewer_trials_than_an_interval_needs() -> None:
    ensemble = monte_carlo(lognormal, max_trials=50)
    assert (ensemble.n_trials, ensemble.history().trials.tolist()) == (50, [50])
    assert ensemble.reason.endswith("exists below 72 trials; got 50")


@pytest.mark.parametrize("pool", ["threads", "processes"])
def test_any_executor_gives_the_same_digits(pool: str) -> None:
    executor = (
        ThreadPoolExecutor(2) if pool == "threads"
        else ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn"))
    )
    with executor:
        spread_out = monte_carlo(lognormal, seed=2, executor=executor)
    alone = monte_carlo(lognormal, seed=2)
    assert spread_out.samples.tobytes() == alone.samples.tobytes()
    assert (spread_out.estimate, spread_out.interval) == (alone.estimate, alone.interval)


def test_every_quantity_of_a_vector_trial_must_settle() -> None:
    both = monte_carlo(pair, rule=MeanRule(tolerance=0.01), seed=3)
    first = monte_carlo(lambda rng: pair(rng)[0], rule=MeanRule(tolerance=0.01), seed=3)
    second = monte_carlo(lambda rng: pair(rng)[1], rule=MeanRule(tolerance=0.01), seed=3)
    assert both.n_trials == max(first.n_trials, second.n_trials) > min(first.n_trials, second.n_trials)
    assert both.estimate[0] == first.estimate
    assert both.estimate == pytest.approx(both.samples.mean(axis=0))


def test_figure_4_statistics_of_two_quantities() -> None:
    rule = AllRules([MeanRule(), PercentileRule(percentile=5), PercentileRule(percentile=95)])
    ensemble = monte_carlo(pair, rule=rule)
    expected = [[np.mean(x), *np.quantile(x, [0.05, 0.95], method="hazen")] for x in ensemble.samples.T]
    assert ensemble.estimate == pytest.approx(np.array(expected))
    assert ensemble.interval[0].shape == ensemble.interval[1].shape == (2, 3)
    assert ensemble.history().estimate.shape[1:] == (2, 3)
    assert "percentile 5 of quantity 1 = " in str(ensemble)


def test_history_ends_at_the_ensemble_and_repeats_the_rule() -> None:
    ensemble = monte_carlo(lognormal)
    history = ensemble.history()
    assert (history.trials[0], history.trials[-1]) == (72, ensemble.n_trials)
    assert history.estimate[-1] == ensemble.estimate
    assert (history.low[-1], history.high[-1]) == ensemble.interval
    assert history.low[0] == PercentileRule().judge(ensemble.samples[:72]).interval[0]
    assert np.all(np.diff(history.trials) > 0)


def test_results_are_frozen() -> None:
    ensemble = monte_carlo(pair, rule=MeanRule())
    with pytest.raises(FrozenInstanceError):
        ensemble.seed = 2
    for array in (ensemble.samples, ensemble.estimate, *ensemble.interval, ensemble.history().trials):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_progress_counts_the_trials_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    ensemble = monte_carlo(lognormal, label="crossings")
    assert "crossings" in sys.stderr.getvalue()
    assert str(ensemble.n_trials) in sys.stderr.getvalue()


@pytest.mark.parametrize("variable", ["FORCE_COLOR", "NOTHING"])
def test_progress_is_silent_elsewhere(
    variable: str, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv(variable, "1")
    monte_carlo(lognormal)
    assert capfd.readouterr() == ("", "")


def test_failing_trial_names_itself_and_how_to_rerun_it() -> None:
    message = r"^trial 17 of seed 1 failed: ZeroDivisionError: the deck is gone; .*trial_rng\(1, 17\)\)"
    with pytest.raises(RuntimeError, match=message) as caught:
        monte_carlo(fails_at_17)
    assert isinstance(caught.value.__cause__, ZeroDivisionError)


def test_failing_trial_names_itself_from_a_worker() -> None:
    with (
        ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as executor,
        pytest.raises(RuntimeError, match=r"^trial 17 of seed 1 failed: .*trial_rng\(1, 17\)") as caught,
    ):
        monte_carlo(fails_at_17, executor=executor)
    assert "ZeroDivisionError: the deck is gone" in str(caught.value.__cause__)


def returns(*values):
    endless = itertools.chain(values, itertools.repeat(values[-1]))
    return lambda rng: next(endless)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: monte_carlo(returns(1.0, np.nan)), ValueError,
         r"trial 1 of seed 1 must be finite, got nan; rerun it alone with trial\(trial_rng\(1, 1\)\)"),
        (lambda: monte_carlo(returns([1.0, np.inf])), ValueError, r"trial 0 of seed 1\[1\] must .*got inf"),
        (lambda: monte_carlo(returns(1.0, "two")), TypeError, r"trial 1 .*must be real numbers, got 'two'"),
        (lambda: monte_carlo(returns(None)), TypeError, r"trial 0 .*must be real numbers, got None"),
        (lambda: monte_carlo(returns([1.0, 2.0], [1.0])), ValueError, r"trial 1 .*shape \(1,\) after \(2,\)"),
        (lambda: monte_carlo(returns(np.ones((2, 2)))), ValueError, r"trial 0 .*shape \(2, 2\).*; return"),
        (lambda: monte_carlo(returns([])), ValueError, r"trial 0 must be one number, .*shape \(0,\)"),
        (lambda: monte_carlo(3.0), TypeError, r"trial must be callable, got 3.0; give a function"),
        (lambda: monte_carlo(lognormal, rule=0.95), TypeError, r"rule must be of type StopRule, got float; give"),
        (lambda: monte_carlo(lognormal, rule=MeanRule), TypeError, r"rule must be of type StopRule, got ABCMeta"),
        (lambda: monte_carlo(lognormal, seed=-1), ValueError, r"seed must be at least 0, got -1; give 0, 1, 2"),
        (lambda: monte_carlo(lognormal, seed=1.5), TypeError, r"seed must be a whole number, got 1.5"),
        (lambda: monte_carlo(lognormal, max_trials=0), ValueError, r"max_trials must be at least 1, got 0"),
        (lambda: monte_carlo(lognormal, executor=2), TypeError,
         r"executor must be of type Executor, got int; .*None to run"),
        (lambda: trial_rng(1, -1), ValueError, r"index must be at least 0, got -1; count trials from 0"),
        (lambda: PercentileRule(percentile=100), ValueError, r"percentile must lie in \[1, 100\), got 100"),
        (lambda: PercentileRule(tolerance=5), ValueError, r"tolerance must lie in \(0, 1\), got 5; .*frac"),
        (lambda: MeanRule(confidence=95), ValueError, r"confidence must lie in \[0.5, 1\), got 95; .*perc"),
        (lambda: MeanRule().judge([]), ValueError, r"number of samples must be at least 1, got 0"),
        (lambda: MeanRule().judge([1.0, np.nan]), ValueError, r"samples\[1\] must be finite, got nan"),
        (lambda: AllRules([]), ValueError, r"number of rules must be at least 1, got 0"),
        (lambda: AllRules(MeanRule()), TypeError, r"rules must be of type Sequence, got MeanRule; give a list"),
        (lambda: AllRules([0.95]), TypeError, r"each rule must be of type StopRule, got float"),
        (lambda: AllRules([AllRules([MeanRule()])]), TypeError, r"each rule must be a single one, .*list"),
        (lambda: StopRule(), TypeError, r"abstract"),
    ],
)
def test_refusals_say_rule_value_and_remedy(call, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        call()

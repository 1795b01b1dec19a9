"""Truth: percentiles of the Rayleigh distribution, each cell run alone, scipy's bootstrap, what netCDF gives back."""

import io
import multiprocessing
import sys
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import FrozenInstanceError, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy import stats

import hsictrl as hsi
from hsictrl.study import AllRules, Ledger, MeanRule, PercentileRule, TrialError, monte_carlo, sweep, trial_rng
from hsictrl.study.ratios import ratios

RAYLEIGH_95 = np.sqrt(-2 * np.log(0.05))
SCALES, SHAPES, MODELS, FACTORS = [1.0, 2.0], ["sharp", "flat"], ["MF", "PMC"], [1, 2, 4]
ROUGH = PercentileRule(tolerance=0.2)
NEVER = MeanRule(tolerance=1e-9)


@dataclass(frozen=True)
class Peak:
    """A Rayleigh number, squared where the shape is flat; one per model and factor if asked for."""

    scale: float
    shape: str = "sharp"
    rows: bool = False

    def __call__(self, rng: np.random.Generator) -> Any:
        peak = self.scale * rng.rayleigh() ** (2 if self.shape == "flat" else 1)
        return (peak * rng.uniform(0.5, 1.0, size=(2, 1)) * np.array([FACTORS])).ravel() if self.rows else peak


@dataclass(frozen=True)
class Counted:
    """Leaves a line per trial in a file, and is interrupted once at trial 60 of the second cell."""

    path: Path
    scale: float

    def __call__(self, rng: np.random.Generator) -> float:
        value = self.scale * rng.rayleigh()
        flag = self.path.with_suffix(".flag")
        if value == 2 * trial_rng(1, 60).rayleigh() and not flag.exists():
            flag.touch()
            raise KeyboardInterrupt
        with self.path.open("a") as file:
            file.write(f"{self.scale} {value!r}\n")
        return value


def rows(**point: Any) -> Peak:
    return Peak(**point, rows=True)


def table(**changed: Any) -> hsi.Sweep:
    return sweep(**{"make": rows, "axes": {"scale": SCALES, "shape": SHAPES}, "rule": ROUGH,
                    "shared": {"model": MODELS, "factor": FACTORS}, "name": "a95",
                    "units": {"a95": "m/s²", "scale": "s"}} | changed)


@pytest.fixture(scope="module")
def found() -> hsi.Sweep:
    return table()


def same(one: hsi.Sweep, other: hsi.Sweep) -> bool:
    return all(a.samples.tobytes() == b.samples.tobytes() and np.array_equal(a.estimate, b.estimate)
               and np.array_equal(a.interval, b.interval)
               for a, b in zip(one.ensembles, other.ensembles, strict=True))


def test_intervals_hold_the_percentiles_of_rayleigh() -> None:
    study = sweep(Peak, {"scale": [1.0, 2.0, 5.0], "shape": SHAPES})
    truth = np.outer([1.0, 2.0, 5.0], [RAYLEIGH_95, RAYLEIGH_95 ** 2])
    assert np.all((study.low < truth) & (truth < study.high))
    assert study.estimate == pytest.approx(truth, rel=0.05)
    assert np.all(study.converged)


def test_cells_draw_the_same_numbers() -> None:
    study = sweep(Peak, {"scale": SCALES})
    assert np.array_equal(study.ensembles[1].samples, 2 * study.ensembles[0].samples)
    assert study.estimate[1] == 2 * study.estimate[0]


def test_each_cell_is_its_study_alone(found: hsi.Sweep) -> None:
    for place, (i, k) in enumerate(np.ndindex(2, 2)):
        alone = monte_carlo(rows(scale=SCALES[i], shape=SHAPES[k]), rule=ROUGH)
        assert found.ensembles[place].samples.tobytes() == alone.samples.tobytes()
        assert np.array_equal(found.estimate[i, k].ravel(), alone.estimate)
        assert np.array_equal(found.low[i, k].ravel(), alone.interval[0])
        assert np.array_equal(found.high[i, k].ravel(), alone.interval[1])
        assert (found.trials[i, k], found.converged[i, k]) == (alone.n_trials, alone.converged)


def test_axes_are_those_of_the_cells_and_then_the_shared_ones(found: hsi.Sweep) -> None:
    assert list(found.axes) == ["scale", "shape", "model", "factor"]
    assert found.estimate.shape == found.low.shape == found.high.shape == (2, 2, 2, 3)
    assert found.trials.shape == found.converged.shape == (2, 2)
    # the factor multiplies what the trial drew, and so does the scale
    assert np.all(found.estimate[..., 2] == 4 * found.estimate[..., 0])
    assert np.all(found.estimate[1, 0, :, 2] == 8 * found.estimate[0, 0, :, 0])


def test_a_cell_that_does_not_settle_is_left(found: hsi.Sweep) -> None:
    study = table(rule=PercentileRule(tolerance=1e-6), max_trials=120)
    assert not study.converged.any()
    assert np.all(study.trials == 120)
    assert found.converged.all()


def test_mean_rule_gives_means() -> None:
    study = sweep(Peak, {"scale": SCALES}, rule=MeanRule())
    assert study.estimate[0] == pytest.approx(np.sqrt(np.pi / 2), rel=0.05)


def test_axes_may_be_ranges_and_arrays() -> None:
    study = table(axes={"scale": np.array([1, 2]), "shape": np.array(SHAPES)},
                  shared={"model": tuple(MODELS), "factor": range(1, 4)})
    assert study.axes == {"scale": (1, 2), "shape": ("sharp", "flat"), "model": ("MF", "PMC"), "factor": (1, 2, 3)}
    assert type(study.axes["scale"][0]) is int


def test_two_processes_give_the_same_bits(found: hsi.Sweep) -> None:
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as executor:
        assert same(table(executor=executor), found)


def test_an_interrupted_sweep_goes_on_and_runs_no_trial_twice(tmp_path: Path) -> None:
    counts, book = tmp_path / "counts", Ledger(tmp_path / "sweep.ledger")
    run = partial(sweep, partial(Counted, counts), {"scale": [1, 2, 3.5]}, rule=NEVER, max_trials=120, label="maps")
    with pytest.raises(KeyboardInterrupt):
        run(ledger=book)
    assert book.trials() == {"maps, scale=1": 120, "maps, scale=2": 60}
    resumed = run(ledger=book)
    assert book.trials() == {"maps, scale=1": 120, "maps, scale=2": 120, "maps, scale=3.5": 120}
    lines = Counter(counts.read_text().splitlines())
    assert (len(lines), set(lines.values())) == (360, {1})
    assert same(resumed, run())


def test_a_label_tells_all_values_of_its_cell(tmp_path: Path) -> None:
    book = Ledger(tmp_path / "sweep.ledger")
    axes = {"density": [0.5], "f_b": [2.0]}
    sweep(lambda density, f_b: Peak(density * f_b), axes, rule=ROUGH, label="maps", ledger=book)
    assert list(book.trials()) == ["maps, density=0.5, f_b=2"]


def test_ratio_of_scaled_copies_is_exact(found: hsi.Sweep) -> None:
    double = found.ratio("factor", 4, 2)
    assert list(double.axes) == ["scale", "shape", "model"]
    assert np.all([double.estimate == 2, double.low == 2, double.high == 2])
    assert double.estimate.shape == (2, 2, 2)


def test_ratio_is_the_bootstrap_of_scipy(found: hsi.Sweep) -> None:
    def quotient(top: np.ndarray, bottom: np.ndarray, axis: int) -> np.ndarray:
        return np.divide(*(np.quantile(samples, 0.95, axis=axis, method="hazen") for samples in (top, bottom)))

    over = found.ratio("model", "PMC", "MF").at({"factor": 2, "shape": "flat"})
    for k, ensemble in enumerate(found.ensembles[1::2]):
        pair = ensemble.samples.reshape(-1, 2, 3)[:, :, 1].T
        expected = stats.bootstrap(pair[::-1], quotient, paired=True, n_resamples=2000, batch=250,
                                   method="percentile", rng=np.random.default_rng(1)).confidence_interval
        assert over.estimate[k] == quotient(pair[1], pair[0], -1)
        # scipy takes the two ends by a quantile of its own, which rounds its last digit in another way
        assert (over.low[k], over.high[k]) == pytest.approx(tuple(expected), rel=1e-15)


@pytest.mark.parametrize("percentile", [1.0, 5.0, 50.0, 99.0])
@pytest.mark.parametrize("n", [1, 2, 7, 80])
def test_ratio_of_any_percentile_and_number(percentile: float, n: int) -> None:
    samples = np.random.default_rng(n).rayleigh(size=(n, 2)).round(1) + 0.1    # with ties
    rows = np.random.default_rng(1).integers(0, n, (2000, n))
    resampled = np.quantile(samples[rows], percentile / 100, axis=1, method="hazen")
    expected = np.percentile(resampled[:, 0] / resampled[:, 1], [2.5, 97.5])
    estimate, *ends = ratios(PercentileRule(percentile=percentile), samples[:, :1], samples[:, 1:])
    assert np.ravel(ends) == pytest.approx(expected, rel=1e-14)
    assert estimate == np.divide(*np.quantile(samples, percentile / 100, axis=0, method="hazen"))


@pytest.fixture(scope="module")
def dependent() -> hsi.study.Estimates:
    """Ratios of the 95th percentiles of two dependent lognormals, 200 times anew."""
    spreads, repeats = np.array([[0.3], [0.2]]), range(200)

    def make(n: int) -> Any:
        return lambda rng: np.exp(spreads * (rng.normal(size=(1, n)) + rng.normal(size=(2, n))) / np.sqrt(2)).ravel()

    shared = {"model": ["A", "B"], "repeat": repeats}
    return sweep(make, {"n": [len(repeats)]}, shared=shared, rule=ROUGH, max_trials=200).ratio("model", "A", "B")


def coverage(over: hsi.study.Estimates, share: float) -> float:
    """How many of the intervals, their halves shrunk to a share, hold the true ratio."""
    truth = np.exp((0.3 - 0.2) * stats.norm.ppf(0.95))
    low, high = (over.estimate + share * (end - over.estimate) for end in (over.low, over.high))
    return float(np.mean((low <= truth) & (truth <= high)))


def test_ratio_covers(dependent: hsi.study.Estimates) -> None:
    assert coverage(dependent, 1.0) >= 0.90


def test_twin_with_half_the_interval_of_the_ratio_does_not_cover(dependent: hsi.study.Estimates) -> None:
    assert coverage(dependent, 0.5) < 0.85


def test_hundreds_of_ratios_take_seconds() -> None:
    pairs = np.random.default_rng(1).rayleigh(size=(2, 400, 96))
    start = time.perf_counter()
    ratios(PercentileRule(), *pairs)
    assert time.perf_counter() - start < 15


def test_at_picks_values_by_name(found: hsi.Sweep) -> None:
    some = found.at({"scale": 2, "factor": 4})
    assert some.axes == {"shape": ("sharp", "flat"), "model": ("MF", "PMC")}
    for name in ("estimate", "low", "high"):
        assert np.array_equal(getattr(some, name), getattr(found, name)[1, :, :, 2])
    assert some.at({"shape": "flat", "model": "PMC"}).estimate == found.estimate[1, 1, 1, 2]


def test_dataset_comes_back_from_a_file(found: hsi.Sweep, tmp_path: Path) -> None:
    data = found.to_xarray()
    data.to_netcdf(tmp_path / "sweep.nc")
    back = xr.load_dataset(tmp_path / "sweep.nc")
    assert set(back.sizes.items()) == {("scale", 2), ("shape", 2), ("model", 2), ("factor", 3)}
    for name, values in {"a95": found.estimate, "a95_low": found.low, "a95_high": found.high}.items():
        assert np.array_equal(back[name], values)
        assert (back[name].dims, back[name].attrs) == (("scale", "shape", "model", "factor"), {"units": "m/s²"})
    assert np.array_equal(back["trials"], found.trials)
    assert np.array_equal(back["converged"], found.converged)
    assert (back["converged"].dtype, back["converged"].dims) == (bool, ("scale", "shape"))
    assert [back[name].values.tolist() for name in found.axes] == [SCALES, SHAPES, MODELS, FACTORS]
    assert (back["scale"].attrs, back["shape"].attrs) == ({"units": "s"}, {})
    assert back.attrs == {"seed": 1, "rule": repr(ROUGH), "hsictrl": hsi.__version__} == data.attrs
    xr.testing.assert_identical(back, data)


def test_ends_that_do_not_exist_come_back_as_nan(tmp_path: Path) -> None:
    sweep(Peak, {"scale": SCALES}, max_trials=10).to_xarray().to_netcdf(tmp_path / "sweep.nc")
    back = xr.load_dataset(tmp_path / "sweep.nc")
    assert np.all(np.isnan(back["estimate_high"]))
    assert not back["converged"].any()


def test_missing_xarray_is_told(found: hsi.Sweep, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ImportError, match=r"must find xarray, got none; pip install 'hsictrl\[data\]'"):
        found.to_xarray()


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_one_display_shows_the_cells_and_the_trials_of_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.setattr(sys, "stderr", Terminal())
    sweep(Peak, {"scale": SCALES}, label="maps")
    lines = sys.stderr.getvalue().replace("\r", "\n").splitlines()
    cells, trials = (next(k for k, line in enumerate(lines) if all(word in line for word in words))
                     for words in [("maps ", "1/2"), ("maps, scale=2", "0/?")])
    assert trials == cells + 1
    assert not any("maps, scale=1 " in line for line in lines[cells:])      # gone when its cell has settled


def test_nothing_is_drawn_elsewhere(capfd: pytest.CaptureFixture[str]) -> None:
    sweep(Peak, {"scale": SCALES})
    assert capfd.readouterr() == ("", "")


def test_display_is_closed_after_a_failure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", Terminal())
    for _ in range(2):
        with pytest.raises(TrialError):
            sweep(lambda k: lambda rng: 1 / (k - k), {"k": [1]})


def test_results_are_frozen(found: hsi.Sweep) -> None:
    with pytest.raises(FrozenInstanceError):
        found.seed = 2
    with pytest.raises(ValueError, match="read-only"):
        found.ratio("model", "PMC", "MF").low[0] = 1


def test_failing_trial_names_its_cell() -> None:
    with pytest.raises(TrialError, match="trial 0 of seed 1 failed: ZeroDivisionError") as caught:
        sweep(lambda k: lambda rng: 1 / (k - 2), {"k": [1, 2]}, rule=ROUGH)
    assert caught.value.__notes__ == ["in the cell 'sweep, k=2'"]


@pytest.mark.parametrize(("shared", "expected"), [(None, r"\(\)"), ({"a": [1, 2], "b": ["x", "y"]}, r"\(4,\)")])
def test_wrong_number_of_values_is_refused(shared: Any, expected: str) -> None:
    message = (rf"^result of trial 0 of 'sweep, k=1' must have shape {expected}, got \(3,\); "
               "return a row of one number for every combination of the shared axes")
    with pytest.raises(ValueError, match=message):
        sweep(lambda k: lambda rng: rng.normal(size=3), {"k": [1]}, shared=shared)


def test_rows_that_are_not_raveled_are_refused() -> None:
    with pytest.raises(ValueError, match=r"must have shape \(4,\), got \(2, 2\)"):
        sweep(lambda k: lambda rng: rng.normal(size=(2, 2)), {"k": [1]}, shared={"a": [1, 2], "b": [1, 2]})


@pytest.mark.parametrize(("changed", "error", "message"), [
    ({"make": 3}, TypeError, "make must be callable, got 3; give a function of one value per axis"),
    ({"make": lambda scale: 3}, TypeError, "what make returns for 'sweep, scale=1' must be callable, got 3; give a f"),
    ({"axes": {}}, ValueError, "axes must hold at least one axis, got none; give a dict"),
    ({"axes": [1, 2]}, TypeError, "axes must be of type Mapping, got list; give a dict of names and their values"),
    ({"shared": {}}, ValueError, "shared must hold at least one axis, got none; give a dict"),
    ({"axes": {"scale": []}}, ValueError, r"axes\['scale'\] must hold at least 1 number\(s\), got 0; give a list"),
    ({"axes": {"scale": 1.0}}, ValueError, r"axes\['scale'\] must have 1 dimension\(s\), got shape \(\); give a list"),
    ({"axes": {"scale": "abc"}}, TypeError, r"axes\['scale'\] must be real numbers, got 'abc'; give a list of numbers"),
    ({"axes": {"scale": ["a", 1]}}, TypeError, r"axes\['scale'\] must be real numbers, got \['a', 1\]; give a list"),
    ({"axes": {"scale": [True]}}, TypeError, r"axes\['scale'\] must be real numbers, got \[True\]; give a list"),
    ({"axes": {"scale": [1, np.nan]}}, ValueError, r"axes\['scale'\]\[1\] must be finite, got nan; give a list"),
    ({"axes": {"scale": [1, 2, 1.0]}}, ValueError, r"axes\['scale'\] must hold each value once, got 1.0 twice; leave"),
    ({"shared": {"m": ["A", "A"]}}, ValueError, r"shared\['m'\] must hold each value once, got 'A' twice; leave one"),
    ({"shared": {"scale": [1]}}, ValueError, "must differ in name, got 'scale' twice; rename one"),
    ({"name": "scale"}, ValueError, "must differ in name, got 'scale' twice; rename one"),
    ({"name": "trials"}, ValueError, "must differ in name, got 'trials' twice; rename one"),
    ({"axes": {"estimate_low": [1]}}, ValueError, "must differ in name, got 'estimate_low' twice; rename one"),
    ({"axes": {"f b": [1]}}, ValueError, "must be one of a Python variable, got 'f b'; give letters, digits and _"),
    ({"axes": {3: [1]}}, ValueError, "must be one of a Python variable, got 3; give letters"),
    ({"units": {"mass": "kg"}}, ValueError, "units must be one of 'scale', 'estimate', got 'mass'; choose one"),
    ({"units": {"scale": 1}}, TypeError, r"units\['scale'\] must be of type str, got int; give a string"),
    ({"units": "m"}, TypeError, "units must be of type Mapping, got str; give a dict of names and units"),
    ({"rule": AllRules([MeanRule(), PercentileRule()])}, ValueError,
     "rule must give one estimate per quantity, got mean, percentile 95; sweep with one of its members"),
    ({"rule": 0.05}, TypeError, r"rule must be of type StopRule, got float; give PercentileRule"),
    ({"seed": -1}, ValueError, "seed must be at least 0, got -1"),
    ({"label": 3}, TypeError, "label must be of type str, got int; give the sweep a name"),
    ({"make": lambda a, b: np.random.Generator.random, "axes": {"a": ["x", "x, b=y"], "b": ["y, b=y", "y"]}},
     ValueError, "values must tell cells apart, got two cells called 'sweep, a=x, b=y, b=y'; change a string"),
    ({"ledger": "sweep.ledger"}, TypeError, r"ledger must be of type Ledger, got str; give Ledger\(path\)"),
])
def test_refusals(changed: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        sweep(**{"make": Peak, "axes": {"scale": SCALES}} | changed)


@pytest.mark.parametrize(("point", "error", "message"), [
    ({"mass": 70}, ValueError, "axis must be one of 'scale', 'shape', 'model', 'factor', got 'mass'; choose one"),
    ({"scale": 3}, ValueError, "scale must be one of 1.0, 2.0, got 3; choose one of these"),
    ("scale", TypeError, "point must be of type Mapping, got str; give a dict of axes and one value of each"),
    ({"scale": np.array([1, 2])}, TypeError, "scale must be of type int or float or str, got ndarray; give one number"),
])
def test_a_point_off_the_axes_is_refused(found: hsi.Sweep, point: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        found.at(point)


@pytest.mark.parametrize(("words", "message"), [
    (("scale", 2, 1), "axis must be one of 'model', 'factor', got 'scale'; choose one"),
    (("model", "MC", "MF"), "model must be one of 'MF', 'PMC', got 'MC'; choose one"),
])
def test_ratios_off_the_shared_axes_are_refused(found: hsi.Sweep, words: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        found.ratio(*words)


def test_ratio_without_a_shared_axis_is_refused() -> None:
    with pytest.raises(ValueError, match="an axis that the trials share, got 'scale' and none shared; sweep with shar"):
        sweep(Peak, {"scale": [1, 2]}, rule=ROUGH).ratio("scale", 2, 1)


def test_ratio_to_nothing_is_refused() -> None:
    found = sweep(lambda scale: lambda rng: scale * rng.rayleigh() * np.array([0.0, 1.0]), {"scale": [1]},
                  shared={"model": ["none", "one"]}, rule=ROUGH)
    with pytest.raises(ValueError, match="bottom of a ratio must be away from zero, got 0 in a resample of the trials"):
        found.ratio("model", "one", "none")
    assert found.ratio("model", "none", "one").high == 0


def test_ratio_of_means_is_refused() -> None:
    with pytest.raises(TypeError, match="rule must be of type PercentileRule, got MeanRule; sweep with PercentileRule"):
        table(rule=MeanRule()).ratio("model", "PMC", "MF")

"""Truth: the digits of `monte_carlo` on trials of bridges made in Python, and what netCDF gives back."""

import json
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from click.testing import Result
from matplotlib.figure import Figure
from typer.testing import CliRunner

import hsictrl as hsi
from hsictrl.assessment import PeaksTrial, PeakTrial
from hsictrl.cli import app
from hsictrl.cli.study import read_study
from hsictrl.crowd import CrowdFlow
from hsictrl.study import PercentileRule, trial_rng
from hsictrl.study.ratios import ratios

STUDY = """seed = 3
[bridge]
kind = "reference"
damping = 0.01

[traffic]
weight = 800.0

[sweep]
frequency = [3.25, 2.0]
modal_mass = [20e3, 50e3]
density = [0.1, 0.2]
force = ["young", "zivanovic"]
model = ["MF", "PMC"]
"""
TRIALS, CELLS = 6, 8
PERCENTILE = PercentileRule(percentile=50.0, tolerance=0.2)
WORDS = ("--max-trials", TRIALS, "--percentile", 50, "--tolerance", 0.2)
FILES = ["study.json", "study.ledger", "study.nc", "study.png", "study_r_hsi.png"]


def run(*words: Any, code: int = 0) -> Result:
    result = CliRunner().invoke(app, list(map(str, words)), catch_exceptions=False)
    assert result.exit_code == code, result.stderr
    return result


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sweep") / "study.toml"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def swept(study: Path) -> Result:
    """The command, run once into the folder of its description."""
    return run("sweep", study, *WORDS, "--output", study.parent, "--json")


@pytest.fixture(scope="module")
def rows(swept: Result) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads(swept.stdout)["rows"]
    return found


@pytest.fixture(scope="module")
def cell() -> hsi.Ensemble:
    """0.2 persons/m² on bridges of 3.25 Hz, forces of Zivanovic: what a Python user gets."""
    bridges = [hsi.reference_bridge(frequency=3.25, damping=0.01, modal_mass=mass) for mass in (20e3, 50e3)]
    trial = PeaksTrial(models=("MF", "PMC"), bridges=bridges, flow=hsi.CrowdFlow(density=0.2, weight=800.0))
    return hsi.monte_carlo(trial, rule=PERCENTILE, seed=3, max_trials=TRIALS)


def in_cell(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    place = {"density_per_m2": 0.2, "frequency_hz": 3.25, "force": "zivanovic"}
    return [row for row in rows if place.items() <= row.items()]


def test_a_cell_has_the_digits_of_monte_carlo(rows: list[dict[str, Any]], cell: hsi.Ensemble) -> None:
    assert len(rows) == 2 * CELLS
    for i, (row, mass) in enumerate(zip(in_cell(rows), (20e3, 50e3), strict=True)):
        assert (row["modal_mass_kg"], row["damping"], row["persons"]) == (mass, 0.01, 30)
        assert (row["trials"], row["converged"]) == (cell.n_trials, cell.converged)
        for j, model in enumerate(("mf", "pmc")):
            found = [row[f"a_{model}{end}_m_per_s2"] for end in ("", "_low", "_high")]
            assert found == [array[2 * j + i] for array in (cell.estimate, *cell.interval)]


def test_the_ratio_is_of_moving_force_over_crowd(rows: list[dict[str, Any]], cell: hsi.Ensemble) -> None:
    truth = ratios(PERCENTILE, *np.split(cell.samples, 2, axis=1))
    found = [[row[f"r_hsi{end}"] for row in in_cell(rows)] for end in ("", "_low", "_high")]
    assert np.array_equal(found, truth)
    for row in rows:
        assert row["r_hsi"] == pytest.approx(row["a_mf_m_per_s2"] / row["a_pmc_m_per_s2"])


def test_files_have_what_is_printed(study: Path, swept: Result, rows: list[dict[str, Any]]) -> None:
    assert sorted(path.name for path in study.parent.iterdir()) == sorted([*FILES, "study.toml"])
    document = json.loads((study.parent / "study.json").read_text())
    assert document == json.loads(swept.stdout)
    assert {"percentile": 50.0, "tolerance": 0.2, "max_trials": TRIALS, "seed": 3}.items() <= document[
        "settings"].items()
    assert hsi.Ledger(study.parent / "study.ledger").trials().keys() == {
        f"study, density={d}, frequency={f}, force={force}"
        for d in (0.1, 0.2) for f in ("2", "3.25") for force in ("young", "zivanovic")}
    for name in ("study.png", "study_r_hsi.png"):
        assert (study.parent / name).read_bytes().startswith(b"\x89PNG")


@pytest.mark.usefixtures("swept")
def test_netcdf_has_the_numbers_of_json(study: Path, rows: list[dict[str, Any]]) -> None:
    data = xr.load_dataset(study.parent / "study.nc")
    axes = {"density": "density_per_m2", "frequency": "frequency_hz", "force": "force", "modal_mass": "modal_mass_kg",
            "damping": "damping"}
    for row in rows:
        point = data.sel({name: row[key] for name, key in axes.items()})
        for end in ("", "_low", "_high"):
            for model in ("MF", "PMC"):
                assert point[f"a50{end}"].sel(model=model) == row[f"a_{model.lower()}{end}_m_per_s2"]
            assert point[f"r_hsi{end}"] == row[f"r_hsi{end}"]
        assert (point["trials"], point["converged"]) == (row["trials"], row["converged"])
    assert [data[name].attrs.get("units") for name in ("a50", "density", "modal_mass")] == ["m/s²", "1/m²", "kg"]


@pytest.mark.usefixtures("swept")
def test_resumed_it_prints_a_table_and_runs_nothing(study: Path, rows: list[dict[str, Any]], tmp_path: Path,
                                                    monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(CrowdFlow, "sample", None)
    printed = run("sweep", study, *WORDS, "--output", tmp_path, "--ledger", study.parent / "study.ledger",
                  "--resume").stdout
    for row in rows:
        assert f"{row['a_pmc_m_per_s2']:#.3g}" in printed
        assert f"{row['r_hsi']:#.3g}" in printed
    words = " ".join(printed.split())
    for told in ("a50 MF", "a50 PMC", "R_HSI: a50 MF / a50 PMC (eq. 18)", "n=30", "ξ_B = 1 %. Seed: 3",
                 "Force young: YoungForce(values='mean')", "95 % interval", "±20 %", "8 of 8 studies have not settled"):
        assert told in words
    assert sorted(path.name for path in tmp_path.iterdir()) == [name for name in FILES if name != "study.ledger"]


def test_interrupted_it_goes_on_to_the_same_digits(study: Path, swept: Result, tmp_path: Path,
                                                   monkeypatch: pytest.MonkeyPatch) -> None:
    calls, sample = [], CrowdFlow.sample

    def interrupted(flow: CrowdFlow, *args: Any, **words: Any) -> Any:
        calls.append(flow)
        if len(calls) == 3 * TRIALS + 2:
            raise KeyboardInterrupt
        return sample(flow, *args, **words)
    monkeypatch.setattr(CrowdFlow, "sample", interrupted)
    stopped = run("sweep", study, *WORDS, "--output", tmp_path, code=130)
    assert (stopped.stdout, stopped.stderr, [path.name for path in tmp_path.iterdir()]) == ("", "", ["study.ledger"])
    again = run("sweep", study, *WORDS, "--output", tmp_path, code=2)
    assert "give --resume to go on with them, or choose another file" in again.stderr
    held = sum(hsi.Ledger(tmp_path / "study.ledger").trials().values())
    assert 3 * TRIALS <= held < CELLS * TRIALS
    calls[:] = [None] * CELLS * TRIALS
    assert run("sweep", study, *WORDS, "--output", tmp_path, "--resume", "--json").stdout == swept.stdout
    assert len(calls) == 2 * CELLS * TRIALS - held


@pytest.mark.usefixtures("swept")
def test_maps_show_the_rows(study: Path, rows: list[dict[str, Any]], tmp_path: Path,
                            monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Any] = []
    monkeypatch.setattr("hsictrl.plots.map_plot", lambda *given, **words: drawn.append((given, words)) or
                        SimpleNamespace(figure=Figure()))
    run("sweep", study, *WORDS, "--output", tmp_path, "--ledger", study.parent / "study.ledger", "--resume")
    assert [words["quantity"] for _, words in drawn] == ["$a_{50}$ PMC [m/s²]", r"$R_\mathrm{HSI}$ [-]"]
    for ((x, y, panels), _), key in zip(drawn, ("a_pmc_m_per_s2", "r_hsi"), strict=True):
        assert (list(x), list(y)) == ([2.0, 3.25], [20.0, 50.0])
        assert list(panels) == ["0.1 /m², young", "0.1 /m², zivanovic", "0.2 /m², young", "0.2 /m², zivanovic"]
        assert panels["0.2 /m², zivanovic"][:, 1].tolist() == [row[key] for row in in_cell(rows)]


def test_one_bridge_has_no_map_and_one_model_no_ratio(tmp_path: Path) -> None:
    path = tmp_path / "small.toml"
    path.write_text("[bridge]\nkind = 'beam'\nspans = [30.0, 20.0]\nwidth = 3.0\nmass = 5e4\nfrequency = 2.0\n"
                    "damping = 0.5\n[traffic]\npersons = 15\n[sweep]\nmodel = 'PMC'\ndamping = [0.01, 0.02]")
    printed = run("sweep", path, *WORDS, "--output", tmp_path).stdout
    assert "R_HSI" not in printed
    assert "d = 0.1 /m² (n=15). f_B = 2 Hz." in printed
    assert sorted(one.name for one in tmp_path.iterdir()) == ["small.json", "small.ledger", "small.nc", "small.toml"]
    assert "r_hsi" not in xr.load_dataset(tmp_path / "small.nc")


@pytest.mark.usefixtures("swept")
def test_without_xarray_it_says_what_to_install_and_writes_the_rest(study: Path, tmp_path: Path,
                                                                    monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    done = run("sweep", study, *WORDS, "--output", tmp_path, "--ledger", study.parent / "study.ledger", "--resume")
    assert f"Remark: {tmp_path / 'study.nc'} was not written: to_xarray must find xarray, got none; " \
           "pip install 'hsictrl[data]'" in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["study.json", "study.png", "study_r_hsi.png"]


def test_options_reach_the_sweep(study: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given: dict[str, Any] = {}

    def fail(*args: Any, **words: Any) -> None:
        given.update(words)
        raise RuntimeError("trial 3 of seed 8 failed")
    monkeypatch.setattr(hsi.study, "sweep", fail)
    result = run("sweep", study, "--percentile", 97.5, "--tolerance", 0.1, "--max-trials", 300, "--seed", 8,
                 "--processes", 2, "--output", tmp_path, code=1)
    assert result.stderr == "Error: trial 3 of seed 8 failed\n"
    assert given["rule"] == PercentileRule(percentile=97.5, tolerance=0.1)
    assert (given["seed"], given["max_trials"], given["name"], given["label"]) == (8, 300, "a97_5", "study")
    assert (given["executor"]._max_workers, given["ledger"]) == (2, hsi.Ledger(tmp_path / "study.ledger"))


# what a file describes

def read(tmp_path: Path, text: str) -> Any:
    path = tmp_path / "study.toml"
    path.write_text(text)
    return read_study(path)


def test_what_is_no_axis_comes_from_the_description(tmp_path: Path) -> None:
    found = read(tmp_path, "[bridge]\nkind = 'reference'\nfrequency = 3.0\nmodal_mass = 40e3\n[traffic]\npersons = "
                           "[15, 30]\n[force]\nmodel = 'young'\nvalues = 'design'\n[sweep]\ndamping = 0.02")
    assert found.cells == {"density": (0.1, 0.2), "frequency": (3.0,), "force": ("young",)}
    assert found.shared == {"model": ("MF", "PMC"), "modal_mass": (40e3,), "damping": (0.02,)}
    trial = found.trial(density=0.2, frequency=3.0, force="young")
    assert (trial.flow, trial.force) == (hsi.CrowdFlow(persons=30), hsi.YoungForce(values="design"))
    assert str(trial.bridges[0]) == str(hsi.reference_bridge(frequency=3.0, damping=0.02, modal_mass=40e3))


def test_an_axis_takes_the_place_of_the_description(tmp_path: Path) -> None:
    found = read(tmp_path, "[bridge]\nkind = 'beam'\nspans = [20.0, 30.0]\nwidth = 3.0\nmass = 6e4\nfrequency = 2.5\n"
                           "damping = 0.01\n[traffic]\npersons = 15\nweight = 800\n[force]\nmodel = 'harmonic'\n"
                           "factors = [0.4]\n[sweep]\nmodal_mass = [9e3]\nfrequency = [3, 2]\ndensity = [0.5]\n"
                           "model = ['MC']\nforce = ['zivanovic', 'harmonic', 'young']")
    assert found.frequency == (2.0, 3.0)
    assert found.forces == {"zivanovic": hsi.ZivanovicForce(), "harmonic": hsi.HarmonicForce([0.4]),
                            "young": hsi.YoungForce()}
    trial = found.trial(density=0.5, frequency=3.0, force="harmonic")
    [alone] = trial.trials
    assert (alone.model, alone.flow) == ("MC", hsi.CrowdFlow(density=0.5, weight=800))
    [mode] = alone.bridge.modes
    beam = hsi.Footbridge.beam(spans=[20.0, 30.0], width=3.0, mass=6e4, frequency=2.5, damping=0.01)
    assert (mode.frequency, mode.damping, mode.modal_mass) == (3.0, 0.01, 9e3)
    x = np.linspace(0.0, 50.0, 7)
    assert np.array_equal(mode.shape(x), beam.modes[0].shape(x))
    assert alone.bridge.mass / mode.modal_mass == pytest.approx(6e4 / beam.modes[0].modal_mass)


def test_models_for_which_bridges_share_nothing_have_the_digits_of_trials_of_one_bridge(tmp_path: Path) -> None:
    found = read(tmp_path, "[traffic]\npersons = 8\n[sweep]\nmodel = ['MF', 'MFAM', 'MC']\ndamping = [0.01, 0.02]")
    peaks = found.trial(density=8 / 150, frequency=2.0, force="zivanovic")(trial_rng(1, 0))
    assert peaks.tolist() == [
        PeakTrial(model=model, bridge=hsi.reference_bridge(damping=damping), flow=CrowdFlow(persons=8))(trial_rng(1, 0))
        for model in ("MF", "MFAM", "MC") for damping in (0.01, 0.02)]


def test_further_modes_change_as_the_first_does_and_respond(tmp_path: Path) -> None:
    found = read(tmp_path, "[bridge]\nkind = 'simply_supported'\nlength = 50.0\nwidth = 3.0\nmass = 5e4\n"
                           "frequency = 2.0\ndamping = [0.005, 0.01]\nn_modes = 2\n[traffic]\npersons = 8\n[sweep]\n"
                           "model = 'PMC'\nfrequency = [1.0, 1.5]\nmodal_mass = 50e3\ndamping = 0.01")
    peak = found.trial(density=8 / 150, frequency=1.0, force="zivanovic")(trial_rng(1, 0))
    bridge = hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=1e5, frequency=1.0, damping=[0.01, 0.02],
                                             n_modes=2)
    traffic = CrowdFlow(persons=8).sample(bridge, rng=trial_rng(1, 0))
    alone = hsi.predict("PMC", bridge, hsi.tune("PMC", bridge, traffic)).peak_acceleration
    assert peak.tolist() == pytest.approx([alone], rel=1e-9)


@pytest.mark.parametrize(("text", "says"), [
    ("seed = 1", "study.toml: the table must hold 'sweep', got no 'sweep'; add it"),
    ("sweep = 3", "study.toml, line 1, sweep: sweep must be a table, got 3; write it like [name]"),
    ("[sweep]\nfrequenzy = [2.0]", "study.toml, line 2, [sweep] frequenzy: key must be one of 'frequency', "
     "'modal_mass', 'damping', 'density', 'model', 'force', got 'frequenzy'; correct its spelling or leave it out"),
    ("[sweep]\nfrequency = []", "line 2, [sweep] frequency: frequency must be a number or a list of numbers, got []"),
    ("[sweep]\n\nmodel = ['MF', 'PCM']", "line 3, [sweep] model: model must be one of 'SF', 'MF', 'MFAM', 'PMC', 'MC', "
     "got 'PCM'; choose one of these"),
    ("[sweep]\nmodel = 2", "line 2, [sweep] model: model must be a word in quotes or a list of them, got 2; write it"),
    ("[sweep]\nmodal_mass = [20e3, -1.0]", "line 2, [sweep] modal_mass: modal_mass must be above 0, got -1; give kg"),
    ("[sweep]\nfrequency = [0]", "line 2, [sweep] frequency: frequency must be above 0, got 0; give Hz"),
    ("[sweep]\ndamping = [0.5, 2]", "line 2, [sweep] damping: damping must lie in [0, 1), got 2; give a fraction, not"),
    ("[sweep]\ndamping = [0, 0.01]", "[sweep] damping: damping[0] must lie in (0, 1), got 0; nothing settles without"),
    ("[sweep]\ndensity = [0.2, 6.0]", "line 2, [sweep] density: density must lie in (0, 5.4), got 6; give persons per "
     "m² above zero and below the jam density"),
    ("[sweep]\ndensity = 2", "line 2, [sweep] density: density must lie in (0, 1.5], got 2; beyond 1.5 persons/m²"),
    ("[sweep]\ndensity = 0.001", "[sweep] density: density must put at least one person on the deck of 150 m², got"),
    ("[sweep]\ndamping = [0.01, 0.02, 0.01]", "line 2, [sweep] damping: damping must hold each value once, got 0.01 "
     "twice; leave one out"),
    ("[sweep]\nforce = 'narrow-band'", "line 2, [sweep] force: force must be one of 'zivanovic', 'young', 'harmonic', "
     "got 'narrow-band'; choose one of these"),
    ("[sweep]\nforce = 'harmonic'", "line 2, [sweep] force: force 'harmonic' must have its factors, got none; describe "
     "it in [force]"),
    ("[bridge]\nkind = 'simply_supported'\nlength = 50.0\nwidth = 3.0\nmass = 5e4\nfrequency = 2.0\ndamping = 0\n"
     "n_modes = 2\n[sweep]", "line 7, [bridge] damping: the first of several modes must have damping above 0, to which "
     "the others stand in proportion, got 0; give the damping that it has"),
    ("[traffic]\nstep_frequency = 1.9\n[sweep]", "line 2, [traffic] step_frequency: the steps of a sweep must be tuned "
     "to each bridge, got step_frequency=(1.9, 0.0); leave it out, or use 'hsictrl assess'"),
    ("[traffic]\npersons = [15, 15]\n[sweep]", "line 2, [traffic] persons: the flows of a sweep must differ in "
     "density, got 0.1, 0.1 persons/m²; leave one out"),
    ("seed = 3000000000\n[sweep]", "seed must be at most 2147483647, got 3000000000; netCDF files hold no larger one"),
])
def test_refusals_name_line_key_rule_value_and_remedy(text: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_text(text)
    result = run("sweep", path, "--output", tmp_path, code=2)
    assert says in result.stderr
    assert (result.stderr.count("\n"), result.stdout, list(tmp_path.iterdir())) == (1, "", [path])


@pytest.mark.parametrize(("words", "says"), [
    ("--seed -1", "seed must be at least 0, got -1; give 0, 1, 2"),
    ("--max-trials 0", "max_trials must be at least 1, got 0; give at least one"),
    ("--tolerance 5", "tolerance must lie in (0, 1), got 5; give a fraction"),
    ("--percentile 100", "percentile must lie in [1, 100), got 100"),
    ("--processes 0", "processes must be at least 1, got 0"),
    ("--output nowhere", "the output folder must exist, got nowhere; make it first"),
    ("--ledger nowhere/a.ledger", "the folder of a ledger must exist, got nowhere; make it first"),
])
def test_options_are_refused_before_the_long_work(words: str, says: str, study: Path) -> None:
    result = run("sweep", study, *words.split(), code=2)
    assert says in result.stderr
    assert result.stderr.count("\n") == 1


def test_help() -> None:
    assert "[sweep]" in run("sweep", "--help").stdout

"""Truth: the digits of the Python functions that the command calls, by another road than its printing."""

import csv
import dataclasses
import errno
import html
import io
import json
import os
import re
import shlex
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import control as ct
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image
from typer.testing import CliRunner

import hsictrl as hsi
from hsictrl import assessment, paper
from hsictrl.cli import app, files
from hsictrl.cli.workers import workers
from hsictrl.paper import load_cycles
from hsictrl.prediction import predict_tuned

QUICK = ["--density", "0.2", "--tolerance", "0.5"]
YOUNG = "seed = 3\n[traffic]\npersons = [15, 30]\n[force]\nmodel = 'young'\n"


def run(*words, code=0):
    result = CliRunner().invoke(app, list(map(str, words)), catch_exceptions=False)
    assert result.exit_code == code, result.stderr
    return result


def process(*words):
    return subprocess.run([sys.executable, "-m", "hsictrl", *map(str, words)], capture_output=True, text=True,
                          encoding="utf-8", check=False)


@pytest.fixture(scope="module")
def young(tmp_path_factory):
    path = tmp_path_factory.mktemp("cli") / "young.toml"
    path.write_text(YOUNG)
    return path


@pytest.fixture(scope="module")
def found():
    """What a Python user gets for YOUNG at a tolerance of 0.5."""
    rule = hsi.PercentileRule(tolerance=0.5)
    return [hsi.assess(hsi.reference_bridge(), hsi.CrowdFlow(persons=n), force=hsi.YoungForce(), rule=rule, seed=3)
            for n in (15, 30)]


@pytest.fixture
def no_work(monkeypatch):
    """Any trial is a failure of the test."""
    def refuse(*args, **kwargs):
        raise AssertionError("the long work began")
    for module, name in ((assessment, "assess"), (assessment, "study_effective"), (paper, "compute"),
                         (assessment.PeakTrial, "prediction")):
        monkeypatch.setattr(module, name, refuse)


@pytest.fixture
def assessed(monkeypatch, found):
    """The command at once: what it would compute is known."""
    answers = iter(found)
    monkeypatch.setattr(assessment, "assess", lambda *args, **kwargs: next(answers))


# assess

def test_json_has_the_digits_of_assess(young, found):
    document = json.loads(run("assess", young, "--tolerance", "0.5", "--json").stdout)
    assert document["rows"] == [one.to_dict() for one in found]
    assert document["bridge"] == {"length_m": 50.0, "width_m": 3.0, "mass_kg": 50e3, "modes": [
        {"frequency_hz": 2.0, "damping": 0.005, "modal_mass_kg": 25e3}]}
    assert {"percentile": 95.0, "tolerance": 0.5, "confidence": 0.95, "seed": 3}.items() <= document["settings"].items()


def test_module_runs_the_command_quietly_and_prints_its_table():
    one = hsi.assess(hsi.reference_bridge(), hsi.CrowdFlow(density=0.2), rule=hsi.PercentileRule(tolerance=0.5))
    done = process("assess", *QUICK)
    assert (done.returncode, done.stderr) == (0, "")
    for value in (one.mf.estimate, one.pmc.estimate, *one.pmc.interval, one.reduction):
        assert f"{value:#.3g}" in done.stdout
    assert "→".join(one.classes) in done.stdout
    assert max(map(len, done.stdout.split("footbridge")[0].splitlines())) <= 80


def test_processes_and_figure_leave_the_digits_alone(young, found, tmp_path):
    done = process("assess", young, "--tolerance", "0.5", "--json", "--processes", "2", "--figure", tmp_path / "a.png")
    assert (done.returncode, done.stderr) == (0, f"wrote {tmp_path / 'a.png'}\n")
    assert json.loads(done.stdout)["rows"] == [one.to_dict() for one in found]
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_options_reach_the_study(monkeypatch, found, tmp_path):
    calls, book = [], tmp_path / "study.ledger"
    monkeypatch.setattr(assessment, "assess", lambda *args, **kwargs: calls.append((args, kwargs)) or found[0])
    run("assess", "--frequency", 3.25, "--damping", 0.01, "--modal-mass", 40e3, "--density", 0.3, "--density", 1.0,
        "--percentile", 90, "--tolerance", 0.2, "--seed", 8, "--ledger", book)
    assert [flow for (_, flow), _ in calls] == [hsi.CrowdFlow(density=0.3), hsi.CrowdFlow(density=1.0)]
    assert str(calls[0][0][0]) == str(hsi.reference_bridge(frequency=3.25, damping=0.01, modal_mass=40e3))
    assert calls[0][1] == {"force": hsi.ZivanovicForce(), "seed": 8, "executor": None,
                           "ledger": hsi.Ledger(book), "rule": hsi.PercentileRule(percentile=90, tolerance=0.2),
                           "mode": 0, "goal": None}


def test_without_options_it_is_section_4_2_at_5_percent(monkeypatch, found):
    calls = []
    monkeypatch.setattr(assessment, "assess", lambda *args, **kwargs: calls.append((args, kwargs)) or found[0])
    run("assess")
    assert [flow.density for (_, flow), _ in calls] == [0.2, 0.5, 0.8, 1.0, 1.5]
    assert str(calls[0][0][0]) == str(hsi.reference_bridge(frequency=2.0, damping=0.005, modal_mass=25e3))
    assert (calls[0][1]["rule"], calls[0][1]["seed"]) == (hsi.PercentileRule(), 1)


@pytest.mark.usefixtures("assessed")
def test_csv_keeps_every_digit(young, found):
    rows = list(csv.DictReader(io.StringIO(run("assess", young, "--csv").stdout)))
    for row, one in zip(rows, found, strict=True):
        numbers = {key: value for key, value in one.to_dict().items() if isinstance(value, int | float)}
        assert {key: type(value)(float(row[key]) if row[key] not in ("True", "False") else row[key] == "True")
                for key, value in numbers.items()} == numbers
        assert row["class_pmc"] == one.classes[1]


@pytest.mark.usefixtures("assessed")
def test_table_says_what_its_columns_are(young):
    printed = " ".join(run("assess", young, "--percentile", 95).stdout.split())
    for words in ("a95 MF", "a95 PMC", "R_HSI", "HiVoSS", "n=15", "n=30", "YoungForce(values='mean')", "Seed: 3",
                  "2.000 Hz, 0.50 %, 25000 kg", "95 % interval", "±5 %", "without interaction", "eq. 18"):
        assert words in printed


def test_what_has_not_settled_is_said_below_the_table_and_in_json(monkeypatch, found):
    one = found[0]
    nowhere = hsi.Ensemble(
        samples=one.pmc.samples.copy(), estimate=one.pmc.estimate, interval=(float("nan"), float("nan")),
        converged=False, reason="too few", seed=1, rule=hsi.PercentileRule())
    unsettled = hsi.Assessment(bridge=one.bridge, flow=one.flow, effective=one.effective, mf=one.mf,
                               pmc=nowhere, guide=one.guide, remarks=("PMC: too few",))
    monkeypatch.setattr(assessment, "assess", lambda *args, **kwargs: unsettled)
    assert "Remark on 15 persons: PMC: too few." in run("assess", *QUICK).stdout
    row = json.loads(run("assess", *QUICK, "--json").stdout)["rows"][0]
    assert (row["a_pmc_low_m_per_s2"], row["a_pmc_converged"], row["remarks"]) == (None, False, "PMC: too few")
    assert ",False," in run("assess", *QUICK, "--csv").stdout


@pytest.mark.usefixtures("assessed")
def test_figure_is_of_the_flow_with_the_largest_acceleration(monkeypatch, young, found, tmp_path):
    drawn = []
    monkeypatch.setattr("hsictrl.cli.figure.draw", lambda path, one, case: drawn.append(one) or path.touch())
    run("assess", young, "--figure", tmp_path / "a.pdf")
    assert drawn == [max(found, key=lambda one: one.pmc.estimate)]


@pytest.mark.usefixtures("assessed")
def test_figure_shows_the_trial_that_it_names(monkeypatch, young, found, tmp_path):
    given = {}
    monkeypatch.setattr("hsictrl.plots.assessment_figure",
                        lambda **words: given.update(words) or SimpleNamespace(figure=Figure()))
    run("assess", young, "--figure", tmp_path / "a.png")
    largest = max(found, key=lambda one: one.pmc.estimate)
    assert "trial 0 of seed 3" in given["title"]
    assert str(largest.flow) in given["title"]
    for response, ensemble in zip(given["responses"], given["ensembles"], strict=True):
        assert abs(response.outputs).max() == pytest.approx(ensemble.samples[0], rel=0.01)   # peak lies between samples
    for response, properties in zip(given["frfs"], given["effective"], strict=True):
        assert abs(response.frdata).max() == pytest.approx(properties.peak, rel=0.02)


def test_goals_and_guides_are_in_table_json_and_csv(monkeypatch, found, tmp_path):
    """The guides' rows by the functions that a Python user calls; the verdict is read from the interval."""
    path = tmp_path / "goals.toml"
    path.write_text("seed = 3\n[traffic]\nclasses = ['TC1', 'TC3']\ngoal = ['CL1', 'CL3']\n[force]\nmodel = 'young'")
    flows = [hsi.CrowdFlow(traffic_class=name) for name in ("TC1", "TC3")]
    cases = [hsi.guide_cases(hsi.reference_bridge(), flow) for flow in flows]
    calls, known = [], [dataclasses.replace(one, flow=flow, guides=case, goal=goal) for one, flow, case, goal in
                        zip(found, flows, cases, ("CL1", "CL3"), strict=True)]
    monkeypatch.setattr(assessment, "assess", lambda bridge, flow, **words: calls.append((flow, words["goal"])) or
                        known[flows.index(flow)])
    document = json.loads(run("assess", path, "--json").stdout)
    assert calls == [(flows[0], "CL1"), (flows[1], "CL3")]
    assert [(row["traffic_class"], row["goal"], row["verdict_pmc"]) for row in document["rows"]] == [
        ("TC1", "CL1", "not met"), ("TC3", "CL3", hsi.comfort_verdict(found[1].pmc.interval, "CL3"))]
    assert [(row["traffic_class"], row["guide"], row["a_m_per_s2"]) for row in document["guides"]] == [
        (flow.traffic_class, guide, hsi.guide_value(hsi.reference_bridge(), flow, guide=guide).acceleration)
        for flow in flows for guide in ("hivoss", "setra")]
    printed = run("assess", path).stdout
    for words in ("TC3", "goal CL3", "→not met", "Sétra", f"{document['guides'][-1]['a_m_per_s2']:#.3g} CL4", "ψ=1.00"):
        assert words in printed
    assert max(map(len, printed.split("footbridge")[0].splitlines())) <= 80
    assert [row["verdict_mf"] for row in csv.DictReader(io.StringIO(run("assess", path, "--csv").stdout))] == [
        hsi.comfort_verdict(one.mf.interval, one.goal) for one in known]


# report

@pytest.mark.usefixtures("assessed")
def test_report_quotes_the_file_and_the_command_that_makes_it_again(found, tmp_path):
    path, page = tmp_path / "a<b>.toml", tmp_path / "a.html"
    path.write_text("# <i>mine</i>\n" + YOUNG)
    done = run("assess", path, "--tolerance", 0.5, "--density", 0.1, "--density", 0.2, "--report", page,
               "--processes", 1)
    text = html.unescape(re.sub("<[^>]*>", "", page.read_text(encoding="utf-8")))
    assert done.stderr == f"wrote {page}\n"
    assert "Assessment of a<b>.toml" in text
    assert path.read_text() in text
    words = ["hsictrl", "assess", str(path), "--density", "0.1", "--density", "0.2", "--tolerance", "0.5", "--report",
             str(page)]
    again = next(line for line in text.splitlines() if " assess " in line)
    assert sorted(shlex.split(again)[1:]) == sorted(words[1:])


@pytest.mark.usefixtures("assessed")
def test_a_report_that_fails_leaves_the_old_one(monkeypatch, young, tmp_path):
    def fail(*args, **kwargs):
        raise KeyboardInterrupt
    monkeypatch.setattr("hsictrl.report.report_page", fail)
    (tmp_path / "a.html").write_text("old")
    run("assess", young, "--report", tmp_path / "a.html", code=130)
    assert [(each.name, each.read_text()) for each in tmp_path.iterdir()] == [("a.html", "old")]


@pytest.mark.usefixtures("assessed")
def test_a_report_that_cannot_be_written_costs_no_number(monkeypatch, young, tmp_path):
    """A disk may fill up while a study runs."""
    def full(*args, **kwargs):
        raise OSError(errno.ENOSPC, "No space left on device")
    monkeypatch.setattr(Path, "write_text", full)
    done = run("assess", young, "--report", tmp_path / "a.html", code=1)
    assert "R_HSI" in done.stdout
    assert done.stderr == (f"Error: {tmp_path / 'a.html'} must be a file that can be written, got No space left on "
                           "device; choose another\n")
    assert not list(tmp_path.glob("*.html"))


# effective

def test_effective_has_the_digits_of_study_effective(young):
    document = json.loads(run("effective", young, "--json", "--tolerance", "0.1").stdout)
    for row, n in zip(document["rows"], (15, 30), strict=True):
        one = hsi.study_effective(hsi.reference_bridge(), hsi.CrowdFlow(persons=n), seed=3,
                                  rule=assessment.effective_rule(0.1))
        assert (row["persons"], row["trials"], row["converged"]) == (n, one.n_trials, True)
        assert [row["f_eff_mean_hz"], row["f_eff_p5_hz"], row["f_eff_p95_hz"]] == one.estimate[0].tolist()
        assert [row["xi_eff_mean_low"], row["xi_eff_p5_low"], row["xi_eff_p95_low"]] == one.interval[0][1].tolist()
        assert row["xi_eff_p95_high"] == one.interval[1][1, 2]


def test_effective_prints_table_and_csv(young):
    printed = run("effective", young, "--tolerance", "0.2").stdout
    row = next(csv.DictReader(io.StringIO(run("effective", young, "--tolerance", "0.2", "--csv").stdout)))
    assert f"{float(row['f_eff_mean_hz']):#.4g}" in printed
    assert f"{100 * float(row['xi_eff_p95']):#.3g}" in printed
    assert f"({row['trials']})" in printed


def test_effective_says_what_has_not_settled(monkeypatch, young):
    one = hsi.study_effective(hsi.reference_bridge(), hsi.CrowdFlow(persons=15))
    unsettled = hsi.Ensemble(samples=one.samples, estimate=one.estimate, interval=one.interval, converged=False,
                             reason="too few", seed=1, rule=one.rule)
    monkeypatch.setattr(assessment, "study_effective", lambda *args, **kwargs: unsettled)
    assert "Remark on 30 persons: too few." in run("effective", young).stdout
    assert json.loads(run("effective", young, "--json").stdout)["rows"][0]["remarks"] == "too few"


def test_effective_says_that_people_hardly_meet_a_lateral_mode(young, tmp_path):
    (tmp_path / "nodes.csv").write_text("x,lateral_1\n" + "\n".join(f"{x},{np.sin(np.pi * x / 50)}" for x in range(51)))
    (tmp_path / "modes.csv").write_text("mode,frequency,damping,modal_mass\n1,1.2,0.01,25e3")
    path = tmp_path / "lateral.toml"
    path.write_text("[bridge]\nkind = 'csv'\nshapes = 'nodes.csv'\nmodes = 'modes.csv'\nwidth = 3.0\nmass = 5e4\n"
                    "[traffic]\npersons = 15")
    remark = "Remark: the first mode does not move vertically at its antinode, where people would change it the most."
    told = [" ".join(run("effective", file, "--tolerance", 0.2).stdout.split()) for file in (path, young)]
    assert [remark in one for one in told] == [True, False]


# simulate

@pytest.fixture(scope="module")
def crossed():
    """Trial 2 of seed 3, as a Python user computes it: 30 persons by Young's forces."""
    bridge, flow = hsi.reference_bridge(), hsi.CrowdFlow(persons=30)
    traffic = flow.sample(bridge, rng=hsi.trial_rng(3, 2), force=hsi.YoungForce())
    return bridge, traffic, predict_tuned("MC", bridge, traffic)


@pytest.fixture(scope="module")
def thirty(tmp_path_factory):
    path = tmp_path_factory.mktemp("cli") / "thirty.toml"
    path.write_text("seed = 3\n[traffic]\npersons = 30\n[force]\nmodel = 'young'\n")
    return path


def test_simulate_has_the_digits_of_a_trial(thirty, crossed):
    bridge, traffic, found = crossed
    document = json.loads(run("simulate", thirty, "--trial", 2, "--json").stdout)
    row, = document["rows"]
    standing = hsi.effective(hsi.couple(bridge, *traffic.standing_on(bridge)))
    by_hand = hsi.simulate(hsi.moving_crowd(bridge, found.system.traffic))
    assert row["a_mc_m_per_s2"] == found.peak_acceleration
    assert row["a_mc_m_per_s2"] == assessment.PeakTrial(
        model="MC", bridge=bridge, flow=hsi.CrowdFlow(persons=30), force=hsi.YoungForce())(hsi.trial_rng(3, 2))
    assert (row["f_eff_hz"], row["xi_eff"]) == (standing.frequency, standing.damping)
    assert row["step_frequency_hz"] == standing.frequency    # below 2.5 Hz: by the first harmonic
    assert (row["error"], row["step_s"]) == (by_hand.error, by_hand.step)
    assert row["crossing_s"] == pytest.approx(50 / hsi.weidmann_speed(0.2))
    assert row["class_mc"] == hsi.comfort_class(found.peak_acceleration)
    assert (document["settings"]["model"], document["settings"]["trial"], document["settings"]["seed"]) == ("MC", 2, 3)


def test_simulate_reads_peak_and_rms_from_whole_seconds(thirty, crossed):
    """The RMS of the last second, by its definition, at every sample that has a second before it."""
    bridge, _, found = crossed
    row, = json.loads(run("simulate", thirty, "--trial", 2, "--json").stdout)["rows"]
    time, signal = found.response.time, found.response.y[0]
    step = time[1] - time[0]
    n = round(1.0 / step)
    rms = max(np.sqrt(np.trapezoid(signal[i:i + n + 1]**2, dx=step) / (n * step)) for i in range(len(time) - n))
    assert row["rms_m_per_s2"] == pytest.approx(rms, rel=2e-3)
    assert abs(signal[np.searchsorted(time, row["peak_at_s"])]) == abs(signal).max()
    on_deck = [bridge.carries(found.system.traffic.walkers.places(t)).sum() for t in time[::20]]
    assert row["persons_on_deck_mean"] == pytest.approx(np.mean(on_deck), rel=0.01)


def test_rms_of_less_than_a_second_does_not_count(monkeypatch, thirty, crossed):
    """A cosine's whole seconds have 2/√2; its first sample alone has 2."""
    time = np.linspace(0.0, 10.0, 1001)
    cosine = ct.TimeResponseData(time, 2.0 * np.cos(4 * np.pi * time), issiso=True)
    known = dataclasses.replace(crossed[2], response=cosine)
    monkeypatch.setattr(assessment.PeakTrial, "prediction", lambda trial, rng: known)
    row, = json.loads(run("simulate", thirty, "--json").stdout)["rows"]
    assert row["rms_m_per_s2"] == pytest.approx(np.sqrt(2.0))


def test_simulate_without_words_is_one_person_per_square_metre(monkeypatch, crossed):
    calls = []
    monkeypatch.setattr(assessment.PeakTrial, "prediction", lambda trial, rng: calls.append((trial, rng)) or crossed[2])
    run("simulate")
    run("simulate", "--density", 0.3, "--frequency", 3.0, "--seed", 5, "--trial", 1)
    assert [trial.flow for trial, _ in calls] == [hsi.CrowdFlow(density=1.0), hsi.CrowdFlow(density=0.3)]
    assert {trial.model for trial, _ in calls} == {"MC"}
    assert str(calls[1][0].bridge) == str(hsi.reference_bridge(frequency=3.0))
    assert [rng.random() for _, rng in calls] == [hsi.trial_rng(1, 0).random(), hsi.trial_rng(5, 1).random()]


def test_density_takes_the_place_of_those_in_the_file(monkeypatch, young, crossed):
    calls = []
    monkeypatch.setattr(assessment.PeakTrial, "prediction", lambda trial, rng: calls.append(trial) or crossed[2])
    run("simulate", young, "--density", 0.3)
    assert calls[0].flow == hsi.CrowdFlow(density=0.3)


@pytest.fixture
def at_once(monkeypatch, crossed):
    """The command at once: what it would compute is known."""
    monkeypatch.setattr(assessment.PeakTrial, "prediction", lambda trial, rng: crossed[2])


@pytest.mark.usefixtures("at_once")
def test_simulate_prints_a_row_and_what_it_means(thirty, crossed):
    done = run("simulate", thirty, "--trial", 2).stdout
    printed = " ".join(done.split())
    for words in (f"{crossed[2].peak_acceleration:#.3g}", "n=30", "n_H", "comfort", "error", "Trial 2", "Seed: 3",
                  "tuned to f_eff", "1-s RMS", "2.000 Hz, 0.50 %, 25000 kg"):
        assert words in printed
    assert max(map(len, done.split("footbridge")[0].splitlines())) <= 80


@pytest.mark.usefixtures("at_once")
def test_simulate_prints_csv_and_remarks(monkeypatch, thirty, crossed):
    row, = csv.DictReader(io.StringIO(run("simulate", thirty, "--csv").stdout))
    assert float(row["a_mc_m_per_s2"]) == crossed[2].peak_acceleration
    odd = dataclasses.replace(crossed[2], remarks=("a remark",))
    monkeypatch.setattr(assessment.PeakTrial, "prediction", lambda trial, rng: odd)
    assert "Remark: a remark." in run("simulate", thirty).stdout
    assert json.loads(run("simulate", thirty, "--json").stdout)["rows"][0]["remarks"] == "a remark"


def test_simulate_draws_one_simulation_in_figure_and_animation(monkeypatch, thirty, crossed, tmp_path):
    given, calls = {}, []
    monkeypatch.setattr(assessment.PeakTrial, "prediction", lambda trial, rng: calls.append(trial) or crossed[2])
    monkeypatch.setattr("hsictrl.plots.simulation_figure",
                        lambda **words: given.update(words) or SimpleNamespace(figure=Figure()))
    monkeypatch.setattr("hsictrl.plots.crossing_animation", lambda *words: given.update(animated=words))
    monkeypatch.setattr("hsictrl.plots.save_animation", lambda one, path, after_each: path.touch())
    done = run("simulate", thirty, "--trial", 2, "--figure", tmp_path / "a.png", "--animate", tmp_path / "a.gif")
    assert done.stderr == f"wrote {tmp_path / 'a.png'}\nwrote {tmp_path / 'a.gif'}\n"
    assert len(calls) == 1
    assert (given["response"], given["animated"]) == (crossed[2].response, (crossed[2].system, crossed[2].response))
    assert "30 persons on footbridge 50 m" in given["title"]
    assert "trial 2 of seed 3" in given["title"]
    step, empty, occupied = given["marks"].values()
    assert (empty, step.tolist()) == (2.0, [pytest.approx(k * occupied) for k in (1, 2, 3, 4)])
    assert given["persons"][0] == crossed[0].carries(crossed[2].system.traffic.walkers.places(0.0)).sum()


@pytest.mark.usefixtures("at_once")
def test_simulate_writes_files_that_open(monkeypatch, thirty, tmp_path):
    monkeypatch.setattr("hsictrl.plots.animation.STRETCH", 0.4)
    run("simulate", thirty, "--figure", tmp_path / "a.png", "--animate", tmp_path / "a.gif")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gif", "a.png"]
    with Image.open(tmp_path / "a.gif") as image:
        assert image.n_frames == 11
    with Image.open(tmp_path / "a.png") as image:
        assert image.size == (1500, 1350)


@pytest.mark.usefixtures("at_once")
def test_an_interrupted_animation_leaves_nothing(monkeypatch, thirty, tmp_path):
    def interrupt(animation, path, after_each):
        path.write_bytes(b"GIF89a")
        raise KeyboardInterrupt
    monkeypatch.setattr("hsictrl.plots.save_animation", interrupt)
    monkeypatch.setattr("hsictrl.plots.crossing_animation", lambda *words: None)
    (tmp_path / "a.gif").write_text("old")
    done = run("simulate", thirty, "--animate", tmp_path / "a.gif", code=130)
    assert [(each.name, each.read_text()) for each in tmp_path.iterdir()] == [("a.gif", "old")]
    assert (done.stdout, done.stderr) == ("", "")


def test_a_crossing_that_fails_ends_with_exit_code_1(monkeypatch, thirty):
    def fail(trial, rng):
        raise ValueError("every step frequency must be above 0, got -0.1 Hz")
    monkeypatch.setattr(assessment.PeakTrial, "prediction", fail)
    done = run("simulate", thirty, "--trial", 4, code=1)
    assert done.stderr.startswith("Error: trial 4 of seed 3 failed: every step frequency must be above 0, got -0.1 Hz;")


# paper

@pytest.fixture
def stand_in(monkeypatch):
    """A figure and a table in place of the real ones."""
    rows = [{"case": "a", "f_hz": 1.23456, "n": 3, "more": 1.0}, {"case": "b", "f_hz": None, "n": 4, "more": 2.0}]

    def compute(name, recompute=False, executor=None, ledger=None, grid="coarse"):
        draw = None if name == "claims" else lambda: ct.ControlPlot([[]], [[]], Figure())
        return paper.Report(name=name, rows=rows, columns=["case", "f_hz", "n"], draw=draw,
                            caption=f"recompute {recompute}, grid {grid}, ledger {ledger and ledger.path.name}, "
                                    f"executor {executor}")
    monkeypatch.setattr(paper, "compute", compute)
    monkeypatch.setattr(paper, "names", lambda: ("fig3", "fig9", "claims"))
    return rows


def test_paper_writes_the_figure_and_its_numbers(stand_in, tmp_path):
    result = run("paper", "fig3", "--output", tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fig3.json", "fig3.png"]
    assert json.loads((tmp_path / "fig3.json").read_text()) == stand_in
    assert result.stderr == f"wrote {tmp_path / 'fig3.png'}\nwrote {tmp_path / 'fig3.json'}\n"
    assert re.search(r"a +1\.235 +3\n", result.stdout)
    assert re.search(r"b +– +4\n", result.stdout)
    assert "recompute False, grid coarse, ledger None, executor None" in result.stdout
    assert "more" not in result.stdout


@pytest.mark.usefixtures("stand_in")
def test_paper_writes_into_the_current_folder_unless_told(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    run("paper", "fig3")
    assert (tmp_path / "fig3.png").exists()


def test_paper_claims_prints_and_writes_nothing(stand_in, tmp_path):
    result = run("paper", "claims", "--json", "--output", tmp_path)
    assert (json.loads(result.stdout), result.stderr, list(tmp_path.iterdir())) == (stand_in, "", [])


def test_paper_writes_the_numbers_of_a_study_without_a_figure(monkeypatch, tmp_path):
    rows = [{"case": "a", "f_hz": 1.5}]
    monkeypatch.setattr(paper, "compute", lambda name, **how: paper.Report(
        name=name, rows=rows, columns=["case"], caption="", study=True))
    result = run("paper", "table2", "--output", tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["table2.json"]
    assert json.loads((tmp_path / "table2.json").read_text()) == rows
    assert result.stderr == f"wrote {tmp_path / 'table2.json'}\n"


@pytest.mark.usefixtures("stand_in")
def test_paper_recomputes_in_processes():
    assert re.search(r"recompute True, .* executor <concurrent.futures.process.ProcessPoolExecutor",
                     run("paper", "claims", "--recompute", "--processes", 2).stdout)


@pytest.mark.usefixtures("stand_in")
@pytest.mark.parametrize(("words", "says"), [
    ("claims", "grid coarse, ledger None"), ("claims --recompute", "grid coarse, ledger claims.ledger"),
    ("claims --recompute --ledger TMP/other", "grid coarse, ledger other"),
    ("claims --recompute --resume", "ledger claims.ledger"),
    ("fig3 --recompute", "recompute True, grid coarse, ledger None"),
    ("fig9 --recompute --grid paper", "recompute True, grid paper, ledger fig9.ledger"),
])
def test_paper_keeps_the_trials_of_a_study_and_chooses_its_cells(words, says, tmp_path):
    assert says in run("paper", *words.replace("TMP", str(tmp_path)).split(), "--output", tmp_path).stdout


@pytest.fixture
def short(monkeypatch):
    """Two spans, four trials each; lists the trials that were run."""
    ran = []
    last_step = load_cycles._last_step
    monkeypatch.setattr(load_cycles, "LENGTHS", (5.0, 10.0))
    monkeypatch.setattr(load_cycles, "study", partial(load_cycles.study, max_trials=4))
    monkeypatch.setattr(load_cycles, "_last_step", lambda moving: ran.append(moving) or last_step(moving))
    return ran


def test_an_interrupted_study_of_the_paper_goes_on_to_the_same_rows(short, monkeypatch, tmp_path):
    words, book = ["paper", "load_cycles", "--recompute", "--output", tmp_path], tmp_path / "load_cycles.ledger"

    def interrupted(moving):
        if len(short) == 6:     # in the second span
            raise KeyboardInterrupt
        return counted(moving)
    counted = load_cycles._last_step
    with monkeypatch.context() as patch:
        patch.setattr(load_cycles, "_last_step", interrupted)
        run(*words, code=130)
    assert hsi.Ledger(book).trials()["load cycles, 5 m"] == 4
    kept = sum(hsi.Ledger(book).trials().values())
    assert kept < 8

    assert run(*words, code=2).stderr == (
        f"Error: the ledger must be a new file, got {book}, which holds {kept} trials; give --resume to go on with "
        "them, or choose another file by --ledger\n")
    short.clear()
    run(*words, "--resume")
    assert len(short) == 8 - kept
    assert hsi.Ledger(book).trials() == {"load cycles, 5 m": 4, "load cycles, 10 m": 4}
    alone = paper.compute("load_cycles", recompute=True).rows       # with NaN: four trials bound no percentile
    assert (tmp_path / "load_cycles.json").read_text() == json.dumps(alone, indent=1) + "\n"


def test_a_table_without_a_study_makes_no_ledger(tmp_path):
    run("paper", "table1", "--recompute", "--output", tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_workers_have_one_blas_thread_and_leave_interrupts_to_the_command(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    with workers(2) as executor:
        assert executor.submit(os.getenv, "OPENBLAS_NUM_THREADS").result() == "1"
        assert executor.submit(signal.getsignal, signal.SIGINT).result() == signal.SIG_IGN
    assert os.environ["OPENBLAS_NUM_THREADS"] == "2"


# refusals

@pytest.mark.usefixtures("no_work")
@pytest.mark.parametrize(("words", "says"), [
    ("assess --damping 5", "damping must lie in [0, 1), got 5; give a fraction, not percent"),
    ("assess --damping -0.005", "damping must lie in [0, 1), got -0.005; give a fraction, not percent"),
    ("assess --damping nan", "damping must lie in [0, 1), got nan; give a fraction, not percent"),
    ("assess --damping 0", "damping[0] must lie in (0, 1), got 0; nothing settles without; give such as 0.005"),
    ("assess --frequency -2", "frequency must be above 0, got -2; give Hz"),
    ("assess --frequency inf", "frequency must be finite, got inf; give Hz"),
    ("assess --modal-mass 0", "modal_mass must be above 0, got 0; give kg"),
    ("assess --density 0", "density must lie in (0, 5.4), got 0; give persons per m² above zero and below the jam"),
    ("assess --density 5.4", "density must lie in (0, 5.4), got 5.4"),
    ("assess --density 0.2 --density nan", "density must lie in (0, 5.4), got nan"),
    ("assess --density 2", "density must lie in (0, 1.5], got 2; beyond 1.5 persons/m² walking is obstructed"),
    ("assess --density 0.003", "density must put at least one person on the deck of 150 m², got 0.003 persons/m²;"),
    ("assess --percentile 100", "percentile must lie in [1, 100), got 100; give percent, such as 95"),
    ("assess --tolerance 5", "tolerance must lie in (0, 1), got 5; give a fraction, not percent"),
    ("assess --seed -1", "seed must be at least 0, got -1; give 0, 1, 2"),
    ("assess --processes 0", "processes must be at least 1, got 0; give 1 to run in place"),
    ("assess --figure TMP/no/a.png", "the output folder must exist, got TMP/no; make it first"),
    ("assess --figure TMP", "a figure must be a file that ends in one of .avif"),
    ("assess --figure TMP/a.doc", "got TMP/a.doc; rename it"),
    ("assess --mode 1", "mode must be below the number of modes 1, got 1; count modes from 0, or describe the bridge"),
    ("assess --mode -1", "mode must be at least 0, got -1; count modes from 0"),
    ("assess --report TMP/no/a.html", "the output folder must exist, got TMP/no; make it first"),
    ("assess --report TMP/a.pdf", "a report must be a file that ends in one of .html, got TMP/a.pdf; rename it"),
    ("assess --json --csv", "the output must have one form, got --json and --csv; leave one of them out"),
    ("assess TMP/no.toml", "TMP/no.toml: the description must be a file that can be read, got No such file"),
    ("assess --damping 1e-9", "at most 100000 people may come until a bridge has settled, got "),
    ("assess TMP/bad.toml", "TMP/bad.toml, line 2, [bridge] damping: damping must lie in [0, 1), got 5; give a"),
    ("assess TMP/good.toml --frequency 3",
     "either by a file or by options, got TMP/good.toml and --frequency; write it into [bridge] of the file"),
    ("effective TMP/bad.toml", "TMP/bad.toml, line 2, [bridge] damping: damping must lie in [0, 1), got 5; give a"),
    ("effective --tolerance 0", "tolerance must lie in (0, 1), got 0; give a fraction, not percent"),
    ("effective --json --csv", "the output must have one form"),
    ("effective --processes -2", "processes must be at least 1, got -2"),
    ("simulate --density 0.2 --density 0.5", "simulate takes one density, got 2: 0.2 persons/m², 0.5 persons/m²; give "
     "one, such as --density 1.0"),
    ("simulate TMP/good.toml", "simulate takes one density, got 5: 0.2 persons/m²,"),
    ("simulate TMP/bad.toml", "TMP/bad.toml, line 2, [bridge] damping: damping must lie in [0, 1), got 5; give a"),
    ("simulate --damping 0", "damping[0] must lie in (0, 1), got 0; nothing settles without"),
    ("simulate --density 2", "density must lie in (0, 1.5], got 2; beyond 1.5 persons/m² walking is obstructed"),
    ("simulate --trial -1", "trial must be at least 0, got -1; count trials from 0"),
    ("simulate --json --csv", "the output must have one form"),
    ("simulate --figure TMP/a.doc", "a figure must be a file that ends in one of .avif"),
    ("simulate --animate TMP/a.doc", "an animation must be a file that ends in one of .gif"),
    ("simulate --animate TMP/no/a.gif", "the output folder must exist, got TMP/no; make it first"),
    ("simulate --figure TMP/a.gif --animate TMP/a.gif",
     "figure and animation must be two files, got TMP/a.gif for both; rename one"),
    ("paper fig99", "name must be one of 'table1', 'table2', 'readings', 'load_cycles', 'fig1', 'fig2', 'fig3', "
                    "'fig4', 'fig5', 'fig6', 'fig7', 'fig8', 'maps', 'fig9', 'fig10', 'fig11', "
                    "'stationary', 'claims', got 'fig99'; choose"),
    ("paper fig3 --output TMP/no", "the output folder must exist, got TMP/no; make it first"),
    ("paper table2 --ledger TMP/a.ledger", "--ledger and --resume must come with a study that runs anew, got table2; "
     "add --recompute, or leave them out"),
    ("paper table2 --resume", "must come with a study that runs anew, got table2; add --recompute"),
    ("paper table1 --recompute --resume", "must come with a study that runs anew, got table1; leave them out"),
    ("paper fig4 --recompute --ledger TMP/no/a.ledger", "the folder of a ledger must exist, got TMP/no; make it first"),
    ("paper table2 --recompute --ledger TMP/bad.toml", "a ledger must be a file made by hsictrl, got TMP/bad.toml"),
    ("paper table2 --grid paper", "--grid must come with one of maps, fig9, fig10, fig11, got table2; leave it out"),
    ("paper fig3 --processes 0", "processes must be at least 1, got 0"),
])
def test_refusals(tmp_path, words, says):
    (tmp_path / "bad.toml").write_text("[bridge]\ndamping = 5\nkind = 'reference'")
    (tmp_path / "good.toml").write_text("")
    before = sorted(tmp_path.iterdir())
    result = run(*words.replace("TMP", str(tmp_path)).split(), code=2)
    assert result.stderr.startswith("Error: ")
    assert says.replace("TMP", str(tmp_path)) in result.stderr
    assert result.stderr.count("\n") == 1
    assert (result.stdout, sorted(tmp_path.iterdir())) == ("", before)


@pytest.mark.parametrize("words", ["assess --seed x", "assess --nonsense", "simulata", "simulate --trial x", "paper"])
def test_wrong_words_are_refused_with_exit_code_2(words):
    result = run(*words.split(), code=2)
    assert "Error: " in result.stderr
    assert "Traceback" not in result.stderr


def test_refusal_of_the_real_command_holds_no_traceback():
    done = process("assess", "--damping", "5")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "Error: damping must lie in [0, 1), got 5; give a fraction, not percent\n"


# endings

def test_failed_trial_ends_with_exit_code_1(monkeypatch):
    def fail(*args, **kwargs):
        raise RuntimeError("trial 3 of seed 1 failed: ValueError: the deck is gone; rerun it alone")
    monkeypatch.setattr(assessment, "assess", fail)
    result = run("assess", code=1)
    assert result.stderr == "Error: trial 3 of seed 1 failed: ValueError: the deck is gone; rerun it alone\n"


def test_our_own_mistakes_are_not_taken_for_bad_input(monkeypatch):
    def fail(*args, **kwargs):
        raise ValueError("a mistake of ours")
    monkeypatch.setattr(assessment, "assess", fail)
    with pytest.raises(ValueError, match="a mistake of ours"):
        run("assess")


def test_interrupt_is_quiet(monkeypatch):
    def interrupt(*args, **kwargs):
        raise KeyboardInterrupt
    monkeypatch.setattr(assessment, "assess", interrupt)
    result = run("assess", code=130)
    assert (result.stdout, result.stderr) == ("", "")


def test_file_is_written_whole_or_not_at_all(tmp_path):
    path = tmp_path / "a.json"
    path.write_text("old")

    def write_half():
        with files.whole_file(path) as draft:
            draft.write_text("ne")
            assert path.read_text() == "old"
            raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        write_half()
    assert [(each.name, each.read_text()) for each in tmp_path.iterdir()] == [("a.json", "old")]


@pytest.mark.parametrize("words", [["--help"], ["assess", "--help"], ["effective", "--help"], ["paper", "--help"],
                                   ["simulate", "--help"]])
def test_help(words):
    assert "Usage: " in run(*words).stdout

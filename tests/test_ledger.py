"""Truth: the same study in one go, without a ledger; what SQLite says of a file; how often each trial really ran."""

import multiprocessing
import os
import pickle
import signal
import sqlite3
import subprocess
import sys
import time
from collections import Counter, deque
from concurrent.futures import ProcessPoolExecutor
from contextlib import closing
from dataclasses import dataclass, replace
from enum import Enum
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import hsictrl as hsi
from hsictrl.assessment import PeakTrial
from hsictrl.cli import app
from hsictrl.study import ChangedStudyError, Ledger, MeanRule, TrialError, identity, ledger, monte_carlo, trial_rng

NEVER = MeanRule(tolerance=1e-9)
N = 150                     # two blocks of the stop rule: trials one by one, then several at once
PAUSE = 1e-3                # s, of one trial
IN_FLIGHT = 0.02 / PAUSE    # trials in a batch of 20 ms
RUNNER = CliRunner()


def lognormal(rng: np.random.Generator) -> float:
    return rng.lognormal(sigma=0.2)


def pair(rng: np.random.Generator) -> np.ndarray:
    return rng.normal([1.0, 5.0], [0.1, 0.3])


def counted(path: Path, rng: np.random.Generator) -> float:
    """A trial that leaves a line in a file."""
    value = lognormal(rng)
    with path.open("a") as file:
        file.write(f"{value!r}\n")
    time.sleep(PAUSE)
    return value


def deadly(flag: Path, rng: np.random.Generator) -> float:
    """Trial 60 kills its process, unless the flag says that it has done so."""
    value = lognormal(rng)
    if value == lognormal(trial_rng(1, 60)) and not flag.exists():
        flag.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return value


def run(path: Path, **changed: Any) -> hsi.Ensemble:
    return monte_carlo(**{"trial": lognormal, "rule": NEVER, "max_trials": N, "ledger": Ledger(path)} | changed)


def runs(path: Path) -> Counter[float]:
    """How often each trial ran, the last line left out if its process died while it wrote."""
    lines = path.read_text().splitlines() if path.exists() else []
    return Counter(float(line) for line in lines)


def intact(path: Path) -> bool:
    with closing(sqlite3.connect(path)) as file:
        return file.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def child(path: Path, trial: Any) -> multiprocessing.Process:
    """A study in a process of its own, with everything imported before it starts."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["hsictrl.cli", "pytest", "typer.testing"])
    return context.Process(target=run, args=(path,), kwargs={"trial": trial})


@pytest.fixture(scope="module")
def alone() -> np.ndarray:
    return monte_carlo(lognormal, rule=NEVER, max_trials=N).samples


@pytest.mark.parametrize("moment", np.sort(np.random.default_rng(20).uniform(0, N, 20)))
def test_a_killed_study_goes_on_and_gives_the_same_digits(moment: float, alone: np.ndarray, tmp_path: Path) -> None:
    """Killed when so many trials have begun, and the fraction of one more."""
    book, counts = tmp_path / "study.ledger", tmp_path / "counts"
    trial = partial(counted, counts)
    process = child(book, trial)
    process.start()
    while runs(counts).total() < int(moment):
        time.sleep(1e-4)
    time.sleep(PAUSE * (moment % 1))
    process.kill()
    process.join()
    killed, kept = runs(counts).total(), sum(Ledger(book).trials().values())
    ensemble = run(book, trial=trial)
    assert ensemble.samples.tobytes() == alone.tobytes()
    assert set(runs(counts)) == set(alone)
    assert runs(counts).total() - N == killed - kept <= IN_FLIGHT
    assert intact(book)


def test_a_killed_command_goes_on_and_gives_the_same_output(tmp_path: Path) -> None:
    words = ["effective", "--density", "0.2", "--json"]
    book = tmp_path / "study.ledger"
    process = subprocess.Popen([sys.executable, "-m", "hsictrl", *words, "--ledger", str(book)],
                               stdout=subprocess.DEVNULL)
    while process.poll() is None and not Ledger(book).trials():
        time.sleep(0.01)
    process.kill()
    process.wait()
    resumed = RUNNER.invoke(app, [*words, "--ledger", str(book), "--resume"])
    assert resumed.exit_code == 0
    assert resumed.stdout == RUNNER.invoke(app, words).stdout


def test_two_studies_at_once_share_one_ledger(alone: np.ndarray, tmp_path: Path) -> None:
    book, counts = tmp_path / "study.ledger", tmp_path / "counts"
    pair_of_them = [child(book, partial(counted, counts)) for _ in range(2)]
    for process in pair_of_them:
        process.start()
    for process in pair_of_them:
        process.join()
    assert [process.exitcode for process in pair_of_them] == [0, 0]
    assert intact(book)
    before = runs(counts)
    assert run(book, trial=partial(counted, counts)).samples.tobytes() == alone.tobytes()
    assert runs(counts) == before


def test_a_second_study_waits_while_a_first_one_writes(alone: np.ndarray, tmp_path: Path) -> None:
    book = tmp_path / "study.ledger"
    with (
        ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("forkserver")) as pool,
        closing(sqlite3.connect(book, isolation_level=None)) as other,
    ):
        pool.submit(run, book, max_trials=10).result()
        other.execute("BEGIN IMMEDIATE")
        second = pool.submit(run, book)
        time.sleep(0.5)
        assert not second.done()
        other.execute("COMMIT")
        assert second.result().samples.tobytes() == alone.tobytes()


def test_a_killed_worker_is_explained_and_what_was_done_is_kept(alone: np.ndarray, tmp_path: Path) -> None:
    book, trial = tmp_path / "study.ledger", partial(deadly, tmp_path / "flag")
    context = multiprocessing.get_context("forkserver")
    with (
        ProcessPoolExecutor(2, mp_context=context) as executor,
        pytest.raises(RuntimeError, match=r"workers must live .*, got BrokenProcessPool.*; look .*goes on from its l"),
    ):
        run(book, trial=trial, executor=executor)
    assert Ledger(book).trials()["trials"] >= 50
    assert run(book, trial=trial).samples.tobytes() == alone.tobytes()


def test_a_failed_trial_loses_none_before_it(tmp_path: Path) -> None:
    limit = lognormal(trial_rng(1, 17))

    def fails(rng: np.random.Generator) -> float:
        value = lognormal(rng)
        return 1 / 0 if value == limit else value

    with pytest.raises(TrialError, match="trial 17 of seed 1 failed"):
        run(tmp_path / "study.ledger", trial=fails)
    assert Ledger(tmp_path / "study.ledger").trials() == {"trials": 17}


def test_a_full_disk_is_explained_and_spoils_nothing(
    alone: np.ndarray, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
) -> None:
    connect = sqlite3.connect

    def cramped(*args: Any, **kwargs: Any) -> sqlite3.Connection:
        file = connect(*args, **kwargs)
        file.execute("PRAGMA max_page_count = 6")
        return file

    book = tmp_path / "study.ledger"
    with monkeypatch.context() as patch:
        patch.setattr(ledger.sqlite3, "connect", cramped)
        with pytest.raises(RuntimeError, match=r"ledger .* must stay .*writable, got: database or disk is full; see"):
            run(book, max_trials=1000)
    assert intact(book)
    assert 50 < Ledger(book).trials()["trials"] < 1000
    assert run(book).samples.tobytes() == alone.tobytes()


def test_a_stricter_rule_starts_from_the_samples_there_are(tmp_path: Path) -> None:
    counts = tmp_path / "counts"
    trial = partial(counted, counts)
    rough = run(tmp_path / "study.ledger", trial=trial, rule=MeanRule(tolerance=0.2))
    fine = run(tmp_path / "study.ledger", trial=trial, rule=MeanRule(tolerance=0.035))
    assert (rough.n_trials, fine.n_trials, runs(counts).total()) == (100, 150, 150)
    assert fine.samples[:100].tobytes() == rough.samples.tobytes()


def test_several_quantities_keep_their_shape_and_digits(tmp_path: Path) -> None:
    first, again = (run(tmp_path / "study.ledger", trial=pair) for _ in range(2))
    assert again.samples.shape == (N, 2)
    assert again.samples.tobytes() == first.samples.tobytes()


def test_studies_are_kept_apart_by_their_label(tmp_path: Path) -> None:
    book = tmp_path / "study.ledger"
    one, two = run(book, label="one"), run(book, label="two", seed=2, max_trials=120)
    assert Ledger(book).trials() == {"one": N, "two": 120}
    assert one.samples[0] != two.samples[0]


@dataclass(frozen=True)
class Bridge:
    damping: float = 0.005
    shape: Any = 0


@dataclass(frozen=True)
class Crossing:
    bridge: Bridge = Bridge()

    def __call__(self, rng: np.random.Generator) -> float:
        return rng.normal(self.bridge.damping, 0.1)


class Side(Enum):
    LEFT = 1
    RIGHT = 2


class Plain:
    def __init__(self, value: float) -> None:
        self.value = value


def shifted(shift: float) -> Any:
    return lambda rng: rng.random() + shift


def test_a_changed_study_is_refused_with_what_changed(tmp_path: Path) -> None:
    book = tmp_path / "study.ledger"
    run(book, trial=Crossing(), label="my bridge")
    message = (r"^a study must stay what it was, but 'my bridge' changed: trial.bridge.damping 0.005 → 0.01; "
               r"seed 1 → 2; choose a new file for the ledger, or undo the change$")
    with pytest.raises(ChangedStudyError, match=message):
        run(book, trial=Crossing(Bridge(0.01)), seed=2, label="my bridge")
    assert Ledger(book).trials() == {"my bridge": N}


def test_another_version_is_another_study(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run(tmp_path / "study.ledger")
    message = rf"changed: hsictrl {hsi.__version__} → 9.9.9; choose"
    monkeypatch.setattr(hsi, "__version__", "9.9.9")
    with pytest.raises(ChangedStudyError, match=message):
        run(tmp_path / "study.ledger")


VALUES = [
    0, 1, 1.0, np.nextafter(1.0, 2), "1", None, True, Side.LEFT, Side.RIGHT, ..., b"1", np.float32(1),
    (1, 2), [1, 2], (2, 1), {1, 2}, {1, 3}, {"a": 1}, {"a": 2}, {(1, 2): 1}, np.arange(3), np.arange(3.0),
    np.arange(100.0), np.arange(100.0) + np.eye(100)[99], np.arange(100.0).reshape(10, 10), Plain(1.0), Plain(2.0),
    shifted(1.0), shifted(2.0), lambda rng: rng.random(), lambda rng: rng.normal(), partial(counted, Path("a")),
    partial(counted, Path("b")), partial(counted, path=Path("a")), lognormal, pair, lru_cache(pair), np.sin, np.cos,
    PeakTrial, trial_rng(1, 1), trial_rng(1, 2), trial_rng(1, 1).normal, Bridge().__eq__, Bridge(1.0).__eq__,
    np.random.default_rng, os.getpid, deque([1]), deque([2]),
]


def test_whatever_a_trial_holds_tells_it_from_others() -> None:
    digests = [identity.digest(identity.described(Crossing(Bridge(shape=value)), 1)) for value in VALUES]
    again = [identity.digest(identity.described(Crossing(Bridge(shape=value)), 1)) for value in VALUES]
    assert len(set(digests)) == len(VALUES)
    assert digests == again


def test_many_changes_are_counted() -> None:
    one, two = (identity.described(Crossing(Bridge(shape=values)), 1) for values in ((1, 2, 3, 4, 5, 6), (0,) * 6))
    assert identity.changes(one, two).startswith("trial.bridge.shape[0] 1 → 0; ")
    assert identity.changes(one, two).endswith("trial.bridge.shape[3] 4 → 0; and 2 more")
    assert identity.changes(identity.described(Crossing(), 1), one).startswith(
        "trial.bridge.shape 0 → builtins.tuple; trial.bridge.shape[0] nothing → 1; ")


def unordered() -> str:
    inside = ({"a", "b", "c", None, 2}, lambda x: x in {"p", "q", "r"}, {"k": 1, "j": 2})
    return identity.digest(identity.described(Crossing(Bridge(shape=inside)), 1))


def test_a_study_is_known_again_in_another_process() -> None:
    # the order of a set of strings is another one in each process
    paths = os.pathsep.join([str(Path(__file__).parent), *sys.path])
    found = subprocess.run([sys.executable, "-c", "import test_ledger; print(test_ledger.unordered())"], check=True,
                           capture_output=True, text=True, env={**os.environ, "PYTHONPATH": paths})
    assert found.stdout.strip() == unordered()


def test_every_field_of_a_peak_trial_counts() -> None:
    trial = PeakTrial(model="PMC", bridge=hsi.reference_bridge(), flow=hsi.CrowdFlow(density=0.2))
    others = [replace(trial, model="MF"), replace(trial, bridge=hsi.reference_bridge(damping=0.006)),
              replace(trial, flow=hsi.CrowdFlow(density=0.2, weight=701.0)), replace(trial, force=hsi.YoungForce())]
    words = [identity.described(one, 1) for one in (trial, *others)]
    assert len(set(map(identity.digest, words))) == len(words)
    assert identity.changes(words[0], words[2]) == "trial.bridge.modes[0].damping 0.005 → 0.006"


def test_a_trial_is_a_small_message() -> None:
    trial = PeakTrial(model="PMC", bridge=hsi.reference_bridge(), flow=hsi.CrowdFlow(density=0.2))
    assert len(pickle.dumps(trial)) < 1000    # bytes; each piece of some trials carries one


def other_database(path: Path) -> Path:
    with closing(sqlite3.connect(path)) as file:
        file.executescript("CREATE TABLE addresses (name); PRAGMA user_version = 1;")
    return path


def text(path: Path) -> Path:
    path.write_text("damping = 0.005\n" * 100)
    return path


def endless(rng: np.random.Generator) -> float:
    return 0.0


endless.itself = endless_list = []
endless_list.append(endless_list)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda folder: Ledger(3), TypeError, r"path must be of type str or Path, got int; give the name of a file"),
        (lambda folder: Ledger(folder / "no" / "a"), ValueError, r"folder of a ledger must exist, got .*no; make it"),
        (lambda folder: Ledger(folder), ValueError, r"must be a file that can be written, got .*; choose a new file"),
        (lambda folder: Ledger(text(folder / "a")), ValueError,
         r"must be a file made by hsictrl, got .*a: file is not a database; choose a new file for the ledger"),
        (lambda folder: Ledger(other_database(folder / "a")), ValueError,
         r"must be a file made by this version of hsictrl, got .*a; choose a new file for the ledger"),
        (lambda folder: monte_carlo(lognormal, ledger="study.ledger"), TypeError,
         r"ledger must be of type Ledger, got str; give Ledger\(path\), or None"),
        (lambda folder: run(folder / "a", trial=partial(lognormal, sys._getframe())), TypeError,
         r"must be able to tell trial.args\[0\] from another, got <frame.*; give a function, or a dataclass"),
        (lambda folder: run(folder / "a", trial=partial(lognormal, endless_list)), ValueError,
         r"a trial must not contain itself, got trial.args\[0\]\[0\].*; give a frozen dataclass"),
    ],
)
def test_refusals_say_rule_value_and_remedy(call, error: type[Exception], message: str, tmp_path: Path) -> None:
    with pytest.raises(error, match=message):
        call(tmp_path)


def test_a_refused_file_is_left_as_it_was(tmp_path: Path) -> None:
    for path in (text(tmp_path / "a"), other_database(tmp_path / "b")):
        before = path.read_bytes()
        with pytest.raises(ValueError, match="a ledger must be"):
            Ledger(path)
        assert path.read_bytes() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a", "b"]


def test_an_empty_file_becomes_a_ledger(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    assert Ledger(tmp_path / "a").trials() == {}
    assert run(tmp_path / "a").n_trials == N


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--resume"], "--resume must come with the ledger to go on with, got none; add --ledger FILE"),
        (["--ledger", "BOOK"], "the ledger must be a new file, got BOOK, which holds 100 trials; give --resume to go "
         "on with them, or choose another file by --ledger"),
        (["--ledger", "BOOK", "--resume", "--damping", "0.01"],
         "'0.2 persons/m², effective' changed: trial.bridge.modes[0].damping 0.005 → 0.01; choose a new file"),
        (["--ledger", "BOOK", "--resume", "--seed", "2"], "changed: seed 1 → 2; choose a new file"),
        (["--ledger", "no/BOOK"], "the folder of a ledger must exist, got no; make it first"),
    ],
)
@pytest.mark.parametrize("command", ["effective", "assess"])
def test_commands_refuse_in_words(
    command: str, words: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    case = PeakTrial(model="MF", bridge=hsi.reference_bridge(frequency=2.0, damping=0.005),
                     flow=hsi.CrowdFlow(density=0.2))
    hsi.study_effective(case.bridge, case.flow, rule=MeanRule(tolerance=0.5), ledger=Ledger("BOOK"))
    if command == "assess":     # whose first study is another one
        message = message.replace("'0.2 persons/m², effective'", "'0.2 persons/m², MF'").replace("100", "101")
        monte_carlo(case, max_trials=1, ledger=Ledger("BOOK"), label="0.2 persons/m², MF")
    result = RUNNER.invoke(app, [command, "--density", "0.2", "--tolerance", "0.5", *words])
    assert result.exit_code == 2
    assert message in result.stderr
    assert "Traceback" not in result.stderr

"""The examples run as they stand; those of the paper do so as the documentation is built."""

import re
import runpy
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hsictrl.cli import app

FOLDER = Path(__file__).parent.parent / "examples"
EXAMPLES = sorted([*FOLDER.glob("*.py"), *(FOLDER / "control").glob("*.py")])
EXERCISES = sorted((FOLDER / "exercises").glob("*.py"))


@pytest.mark.filterwarnings("ignore:FigureCanvasAgg is non-interactive")    # where there is a screen
@pytest.mark.parametrize("path", [*EXAMPLES, *EXERCISES], ids=lambda path: path.name)
def test_example_runs(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(path), run_name="__main__")
    assert capsys.readouterr().out


@pytest.mark.parametrize("path", EXERCISES, ids=lambda path: path.name)
def test_exercise_has_its_parts_and_opens_as_a_notebook(path: Path) -> None:
    """Text cells are plain comments; theory, tasks, hints and a solution to each task come in this order."""
    text = path.read_text(encoding="utf-8")
    cells = re.split(r"^# %%(.*)\n", text, flags=re.MULTILINE)
    kinds, bodies = cells[1::2], cells[2::2]
    assert set(kinds) == {"", " [markdown]"}
    for kind, body in zip(kinds, bodies, strict=True):
        assert not kind or all(line.startswith("#") for line in body.strip().splitlines())
    heads = re.findall(r"^# (\w+)\n# -+$", text, flags=re.MULTILINE)
    assert heads == ["Theory", "Tasks", "Hints", "Solution"]
    tasks = re.findall(r"^# (\d)\. ", text, flags=re.MULTILINE)
    assert tasks == re.findall(r"^# \*\*Task (\d)\.\*\*", text, flags=re.MULTILINE) != []


def test_eight_exercises_are_listed() -> None:
    page = (FOLDER.parent / "docs" / "exercises.md").read_text(encoding="utf-8")
    assert re.findall(r"gallery/exercises/(\w+)\.rst", page) == [path.stem for path in EXERCISES]
    assert len(EXERCISES) == 8


def test_the_roads_to_the_occupied_bridge_agree(capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(FOLDER / "control" / "plot_crowd_as_feedback.py"), run_name="__main__")
    difference = float(capsys.readouterr().out.split(":")[1].split()[0])
    assert difference < 1e-14    # m/s² per N, beside a peak of 2e-3


def test_the_study_runs(tmp_path: Path) -> None:
    study = FOLDER / "study.toml"
    done = CliRunner().invoke(app, ["sweep", str(study), "--max-trials", "10", "--output", str(tmp_path)],
                              catch_exceptions=False)
    assert done.exit_code == 0
    assert "R_HSI" in done.stdout
    assert {path.suffix for path in tmp_path.iterdir()} == {".json", ".ledger", ".nc", ".png"}

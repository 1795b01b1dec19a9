"""The examples run as they stand; those of the paper do so as the documentation is built."""

import runpy
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hsictrl.cli import app

FOLDER = Path(__file__).parent.parent / "examples"
EXAMPLES = sorted([*FOLDER.glob("*.py"), *(FOLDER / "control").glob("*.py")])


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_example_runs(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(path), run_name="__main__")
    assert capsys.readouterr().out


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

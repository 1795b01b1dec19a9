"""From nothing to the first frequency response: an environment, `pip install`, and the first Python block of README.md.

Not part of `make bench`, for most of it is the network: `python tests/benchmarks/newcomer.py`.
"""

from __future__ import annotations

import re
import subprocess
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from rows import publish, seconds_of, told

ROOT = Path(__file__).parents[2]


def first_block() -> str:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    found = re.search(r"^```python\n(.*?)^```", readme, re.DOTALL | re.MULTILINE)
    assert found, "README.md shows no Python"
    return found[1]


def timed(*command: str | Path, folder: str) -> str:
    # nothing of the surroundings: an environment finds what is installed in it, and no other
    return told(seconds_of(partial(subprocess.run, [*map(str, command)], cwd=folder, check=True, capture_output=True,
                                   env={"PATH": "/usr/bin:/bin", "MPLBACKEND": "Agg", "HOME": folder})))


def steps() -> list[list[str]]:
    """Seconds of each step, as a newcomer waits for them."""
    with TemporaryDirectory() as folder:
        python = Path(folder) / "env" / "bin" / "python"
        return [["python -m venv env", timed(sys.executable, "-m", "venv", "env", folder=folder)],
                ["pip install", timed(python, "-m", "pip", "install", ROOT, folder=folder)],
                ["the five lines, for the first time", timed(python, "-c", first_block(), folder=folder)],
                ["again", timed(python, "-c", first_block(), folder=folder)]]


if __name__ == "__main__":
    publish("newcomer", "from nothing to the first frequency response", ["step", "takes"], steps(), [])

"""Python blocks of the pages run as they stand, and print what is shown below them; faulty links are found."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import chdir, redirect_stdout
from doctest import ELLIPSIS, NORMALIZE_WHITESPACE, OutputChecker
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parent.parent
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
BLOCK = re.compile(r"^(<!-- not run: [^\n]+ -->\n+)?```python\n(.*?)^```(?:\s+```text\n(.*?)^```)?",
                   re.DOTALL | re.MULTILINE)
# what a page takes for granted, by its name
GIVEN = {
    "fe.md": "from shutil import copy\nfor name in 'nodes', 'modes':\n"
             "    copy(EXAMPLES / f'finite_elements_{name}.csv', f'{name}.csv')\n",
    "trajectories.md": "from runpy import run_path\nglobals().update(run_path(EXAMPLES / 'trajectories.py'))\n",
    "identify.md": "from runpy import run_path\n_, time, acceleration = run_path(DOCS / 'identify.py')['record']()\n",
}


def blocks(page: Path) -> Iterator[tuple[str, str]]:
    """Source, at the lines of the page on which it stands, and what it should print."""
    text = page.read_text(encoding="utf-8")
    for found in BLOCK.finditer(text):
        skipped, source, printed = found.groups()
        if not skipped:
            yield "\n" * text[:found.start(2)].count("\n") + source, printed or ""


def printed_by(source: str, page: Path, names: dict[str, Any]) -> str:
    with redirect_stdout(StringIO()) as out:
        exec(compile(source, page, "exec"), names)
    return out.getvalue()


@pytest.mark.parametrize("page", [page for page in PAGES if any(blocks(page))], ids=lambda page: page.name)
def test_blocks_run_and_print_what_is_shown(page: Path, tmp_path: Path) -> None:
    names: dict[str, Any] = {"__name__": "page", "EXAMPLES": ROOT / "examples", "DOCS": ROOT / "docs"}
    with chdir(tmp_path):
        exec(GIVEN.get(page.name, ""), names)
        for source, shown in blocks(page):
            printed = printed_by(source, page, names)
            same = OutputChecker().check_output(shown, printed, NORMALIZE_WHITESPACE | ELLIPSIS)
            assert not shown or same, f"{source.strip()}\n\nprints\n{printed}\nand the page shows\n{shown}"


@pytest.mark.parametrize(("body", "fault"), [
    ('<a href="missing.html">x</a>', "missing.html: no such file"),
    ('<a href="other.html#nowhere">x</a>', "other.html#nowhere: no such place on that page"),
    ('<a href="#nowhere">x</a>', "#nowhere: no such place on that page"),
    ('<img src="https://elsewhere.org/a.png">', "loads https://elsewhere.org/a.png"),
    ('<code class="xref py py-func">frf</code>', "no target for a xref py py-func name"),
    ('<a href="other.html#here">x</a> <a href="https://elsewhere.org">y</a>', None),
])
def test_faulty_links_are_found(body: str, fault: str | None, tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text(body, encoding="utf-8")
    (tmp_path / "other.html").write_text('<p id="here">', encoding="utf-8")
    done = subprocess.run([sys.executable, ROOT / "docs" / "links.py", tmp_path], capture_output=True, text=True)
    assert (done.returncode, f"index.html: {fault}" in done.stdout) == ((1, True) if fault else (0, False)), done.stdout

"""The Python blocks of the pages run as they stand, and print what is shown below them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import chdir, redirect_stdout
from doctest import ELLIPSIS, NORMALIZE_WHITESPACE, OutputChecker
from io import StringIO
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest

ROOT = Path(__file__).parent.parent
PAGES = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])
BLOCK = re.compile(r"^(<!-- not run: [^\n]+ -->\n+)?```python\n(.*?)^```(?:\s+```text\n(.*?)^```)?",
                   re.DOTALL | re.MULTILINE)
# what a page takes for granted, by its name
GIVEN = {
    "fe.md": "from shutil import copy\nfor name in 'nodes', 'modes':\n"
             "    copy(EXAMPLES / f'finite_elements_{name}.csv', f'{name}.csv')\n",
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
    plt.close("all")

"""Tables of what was measured, `{benchmarks} NAME`, from the file that `make bench` writes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.util.docutils import SphinxDirective

FILE = Path(__file__).parent.parent / "benchmarks.json"


class Benchmarks(SphinxDirective):
    """One table, with when and on what it was measured above it and its notes below."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        self.env.note_dependency(str(FILE))
        run = json.loads(FILE.read_text(encoding="utf-8"))[self.arguments[0]]
        return self.parse_text_to_nodes("\n".join([told(run["where"]), "", *table(run["columns"], run["rows"]), "",
                                                   *(f"{note}\n" for note in run["notes"])]))


def told(where: dict[str, str]) -> str:
    return f"Measured on {where['date']}: {where['machine']}; {where['versions']}."


def table(columns: list[str], rows: list[list[str]]) -> list[str]:
    return [row_of(columns), row_of(["---"] * len(columns)), *map(row_of, rows)]


def row_of(cells: list[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def setup(app: Any) -> dict[str, Any]:
    app.add_directive("benchmarks", Benchmarks)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

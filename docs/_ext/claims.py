"""What the paper says, and what was found, `{claims}`: one paragraph a claim, from the committed results."""

from __future__ import annotations

from itertools import groupby
from typing import Any

from docutils import nodes
from hsictrl.paper import compute
from sphinx.util.docutils import SphinxDirective


class Claims(SphinxDirective):
    """All claims, by the part of the paper that they are about."""

    def run(self) -> list[nodes.Node]:
        return [node for where, group in groupby(compute("claims").rows, key=lambda row: row["where"])
                for node in (nodes.rubric("", f"Section {where}"), *(paragraph(row) for row in group))]


def paragraph(row: dict[str, str]) -> nodes.paragraph:
    reason = f" {row['verdict'].capitalize()}: {row['reason']}." if row["reason"] else ""
    return nodes.paragraph("", "", nodes.strong("", f"{row['id']} {row['verdict']}. "),
                           nodes.emphasis("", row["says"]), nodes.Text(f" Found: {row['measured']}.{reason}"))


def setup(app: Any) -> dict[str, Any]:
    app.add_directive("claims", Claims)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

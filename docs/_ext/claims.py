"""What the paper says, and what was found, `{claims}`: one paragraph a claim, from the committed results."""

from __future__ import annotations

from collections import Counter
from itertools import groupby
from typing import Any

from docutils import nodes
from sphinx.util.docutils import SphinxDirective

from hsictrl.paper import compute


class Claims(SphinxDirective):
    """All claims, by the part of the paper that they are about."""

    def run(self) -> list[nodes.Node]:
        self.env.note_reread()      # results may have changed while the page has not
        rows = compute("claims").rows
        return [nodes.paragraph("", counted(rows)), *(
            node for where, group in groupby(rows, key=lambda row: row["where"])
            for node in (nodes.rubric("", f"Section {where}"), *map(paragraph, group)))]


def counted(rows: list[dict[str, str]]) -> str:
    count = Counter(row["verdict"] for row in rows)
    return f"Of {len(rows)} claims {count['holds']} hold, {count['fails']} fail, {count['undecided']} are undecided."


def paragraph(row: dict[str, str]) -> nodes.paragraph:
    reason = f" {row['verdict'].capitalize()}: {row['reason']}." if row["reason"] else ""
    return nodes.paragraph("", "", nodes.strong("", f"{row['id']} {row['verdict']}. "),
                           nodes.emphasis("", row["says"]), nodes.Text(f" Found: {row['measured']}.{reason}"))


def setup(app: Any) -> dict[str, Any]:
    app.add_directive("claims", Claims)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

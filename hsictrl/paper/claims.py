"""The claims of the paper, each evaluated by the criterion that was fixed beforehand."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator
from importlib.resources import files

from hsictrl.paper import claims_fig3, claims_fig4, claims_fig8, claims_table2, fig4, fig8, load_cycles, table2
from hsictrl.paper.reports import Finding, Report, Rows, Run

VERDICTS = {True: "holds", False: "fails", None: "undecided"}


def report(run: Run) -> Report:
    """All claims that have a criterion and a finding."""
    findings = _findings(*(study.report(run).rows for study in (fig4, table2, load_cycles, fig8)))
    rows: Rows = [_row(claim, *findings[claim["id"]]()) for claim in _claims()]
    held = sum(row["verdict"] == "holds" for row in rows)
    return Report(name="claims", rows=rows, columns=["id", "where", "says", "measured", "verdict", "reason"],
                  caption=f"{held} of {len(rows)} claims hold by their criterion")


def _findings(effective: Rows, table: Rows, cycles: Rows, bars: Rows) -> dict[str, Callable[[], Finding]]:
    """All findings by id, from the rows of figure 4, table 2, the load cycles and figure 8."""
    return (claims_fig3.FINDINGS | claims_fig4.findings(effective) | claims_table2.findings(table, cycles)
            | claims_fig8.findings(bars))


def _row(claim: dict[str, str], measured: str, holds: bool | None, reason: str) -> dict[str, str]:
    return {"id": claim["id"], "where": claim["where"], "says": claim["says"], "measured": measured,
            "verdict": VERDICTS[holds], "reason": "" if holds else reason,
            "criterion": claim["criterion"]}


def _claims() -> Iterator[dict[str, str]]:
    text = (files("hsictrl.paper") / "claims.toml").read_text(encoding="utf-8")
    yield from tomllib.loads(text)["claim"]

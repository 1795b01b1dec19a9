"""The claims of the paper, each evaluated by the criterion that was fixed beforehand."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator
from importlib.resources import files

from hsictrl.paper import (
    claims_fig3,
    claims_fig4,
    claims_fig7,
    claims_fig8,
    claims_maps,
    claims_table2,
    fig4,
    fig6,
    fig7,
    fig8,
    load_cycles,
    maps,
    table2,
)
from hsictrl.paper.reports import Finding, Report, Rows, Run

VERDICTS = {True: "holds", False: "fails", None: "undecided"}


def report(run: Run) -> Report:
    """All claims, each by its criterion."""
    studies = (fig4.report, fig7.report, table2.report, load_cycles.report, fig8.report, maps.report, maps.stationary)
    findings = _findings(*(study(run).rows for study in studies))
    rows: Rows = [_row(claim, *findings[claim["id"]]()) for claim in _claims()]
    counts = ", ".join(f"{[row['verdict'] for row in rows].count(verdict)} {verdict}" for verdict in VERDICTS.values())
    return Report(name="claims", rows=rows, columns=["id", "where", "says", "measured", "verdict", "reason"],
                  caption=f"{len(rows)} claims by their criterion: {counts}")


def _findings(
    effective: Rows, eeklo: Rows, table: Rows, cycles: Rows, bars: Rows, cells: Rows, stationary: Rows,
) -> dict[str, Callable[[], Finding]]:
    """All findings by id, from the rows of figures 4 and 7, table 2, the load cycles, figure 8 and the maps."""
    return (claims_fig3.FINDINGS | {"C17": fig6.straight} | claims_fig4.findings(effective)
            | claims_fig7.findings(eeklo) | claims_table2.findings(table, cycles) | claims_fig8.findings(bars)
            | claims_maps.findings(cells, stationary))


def _row(claim: dict[str, str], measured: str, holds: bool | None, reason: str) -> dict[str, str]:
    return {"id": claim["id"], "where": claim["where"], "says": claim["says"], "measured": measured,
            "verdict": VERDICTS[holds], "reason": "" if holds else reason,
            "criterion": claim["criterion"]}


def _claims() -> Iterator[dict[str, str]]:
    text = (files("hsictrl.paper") / "claims.toml").read_text(encoding="utf-8")
    yield from tomllib.loads(text)["claim"]

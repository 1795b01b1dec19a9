"""An assessment as tables on the terminal, and what stands below them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import Any

from rich.table import Table

from hsictrl._digits import significant
from hsictrl.assessment import Assessment
from hsictrl.cli import tables
from hsictrl.cli.description import Description
from hsictrl.cli.outcome import Rows
from hsictrl.cli.tables import Column, Row, estimate
from hsictrl.study import PercentileRule


def table(found: Sequence[Assessment], rule: PercentileRule) -> Table:
    """A row per flow: what interaction does to the bridge, and to its acceleration."""
    accelerations = [Column(f"a{rule.percentile:g} {model}", "[m/s²]", estimate(
        f"a_{model.lower()}", unit="_m_per_s2", trials=f"a_{model.lower()}_trials")) for model in ("MF", "PMC")]
    return tables.table([
        tables.FLOW,
        Column("f_eff", "[Hz]", estimate("f_eff", unit="_hz", trials="effective_trials", digits=4)),
        Column("ξ_eff", "[%]", estimate("xi_eff", trials="effective_trials", scale=100.0)),
        *accelerations,
        Column("R_HSI", "[-]", estimate("r_hsi")),
        Column("comfort", "MF→PMC", _comfort),
        Column("HiVoSS", "[m/s²]", lambda row: significant(row["hivoss_m_per_s2"])),
    ], [one.to_dict() for one in found])


def guide_rows(found: Sequence[Assessment]) -> Rows:
    """The load cases of the guides, each with the traffic that it is for."""
    return [{**_traffic(one), **case.to_dict()} for one in found for case in one.guides]


def guide_table(rows: Rows) -> Table:
    """A row per flow, mode and direction, the guides side by side."""
    keys = ("density_per_m2", "persons", "traffic_class", "mode", "direction")
    merged = [{**(cases := list(same))[0], **{case["guide"]: case for case in cases}}
              for _, same in groupby(rows, key=lambda row: [row[key] for key in keys])]
    return tables.table([
        tables.FLOW,
        Column("mode", "", lambda row: str(row["mode"])),
        Column("direction", "", lambda row: row["direction"], "left"),
        Column("f", "[Hz]", lambda row: significant(row["frequency_hz"], 4)),
        Column("m", "[t]", lambda row: significant(row["modal_mass_kg"] / 1e3)),
        Column("n′", "[1/m²]", lambda row: significant(row["equivalent_pedestrians_per_m2"])),
        Column("HiVoSS", "[m/s²]", lambda row: _guide(row, "hivoss")),
        Column("Sétra", "[m/s²]", lambda row: _guide(row, "setra")),
    ], merged)


def notes(case: Description, rule: PercentileRule, found: Sequence[Assessment]) -> list[str]:
    """What stands below the tables."""
    percentile = f"{rule.percentile:g}"
    resonant = [f"Mode in resonance: {found[0].mode}."] if case.bridge.n_modes > 1 else []
    goals = ["Goal: met or not met if the whole interval lies on one side of its bound, otherwise undecided."]
    return [
        *tables.case_notes(case), *resonant,
        f"a{percentile}: percentile {percentile} of the peak acceleration. f_eff, ξ_eff: means. "
        f"{tables.interval_note(rule)}",
        "MF: moving forces on the empty bridge, without interaction. PMC: moving forces on the bridge with a standing "
        "crowd, with interaction.",
        f"R_HSI: a{percentile} MF / a{percentile} PMC (eq. 18). HiVoSS, Sétra: design accelerations of the guides.",
        *(goals if case.goals else []),
        *(f"Remark on {one.flow}: {remark}." for one in found for remark in one.remarks)]


def _traffic(one: Assessment) -> dict[str, Any]:
    return {"density_per_m2": one.flow.density_on(one.bridge), "persons": one.flow.persons_on(one.bridge),
            "traffic_class": one.flow.traffic_class}


def _comfort(row: Row) -> str:
    classes = f"{row['class_mf']}→{row['class_pmc']}"
    return f"{classes}\ngoal {row['goal']}\n{row['verdict_mf']}\n→{row['verdict_pmc']}" if row["goal"] else classes


def _guide(row: Row, guide: str) -> str:
    case = row.get(guide)
    return f"{significant(case['a_m_per_s2'])} {case['class']}\nψ={significant(case['reduction'])}" if case else "–"

"""Figure 2: the five models, drawn as their assumptions tell (section 2.4)."""

from __future__ import annotations

from typing import Any

import control as ct

from hsictrl.bridge import Footbridge, reference_bridge
from hsictrl.coupling import moving_crowd
from hsictrl.crowd import Traffic
from hsictrl.paper.reports import Report, Rows, Run
from hsictrl.paper.table1 import traffic
from hsictrl.prediction import ASSUMPTIONS, Assumptions

BRIDGE = reference_bridge()
WALKERS, TIME = traffic(BRIDGE, 4), 38.0    # off the middle of the window, so that who moves is not where who stands is
COLUMNS = ["model", "name", "order", "time_variant", "forces_at_m", "forces_move", "added_mass_kg", "bodies_at_m",
           "bodies_move"]


def scene(row: Assumptions, bridge: Footbridge, walkers: Traffic, time: float) -> dict[str, Any]:
    """What a model puts on the deck, and where, by its row of Table 1."""
    people, standing = walkers.standing_on(bridge)
    moving = moving_crowd(bridge, walkers).at(time).positions
    forces_move, bodies_move = row.fixed_driver == "moving", row.interaction == "moving human body models"
    bodies = {"stationary human body models": standing, "moving human body models": moving}.get(row.interaction)
    added = row.interaction == "uniformly distributed crowd mass"
    return {"forces_at_m": (moving if forces_move else walkers.stopped_on(bridge)[1])[:, 0].tolist(),
            "forces_move": forces_move, "added_mass_kg": float(people.mass.sum()) if added else 0.0,
            "bodies_at_m": [] if bodies is None else bodies[:, 0].tolist(), "bodies_move": bodies_move}


def report(run: Run) -> Report:
    """One row per panel."""
    rows = [{"model": model, "name": row.name, "order": row.order, "time_variant": row.time_variant,
             **scene(row, BRIDGE, WALKERS, TIME)} for model, row in ASSUMPTIONS.items()]
    return Report(name="fig2", rows=rows, columns=COLUMNS, draw=lambda: _draw(rows), caption=(
        f"Fig. 2: what each model puts on the reference bridge {TIME:g} s after the first of "
        f"{len(WALKERS.walkers)} walkers stepped on"))


def _draw(rows: Rows) -> ct.ControlPlot:
    from hsictrl import plots
    return plots.models_plot(BRIDGE, {_title(row): row for row in rows})


def _title(row: dict[str, Any]) -> str:
    kind = "time-variant" if row["time_variant"] else "time-invariant"
    return f"{row['model']}: {row['name']}\n$n_s = {row['order']}$, {kind}"

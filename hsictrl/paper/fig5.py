"""Figure 5: the footbridge in Eeklo, and where people stand on it (section 3.4)."""

from __future__ import annotations

from itertools import pairwise

import control as ct

from hsictrl._checks import Array
from hsictrl.paper.eeklo import BRIDGE, SETUPS, beside_centre, setup
from hsictrl.paper.reports import Report, Rows, Run

COLUMNS = ["x_m", "y_m", "from_setup", "in_lateral_torsional", "phi_vertical", "phi_torsion", "phi_lateral"]


def report(run: Run) -> Report:
    """One row per person; they take no time, so they are always computed anew."""
    rows = [row for persons, places in added().items() for row in _rows(persons, places)]
    return Report(name="fig5", rows=rows, columns=COLUMNS, draw=_draw, caption=(
        "Fig. 5: footbridge in Eeklo, its two modes and the places of 3 to 26 persons; frequencies, damping ratios and "
        "modal masses as printed, span, width, shapes and places assumed (docs: choices); persons on the central "
        "stringer are left out where the lateral-torsional mode decays"))


def added() -> dict[int, Array]:
    """Places of those whom each setup adds to the one before."""
    return {persons: setup(persons)[before:] for before, persons in pairwise((0, *SETUPS))}


def _rows(persons: int, places: Array) -> Rows:
    sway, bending = (mode.shape for mode in BRIDGE.modes)
    return [{"x_m": x, "y_m": y, "from_setup": persons, "in_lateral_torsional": beside,
             "phi_vertical": float(bending(x, y)), "phi_torsion": float(sway(x, y)),
             "phi_lateral": float(sway(x, y, "lateral"))}
            for (x, y), beside in zip(places.tolist(), beside_centre(places).tolist(), strict=True)]


def _draw() -> ct.ControlPlot:
    from hsictrl import plots
    first, *others = added().items()
    labels = {f"{first[0]} persons": first[1], **{f"to {persons}": places for persons, places in others}}
    return plots.modes_plot(BRIDGE, labels)

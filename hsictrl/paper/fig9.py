"""Figure 9: the moving force model over natural frequency and modal mass (section 4.4)."""

from __future__ import annotations

from functools import partial

from hsictrl.paper.maps import drawn, rows_of
from hsictrl.paper.reports import Report, Run

DENSITIES, DAMPING = (0.2, 1.0), 0.005
COLUMNS = ["density_per_m2", "f_b_hz", "m_b_kg", "a95_mf_m_per_s2", "a95_mf_low_m_per_s2", "a95_mf_high_m_per_s2",
           "trials"]
LEVELS = (0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 20.0, 24.0)


def report(run: Run) -> Report:
    """A sparse and a dense crowd, ξ_B 0.5 %."""
    rows = [row for row in rows_of(run) if row["density_per_m2"] in DENSITIES and row["xi_b"] == DAMPING]
    return Report(name="fig9", rows=rows, columns=COLUMNS, caption=(
        f"Fig. 9: a95 of the peak acceleration by MF, without interaction, ξ_B {100 * DAMPING:g} %, "
        f"{rows[0]['trials']} trials a cell, 95 % intervals; crowds tuned to the bridge"),
        draw=partial(drawn, rows, "a95_mf", "_m_per_s2", quantity=r"$\ddot{u}_\mathrm{F,max95}$ [m/s²]", levels=LEVELS))

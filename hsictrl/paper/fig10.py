"""Figure 10: the pseudo-moving crowd model over natural frequency and modal mass (section 4.4)."""

from __future__ import annotations

from functools import partial

from hsictrl.paper.maps import drawn, rows_of
from hsictrl.paper.reports import Report, Run

COLUMNS = ["density_per_m2", "xi_b", "f_b_hz", "m_b_kg", "a95_pmc_m_per_s2", "a95_pmc_low_m_per_s2",
           "a95_pmc_high_m_per_s2", "trials"]
LEVELS = (0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0)


def report(run: Run) -> Report:
    """Five densities, three dampings."""
    rows = rows_of(run)
    return Report(name="fig10", rows=rows, columns=COLUMNS, caption=(
        f"Fig. 10: a95 of the peak acceleration by PMC, with interaction, {rows[0]['trials']} trials a cell, 95 % "
        "intervals; crowds tuned to the occupied bridge"),
        draw=partial(drawn, rows, "a95_pmc", "_m_per_s2", levels=LEVELS,
                     quantity=r"$\ddot{u}_\mathrm{HSI,max95}$ [m/s²]"))

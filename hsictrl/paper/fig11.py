"""Figure 11: by how much interaction reduces the response, over natural frequency and modal mass (section 4.4)."""

from __future__ import annotations

from functools import partial

from hsictrl.paper.maps import drawn, rows_of
from hsictrl.paper.reports import Report, Run

COLUMNS = ["density_per_m2", "xi_b", "f_b_hz", "m_b_kg", "r_hsi", "r_hsi_low", "r_hsi_high", "trials"]
LEVELS = (1.0, 1.25, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0)


def report(run: Run) -> Report:
    """Five densities, three dampings."""
    rows = rows_of(run)
    return Report(name="fig11", rows=rows, columns=COLUMNS, caption=(
        f"Fig. 11: R_HSI (eq. 18), a95 by MF over a95 by PMC, {rows[0]['trials']} trials a cell, 95 % intervals by a "
        "paired bootstrap"),
        draw=partial(drawn, rows, "r_hsi", quantity=r"$R_\mathrm{HSI}$ [-]", levels=LEVELS))

"""
Figure 9: design acceleration without interaction
=================================================

a95 by the moving force model over natural frequency and modal mass, ξ_B of 0.5 %, for a sparse and a dense crowd.

**What differs.** The paper reads off up to 6 and 20 m/s²; here it is 4.75 [4.52, 5.23] and 25.6 [24.0, 27.5]
m/s², and both intervals reach across the ends of a band of ±20 % (claim C29, undecided). The grid is coarser
than the paper's, 16 frequencies and 4 modal masses, at 400 trials a cell; ``hsictrl paper fig9 --recompute
--grid paper`` takes steps of 0.1 Hz and 5 t, and 1000 trials.
"""

import hsictrl as hsi
from hsictrl.paper import compute

figure = compute("fig9")
figure.draw()

# %%
# The worst cell of each crowd, and what :func:`~hsictrl.spectral_estimate` says of it without a single trial:

for density in (0.2, 1.0):
    cells = [row for row in figure.rows if row["density_per_m2"] == density]
    worst = max(cells, key=lambda row: row["a95_mf_m_per_s2"])
    a95, low, high = (worst[f"a95_mf_{end}m_per_s2"] for end in ("", "low_", "high_"))
    bridge = hsi.reference_bridge(frequency=worst["f_b_hz"], damping=0.005, modal_mass=worst["m_b_kg"])
    print(f"{density:g} persons/m², {worst['f_b_hz']:g} Hz, {worst['m_b_kg'] / 1e3:g} t: "
          f"{a95:.2f} [{low:.2f}, {high:.2f}] m/s²")
    print(f"    {hsi.spectral_estimate('MF', bridge, hsi.CrowdFlow(density=density))}")

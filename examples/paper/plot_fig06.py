"""
Figure 6: free decay of the bridge with people on it
====================================================

Fifteen people bob the Eeklo bridge into resonance and then stand still, upright or with bent legs. The exponential
through the extremes between 90 and 20 % of the largest gives the damping.

**What differs.** The paper shows measured records, here the decay is simulated, under random bodies. Either posture
gives a straight line through the logarithms (claim C17). A decay shows the damping of the pole; ξ_eff of eq. 17, which
figure 7 draws, is something else, and both stand below.
"""

from hsictrl.paper import compute

figure = compute("fig6")
figure.draw()

# %%
# What is identified, and what the system that decays has:

for row in figure.rows:
    low, high = 100 * row["damping_low"], 100 * row["damping_high"]
    print(f"{row['posture']}: {row['frequency_hz']:.3f} Hz, {100 * row['damping']:.3f} % [{low:.3f}, {high:.3f}], "
          f"R² {row['r_squared']:.4f}")
    print(f"    pole {100 * row['pole_damping']:.3f} %, peak (eq. 17) {100 * row['xi_eff']:.3f} %")

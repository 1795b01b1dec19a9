"""
Figure 11: what interaction takes away
======================================

R_HSI, a95 by MF over a95 by PMC (eq. 18). It grows with density and with falling damping, and is largest from 3.5 to
5 Hz, up to 33.

**What differs: between 2.5 and 3.2 Hz interaction may make things worse.** An empty bridge of 2.7 Hz is too
fast for the first harmonic, and its crowd takes the second. The crowd on it lowers the resonance to below 2.5
Hz, and then the same rule (section 2.2) tunes it to the first harmonic, several times as strong. R_HSI falls to
0.29 [0.28, 0.30] there (0.8 persons/m², 2 %), and is below one beyond its interval in 24 cells, all at 2.7 and
3 Hz, where the paper finds at least one everywhere (claim C36). A designer who tunes the crowd to the empty
bridge would miss the governing case.

Also:

* A reduction of at least 30 % for dense crowds is not found at 1 Hz, nor where the harmonics change, 28 of 384
  cells in all; in sparse crowds of 0.5 % or less and 2 to 6 Hz, not in 11 of 312 (C37).
* "Little effect at 2 % below 2.5 and above 4.5 Hz", R_HSI below 1.5, holds in 88, 62 and 25 % of the cells at
  0.2, 0.5 and 0.8 persons/m² (C38).
"""

from hsictrl.paper import compute

figure = compute("fig11")
figure.draw()

# %%
# The cells where interaction makes things worse, beyond the intervals:

for row in figure.rows:
    if row["r_hsi_high"] < 1 and row["xi_b"] == 0.02:
        print(f"{row['density_per_m2']:g} persons/m², {row['f_b_hz']:g} Hz, {row['m_b_kg'] / 1e3:g} t: "
              f"R_HSI {row['r_hsi']:.2f} [{row['r_hsi_low']:.2f}, {row['r_hsi_high']:.2f}]")

"""
Table 2: five models beside the moving crowd
============================================

a95 of each model over that of the moving crowd model (MC), for two densities, two spreads of step frequencies
(case 1: they scatter, case 2: all the same) and three natural frequencies.

**What differs.** PMC over MC is 1.01 to 1.09, on the safe side by a few per cent. The ratios of SF, MF and MFAM
are larger than printed, by 47, 57 and 43 % in the median: printed are smaller effects of interaction
throughout, as a heavier or better damped bridge has. Modal damping (0.5 %) and modal mass (25 t) behind the
table are not printed; :doc:`/paper` tells which others come closer.
"""

import matplotlib.pyplot as plt
import numpy as np

from hsictrl.paper import compute

rows = [row for row in compute("table2").rows if row["model"] != "MC"]

figure, axes = plt.subplots(layout="constrained")
axes.plot([0.8, 14], [0.8, 14], color="0.5", linewidth=1, label="as printed")
for model, marker, colour in (("SF", "s", "#D55E00"), ("MF", "o", "#0072B2"), ("MFAM", "^", "#009E73"),
                              ("PMC", "D", "#CC79A7")):
    ratio, low, high, printed = np.array([[row[key] for key in ("ratio", "ratio_low", "ratio_high", "printed_ratio")]
                                          for row in rows if row["model"] == model]).T
    axes.errorbar(printed, ratio, yerr=[ratio - low, high - ratio], fmt=marker, color=colour, markersize=4, label=model)
axes.set(xscale="log", yscale="log", xlabel="a95 over that of MC, printed [-]",
         ylabel="a95 over that of MC, found, with 95 % interval [-]")
axes.legend()
plt.show()

# %%
# In numbers: found, and in brackets printed, for natural frequencies of 2.00, 3.25 and 5.00 Hz of case 1, then
# of case 2.

for density in (0.2, 1.0):
    print(f"{density:g} persons/m²")
    for model in ("SF", "MF", "MFAM", "PMC"):
        cells = [row for row in rows if (row["density_per_m2"], row["model"]) == (density, model)]
        cells.sort(key=lambda row: (row["case"], row["f_b_hz"]))
        print(f"  {model:5}" + "  ".join(f"{row['ratio']:5.2f} ({row['printed_ratio']:.2f})" for row in cells))

# %%
# Who lies how far from what is printed:

for model in ("SF", "MF", "MFAM", "PMC"):
    off = [row["ratio"] / row["printed_ratio"] - 1 for row in rows if row["model"] == model]
    print(f"{model:4} median {100 * np.median(off):+.0f} %, from {100 * min(off):+.0f} to {100 * max(off):+.0f} %")

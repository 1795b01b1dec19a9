"""How far `spectral_estimate` is from Monte Carlo on the maps of figures 9 to 11: compare, tabulate and draw.

`python docs/map_error.py` reads the committed results of the maps and writes docs/images/map_error.png.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt

from hsictrl import CrowdFlow, reference_bridge, spectral_estimate
from hsictrl.paper.reports import committed

FIGURE = Path(__file__).parent / "images" / "map_error.png"
MODELS = {"MF": "a95_mf", "PMC": "a95_pmc"}
DENSITY, DAMPING, MASS, FREQUENCY = CELL = ("density_per_m2", "xi_b", "m_b_kg", "f_b_hz")
COLOURS, DASHES = plt.get_cmap("viridis"), ("solid", (0, (5, 1.5)), (0, (5, 1.5, 1, 1.5)), (0, (1, 1)))


def estimate(model, row):
    bridge = reference_bridge(frequency=row[FREQUENCY], damping=row[DAMPING], modal_mass=row[MASS])
    return spectral_estimate(model, bridge, CrowdFlow(density=row[DENSITY])).acceleration


def compared(rows):
    """Error of each cell and model, and the ends of Monte Carlo's own interval, relative to its a95."""
    found = []
    for row in rows:
        for model, key in MODELS.items():
            a95, low, high = (row[f"{key}{end}_m_per_s2"] for end in ("", "_low", "_high"))
            error, low, high = (value / a95 - 1 for value in (estimate(model, row), low, high))
            found.append({"model": model, **{name: row[name] for name in CELL},
                          "error": error, "low": low, "high": high, "inside": low <= error <= high})
    return found


def column(cells, name):
    return np.array([cell[name] for cell in cells])


def values(cells, name):
    return sorted({cell[name] for cell in cells})


def chosen(cells, **wanted):
    return [cell for cell in cells if all(cell[name] == value for name, value in wanted.items())]


def summary(cells):
    """Mean, median size, size that 90 % do not exceed and worst error [%], and the share inside the interval [%]."""
    error = 100 * column(cells, "error")
    median, most, worst = np.quantile(np.abs(error), (0.5, 0.9, 1.0))
    share = 100 * np.mean(column(cells, "inside"))
    return f"{len(cells):5d} | {error.mean():+5.1f} | {median:6.1f} | {most:5.1f} | {worst:5.1f} | {share:5.0f}"


def report(cells):
    """Errors by model, density and damping."""
    print(f"{'':17} | cells |  mean | median |  90 % | worst | inside   [%]")
    for model in MODELS:
        own = chosen(cells, model=model)
        print(f"{model:17} | {summary(own)}")
        for name, label in ((DENSITY, "density"), (DAMPING, "damping")):
            for value in values(own, name):
                print(f"{model:4}{label} {value:<5g} | {summary(chosen(own, **{name: value}))}")
    reach = (column(cells, "high") - column(cells, "low")) / 2
    print(f"Monte Carlo's own 95 % interval: median ±{100 * np.median(reach):.1f} %")
    for cell in sorted(cells, key=lambda cell: -abs(cell["error"]))[:5]:
        print("  worst", cell["model"], *(f"{name} {cell[name]:g}" for name in CELL), f"{100 * cell['error']:+.0f} %")


def along(cells, name, level):
    """A quantile of one column at each frequency [%]."""
    return [100 * np.quantile(column(chosen(cells, **{FREQUENCY: f}), name), level) for f in values(cells, FREQUENCY)]


def draw_panel(ax, cells, densities):
    """Median over masses by density, with the band they span, over the median of Monte Carlo's interval in grey."""
    ax.fill_between(values(cells, FREQUENCY), along(cells, "low", 0.5), along(cells, "high", 0.5), color="0.85",
                    linewidth=0, label="95 % interval of Monte Carlo, median")
    for k, density in enumerate(densities):
        own, colour = chosen(cells, **{DENSITY: density}), COLOURS(0.85 * k / max(len(densities) - 1, 1))
        ax.fill_between(values(own, FREQUENCY), along(own, "error", 0.0), along(own, "error", 1.0), color=colour,
                        alpha=0.2, linewidth=0)
        ax.plot(values(own, FREQUENCY), along(own, "error", 0.5), color=colour, linestyle=DASHES[k % len(DASHES)],
                linewidth=1.2, label=f"{density:g} /m²")
    ax.axhline(0.0, color="0.4", linewidth=0.6)
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.margins(x=0)


def draw(cells, path=FIGURE):
    """A panel per model and damping."""
    dampings, densities = values(cells, DAMPING), values(cells, DENSITY)
    figure, axes = plt.subplots(len(MODELS), len(dampings), figsize=(9.0, 5.6), sharex=True, sharey=True,
                                squeeze=False, layout="constrained")
    for row, model in zip(axes, MODELS, strict=True):
        for ax, damping in zip(row, dampings, strict=True):
            draw_panel(ax, chosen(cells, model=model, **{DAMPING: damping}), densities)
            ax.set_title(rf"{model}, $\xi_B$ = {100 * damping:g} %", loc="left", fontsize="medium")
    figure.supxlabel("$f_B$ [Hz]", fontsize="medium")
    figure.supylabel("estimate over Monte Carlo, less one [%]", fontsize="medium")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=len(densities) + 1,
                  frameon=False, fontsize="small")
    figure.savefig(path, dpi=120)


def main(rows, path=FIGURE):
    start = time.perf_counter()
    cells = compared(rows)
    print(f"{len(cells)} estimates in {time.perf_counter() - start:.1f} s")
    report(cells)
    draw(cells, path)


if __name__ == "__main__":
    main(committed("maps"))

"""A tuned mass damper sized without and with people on the deck: what the page absorber.md shows.

`python docs/absorber.py` prints its numbers and writes docs/images/absorber.png.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import hsictrl as hsi
from hsictrl.plots import frf_plot

FIGURE = Path(__file__).parent / "images" / "absorber.png"
BRIDGE, RATIO, MIDSPAN = hsi.reference_bridge(frequency=2.0, damping=0.005), 0.01, [25.0]
PEOPLE, X = hsi.Pedestrian(), (np.arange(75) + 0.5) * 50 / 75     # 0.5 persons/m²
DECKS = {"nobody": (), "75 people": (PEOPLE, X)}
HERTZ = np.linspace(1.5, 2.5, 1001)


def bridges():
    """The bridge without and with absorbers, by how these were sized."""
    sized = {"Den Hartog": hsi.Absorber.den_hartog(BRIDGE, mass_ratio=RATIO),
             "Warburton": hsi.Absorber.warburton(BRIDGE, mass_ratio=RATIO),
             "sized empty": hsi.Absorber.tuned(BRIDGE, mass_ratio=RATIO),
             "sized with 75 people": hsi.Absorber.tuned(BRIDGE, [PEOPLE] * len(X), X, mass_ratio=RATIO)}
    return {"no absorber": BRIDGE, **{name: BRIDGE.with_absorbers(one, at=MIDSPAN) for name, one in sized.items()}}


def report(cases):
    """Effective properties, and the design acceleration by the spectral estimate."""
    flow = hsi.CrowdFlow(density=0.5)
    for name, bridge in cases.items():
        print(f"{name}: {', '.join(str(body) for body, _ in bridge.absorbers) or 'nothing'}")
        for deck, people in DECKS.items():
            print(f"    {deck}: {hsi.effective(hsi.couple(bridge, *people))}")
        print("   ", *(hsi.spectral_estimate(model, bridge, flow) for model in ("MF", "PMC")), sep="  ")


def draw(cases, path=FIGURE):
    """|H| over frequency, a panel for each deck."""
    shown = [name for name in cases if name not in ("Den Hartog", "Warburton")]
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 4.0), sharey=True, layout="constrained")
    for ax, (deck, people) in zip(axes, DECKS.items(), strict=True):
        systems = [hsi.couple(cases[name], *people) for name in shown]
        plot = frf_plot([hsi.frf(system, HERTZ) for system in systems], labels=shown, ax=ax)
        ax.set_title(deck, loc="left", fontsize="medium")
        ax.get_legend().remove()
    axes[1].set_ylabel("")
    figure.legend(handles=list(plot.lines[0, 0]), loc="outside upper center", ncols=len(shown), frameon=False)
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    draw(bridges())
    report(bridges())

"""Two close modes under people at one side of the deck: what the page modes.md shows.

`python docs/modes.py` prints its table and writes docs/images/modes.png.
"""

from __future__ import annotations

from pathlib import Path

import control as ct
import matplotlib.pyplot as plt
import numpy as np

import hsictrl as hsi
from hsictrl.plots import frf_plot

FIGURE = Path(__file__).parent / "images" / "modes.png"
ALONG = np.linspace(0.0, 50.0, 51)
TORSION = hsi.SampledShape(x=ALONG, y=[-1.5, 1.5], vertical=np.outer(np.sin(np.pi * ALONG / 50), [-1, 1]))
SPACINGS, SHOWN = (0.2, 0.1, 0.05, 0.03, 0.02, 0.01, 0.005), (0.1, 0.05, 0.01)


def bridge(spacing):
    """Bending at 2 Hz, and torsion higher by a part of it."""
    bending = hsi.Mode(frequency=2.0, damping=0.005, modal_mass=25e3, shape=hsi.SineShape(50.0))
    torsion = hsi.Mode(frequency=2.0 * (1 + spacing), damping=0.005, modal_mass=25e3 / 3, shape=TORSION)
    return hsi.Footbridge(modes=[bending, torsion], length=50.0, width=3.0, mass=50e3)


def occupied(spacing, persons=15):
    """Equal people 0.75 m beside the centre line."""
    x = (np.arange(persons) + 0.5) * 50 / persons
    return hsi.couple(bridge(spacing), hsi.Pedestrian(), np.column_stack([x, np.full(persons, 0.75)]))


def report(persons):
    """By spacing, for both modes: by peak and by pole, how much the other moves along, the competing peak."""
    print(f"{persons} people")
    for spacing in SPACINGS:
        system = occupied(spacing, persons)
        cells = []
        for mode in (0, 1):
            peak, pole = (hsi.effective(system, mode=mode, method=method) for method in ("peak", "pole"))
            rival = max((height / peak.peak for _, height in peak.competing), default=0.0)
            cells.append(f"{peak.frequency:.3f} Hz, {100 * peak.damping:.2f} % | {pole.frequency:.3f} Hz, "
                         f"{100 * pole.damping:.2f} % | {peak.mixing:.2f} | {rival:.2f}")
        print(f"| {100 * spacing:g} % |", " | ".join(cells), "|")


def coordinate(system, mode, hertz):
    """Accelerance on a mode's own coordinate, which `effective` reads."""
    s = 2j * np.pi * hertz
    motion = s**2 * np.linalg.inv(system.dynamic_stiffness(s))[:, mode, mode] / system.bridge.modes[mode].modal_mass
    return ct.frd(motion, 2 * np.pi * hertz)


def draw(path=FIGURE):
    """A panel per spacing, with both coordinates, their effective properties and competing peaks."""
    figure, axes = plt.subplots(1, len(SHOWN), figsize=(9.0, 4.0), sharey=True, layout="constrained")
    for ax, spacing in zip(axes, SHOWN, strict=True):
        system, hertz = occupied(spacing), np.linspace(1.8, 2.3, 1001)
        plot = frf_plot([coordinate(system, mode, hertz) for mode in (0, 1)], labels=["bending", "torsion"],
                        effective=[hsi.effective(system, mode=mode) for mode in (0, 1)], ax=ax)
        ax.set_title(f"{100 * spacing:g} % apart", loc="left", fontsize="medium")
        ax.set_xticks([1.9, 2.0, 2.1, 2.2])
        ax.get_legend().remove()
        ax.set_ylabel("" if ax is not axes[0] else ax.get_ylabel())
    handles = [line for line in plot.lines[0, 0] if line.get_label() in ("bending", "torsion")]
    figure.legend(handles=handles, loc="outside upper center", ncols=2, frameon=False)
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    report(15)
    report(60)
    draw()

"""How far reduced crowds are from those they stand for: run random crowds, or read those that are kept, and tabulate.

`python docs/reduced_error.py` reads docs/reduced_error.json and draws docs/images/reduced.png;
`python docs/reduced_error.py 1000` first runs 1000 crowds of 225 walkers anew, some 5 min on a core.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt

from hsictrl import Crowd, Footbridge, Population, couple, reference_bridge

HERE = Path(__file__).parent
KEPT, FIGURE = HERE / "reduced_error.json", HERE / "images" / "reduced.png"
ORDERS, FREQUENCIES = (2, 4, 6, 8, 10), np.linspace(1.0, 6.0, 11)
OMEGA = 2 * np.pi * np.geomspace(0.5, 10.0, 5000)
BRIDGES = [reference_bridge(frequency=frequency, damping=0.005) for frequency in FREQUENCIES]
COLOURS, DASHES = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, 5)), ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))


def drawn(seed):
    """225 random walkers, and where they stand."""
    rng = np.random.default_rng(seed)
    return Population.walking().sample(225, rng), rng.uniform(0.0, 50.0, 225)


def apparent_mass(people, places):
    """Σ φ² (m₀ + m₁(c s + k)/(m₁s² + c s + k)), written down here once more."""
    s, phi = 1j * OMEGA[:, None], BRIDGES[0].participation(places)[:, 0]
    k, c, m1, m0 = people.stiffness, people.damping_coefficient, people.sprung_mass, people.unsprung_mass
    return (m0 + m1 * (c * s + k) / (m1 * s**2 + c * s + k)) @ phi**2


def error(bridge, mass, other):
    """Largest difference of the two accelerances, relative to the largest."""
    own = 1 - 2j * bridge.damping[0] * bridge.omega[0] / OMEGA - (bridge.omega[0] / OMEGA) ** 2
    return np.max(np.abs(1 / (own + other) - 1 / (own + mass))) / np.max(np.abs(1 / (own + mass)))


def errors(mass, other):
    return np.array([error(bridge, mass, other) for bridge in BRIDGES])


def mean_oscillator(people, places):
    """Modal mass of the crowd, with its mean frequency and damping: the oscillator of two-degree-of-freedom models."""
    share = BRIDGES[0].participation(places)[:, 0] ** 2 * people.mass
    mass = share.sum() * BRIDGES[0].modes[0].modal_mass
    return Crowd(mass=mass, frequency=np.average(people.frequency, weights=share),
                 damping=np.average(people.damping, weights=share)), [25.0]


def compared(seed):
    """Of each order the largest error over the bridges, the largest bound, and bound over error where that is least."""
    people, places = drawn(seed)
    mass = apparent_mass(people, places)
    row = {"seed": seed, "mean": errors(mass, apparent_mass(*mean_oscillator(people, places))).max()}
    for order in ORDERS:
        small = people.reduced(order=order, bridge=BRIDGES[0], positions=places)
        other = apparent_mass(*small)
        found, bounds = errors(mass, other), np.array([small.bound(bridge) for bridge in BRIDGES])
        power = np.max(OMEGA * other.imag)      # what comes out per velocity squared: never above zero
        row[str(order)] = [found.max(), bounds.max(), np.min(bounds / found), power]
    return row


def run(crowds):
    rows = [compared(seed) for seed in range(crowds)]
    KEPT.write_text(json.dumps(json.loads(json.dumps(rows), parse_float=lambda text: float(f"{float(text):.5g}"))))


def report(rows):
    print(f"{len(rows)} crowds; percent of the peak, worst of {len(FREQUENCIES)} bridges from 1 to 6 Hz")
    mean = np.array([row["mean"] for row in rows])
    print(f"mean oscillator: error {spread(mean)}")
    for order in ORDERS:
        found, bounds, ratio, power = np.array([row[str(order)] for row in rows]).T
        print(f"order {order:2d}: error {spread(found)}; bound {spread(bounds)}, over error {ratio.min():.5f} or more, "
              f"over its largest at most {np.max(bounds / found):.3f}; largest power {power.max():.2g}")


def spread(values):
    return f"median {100 * np.median(values):.3g}, largest {100 * np.max(values):.3g}"


def several_modes(n_modes, order, crowds=8):
    """Error and bound on a beam of several modes, in the norm of the bound."""
    bridge = Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=0.005,
                                         n_modes=n_modes)
    rows = []
    for seed in range(crowds):
        people, places = drawn(seed)
        small = people.reduced(order=order, bridge=bridge, positions=places)
        rows.append([modal_error(couple(bridge, people, places), couple(bridge, *small)), small.bound(bridge)])
    found, bounds = np.transpose(rows)
    print(f"{n_modes} modes, order {order}, {crowds} crowds: error {spread(found)}; bound over error "
          f"{np.min(bounds / found):.2f} to {np.max(bounds / found):.2f}")


def modal_error(full, small):
    s = 2j * np.pi * np.geomspace(0.5, 60.0, 3000)
    X, Y = (s[:, None, None] ** 2 * np.linalg.inv(system.dynamic_stiffness(s)) for system in (full, small))
    return np.linalg.norm(Y - X, 2, axis=(1, 2)).max() / np.linalg.norm(X, 2, axis=(1, 2)).max()


def draw(seed):
    """Errors of one crowd over the bridge's frequency."""
    people, places = drawn(seed)
    mass = apparent_mass(people, places)
    figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
    axes.semilogy(FREQUENCIES, 100 * errors(mass, apparent_mass(*mean_oscillator(people, places))), color="0.5", lw=2,
                  label="mean oscillator")
    for order, colour, dash in zip(ORDERS, COLOURS, DASHES, strict=True):
        small = people.reduced(order=order, bridge=BRIDGES[0], positions=places)
        found, bounds = errors(mass, apparent_mass(*small)), np.array([small.bound(bridge) for bridge in BRIDGES])
        axes.semilogy(FREQUENCIES, 100 * found, color=colour, ls=dash, label=f"order {order}")
        axes.semilogy(FREQUENCIES, 100 * bounds, ".", color=colour, ms=4)
    axes.plot([], [], "k.", ms=4, label="bounds")
    axes.set(xlabel="Natural frequency of the bridge [Hz]", ylabel="Largest error [% of the peak]", xlim=(1, 6))
    axes.legend(fontsize="small", loc="center left", bbox_to_anchor=(1, 0.5))
    axes.grid(alpha=0.3)
    figure.savefig(FIGURE, dpi=150)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        run(int(sys.argv[1]))
    report(json.loads(KEPT.read_text()))
    for n_modes, order in ((2, 6), (2, 12), (2, 20), (3, 12), (3, 20), (3, 30)):
        several_modes(n_modes, order)
    draw(0)

"""How far `spectral_estimate` is from Monte Carlo: run trials, or read those that are kept, and tabulate.

`python docs/spectral_error.py` reads docs/spectral_error.json;
`python docs/spectral_error.py 45` first runs 45 trials a cell anew, some 10 min on a core.
"""

from __future__ import annotations

import json
import random
import sys
from itertools import product
from pathlib import Path

import numpy as np

from hsictrl import CrowdFlow, reference_bridge, spectral_estimate, trial_rng
from hsictrl.assessment import PeakTrial

HERE = Path(__file__).parent
KEPT = HERE / "spectral_error.json"
MODELS, FREQUENCIES = ("MF", "PMC"), (1.5, 2.0, 2.5, 3.25, 4.0, 5.0)
DENSITIES, DAMPINGS = (0.2, 0.5, 0.8, 1.0, 1.5), (0.002, 0.005, 0.02)


def cells():
    """All of them in an arbitrary order, each with a seed of its own."""
    order = list(product(MODELS, FREQUENCIES, DENSITIES, DAMPINGS))
    random.Random(0).shuffle(order)
    return [(*cell, 1000 + k) for k, cell in enumerate(order)]


def case(frequency, density, damping):
    return reference_bridge(frequency=frequency, damping=damping), CrowdFlow(density=density)


def simulated(model, frequency, density, damping, seed, trials):
    """Mean square and peak of each trial [m²/s⁴, m/s²]."""
    bridge, flow = case(frequency, density, damping)
    trial = PeakTrial(model=model, bridge=bridge, flow=flow)
    drawn = [trial.prediction(trial_rng(seed, i)) for i in range(trials)]
    return [[float(np.mean(one.response.y**2)), one.peak_acceleration] for one in drawn]


def run(trials):
    rows = [{"cell": cell, "trials": np.round(simulated(*cell, trials), 6).tolist()} for cell in cells()]
    KEPT.write_text(json.dumps(rows))


def compared(row):
    """Relative errors of rms and a95, and Monte Carlo's own standard errors."""
    model, *rest, _ = row["cell"]
    found = spectral_estimate(model, *case(*rest))
    square, peak = np.array(row["trials"]).T
    rms, a95 = np.sqrt(square.mean()), percentile(peak)
    again = np.random.default_rng(0).choice(peak, (1000, len(peak)))
    return {"rms": found.rms / rms - 1, "rms_error": square.std() / square.mean() / np.sqrt(len(square)) / 2,
            "a95": found.acceleration / a95 - 1, "a95_error": np.std(percentile(again)) / a95,
            "factor": found.peak_factor / (a95 / rms) - 1}


def percentile(peaks):
    return np.quantile(peaks, 0.95, axis=-1, method="median_unbiased")


def spread(errors):
    """Mean, median size and largest size in percent."""
    size = 100 * np.abs(errors)
    return f"{100 * np.mean(errors):+5.1f} | {np.median(size):4.1f} | {size.max():5.1f}"


def report(rows, found):
    """Error by group, rms and a95."""
    groups = {"all": lambda cell: True}
    for i, (name, values) in enumerate({"model": MODELS, "f_B": FREQUENCIES, "d": DENSITIES, "xi": DAMPINGS}.items()):
        groups |= {f"{name} {value}": lambda cell, i=i, v=value: cell[i] == v for value in values}
    for model in MODELS:
        groups |= {f"{model}, sparse": lambda cell, m=model: cell[0] == m and cell[2] < 1,
                   f"{model}, dense": lambda cell, m=model: cell[0] == m and cell[2] >= 1}
    for name, member in groups.items():
        chosen = [one for row, one in zip(rows, found, strict=True) if member(row["cell"])]
        print(f"{name:12}", *(spread([one[key] for one in chosen]) for key in ("rms", "a95")), sep=" | ")
    for key in ("rms", "a95"):
        noise = np.array([one[f"{key}_error"] for one in found])
        errors = np.array([one[key] for one in found])
        print(f"{key}: Monte Carlo's own standard error, median {100 * np.median(noise):.1f} %; rms of errors "
              f"{100 * np.sqrt(np.mean(errors**2)):.1f} %, of Monte Carlo's {100 * np.sqrt(np.mean(noise**2)):.1f} %")
        for i in np.argsort(-np.abs(errors))[:5]:
            print("  worst", rows[i]["cell"], f"{100 * errors[i]:+.0f} % ± {100 * noise[i]:.0f} %")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        run(int(sys.argv[1]))
    kept = json.loads(KEPT.read_text())
    errors = [compared(row) for row in kept]
    report(kept, errors)

"""How often the intervals of `subspace_identification` hold a pole that is known: identify, or read what was kept.

`python docs/subspace_coverage.py` reads docs/subspace_coverage.json;
`python docs/subspace_coverage.py anew` first identifies 100 records a case anew, a minute or two on a core.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
from scipy.stats import binomtest

import hsictrl as hsi

KEPT = Path(__file__).parent / "subspace_coverage.json"
RECORDS, SENSORS = 100, [12.5, 25.0, 37.5]
# persons, frequency of the empty bridge and highest frequency sought [Hz], duration [s], noise of sensors [m/s²]
CASES = [(15, 2.0, 3.0, 600.0, 1e-3), (75, 2.0, 3.0, 600.0, 1e-3), (15, 3.25, 5.0, 600.0, 1e-3),
         (15, 2.0, 3.0, 600.0, 5e-3), (15, 2.0, 6.0, 600.0, 1e-3), (15, 2.0, 3.0, 180.0, 1e-3),
         (75, 3.25, 5.0, 600.0, 1e-3)]


def occupied(persons, frequency):
    """The reference bridge with random people at even distances."""
    people = hsi.Population.walking().sample(persons, np.random.default_rng(0))
    return hsi.couple(hsi.reference_bridge(frequency=frequency), people, (np.arange(persons) + 0.5) * 50 / persons)


def record(persons, frequency, duration, noise, seed):
    return hsi.virtual_measurement(occupied(persons, frequency), sense_at=SENSORS, duration=duration, noise=noise,
                                   rng=np.random.default_rng(seed))


def identified(case):
    """Estimates and standard errors of the mode nearest to the pole, one row per seed from 0 on; its row of none."""
    persons, frequency, highest, duration, noise = case
    pole = hsi.effective(occupied(persons, frequency), method="pole")
    rows, modes = [], []
    for seed in range(RECORDS):
        found = hsi.subspace_identification(record(persons, frequency, duration, noise, seed), highest=highest)
        mode = found.nearest(pole.frequency)
        rows.append([float(f"{value:.6g}") for value in (*mode, mode.frequency_error, mode.damping_error)])
        modes.append(len(found.modes))
    return {"case": case, "pole": [*pole], "identified": rows, "modes": modes}


def report(kept):
    print("persons, f_B, highest, duration, noise: f, ξ and both held [95 % interval], half widths of f and ξ [%], "
          "records with other modes too")
    for one in kept:
        rows, pole = np.array(one["identified"]), np.array(one["pole"])
        reach = 2.00958 * rows[:, 2:]          # Student's t, 49 degrees of freedom
        held = np.abs(rows[:, :2] - pole) < reach
        counts = (*held.sum(axis=0).tolist(), int(held.all(axis=1).sum()))
        ends = [binomtest(count, len(rows)).proportion_ci() for count in counts]
        width = 100 * np.median(reach, axis=0) / pole
        bias = 100 * (rows[:, :2].mean(axis=0) / pole - 1)
        print(*one["case"], ":", *(f"{count} [{100 * end.low:.0f}, {100 * end.high:.0f}]"
                                   for count, end in zip(counts, ends, strict=True)),
              f"{width[0]:.2f} {width[1]:.0f}, bias {bias[0]:+.2f} {bias[1]:+.1f},", sum(np.array(one["modes"]) > 1))


if __name__ == "__main__":
    if sys.argv[1:] == ["anew"]:
        KEPT.write_text(json.dumps([identified(case) for case in CASES]) + "\n")
    report(json.loads(KEPT.read_text()))

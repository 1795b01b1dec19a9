"""Free decay of the occupied reference bridge: what the page identify.md shows.

`python docs/identify.py` prints what is identified and writes docs/images/free_decay.png.
"""

from __future__ import annotations

from pathlib import Path

import control as ct
import numpy as np

import hsictrl as hsi
from hsictrl.plots import decay_plot, save

FIGURE = Path(__file__).parent / "images" / "free_decay.png"


def record():
    """Acceleration at midspan with 15 people: driven for 40 s, then let go, with noise of 1 % of the largest."""
    bridge = hsi.reference_bridge(frequency=2.0, damping=0.005)
    occupied = hsi.couple(bridge, hsi.Pedestrian(), (np.arange(15) + 0.5) * 50 / 15)
    time = np.arange(0.0, 90.0, 0.01)
    force = np.where(time < 40.0, 500.0 * np.sin(2 * np.pi * 1.9707 * time), 0.0)
    response = ct.forced_response(occupied, time, force).outputs
    noise = np.random.default_rng(1).normal(scale=0.01 * np.max(response), size=len(time))
    return occupied, time, response + noise


if __name__ == "__main__":
    occupied, time, acceleration = record()
    decay = hsi.free_decay(acceleration, timepts=time)
    print(decay, *(hsi.effective(occupied, method=method) for method in ("pole", "peak", "halfpower")), sep="\n")
    save(decay_plot(decay), FIGURE)

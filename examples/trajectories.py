"""A simulated and a filmed crowd walk over a bridge: forces move along recorded ways, and bodies with them."""

from pathlib import Path

import numpy as np

import hsictrl as hsi

HERE = Path(__file__).parent
bridge = hsi.reference_bridge(frequency=2.0, damping=0.005)

# the deck as each file has it: along the x axis from (0, 0), and along the y axis from (12, 3) m
simulated = hsi.Traffic.from_trajectories(HERE / "simulated.sqlite", bridge, rng=np.random.default_rng(1))
filmed = hsi.Traffic.from_trajectories(
    HERE / "filmed.txt", bridge, rng=np.random.default_rng(1), origin=(12.0, 3.0), angle=np.pi / 2)

for name, traffic in {"simulated": simulated, "filmed": filmed}.items():
    print(f"{name}: {traffic}, speeds {traffic.walkers.speed.round(2)} m/s, step frequencies "
          f"{traffic.walkers.step_frequency.round(2)} Hz")
    print(*(hsi.predict(model, bridge, traffic) for model in ("MF", "PMC", "MC")), sep="\n")

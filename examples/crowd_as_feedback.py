"""The crowd as a feedback loop around the bridge: three roads to one system, and what it does to the resonance."""

import control as ct
import numpy as np

import hsictrl as hsi

bridge = hsi.reference_bridge(frequency=3.25, damping=0.005)
body = hsi.Pedestrian()
places = [15.0, 25.0, 35.0]

# by hand: a port at every place, a body at every port
plant = bridge.ss(at=places)
bodies = ct.append(*[body.ss(name=f"walker{k}") for k in range(3)])
by_hand = ct.feedback(plant, bodies, sign=+1)

# in one call, condensed
occupied = hsi.couple(bridge, body, places, force_at=places, sense_at=places)

# taken apart again into named blocks
blocks = occupied.interconnected()

omega = 2 * np.pi * np.linspace(1.0, 6.0, 200)
accelerations = by_hand[[f"y[{3 * k + 2}]" for k in range(3)], :]
difference = ct.frequency_response(accelerations, omega).frdata - ct.frequency_response(occupied, omega).frdata
print(f"largest difference between the roads: {np.abs(difference).max():.1e} m/s² per N")
print(f"blocks: {', '.join(block.name for block in blocks.syslist)}")
print(f"empty bridge:  {hsi.effective(bridge)}")
print(f"three walkers: {hsi.effective(hsi.couple(bridge, body, places))}")

"""
The crowd as a feedback loop
============================

Three roads to one system, a bridge with three people who stand on it: the host's ``feedback`` by hand, one
call, and the named blocks that this call can be taken apart into. And what the loop does to the resonance.
"""

import control as ct
import numpy as np

import hsictrl as hsi

bridge = hsi.reference_bridge(frequency=3.25, damping=0.005)
body = hsi.Pedestrian()
places = [15.0, 25.0, 35.0]

# %%
# By hand: a port at every place, a body at every port, and a plus sign, since forces on the deck count downwards as its
# motion does.

plant = bridge.ss(at=places)
bodies = ct.append(*[body.ss(name=f"walker{k}") for k in range(3)])
by_hand = ct.feedback(plant, bodies, sign=+1)

# %%
# In one call, condensed: the frequency response costs the same however many people there are.

occupied = hsi.couple(bridge, body, places, force_at=places, sense_at=places)

omega = 2 * np.pi * np.linspace(1.0, 6.0, 200)
accelerations = by_hand[[f"y[{3 * k + 2}]" for k in range(3)], :]
difference = ct.frequency_response(accelerations, omega).frdata - ct.frequency_response(occupied, omega).frdata
print(f"largest difference between the roads: {np.abs(difference).max():.1e} m/s² per N")

# %%
# Taken apart again into named blocks:

blocks = occupied.interconnected()
print(f"blocks: {', '.join(block.name for block in blocks.syslist)}")

# %%
# Three people are 0.4 % of the bridge's mass, and more than double its damping:

print(f"empty bridge:  {hsi.effective(bridge)}")
print(f"three walkers: {hsi.effective(hsi.couple(bridge, body, places))}")
ct.bode_plot([hsi.couple(bridge), hsi.couple(bridge, body, places)], omega, Hz=True, label=["empty", "three walkers"])

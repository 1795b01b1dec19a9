"""
The crowd as a controller
=========================

Loop gain, sensitivity, root locus and the scatter of poles of 75 people on the reference bridge.
"""

import numpy as np

import hsictrl as hsi
from hsictrl import plots

bridge = hsi.reference_bridge(frequency=2.0, damping=0.005)
places = np.random.default_rng(1).permutation((np.arange(75) + 0.5) * 50 / 75)
occupied = hsi.couple(bridge, hsi.Pedestrian(), places)

# %%
# The loop gain does not encircle −1: every body is passive, so that no crowd makes the loop unstable.

gain = hsi.loop_gain(occupied)
plots.nyquist_plot(gain)

# %%
# The sensitivity is the occupied bridge over the empty one. Where it exceeds one, the crowd amplifies:

print(hsi.amplified_bands(occupied, band=(0.5, 10.0)))
plots.sensitivity_plot(hsi.sensitivity(occupied), band=(0.5, 20.0))

# %%
# The poles as people come, one after the other:

plots.root_locus_plot(hsi.root_locus(bridge, hsi.Pedestrian(), places))

# %%
# And the pole of the bridge under a thousand crowds who may stand on it:

scatter = hsi.pole_scatter(bridge, hsi.CrowdFlow(persons=75), rng=np.random.default_rng(1))
print(scatter)
plots.pole_scatter_plot(scatter)

"""
Figure 5: the footbridge in Eeklo, and where people stand on it
===============================================================

The two modes of section 3.4, and the places of 3 to 26 persons, drawn from the same object as figures 6 and 7 use.

**What differs.** Frequencies, damping ratios and modal masses are printed; span, width, mode shapes and places are not,
and the photograph and the cross section of the paper are not redrawn. Assumed are a span of 42 m, a deck of 3 m, half
sines, girders every 3 m and stringers 1 m beside the centre line; :doc:`/choices` lists all of it, and figure 7 says
what depends on it.
"""

import hsictrl as hsi
from hsictrl.paper import compute

figure = compute("fig5")
figure.draw()

# %%
# The bridge in words:

print(hsi.eeklo_bridge())

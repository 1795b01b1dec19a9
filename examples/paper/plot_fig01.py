"""
Figure 1: a walker, and the two parts of the contact force
==========================================================

A walker is a sprung and an unsprung mass. What the feet do to the deck is the force that they would exert on rigid
ground, the fixed-driver term, plus what the body makes of the motion of the deck, the interaction term (eqs. 3 and 4).

**What differs.** The drawing is made from the objects that the models use: three walkers of a
:class:`~hsictrl.Traffic`, where they are after 36 s, and their walking forces. Only places along the deck and these
forces are to scale.
"""

import numpy as np

import hsictrl as hsi
from hsictrl.paper import compute

figure = compute("fig1")
figure.draw()

# %%
# The deck feels a body as an apparent mass: all of it where the deck moves slowly, the unsprung part where it moves
# fast, and something complex, which damps, in between.

body = hsi.Pedestrian()
print(f"sprung {body.sprung_mass:.1f} kg, unsprung {body.unsprung_mass:.1f} kg, {body.stiffness:.0f} N/m, "
      f"{body.damping_coefficient:.0f} N s/m")
for frequency in (0.01, 2.0, 3.25, 5.0, 1000.0):
    print(f"{frequency:g} Hz: {body.apparent_mass(2j * np.pi * frequency):.1f} kg")

"""Who stands where on the footbridge in Eeklo, and how (section 3.4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.bridge import eeklo_bridge
from hsictrl.pedestrian.population import POSTURES as NAMED

BRIDGE = eeklo_bridge()
SETUPS = (3, 9, 15, 21, 26)
POSTURES = {posture: NAMED[posture] for posture in ("upright", "bent legs")}
SPACING, STRINGERS = 3.0, (-1.0, 1.0, 0.0)     # of cross girders along the deck, and places across it [m]
GIRDERS = (0, -1, 1, -2, 2, -3, 3, -4, 4)      # in the order in which they are occupied, from midspan


def setup(persons: int) -> Array:
    """Places (x, y) [m] of those who stand on the bridge, shape (persons, 2).

    Three at midspan, where stringers cross a girder; then three more on either adjacent girder at a time. Of the last
    setup 26 persons are reported; the one who makes up 27 is left out on the central stringer.
    """
    if persons not in (*SETUPS, 27):
        raise ValueError(f"persons must be one of {', '.join(map(str, SETUPS))} or 27, got {persons}; choose a setup")
    middle = BRIDGE.length / 2
    return np.array([(middle + SPACING * girder, y) for girder in GIRDERS for y in STRINGERS])[:persons]


def beside_centre(places: Array) -> NDArray[np.bool_]:
    """Who takes part in the free decay of the lateral-torsional mode: all but those on the central stringer."""
    return np.asarray(places[:, 1] != 0)

"""How often people step at a speed that they have chosen."""

from __future__ import annotations

from typing import Any

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array

CUBIC = (0.35, -1.59, 2.93, 0.0)     # of v³, v², v, 1


def preferred_step_frequency(speed: Any) -> Array:
    """Step frequency that people prefer at a walking speed: 0.35 v³ − 1.59 v² + 2.93 v.

    The cubic rises at all speeds. It comes to 0.5 Hz at 0.19 m/s, and to 2.5 Hz at 2.2 m/s, where people begin to run.

    Parameters
    ----------
    speed : float or array_like
        Walking speed, 0 to 10 [m/s].

    Returns
    -------
    array, as `speed`
        f_s [Hz].

    Notes
    -----
    Source: Bruno & Venuti (2009), J. Sound Vib. 323, 475–493, who fit it to the measurements of Bertram & Ruina (2001),
    J. Theor. Biol. 209, 445–453. The coefficients are quoted as others use them; unverified: not checked against the
    source.

    Examples
    --------
    >>> float(preferred_step_frequency(1.34).round(2))      # in free flow
    1.91
    """
    v = check.numbers("speed", speed, least=0, most=10, remedy="give m/s, at most 10")
    return np.asarray(np.polyval(CUBIC, v))

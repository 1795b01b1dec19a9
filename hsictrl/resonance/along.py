"""Effective properties from instant to instant, while a crowd walks."""

from __future__ import annotations

from typing import Any

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.coupling import MovingCrowd
from hsictrl.resonance.effective import effective


def effective_along(
    crowd: MovingCrowd, times: Any, *, mode: int = 0, band: Any = None, method: str = "peak",
) -> tuple[Array, Array]:
    """Effective frequency and damping at given times, as if everybody stood still at each of them.

    Parameters
    ----------
    crowd : MovingCrowd
        The bridge and those who walk over it.
    times : array_like, shape (m,)
        Instants [s].
    mode, band, method
        As in `effective`.

    Returns
    -------
    frequency : array, shape (m,)
        Effective frequency f_eff [Hz].
    damping : array, shape (m,)
        Effective damping ratio ξ_eff [-].

    Examples
    --------
    One walker damps the bridge most in the middle of it:

    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import moving_crowd
    >>> from hsictrl.crowd import Traffic, Walker
    >>> from hsictrl.walking import HarmonicForce
    >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> crowd = moving_crowd(reference_bridge(frequency=2.0), Traffic([walker]))
    >>> effective_along(crowd, [0.0, 20.0, 40.0])[1].round(5)
    array([0.005  , 0.00536, 0.005  ])
    """
    check.instance("crowd", crowd, MovingCrowd, "make it with moving_crowd(bridge, traffic)")
    instants = check.numbers("times", times, ndim=1, remedy="give a list of seconds")
    found = [tuple(effective(crowd.at(time), mode=mode, band=band, method=method)) for time in instants]
    frequency, damping = np.array(found, dtype=float).reshape(-1, 2).T
    return frequency, damping

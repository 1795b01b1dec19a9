"""Comfort classes of peak accelerations, and whether a goal is met."""

from __future__ import annotations

from typing import Any

import numpy as np

from hsictrl import _checks as check

COMFORT_CLASSES = ("CL1", "CL2", "CL3", "CL4")
COMFORT_BOUNDS = {"vertical": (0.5, 1.0, 2.5), "lateral": (0.1, 0.3, 0.8)}    # m/s²


def comfort_class(acceleration: float, direction: str = "vertical") -> str:
    """Return the comfort class of a peak acceleration.

    Parameters
    ----------
    acceleration : float
        Peak acceleration of the deck [m/s²].
    direction : {"vertical", "lateral"}
        Direction of the acceleration.

    Returns
    -------
    str
        "CL1" (maximum comfort), "CL2", "CL3" or "CL4" (not acceptable).

    Notes
    -----
    Vertical: CL1 < 0.5 ≤ CL2 < 1.0 ≤ CL3 ≤ 2.5 < CL4. Lateral: CL1 < 0.1 ≤ CL2 < 0.3 ≤ CL3 ≤ 0.8 < CL4; its
    bound of 0.3 is unverified: not checked against the guide. To which class a bound itself belongs is our reading.

    Source: HiVoSS (2008), comfort classes, and the ranges of Sétra (2006).

    Examples
    --------
    >>> comfort_class(0.49), comfort_class(0.5), comfort_class(2.5), comfort_class(2.51)
    ('CL1', 'CL2', 'CL3', 'CL4')
    """
    a = check.number("acceleration", acceleration, least=0, remedy="give the peak of its absolute value in m/s²")
    low, middle, high = COMFORT_BOUNDS[check.choice("direction", direction, check.DIRECTIONS)]
    return f"CL{1 + (a >= low) + (a >= middle) + (a > high)}"


def comfort_verdict(interval: Any, goal: str, direction: str = "vertical") -> str:
    """Say whether a peak acceleration that is known within an interval meets a comfort goal.

    Parameters
    ----------
    interval : array_like, shape (2,)
        Low and high end of the interval of the peak acceleration; nan where there is no end yet [m/s²].
    goal : {"CL1", "CL2", "CL3"}
        The worst comfort class that will do.
    direction : {"vertical", "lateral"}
        Direction of the acceleration.

    Returns
    -------
    str
        "met" if the whole interval lies in the goal's class or a better one, "not met" if none of it does,
        "undecided" if it straddles the bound or has no ends.

    Examples
    --------
    >>> [comfort_verdict(interval, "CL2") for interval in [(0.8, 0.99), (0.9, 1.1), (1.0, 1.2)]]
    ['met', 'undecided', 'not met']
    """
    check.choice("goal", goal, COMFORT_CLASSES[:-1])
    ends = check.known("interval", interval, remedy="give its low and high end in m/s²")
    if ends.shape != (2,):
        raise ValueError(f"interval must hold two ends, got shape {ends.shape}; give its low and high end in m/s²")
    if np.ma.is_masked(ends):
        return "undecided"
    meets = [comfort_class(float(end), direction) <= goal for end in ends]
    return "met" if all(meets) else "undecided" if any(meets) else "not met"

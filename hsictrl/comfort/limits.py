"""Limits of EN 1990 and ISO 10137."""

from __future__ import annotations

from hsictrl import _checks as check

_EN1990_LIMITS = {
    ("vertical", "normal"): 0.7, ("vertical", "exceptional"): 0.7,
    ("lateral", "normal"): 0.2, ("lateral", "exceptional"): 0.4,
}


def en1990_limit(direction: str = "vertical", *, crowd: str = "normal") -> float:
    """Return the comfort limit of EN 1990 for the peak acceleration.

    Parameters
    ----------
    direction : {"vertical", "lateral"}
        Direction of the acceleration.
    crowd : {"normal", "exceptional"}
        Normal use or exceptional crowd conditions.

    Returns
    -------
    float
        Limit of the peak acceleration of any part of the deck [m/s²].

    Notes
    -----
    The code gives 0.7 vertical, 0.2 horizontal and 0.4 in exceptional crowds; we read the last as horizontal,
    so that the vertical limit is the same in both.

    Source: EN 1990 A2.4.3.2.

    Examples
    --------
    >>> en1990_limit(), en1990_limit("lateral"), en1990_limit("lateral", crowd="exceptional")
    (0.7, 0.2, 0.4)
    """
    check.choice("direction", direction, check.DIRECTIONS)
    return _EN1990_LIMITS[direction, check.choice("crowd", crowd, ("normal", "exceptional"))]


def iso10137_limit(frequency: float, multiplier: float = 60.0) -> float:
    """Return the limit of the vertical RMS acceleration by ISO 10137.

    Parameters
    ----------
    frequency : float
        Frequency of the vibration, from 1 to 8 [Hz].
    multiplier : float
        Multiplier of the base curve: 60 for footbridges, 30 where people stand on them [-].

    Returns
    -------
    float
        Limit of the RMS acceleration [m/s²].

    Notes
    -----
    Base curve: 0.010/√f from 1 to 4 Hz, 0.005 from 4 to 8 Hz. Neither multiplier is checked against the
    standard.

    Source: ISO 10137 (2007), base curve of vertical vibration.

    Examples
    --------
    >>> iso10137_limit(1.0), iso10137_limit(4.0, multiplier=30)
    (0.6, 0.15)
    """
    f = check.number("frequency", frequency, least=1, most=8, remedy="outside it, use the standard's own curve")
    factor = check.number("multiplier", multiplier, above=0, remedy="60 is usual, 30 where people stand")
    return factor * 0.010 / min(f, 4.0) ** 0.5

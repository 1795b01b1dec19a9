"""Numbers as a reader wants them."""

from __future__ import annotations


def significant(value: float, digits: int = 3) -> str:
    """A number to so many significant digits, trailing zeros kept.

    Examples
    --------
    >>> significant(2.0), significant(16.512), significant(120.4), significant(1.94327, 4)
    ('2.00', '16.5', '120', '1.943')
    """
    return f"{value:#.{digits}g}".rstrip(".")

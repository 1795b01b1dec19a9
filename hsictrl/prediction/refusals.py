"""What no recipe can predict."""

from __future__ import annotations

from hsictrl.bridge import Footbridge


def check_vertical(bridge: Footbridge) -> None:
    """Refuse a bridge whose first mode walking can't excite.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.

    Raises
    ------
    ValueError
        If the first mode does not move vertically at its antinode.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> check_vertical(reference_bridge())
    """
    if not bridge.moves_vertically(0):
        raise ValueError("the first mode must move vertically, got a shape that does not at its antinode; walking "
                         "forces are vertical, so describe the bridge with a vertical mode first")

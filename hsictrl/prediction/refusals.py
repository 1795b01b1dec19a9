"""What no recipe can predict."""

from __future__ import annotations

from hsictrl.bridge import Footbridge


def check_vertical(bridge: Footbridge, mode: int = 0) -> None:
    """Refuse a mode that walking can't excite.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    mode : int
        Which mode of the bridge, from 0 [-].

    Raises
    ------
    ValueError
        If the mode does not move vertically at its antinode.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> check_vertical(reference_bridge())
    """
    if not bridge.moves_vertically(mode):
        name, remedy = (f"mode {mode}", "choose another") if mode else (
            "the first mode", "describe the bridge with a vertical mode first")
        raise ValueError(f"{name} must move vertically, got a shape that does not at its antinode; walking forces are "
                         f"vertical, so {remedy}")

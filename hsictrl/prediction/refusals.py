"""What no recipe can predict."""

from __future__ import annotations

from hsictrl.bridge import Footbridge


def check_vertical(bridge: Footbridge, mode: int = 0) -> None:
    """Refuse a bridge with a mode that walking can't excite.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    mode : int
        Which mode, from 0 [-].

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
        name = f"mode {mode}" if mode else "the first mode"
        raise ValueError(f"{name} must move vertically, got a shape that does not at its antinode; walking forces are "
                         f"vertical, so {'take another' if mode else 'describe the bridge with a vertical mode first'}")

"""What no recipe can predict."""

from __future__ import annotations

from typing import Any

from hsictrl import _checks as check
from hsictrl.bridge import Footbridge
from hsictrl.crowd import CrowdFlow, check_somebody


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


def check_case(bridge: Any, flow: Any) -> None:
    """Refuse what is no bridge, or no flow."""
    check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
    check.instance("flow", flow, CrowdFlow, "use CrowdFlow(density=…) or CrowdFlow(persons=…)")


def check_excitable(bridge: Footbridge, flow: CrowdFlow, mode: int = 0) -> None:
    """Refuse a bridge and a flow of people of which no stationary vibration comes.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        The stream of people.
    mode : int
        The mode in resonance, from 0 [-].

    Raises
    ------
    ValueError
        If nobody is on the deck, nothing damps a mode, or the mode in resonance does not move vertically.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> check_excitable(reference_bridge(), CrowdFlow(density=1.5))
    """
    check_somebody(flow, bridge)
    check.numbers("damping", bridge.damping, above=0, below=1, remedy="nothing settles without; give such as 0.005")
    check_vertical(bridge, mode)

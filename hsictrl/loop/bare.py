"""Bridges whose modes are all there is."""

from __future__ import annotations

from typing import Any

from hsictrl import _checks as check
from hsictrl.bridge import Footbridge


def bare(bridge: Any, remedy: str) -> Footbridge:
    """The bridge, if nothing is fixed to it."""
    given: Footbridge = check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
    if given.absorbers:
        raise ValueError(f"bridge must have no absorbers, got {len(given.absorbers)}; {remedy}")
    return given

"""Joins bridge and bodies: an LTI system at an instant, a dynamic stiffness, or blocks and their connections."""

from hsictrl.coupling.condensation import CondensedCrowd
from hsictrl.coupling.frozen import FrozenSystem
from hsictrl.coupling.interconnection import interconnect
from hsictrl.coupling.measurement import OccupiedMeasurement
from hsictrl.coupling.moving import MovingCrowd, moving_crowd
from hsictrl.coupling.occupied import OccupiedBridge, couple

__all__ = [
    "CondensedCrowd", "FrozenSystem", "MovingCrowd", "OccupiedBridge", "OccupiedMeasurement", "couple", "interconnect",
    "moving_crowd",
]

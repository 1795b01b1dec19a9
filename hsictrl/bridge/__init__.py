"""A footbridge is modes: frequency, damping, modal mass, and a shape that can be evaluated at any point."""

from hsictrl.bridge.beams import BeamShape
from hsictrl.bridge.eeklo import eeklo_bridge
from hsictrl.bridge.extent import Extent
from hsictrl.bridge.measured import MeasuredBridge
from hsictrl.bridge.modal import Footbridge, reference_bridge
from hsictrl.bridge.mode import Mode
from hsictrl.bridge.sampled import SampledShape
from hsictrl.bridge.shapes import Shape, SineShape
from hsictrl.bridge.torsion import LateralTorsionShape

__all__ = [
    "BeamShape", "Extent", "Footbridge", "LateralTorsionShape", "MeasuredBridge", "Mode", "SampledShape", "Shape",
    "SineShape", "eeklo_bridge", "reference_bridge",
]

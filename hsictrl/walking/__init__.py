"""The force of one walker on rigid ground, as a function of time."""

from hsictrl.walking.lines import ForceLines
from hsictrl.walking.model import WalkingForce
from hsictrl.walking.narrowband import MainHarmonics, ZivanovicForce, kerr_factor
from hsictrl.walking.parts import ForceParts
from hsictrl.walking.periodic import HarmonicForce, YoungForce

__all__ = [
    "ForceLines", "ForceParts", "HarmonicForce", "MainHarmonics", "WalkingForce", "YoungForce", "ZivanovicForce",
    "kerr_factor",
]

"""The crowd seen as a controller: loop gain, sensitivity, root loci, passivity and scattered poles."""

from hsictrl.loop.bands import AmplifiedBands, amplified_bands
from hsictrl.loop.gain import LoopGain, loop_gain
from hsictrl.loop.sensitivity import Sensitivity, sensitivity

__all__ = ["AmplifiedBands", "LoopGain", "Sensitivity", "amplified_bands", "loop_gain", "sensitivity"]

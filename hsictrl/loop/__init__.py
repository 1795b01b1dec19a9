"""The crowd seen as a controller: loop gain, sensitivity, root loci, passivity and scattered poles."""

from hsictrl.loop.gain import LoopGain, loop_gain
from hsictrl.loop.sensitivity import Sensitivity, sensitivity

__all__ = ["LoopGain", "Sensitivity", "loop_gain", "sensitivity"]

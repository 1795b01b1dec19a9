"""The crowd seen as a controller: loop gain, sensitivity, root loci, passivity and scattered poles."""

from hsictrl.loop.bands import AmplifiedBands, amplified_bands
from hsictrl.loop.gain import LoopGain, loop_gain
from hsictrl.loop.locus import RootLocus, root_locus
from hsictrl.loop.passivity import Passivity, passivity
from hsictrl.loop.scatter import PoleScatter, pole_scatter
from hsictrl.loop.sensitivity import Sensitivity, sensitivity

__all__ = [
    "AmplifiedBands", "LoopGain", "Passivity", "PoleScatter", "RootLocus", "Sensitivity", "amplified_bands",
    "loop_gain", "passivity", "pole_scatter", "root_locus", "sensitivity",
]

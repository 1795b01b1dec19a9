"""Human-structure interaction on footbridges, as python-control systems.

A bridge is a set of modes; a walker is a sprung body that pushes back on the deck; a crowd is a feedback
loop around the bridge. Van Nimmen, Lombaert, De Roeck & Van den Broeck (2017) is implemented throughout.
"""

from hsictrl import plots as plots
from hsictrl.absorber import Absorber
from hsictrl.assessment import Assessment, GuideCase, assess, guide_cases, guide_value, study_effective
from hsictrl.bridge import (
    BeamShape,
    Footbridge,
    LateralTorsionShape,
    MeasuredBridge,
    Mode,
    SampledShape,
    Shape,
    SineShape,
    eeklo_bridge,
    reference_bridge,
)
from hsictrl.comfort import comfort_class, comfort_verdict, design_acceleration, en1990_limit, iso10137_limit
from hsictrl.coupling import MovingCrowd, OccupiedBridge, OccupiedMeasurement, couple, interconnect, moving_crowd
from hsictrl.crowd import (
    CrowdFlow,
    Traffic,
    Trajectory,
    Walker,
    Walkers,
    preferred_step_frequency,
    resonant_step_frequency,
    weidmann_speed,
)
from hsictrl.identify import FreeDecay, SubspaceIdentification, SubspaceMode, free_decay, subspace_identification
from hsictrl.loop import (
    AmplifiedBands,
    LoopGain,
    Passivity,
    PoleScatter,
    RootLocus,
    Sensitivity,
    amplified_bands,
    loop_gain,
    passivity,
    pole_scatter,
    root_locus,
    sensitivity,
)
from hsictrl.measurement import virtual_measurement
from hsictrl.pedestrian import Body, Crowd, Pedestrian, Population, ReducedCrowd
from hsictrl.prediction import Prediction, SpectralEstimate, predict, spectral_estimate, tune
from hsictrl.resonance import (
    EffectiveProperties,
    EffectiveSensitivity,
    effective,
    effective_along,
    effective_map,
    effective_sensitivity,
    frf,
)
from hsictrl.stepper import Simulation, simulate
from hsictrl.study import (
    AllRules,
    Ensemble,
    Ledger,
    MeanRule,
    PercentileRule,
    StopRule,
    Sweep,
    monte_carlo,
    sweep,
    trial_rng,
)
from hsictrl.walking import ForceLines, HarmonicForce, MainHarmonics, WalkingForce, YoungForce, ZivanovicForce

__version__ = "0.1.0"

__all__ = [
    "Absorber", "AllRules", "AmplifiedBands", "Assessment", "BeamShape", "Body", "Crowd", "CrowdFlow",
    "EffectiveProperties", "EffectiveSensitivity", "Ensemble", "Footbridge", "ForceLines", "FreeDecay", "GuideCase",
    "HarmonicForce", "LateralTorsionShape", "Ledger", "LoopGain", "MainHarmonics", "MeanRule", "MeasuredBridge", "Mode",
    "MovingCrowd", "OccupiedBridge", "OccupiedMeasurement", "Passivity", "Pedestrian", "PercentileRule", "PoleScatter",
    "Population", "Prediction", "ReducedCrowd", "RootLocus", "SampledShape", "Sensitivity", "Shape", "Simulation",
    "SineShape", "SpectralEstimate", "StopRule", "SubspaceIdentification", "SubspaceMode", "Sweep", "Traffic",
    "Trajectory", "Walker", "Walkers", "WalkingForce", "YoungForce", "ZivanovicForce", "amplified_bands", "assess",
    "comfort_class", "comfort_verdict", "couple", "design_acceleration", "eeklo_bridge", "effective", "effective_along",
    "effective_map", "effective_sensitivity", "en1990_limit", "free_decay", "frf", "guide_cases", "guide_value",
    "interconnect", "iso10137_limit", "loop_gain", "monte_carlo", "moving_crowd", "passivity", "pole_scatter",
    "predict", "preferred_step_frequency", "reference_bridge", "resonant_step_frequency", "root_locus", "sensitivity",
    "simulate", "spectral_estimate", "study_effective", "subspace_identification", "sweep", "trial_rng", "tune",
    "virtual_measurement", "weidmann_speed",
]

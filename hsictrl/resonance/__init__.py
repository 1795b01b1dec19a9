"""Frequency responses, their refined peaks, and the effective properties read from them."""

from hsictrl.resonance.along import effective_along
from hsictrl.resonance.effective import EffectiveProperties, effective
from hsictrl.resonance.response import frf
from hsictrl.resonance.sensitivity import EffectiveSensitivity, effective_sensitivity
from hsictrl.resonance.shared import effective_map

__all__ = [
    "EffectiveProperties", "EffectiveSensitivity", "effective", "effective_along", "effective_map",
    "effective_sensitivity", "frf",
]

"""Frequency and damping from a record."""

from hsictrl.identify.decay import FreeDecay, free_decay

__all__ = ["FreeDecay", "free_decay"]

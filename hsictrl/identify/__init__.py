"""Frequency and damping from a record."""

from hsictrl.identify.decay import FreeDecay, free_decay
from hsictrl.identify.subspace import SubspaceIdentification, SubspaceMode, subspace_identification

__all__ = ["FreeDecay", "SubspaceIdentification", "SubspaceMode", "free_decay", "subspace_identification"]

"""Determinants of stacks of small matrices, with their slopes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complex128]


def determinant(matrices: Complex, slopes: Complex) -> tuple[Complex, Complex]:
    """det D and its derivative, row by row and without an inverse: a zero may be met to the bit."""
    slope = np.zeros(len(matrices), dtype=complex)
    for i in range(matrices.shape[-1]):
        replaced = matrices.copy()
        replaced[:, i] = slopes[:, i]
        slope += np.linalg.det(replaced)
    return np.linalg.det(matrices), slope

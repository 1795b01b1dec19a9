"""Random variables from standard uniform numbers, so that the same draws serve at other parameters."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.special import ndtr, ndtri

from hsictrl._checks import Array

SMALLEST_DRAW = 2.0**-53     # above zero, of numpy.random.Generator.random


def truncated_normal(mean: Any, spread: Any, draws: Array, *, high: float = np.inf) -> Array:
    """Quantiles of normals truncated to (0, high), at uniform `draws` in [0, 1); without spread, the mean."""
    if np.all(spread == 0):
        return np.broadcast_to(np.asarray(mean, dtype=float), np.shape(draws)).copy()
    # counted from the upper tail, since 1 − draws is never zero; a draw of exactly zero, whose quantile is not
    # positive, counts as the smallest other one
    above_zero, above_high = ndtr(mean / spread), ndtr((mean - high) / spread)
    upper = 1 - np.maximum(draws, SMALLEST_DRAW)
    return np.asarray(mean - spread * ndtri(above_high + (above_zero - above_high) * upper))


def retuned(values: Array, mean: float, new_mean: float, spread: float) -> Array:
    """The same quantiles of a normal truncated to (0, ∞) after its mean has moved; without spread, a shift."""
    if spread == 0:
        return np.asarray(new_mean + (values - mean))
    z, kept = (values - mean) / spread, ndtr(new_mean / spread) / ndtr(mean / spread)
    # each half from its own tail, where probabilities keep their digits
    below = ndtri((ndtr(z) - ndtr(-mean / spread)) * kept + ndtr(-new_mean / spread))
    return np.asarray(new_mean + spread * np.where(z < 0, below, -ndtri(ndtr(-z) * kept)))

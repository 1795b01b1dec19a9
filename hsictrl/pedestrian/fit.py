"""A few bodies that move the bridge as many do: exact merging of those that move alike, then a fit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, nnls
from scipy.special import expit, logit, softmax

from hsictrl._checks import Array
from hsictrl.pedestrian.crowd import Crowd

Complex = NDArray[np.complex128]
Indices = NDArray[np.intp]
SAMPLES = 48, 480       # frequencies at which apparent masses are compared, fewest and most
EVALUATIONS = 100       # after these a fit gains nothing that could be seen
NEGLIGIBLE = 1e-9       # share of a body that the fit has no use for


def merge(people: Crowd, rows: Array) -> tuple[Crowd, Indices]:
    """One body for all that have the same frequency, damping and direction in modal space, exactly.

    On a single mode everyone has the same direction. Returned are the bodies, and who gives each its place.
    """
    size = np.sum(rows**2, axis=1)
    alike = np.column_stack([people.frequency, people.damping, _pairs(rows) / size[:, None]])
    group = np.unique(alike, axis=0, return_inverse=True)[1].ravel()
    largest = np.argsort(-size, kind="stable")
    leaders = largest[np.unique(group[largest], return_index=True)[1]]
    mass, sprung = (np.bincount(group, size * each) for each in (people.mass, people.sprung_mass))
    return Crowd(mass=mass / size[leaders], frequency=people.frequency[leaders], damping=people.damping[leaders],
                 sprung_ratio=np.minimum(sprung / mass, 1.0), direction=people.direction[leaders]), leaders


def fit(people: Crowd, rows: Array, count: int, damping: float) -> tuple[Crowd, Indices]:
    """At most `count` bodies, and whose places they take, fitted to the apparent mass of all [-].

    The trace of the apparent mass is kept exactly at 0 Hz and at infinity; so is all of it on a single mode.
    """
    size = np.sum(rows**2, axis=1)
    sprung, mass = (float(size @ each) for each in (people.sprung_mass, people.mass))
    omega = _frequencies(people, count)
    pairs, shares = _pairs(rows) / size[:, None], size * people.sprung_mass / sprung
    curves = shares * _curves(omega, people.frequency, people.damping)[0][:, None] * pairs.T
    target = curves.sum(axis=-1)
    weight = 1 / (2 * damping / sprung + np.linalg.norm(target.imag, axis=1))
    leaders, scale = _representatives(_stacked(weight[:, None, None] * curves), count)
    task = _Fit(omega, pairs[leaders], target, weight, *_limits(people))
    found = np.array(task.solved(shares[leaders] * scale, people.frequency[leaders], people.damping[leaders]))
    useful = found[0] > NEGLIGIBLE
    (shares, frequency, ratio), leaders = found[:, useful], leaders[useful]
    return Crowd(mass=shares / shares.sum() * mass / size[leaders], frequency=frequency, damping=ratio,
                 sprung_ratio=np.minimum(sprung / mass, 1.0), direction=people.direction[leaders]), leaders


@final
@dataclass(frozen=True, slots=True, eq=False)
class _Fit:
    """Shares, frequencies and dampings of bodies in given places, and how far they are from the target.

    Unknowns are logits: shares add up to one, and the other two stay within limits.
    """

    omega: Array
    pairs: Array
    target: Complex
    weight: Array
    lowest: Array
    highest: Array

    def solved(self, shares: Array, *values: Array) -> tuple[Array, ...]:
        span = np.log(self.highest / self.lowest)[:, None]
        inside = np.log(np.array(values) / self.lowest[:, None]) / span
        start = np.concatenate([np.log(shares), *logit(inside)])
        return self.bodies(least_squares(self.residuals, start, self.slopes, method="lm", max_nfev=EVALUATIONS).x)

    def bodies(self, unknowns: Array) -> tuple[Array, ...]:
        heights, *rest = unknowns.reshape(3, -1)
        limits = zip(self.lowest, self.highest, expit(rest), strict=True)
        return softmax(heights), *(low * (high / low) ** inside for low, high, inside in limits)

    def residuals(self, unknowns: Array) -> Array:
        shares, *values = self.bodies(unknowns)
        difference = (shares * _curves(self.omega, *values)[0]) @ self.pairs - self.target
        return _stacked((self.weight[:, None] * difference)[:, :, None])[:, 0]

    def slopes(self, unknowns: Array) -> Array:
        """Derivatives of the residuals with respect to the unknowns."""
        shares, *values = self.bodies(unknowns)
        curves, *slopes = _curves(self.omega, *values)
        inside = expit(unknowns.reshape(3, -1)[1:])
        stretch = np.log(self.highest / self.lowest)[:, None] * inside * (1 - inside)
        along = [slope * rate for slope, rate in zip(slopes, stretch, strict=True)]
        mean = (shares * curves) @ self.pairs
        by_share = curves[:, None] * self.pairs.T - mean[:, :, None]
        moved = [by_share, *(slope[:, None] * self.pairs.T for slope in along)]
        return _stacked(self.weight[:, None, None] * np.concatenate([shares * each for each in moved], axis=-1))


def _representatives(columns: Array, count: int) -> tuple[Indices, Array]:
    """Greedy non-negative least squares: who stands best for all, and for how many each."""
    target = columns.sum(axis=1)
    chosen: list[int] = []
    rest = target
    for _ in range(count):
        chosen.append(int(np.argmax(columns.T @ rest)))
        scale = nnls(columns[:, chosen], target)[0]
        rest = target - columns[:, chosen] @ scale
    return np.array(chosen)[scale > 0], scale[scale > 0]


def _curves(omega: Array, frequency: Array, damping: Array) -> tuple[Complex, Complex, Complex]:
    """g = (2ξp + 1)/(p² + 2ξp + 1) at p = iω/ω_H, with its slopes by ln ω_H and ln ξ."""
    p = 1j * omega[:, None] / (2 * np.pi * frequency)
    below = p**2 + 2 * damping * p + 1
    steep = 2 * p**2 / below**2
    return (2 * damping * p + 1) / below, steep * (damping * p + 1), steep * damping * p


def _frequencies(people: Crowd, count: int) -> Array:
    """From a third of the lowest frequency to twice the highest, so close that the least damped body is resolved."""
    low, high = people.frequency.min() / 3, 2 * people.frequency.max()
    samples = np.clip(2 * np.log(high / low) / people.damping.min(), *SAMPLES)
    return 2 * np.pi * np.geomspace(low, high, max(int(samples), 2 * count))


def _limits(people: Crowd) -> tuple[Array, Array]:
    """Frequencies and dampings, lowest and highest, that a fitted body may have: twice as wide as those there are."""
    values = np.array([people.frequency, people.damping])
    highest = 2 * values.max(axis=1)
    highest[1] = min(highest[1], (1 + people.damping.max()) / 2)
    return values.min(axis=1) / 2, highest


def _pairs(rows: Array) -> Array:
    """Upper triangle of each φφᵀ."""
    i, j = np.triu_indices(rows.shape[1])
    return rows[:, i] * rows[:, j]


def _stacked(values: Complex) -> Array:
    """Real above imaginary parts, one column for each entry of the last axis."""
    flat = values.reshape(-1, values.shape[-1])
    return np.concatenate([flat.real, flat.imag])

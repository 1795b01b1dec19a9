"""Forces that repeat with every step: given harmonics, and Young's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.walking.lines import shaped
from hsictrl.walking.model import WalkingForce, phasors, walkers
from hsictrl.walking.parts import ForceParts


@final
@dataclass(frozen=True, slots=True)
class HarmonicForce(WalkingForce):
    """A periodic force with given harmonics: F(t) = W Σ_h factor_h cos(2π h f_s t + phase_h), h = 1, 2, ….

    Parameters
    ----------
    factors : sequence of float
        Dynamic load factors: amplitudes of harmonics 1, 2, … as fractions of the weight [-].
    phases : sequence of float, optional
        Phase of each harmonic at t = 0; default all zero [rad].

    Examples
    --------
    >>> force = HarmonicForce([0.43, 0.08], phases=[0.0, 0.0])
    >>> force.lines([2.0], weight=[700.0], draws=np.empty((1, 0))).at([0.0]).round(9)
    array([[357.]])
    """

    factors: Sequence[float]
    phases: Sequence[float] | None = None

    def __post_init__(self) -> None:
        factors = check.numbers("factors", self.factors, least=0, ndim=1,
                                remedy="give [0.43], and a sign as a phase of pi")
        if not factors.size:
            raise ValueError("factors must hold at least one harmonic, got none; give [0.0] for no force")
        phases = np.zeros_like(factors) if self.phases is None else self.phases
        phases = check.numbers("phases", phases, remedy="give rad")
        shaped("phases", phases, factors.shape, "give one phase per factor")
        check.store(self, factors=tuple(factors.tolist()), phases=tuple(phases.tolist()))

    @property
    def n_draws(self) -> int:
        return 0

    def parts(self, weight: ArrayLike, draws: ArrayLike) -> ForceParts:
        W, _ = walkers(weight, draws, self.n_draws)
        coefficients = np.multiply.outer(W, self.factors * np.exp(1j * np.asarray(self.phases)))
        return ForceParts(coefficients=coefficients[np.newaxis], first=1, spacing=1.0,
                          factors=lambda f_s: np.ones((1, len(f_s))))

    def periodic(self) -> HarmonicForce:
        return self


# Young (2001), as in CCIP-016: factor of harmonic h is constant + slope h f_s, the first at most the cap
YOUNG = {
    "mean": (np.array([-0.37 * 0.95, 0.054, 0.026, 0.010]), np.array([0.37, 0.0044, 0.0050, 0.0051]), 0.50),
    "design": (np.array([-0.41 * 0.95, 0.069, 0.033, 0.013]), np.array([0.41, 0.0056, 0.0064, 0.0065]), 0.56),
}


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class YoungForce(WalkingForce):
    """The periodic force of Young (2001), as in CCIP-016: four harmonics with independent uniform phases.

    The load factor of harmonic h is linear in the harmonic's frequency f = h f_s, never below zero; the first
    one is capped. There is no variability within a walker. The formulas are used as they are beyond their
    stated ranges of f (1–2.8, 2–5.6, 3–8.4 and 4–11.2 Hz; unverified: not checked against the source).

    Parameters
    ----------
    values : {"mean", "design"}
        The mean factors 0.37(f − 0.95) ≤ 0.50, 0.054 + 0.0044 f, 0.026 + 0.0050 f, 0.010 + 0.0051 f, which
        are unverified: not checked against the source; or the design factors 0.41(f − 0.95) ≤ 0.56, 0.069 + 0.0056 f,
        0.033 + 0.0064 f, 0.013 + 0.0065 f.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> force = YoungForce(values="design").lines([2.0], weight=[1.0], draws=rng.random((1, 4)))
    >>> abs(force.coefficients).round(4)
    array([[0.4305, 0.0914, 0.0714, 0.065 ]])
    """

    values: str = "mean"

    def __post_init__(self) -> None:
        check.choice("values", self.values, tuple(YOUNG))

    @property
    def n_draws(self) -> int:
        return 4

    def parts(self, weight: ArrayLike, draws: ArrayLike) -> ForceParts:
        W, draws = walkers(weight, draws, self.n_draws)
        harmonics = np.eye(4)[:, np.newaxis] * (W[:, np.newaxis] * phasors(draws))
        return ForceParts(coefficients=harmonics, first=1, spacing=1.0, factors=self._load_factors)

    def _load_factors(self, step_frequency: Array) -> Array:
        constant, slope, cap = YOUNG[self.values]
        factors = np.maximum(constant + slope * np.multiply.outer(step_frequency, [1, 2, 3, 4]), 0.0)
        factors[:, 0] = np.minimum(factors[:, 0], cap)
        return factors.T

    def periodic(self) -> YoungForce:
        return self

"""Forces of walkers who may step at several frequencies, as combs that do not depend on it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.walking.lines import Complex, ForceLines, Whole, shaped


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ForceParts:
    """Forces of n walkers at any step frequencies f_k: F_k(t) = Re Σ_p g_p(f_k) Σ_l c_pkl exp(2πi l d f_k t).

    To step faster is to run through the same combs faster, and to weigh them by other load factors. What is costly,
    phases and shapes of the combs, is the same at every step frequency.

    Parameters
    ----------
    coefficients : array of complex, shape (p, n, L)
        Amplitude times exp(i phase at t = 0) of each line, in each part [N].
    first : int
        Index of the first line, at least 1 [-].
    spacing : float
        Distance d between lines, as a fraction of the step frequency [-].
    factors : callable
        Takes the step frequencies, shape (n,), and gives the factors g_p, shape (p, n) [Hz, -].

    Examples
    --------
    A force in which only the first harmonic grows with the step frequency:

    >>> parts = ForceParts(coefficients=np.array([[[100.0, 0.0]], [[0.0, 50.0]]]), first=1, spacing=1.0,
    ...                    factors=lambda f: np.stack([f, np.ones_like(f)]))
    >>> parts.at([2.0]).coefficients.real
    array([[200.,  50.]])
    """

    coefficients: Complex
    first: int
    spacing: float
    factors: Callable[[Array], Array]

    @property
    def indices(self) -> Whole:
        """Indices l of the lines, shape (L,) [-].

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> HarmonicForce([0.43, 0.08]).parts([700.0], draws=np.empty((1, 0))).indices
        array([1, 2])
        """
        return np.arange(self.first, self.first + self.coefficients.shape[2])

    def at(self, step_frequency: ArrayLike) -> ForceLines:
        """Give the forces at one step frequency per walker.

        Parameters
        ----------
        step_frequency : array_like, shape (n,)
            Step frequency of each walker [Hz].

        Returns
        -------
        ForceLines

        Examples
        --------
        >>> from hsictrl.walking import YoungForce
        >>> parts = YoungForce().parts([700.0], draws=[[0.5, 0.5, 0.5, 0.5]])
        >>> parts.at([1.8]).coefficients.real.round(1), parts.at([2.2]).coefficients.real.round(1)
        (array([[220.2,  48.9,  37.1,  32.7]]), array([[323.8,  51.4,  41.3,  38.4]]))
        """
        frequency = check.numbers("step_frequency", step_frequency, above=0, ndim=1, remedy="give a list of Hz")
        shaped("step_frequency", frequency, self.coefficients.shape[1:2], "give one per walker")
        coefficients = np.einsum("pn,pnl->nl", self.factors(frequency), self.coefficients)
        return ForceLines(coefficients=coefficients, first=self.first, spacing=self.spacing, step_frequency=frequency)

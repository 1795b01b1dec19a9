"""What every model of a walking force can do."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.walking.lines import Complex, ForceLines, shaped
from hsictrl.walking.parts import ForceParts


class WalkingForce(ABC):
    """A model of the force of a walker on rigid ground.

    Randomness comes in as standard uniform numbers, one row per walker: the same draws at another step
    frequency are the same walkers, retuned, and row k of a result depends on row k of the arguments alone.

    Examples
    --------
    >>> import numpy as np
    >>> from hsictrl.walking import HarmonicForce, YoungForce, ZivanovicForce
    >>> rng = np.random.default_rng(1)
    >>> for model in HarmonicForce([0.43]), YoungForce(), ZivanovicForce():
    ...     draws = rng.random((2, model.n_draws))
    ...     lines = model.lines([1.9, 2.1], weight=[700.0, 700.0], draws=draws)
    ...     print(model.n_draws, lines.n_walkers, round(lines.highest_frequency, 3))
    0 2 2.1
    4 2 8.4
    505 2 11.004
    """

    __slots__ = ()

    @property
    @abstractmethod
    def n_draws(self) -> int:
        """Number of uniform draws that the force of one walker takes [-].

        Examples
        --------
        >>> from hsictrl.walking import YoungForce
        >>> YoungForce().n_draws
        4
        """

    @abstractmethod
    def parts(self, weight: ArrayLike, draws: ArrayLike) -> ForceParts:
        """Give what the forces of n walkers are made of, at any step frequencies.

        Parameters
        ----------
        weight : array_like, shape (n,)
            Weight of each walker [N].
        draws : array_like, shape (n, n_draws)
            Standard uniform numbers in [0, 1) [-].

        Returns
        -------
        ForceParts
            Combs of lines, and the factors by which a step frequency weighs them [N].

        Examples
        --------
        >>> import numpy as np
        >>> from hsictrl.walking import HarmonicForce
        >>> HarmonicForce([0.43]).parts([700.0], draws=np.empty((1, 0))).coefficients.real
        array([[[301.]]])
        """

    def lines(self, step_frequency: ArrayLike, weight: ArrayLike, draws: ArrayLike) -> ForceLines:
        """Give the forces of n walkers.

        Parameters
        ----------
        step_frequency : array_like, shape (n,)
            Step frequency of each walker [Hz].
        weight : array_like, shape (n,)
            Weight of each walker [N].
        draws : array_like, shape (n, n_draws)
            Standard uniform numbers in [0, 1) [-].

        Returns
        -------
        ForceLines
            The forces as lines [N].

        Examples
        --------
        >>> import numpy as np
        >>> from hsictrl.walking import HarmonicForce
        >>> force = HarmonicForce([0.43]).lines([2.0], weight=[700.0], draws=np.empty((1, 0)))
        >>> force.coefficients.real
        array([[301.]])
        """
        f_s = check.numbers("step_frequency", step_frequency, above=0, ndim=1, remedy="give a list of Hz")
        shaped("weight", check.numbers("weight", weight, remedy="give N"), f_s.shape, "give one per step frequency")
        return self.parts(weight, draws).at(f_s)

    @abstractmethod
    def periodic(self) -> WalkingForce:
        """Give the same walkers without intra-person variability: all their steps are alike.

        Returns
        -------
        WalkingForce
            A periodic force of the same draws; a force that is periodic is its own.

        Examples
        --------
        >>> from hsictrl.walking import YoungForce, ZivanovicForce
        >>> YoungForce().periodic(), ZivanovicForce().periodic().n_draws == ZivanovicForce().n_draws
        (YoungForce(values='mean'), True)
        """


def walkers(weight: ArrayLike, draws: ArrayLike, n_draws: int) -> tuple[Array, Array]:
    W = check.numbers("weight", weight, above=0, ndim=1, remedy="give N")
    u = check.numbers("draws", draws, least=0, below=1, remedy="draw them by rng.random((n, force.n_draws))")
    shaped("draws", u, (*W.shape, n_draws), "give n_draws uniform numbers per walker")
    return W, u


def phasors(draws: Array) -> Complex:
    """Points exp(iθ) with θ = 2π(draw − ½), uniform on [−π, π)."""
    # by the tangent of the half angle, which numpy has vectorised: a quarter of the time of cosine and sine
    t = np.tan(np.pi * (draws - 0.5))
    scale = 1 / (1 + t * t)
    phasors = np.empty(draws.shape, dtype=complex)
    np.subtract(2 * scale, 1, out=phasors.real)
    np.multiply(2 * t, scale, out=phasors.imag)
    return phasors

"""Condensation: to the bridge, any crowd is an n_m × n_m apparent mass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.pedestrian import Crowd

Complex = NDArray[np.complex128]


@final
@dataclass(frozen=True, slots=True, eq=False)
class CondensedCrowd:
    """A standing crowd as the modes of the bridge feel it.

    Parameters
    ----------
    people : Crowd
        The n bodies.
    rows : array, shape (n, n_m)
        Participation of each body in the mass-normalised modes [1/√kg].

    Examples
    --------
    >>> from hsictrl.pedestrian import Pedestrian
    >>> crowd = CondensedCrowd(Crowd.of([Pedestrian()]), np.array([[0.01]]))
    >>> print(crowd.apparent_mass(0j).round(6))       # static: the whole mass, 70 kg · (0.01/√kg)²
    [[[0.007+0.j]]]
    """

    people: Crowd
    rows: Array

    def apparent_mass(self, s: Any) -> Complex:
        """Sum of φₖφₖᵀ αₖ(s) over the bodies, αₖ = m₀ + m₁(c s + k)/(m₁s² + c s + k).

        Parameters
        ----------
        s : complex or array, shape (w,)
            Laplace variable [rad/s].

        Returns
        -------
        array, shape (w, n_m, n_m)
            Apparent mass in mass-normalised coordinates [-].

        Examples
        --------
        >>> from hsictrl.pedestrian import Pedestrian
        >>> CondensedCrowd(Crowd.of([Pedestrian()]), np.array([[0.01]])).apparent_mass(1j * np.ones(5)).shape
        (5, 1, 1)
        """
        s, n_m = np.atleast_1d(np.asarray(s, dtype=complex)), self.rows.shape[1]
        pairs = (self.rows[:, :, None] * self.rows[:, None, :]).reshape(len(self.people), n_m**2).T
        rigid = pairs @ self.people.mass
        lagging = _weighted_receptance(pairs * self.people.sprung_mass, self.people, s)
        return (rigid[:, None] - s**2 * lagging).T.reshape(len(s), n_m, n_m)

    def apparent_mass_slope(self, s: complex) -> Complex:
        """Derivative of the apparent mass with respect to s, where α′ = −m₁s(2ξω s + 2ω²)/(s² + 2ξω s + ω²)².

        Parameters
        ----------
        s : complex
            Laplace variable [rad/s].

        Returns
        -------
        array, shape (n_m, n_m)
            In mass-normalised coordinates [s].

        Examples
        --------
        >>> from hsictrl.pedestrian import Pedestrian
        >>> CondensedCrowd(Crowd.of([Pedestrian()]), np.array([[0.01]])).apparent_mass_slope(1j).shape
        (1, 1)
        """
        people, damping = self.people, 2 * self.people.damping * self.people.omega
        spring = damping * s + people.omega**2
        slopes = -people.sprung_mass * s * (spring + people.omega**2) / (s**2 + spring)**2
        return np.asarray(self.rows.T * slopes @ self.rows)


def _weighted_receptance(weights: Array, people: Crowd, s: Complex) -> Complex:
    """``weights @ 1/(s² + 2ξω s + ω²)``, in real arithmetic, which numpy runs several times faster."""
    damping, square = 2 * people.damping * people.omega, s**2
    real = np.add.outer(people.omega**2, square.real)
    imaginary = np.multiply.outer(damping, s.imag)
    if np.any(s.real):    # on the imaginary axis, where most questions are asked, these are zero
        real += np.multiply.outer(damping, s.real)
        imaginary += square.imag
    size = real**2
    size += imaginary**2
    real /= size
    imaginary /= size
    return np.asarray(weights @ real - 1j * (weights @ imaginary))

"""One body: sprung mass, unsprung mass, spring and damper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array

RULES: dict[str, dict[str, Any]] = {
    "mass": {"above": 0, "remedy": "give kg"},
    "frequency": {"above": 0, "remedy": "give Hz"},
    "damping": {"least": 0, "below": 1, "remedy": check.PERCENT},
    "sprung_ratio": {"above": 0, "most": 1, "remedy": check.PERCENT},
}
Complex = NDArray[np.complex128]


class SprungBody:
    """What follows from mass, frequency, damping and sprung ratio, for one body or for arrays of them."""

    __slots__ = ()
    mass: Any
    frequency: Any
    damping: Any
    sprung_ratio: Any

    @property
    def omega(self) -> Any:
        """Angular natural frequency of the sprung mass [rad/s]."""
        return 2 * np.pi * self.frequency

    @property
    def sprung_mass(self) -> Any:
        """Mass on the spring, m_H1 [kg]."""
        return self.sprung_ratio * self.mass

    @property
    def unsprung_mass(self) -> Any:
        """Mass that moves with the deck, m_H0 [kg]."""
        return self.mass - self.sprung_mass

    @property
    def stiffness(self) -> Any:
        """Spring, k_H1 [N/m]."""
        return self.sprung_mass * self.omega**2

    @property
    def damping_coefficient(self) -> Any:
        """Damper, c_H1 [N s/m]."""
        return 2 * self.damping * self.sprung_mass * self.omega


class Body(SprungBody):
    """One body on a deck, whoever or whatever it is: a `Pedestrian`, or an `Absorber`.

    Examples
    --------
    >>> isinstance(Pedestrian(), Body)
    True
    """

    __slots__ = ()
    direction: str

    def apparent_mass(self, s: complex | Complex) -> Complex:
        """Apparent mass: the force that moves the contact point, over its acceleration.

        Parameters
        ----------
        s : complex or array
            Laplace variable; ``1j * omega`` for a frequency response [rad/s].

        Returns
        -------
        array, as `s`
            m₀ + m₁(c s + k)/(m₁s² + c s + k) [kg], the condensation of (A.2) and (A.3).

        Examples
        --------
        >>> print(Pedestrian().apparent_mass(0).round(6))
        (70+0j)
        """
        s = np.asarray(s, dtype=complex)
        spring = self.damping_coefficient * s + self.stiffness
        return np.asarray(self.unsprung_mass + self.sprung_mass * spring / (self.sprung_mass * s**2 + spring))

    def ss(self, *, ports: Sequence[str] = ("y", "v", "a"), name: str = "walker") -> ct.StateSpace:
        """Give the body as a block: motion of the deck in, force on the deck out (eq. 4).

        Parameters
        ----------
        ports : ("y", "v", "a") or ("y", "v")
            Displacement [m], velocity [m/s] and acceleration [m/s²] of the contact point. A body
            without unsprung mass needs no acceleration.
        name : str
            Name of the block.

        Returns
        -------
        control.StateSpace
            Inputs `ports`, output F [N], states u [m] and du [m/s] of the sprung mass.

        Examples
        --------
        >>> walker = Pedestrian().ss()
        >>> walker.input_labels, walker.output_labels, walker.state_labels
        (['y', 'v', 'a'], ['F'], ['u', 'du'])
        """
        columns = checked_ports(ports, np.atleast_1d(self.unsprung_mass))
        A, B, C, D = block_matrices(self)
        return ct.ss(A, B[:, :columns], C, D[:, :columns],
                     inputs=list(ports), outputs=["F"], states=["u", "du"], name=name)


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Pedestrian(Body):
    """The body of one person: a damped sprung mass above an unsprung one.

    The defaults are those of a walker, with one or two legs slightly bent (section 2.2 of Van Nimmen
    et al., 2017).

    Parameters
    ----------
    mass : float
        Whole mass, sprung and unsprung [kg].
    frequency : float
        Natural frequency on a rigid floor [Hz].
    damping : float
        Damping ratio on a rigid floor, in [0, 1) [-].
    sprung_ratio : float
        Share of the mass that is sprung, in (0, 1] [-].
    direction : {"vertical", "lateral"}
        Direction in which the body moves.

    Examples
    --------
    >>> body = Pedestrian()
    >>> round(body.sprung_mass, 2), round(body.unsprung_mass, 2)
    (66.5, 3.5)
    >>> print(Pedestrian(frequency=5.7, damping=0.44))
    70 kg at 5.70 Hz, 44.0 %, 95 % sprung, vertical
    """

    mass: float = 70.0
    frequency: float = 3.25
    damping: float = 0.30
    sprung_ratio: float = 0.95
    direction: str = "vertical"

    def __post_init__(self) -> None:
        check.store(self, **{name: check.number(name, getattr(self, name), **rule) for name, rule in RULES.items()})
        check.choice("direction", self.direction, check.DIRECTIONS)

    def __str__(self) -> str:
        return (f"{self.mass:g} kg at {self.frequency:.2f} Hz, {self.damping:.1%}, ".replace("%", " %")
                + f"{self.sprung_ratio:.0%} sprung, {self.direction}".replace("%", " %"))


def block_matrices(body: Body) -> tuple[Array, Array, Array, Array]:
    """A, B, C, D from y, v, a of the deck to the force on it (eq. 4, A.3), with states u and du."""
    k, c, m = body.stiffness, body.damping_coefficient, body.sprung_mass
    return (np.array([[0, 1], [-k / m, -c / m]]), np.array([[0, 0, 0], [k / m, c / m, 0]]),
            np.array([[k, c]]), np.array([[-k, -c, -body.unsprung_mass]]))


def checked_ports(ports: Sequence[str], unsprung_mass: Array) -> int:
    """Number of ports, having checked that they are y, v or y, v, a, and that a serves any unsprung mass."""
    ports = check.ports(ports)
    if len(ports) == 2 and np.any(unsprung_mass):
        raise ValueError(f"ports must hold 'a' for a body with unsprung mass, got {tuple(ports)} and "
                         f"{np.max(unsprung_mass):g} kg; add 'a', or set sprung_ratio=1")
    return len(ports)

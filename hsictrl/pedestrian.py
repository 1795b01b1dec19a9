"""A body is sprung mass, unsprung mass, spring and damper, in a direction, drawn from a population."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, final

import control as ct
import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._draws import truncated_normal

PERCENT = "give a fraction, not percent"
RULES: dict[str, dict[str, Any]] = {
    "mass": {"above": 0, "remedy": "give kg"},
    "frequency": {"above": 0, "remedy": "give Hz"},
    "damping": {"least": 0, "below": 1, "remedy": PERCENT},
    "sprung_ratio": {"above": 0, "most": 1, "remedy": PERCENT},
}
Complex = NDArray[np.complex128]


class _SprungBody:
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


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Pedestrian(_SprungBody):
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
        for name in ("mass", "frequency", "damping", "sprung_ratio"):
            object.__setattr__(self, name, check.number(name, getattr(self, name), **RULES[name]))
        check.choice("direction", self.direction, check.DIRECTIONS)

    def __str__(self) -> str:
        return (f"{self.mass:g} kg at {self.frequency:.2f} Hz, {self.damping:.1%}, ".replace("%", " %")
                + f"{self.sprung_ratio:.0%} sprung, {self.direction}".replace("%", " %"))

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
        columns = _ports(ports)
        if columns == 2 and self.unsprung_mass:
            raise ValueError(f"ports must hold 'a' for a body with unsprung mass, got {tuple(ports)} and "
                             f"{self.unsprung_mass:g} kg; add 'a', or set sprung_ratio=1")
        k, c, m = self.stiffness, self.damping_coefficient, self.sprung_mass
        return ct.ss([[0, 1], [-k / m, -c / m]], np.array([[0, 0, 0], [k / m, c / m, 0]])[:, :columns],
                     [[k, c]], np.array([[-k, -c, -self.unsprung_mass]])[:, :columns],
                     inputs=list(ports), outputs=["F"], states=["u", "du"], name=name)


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Crowd(_SprungBody):
    """Bodies of n people as arrays.

    Parameters
    ----------
    mass, frequency, damping, sprung_ratio : array_like, shape (n,)
        As in `Pedestrian`, one value per body; a scalar serves all [kg, Hz, -, -].
    direction : str or array_like of str, shape (n,)
        Direction in which each body moves, "vertical" or "lateral".

    Examples
    --------
    >>> people = Crowd(mass=[70.0, 80.0], frequency=3.25, damping=0.3)
    >>> len(people), people[1].mass, float(people.mass.sum())
    (2, 80.0, 150.0)
    """

    mass: Array
    frequency: Array
    damping: Array
    sprung_ratio: Array = 0.95  # type: ignore[assignment]
    direction: NDArray[np.str_] = "vertical"  # type: ignore[assignment]

    def __post_init__(self) -> None:
        values: list[NDArray[Any]] = [check.numbers(name, getattr(self, name), **rule) for name, rule in RULES.items()]
        values.append(_directions(self.direction))
        for name, value in zip(self.__slots__, _same_length(values), strict=True):
            object.__setattr__(self, name, value)

    @classmethod
    def of(cls, bodies: Sequence[Pedestrian]) -> Crowd:
        """Gather single bodies.

        Parameters
        ----------
        bodies : sequence of Pedestrian
            The bodies, in order.

        Returns
        -------
        Crowd

        Examples
        --------
        >>> len(Crowd.of([Pedestrian(), Pedestrian(mass=80.0)]))
        2
        """
        for body in bodies:
            check.instance("bodies", body, Pedestrian, "give a sequence of Pedestrian")
        values: dict[str, Any] = {name: [getattr(body, name) for body in bodies] for name in cls.__slots__}
        return cls(**values)

    def __len__(self) -> int:
        return len(self.mass)

    def __getitem__(self, index: int) -> Pedestrian:
        one = {name: getattr(self, name)[index].item() for name in self.__slots__}
        return Pedestrian(**one)

    def __iter__(self) -> Iterator[Pedestrian]:
        return (self[i] for i in range(len(self)))

    def __str__(self) -> str:
        if not len(self):
            return "nobody"
        low, high = self.frequency.min(), self.frequency.max()
        return (f"{len(self)} bodies, {self.mass.sum():.0f} kg, {low:.2f}–{high:.2f} Hz, "
                f"{100 * self.damping.min():.0f}–{100 * self.damping.max():.0f} %")

    def part(self, which: Any) -> Crowd:
        """Some of the bodies.

        Parameters
        ----------
        which : slice, index array or mask
            What numpy takes to choose from an array of n.

        Returns
        -------
        Crowd

        Examples
        --------
        >>> len(Crowd(mass=[70.0] * 5, frequency=3.25, damping=0.3).part(slice(2)))
        2
        """
        return Crowd(**{name: getattr(self, name)[which] for name in self.__slots__})


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Population:
    """People to draw bodies from: each property a value, or mean and standard deviation of a normal.

    Normals are truncated to what a body can have: frequency and mass above 0, damping in [0, 1)
    (section 2.2).

    Parameters
    ----------
    frequency : float or (float, float)
        Natural frequency, or its mean and standard deviation [Hz].
    damping : float or (float, float)
        Damping ratio, or its mean and standard deviation [-].
    mass : float or (float, float)
        Whole mass, or its mean and standard deviation [kg].
    sprung_ratio : float
        Share of the mass that is sprung [-].
    direction : {"vertical", "lateral"}
        Direction in which the bodies move.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> people = Population.walking().sample(75, rng)
    >>> len(people), bool(abs(people.frequency.mean() - 3.25) < 0.15)
    (75, True)
    """

    frequency: float | tuple[float, float]
    damping: float | tuple[float, float]
    mass: float | tuple[float, float] = 70.0
    sprung_ratio: float = 0.95
    direction: str = "vertical"

    def __post_init__(self) -> None:
        for name, most in (("frequency", np.inf), ("damping", 1.0), ("mass", np.inf)):
            object.__setattr__(self, name, _mean_and_spread(name, getattr(self, name), most))
        check.number("sprung_ratio", self.sprung_ratio, **RULES["sprung_ratio"])
        check.choice("direction", self.direction, check.DIRECTIONS)

    @classmethod
    def walking(cls) -> Population:
        """Walkers, one or two legs slightly bent: N(3.25, 0.32) Hz, N(0.30, 0.05) (section 2.2).

        Returns
        -------
        Population

        Examples
        --------
        >>> Population.walking().frequency
        (3.25, 0.32)
        """
        return cls(frequency=(3.25, 0.32), damping=(0.30, 0.05))

    @classmethod
    def standing(cls) -> Population:
        """People standing upright: N(5.7, 0.56) Hz, N(0.44, 0.07) (section 3.4).

        Returns
        -------
        Population

        Examples
        --------
        >>> Population.standing().damping
        (0.44, 0.07)
        """
        return cls(frequency=(5.7, 0.56), damping=(0.44, 0.07))

    @classmethod
    def lateral(cls) -> Population:
        """Sideways motion of the body: 95 % of the frequencies in 0.5–1.0 Hz (section 3.4).

        The paper gives this range only; the normal N(0.75, 0.125) Hz and the damping N(0.30, 0.05)
        are assumptions of ours.

        Returns
        -------
        Population

        Examples
        --------
        >>> Population.lateral().direction
        'lateral'
        """
        return cls(frequency=(0.75, 0.125), damping=(0.30, 0.05), direction="lateral")

    def sample(self, n: int, rng: np.random.Generator) -> Crowd:
        """Draw n bodies.

        Parameters
        ----------
        n : int
            Number of bodies [-].
        rng : numpy.random.Generator
            Source of randomness; body i depends on the draws up to i only.

        Returns
        -------
        Crowd

        Examples
        --------
        >>> len(Population.standing().sample(3, np.random.default_rng(0)))
        3
        """
        n = check.whole("n", n, least=0, remedy="give the number of bodies to draw")
        check.instance("rng", rng, np.random.Generator, "give numpy.random.default_rng(seed)")
        draws = rng.random((n, 3)).T
        return Crowd(
            frequency=truncated_normal(*_pair(self.frequency), draws[0]),
            damping=truncated_normal(*_pair(self.damping), draws[1], high=1.0),
            mass=truncated_normal(*_pair(self.mass), draws[2]),
            sprung_ratio=np.full(n, self.sprung_ratio), direction=np.full(n, self.direction))


def _pair(normal: float | tuple[float, float]) -> tuple[float, float]:
    return normal if isinstance(normal, tuple) else (normal, 0.0)


def _mean_and_spread(name: str, value: Any, most: float) -> tuple[float, float]:
    remedy = PERCENT if name == "damping" else "give a value, or (mean, standard deviation)"
    pair = np.atleast_1d(check.numbers(name, value, least=0, remedy=remedy))
    if pair.shape not in ((1,), (2,)):
        raise ValueError(f"{name} must be a value or (mean, standard deviation), got shape {pair.shape}; {remedy}")
    mean = check.number(name, pair[0], above=0 if name != "damping" else None, below=most, remedy=remedy)
    return mean, float(pair[1]) if len(pair) == 2 else 0.0


def _directions(value: Any) -> NDArray[np.str_]:
    directions = np.array(value, dtype=np.str_)
    for one in np.unique(directions):
        check.choice("direction", str(one), check.DIRECTIONS)
    return directions


def _same_length(values: Sequence[Any]) -> tuple[NDArray[Any], ...]:
    try:
        arrays = np.broadcast_arrays(*map(np.atleast_1d, values))
    except ValueError:
        shapes = ", ".join(str(np.shape(v)) for v in values)
        raise ValueError("mass, frequency, damping, sprung_ratio and direction must have the same length, "
                         f"got shapes {shapes}; give one value per body, or a scalar for all") from None
    if arrays[0].ndim != 1:
        raise ValueError(f"a crowd must be one row of bodies, got shape {arrays[0].shape}; give arrays of shape (n,)")
    for array in arrays:
        array.flags.writeable = False
    return arrays


def _ports(ports: Sequence[str]) -> int:
    """Number of ports, having checked that they are y, v or y, v, a."""
    if tuple(ports) not in (("y", "v"), ("y", "v", "a")):
        raise ValueError(f"ports must be ('y', 'v', 'a') or ('y', 'v'), got {tuple(ports)}; choose one of these")
    return len(ports)

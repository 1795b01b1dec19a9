"""People to draw bodies from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from hsictrl import _checks as check
from hsictrl._draws import truncated_normal
from hsictrl.pedestrian.body import RULES
from hsictrl.pedestrian.crowd import Crowd


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
        below = {"frequency": None, "damping": 1.0, "mass": None}
        check.store(self, **{name: _mean_and_spread(name, getattr(self, name), one) for name, one in below.items()})
        check.number("sprung_ratio", self.sprung_ratio, **RULES["sprung_ratio"])
        check.choice("direction", self.direction, check.DIRECTIONS)

    @classmethod
    def walking(cls) -> Population:
        """Legs slightly bent, of those who walk or stand so: N(3.25, 0.32) Hz, N(0.30, 0.05) (section 2.2).

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
        """Upright, the normal way to stand: N(5.7, 0.56) Hz, N(0.44, 0.07) (section 3.4).

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
        People who push back both ways have two bodies each, at the same place:

        >>> rng = np.random.default_rng(1)
        >>> both = Population.walking().sample(5, rng) + Population.lateral().sample(5, rng)
        >>> len(both), str(both.direction[0]), str(both.direction[5])
        (10, 'vertical', 'lateral')
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
        pairs: list[tuple[float, float]] = [getattr(self, name) for name in ("frequency", "damping", "mass")]
        frequency, damping, mass = pairs
        return Crowd(
            frequency=truncated_normal(*frequency, draws[0]),
            damping=truncated_normal(*damping, draws[1], high=1.0),
            mass=truncated_normal(*mass, draws[2]),
            sprung_ratio=np.full(n, self.sprung_ratio), direction=np.full(n, self.direction))


def _mean_and_spread(name: str, value: Any, below: float | None) -> tuple[float, float]:
    remedy = check.PERCENT if name == "damping" else "give a value, or (mean, standard deviation)"
    pair = np.atleast_1d(check.numbers(name, value, least=0, remedy=remedy))
    if pair.shape not in ((1,), (2,)):
        raise ValueError(f"{name} must be a value or (mean, standard deviation), got shape {pair.shape}; {remedy}")
    mean = check.number(name, pair[0], above=0 if name != "damping" else None, below=below, remedy=remedy)
    spread = pair[1] if len(pair) == 2 else 0.0
    return mean, check.number(f"spread of {name}", spread, below=below, remedy=remedy)


POSTURES = {"bent legs": Population.walking(), "upright": Population.standing()}

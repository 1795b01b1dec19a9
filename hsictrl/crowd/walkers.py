"""Many walkers, as arrays: who they are, and where each of them is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.crowd.trajectory import Trajectory, check_on_deck
from hsictrl.crowd.walker import FOLLOWED, Walker
from hsictrl.pedestrian import Crowd
from hsictrl.walking import ForceLines, ForceParts, WalkingForce

Indices = NDArray[np.intp]


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Walkers:
    """Walkers as arrays, in the order in which they are given.

    Parameters
    ----------
    bodies : Crowd
        Their n bodies.
    forces : sequence of WalkingForce
        The distinct force models among them.
    model : array of int, shape (n,)
        Which of `forces` each walker has [-].
    draws : sequence of array, one of shape (n_i, n_draws) per model
        Standard uniform numbers from which each model makes its walkers' forces [-].
    weight, step_frequency, speed, arrival, offset : array, shape (n,)
        As in `Walker` [N, Hz, m/s, s, m].
    trajectories : sequence of Trajectory or None, shape (n,) or ()
        The trajectory of each walker who follows one; their speed, arrival and offset are read from it.

    Examples
    --------
    >>> from hsictrl.walking import HarmonicForce
    >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
    >>> walkers = Walkers.of([walker, walker])
    >>> len(walkers), walkers.position([4.0]).ravel()
    (2, array([5., 5.]))
    """

    bodies: Crowd
    forces: Sequence[WalkingForce]
    model: Indices
    draws: Sequence[Array]
    weight: Array
    step_frequency: Array
    speed: Array
    arrival: Array
    offset: Array
    trajectories: Sequence[Trajectory | None] = ()

    def __post_init__(self) -> None:
        check.instance("trajectories", self.trajectories, Sequence, "give a list, empty where all go straight on")
        followed = any(one is not None for one in self.trajectories)
        check.store(self, trajectories=tuple(self.trajectories) if followed else ())
        for name in ("weight", "step_frequency", "speed"):
            bound: Any = {"least": 0} if self.trajectories and name == "speed" else {"above": 0}
            values = check.numbers(name, getattr(self, name), **bound, remedy=f"give one {name} per walker")
            check.store(self, **{name: values})
        for name in ("arrival", "offset"):
            check.store(self, **{name: check.numbers(name, getattr(self, name), remedy="give one per walker")})
        lengths = {name: len(getattr(self, name)) for name in ("bodies", "model", *ARRAYS)}
        if self.trajectories:
            lengths["trajectories"] = len(self.trajectories)
        if len(set(lengths.values())) > 1:
            raise ValueError(f"walkers' arrays must have the same length, got {lengths}; give one value per walker")
        check.store(self, forces=tuple(self.forces), model=np.array(self.model, dtype=np.intp),
                    draws=tuple(np.asarray(table)[:] for table in self.draws))    # views: a caller's own stay writable
        check.freeze(self.model, *self.draws)
        self._check_draws()
        if self.trajectories:
            self._follow()

    def _follow(self) -> None:
        """Read speed, arrival and offset from the trajectories."""
        for one in self.trajectories:
            check.instance("trajectories", one, (Trajectory, type(None)), "give Trajectory(times, x, y), or None")
        for name in FOLLOWED:
            read = [0.0 if one is None else getattr(one, name) for one in self.trajectories]
            values = np.where(self.followed, read, getattr(self, name))
            check.freeze(values)
            check.store(self, **{name: values})
        check.numbers("speed", np.where(self.followed, 1.0, self.speed), above=0,
                      remedy="give those a trajectory who stand")

    def _check_draws(self) -> None:
        expected = [(int(np.sum(self.model == i)), force.n_draws) for i, force in enumerate(self.forces)]
        found = [table.shape for table in self.draws]
        if found != expected or sum(n for n, _ in expected) != len(self.model):
            raise ValueError(f"draws must be one table per force model, a row per walker, of shapes {expected}, got "
                             f"{found}; draw them by rng.random((n, force.n_draws))")

    @classmethod
    def of(cls, walkers: Sequence[Walker], rng: np.random.Generator | None = None) -> Walkers:
        """Gather single walkers.

        Parameters
        ----------
        walkers : sequence of Walker
            The walkers.
        rng : numpy.random.Generator, optional
            Source of randomness, for forces that draw any.

        Returns
        -------
        Walkers

        Examples
        --------
        >>> from hsictrl.walking import YoungForce
        >>> walker = Walker(force=YoungForce(), step_frequency=2.0, speed=1.25)
        >>> len(Walkers.of([walker], rng=np.random.default_rng(1)))
        1
        """
        for walker in check.instance("walkers", walkers, Sequence, "give a list of Walker"):
            check.instance("walkers", walker, Walker, "give a list of Walker")
        forces = list(dict.fromkeys(walker.force for walker in walkers))
        model = np.array([forces.index(walker.force) for walker in walkers], dtype=np.intp)
        draws = [_draws(force, int(np.sum(model == i)), rng) for i, force in enumerate(forces)]
        own = {name: np.array([getattr(walker, name) for walker in walkers], float) for name in ARRAYS}
        bodies = Crowd.of([walker.body for walker in walkers])
        return cls(bodies=bodies, forces=tuple(forces), model=model, draws=tuple(draws), **own,
                   trajectories=tuple(walker.trajectory for walker in walkers))

    def __len__(self) -> int:
        return len(self.model)

    def __getitem__(self, index: int) -> Walker:
        own = {name: float(getattr(self, name)[index]) for name in ARRAYS}
        return Walker(body=self.bodies[index], force=self.forces[self.model[index]], **own,
                      trajectory=self.trajectories[index] if self.trajectories else None)

    def __iter__(self) -> Iterator[Walker]:
        return (self[i] for i in range(len(self)))

    def part(self, which: Any) -> Walkers:
        """Some of the walkers, with the same forces.

        Parameters
        ----------
        which : slice, index array or mask
            What numpy takes to choose from an array of n.

        Returns
        -------
        Walkers

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
        >>> len(Walkers.of([walker] * 3).part([0, 2]))
        2
        """
        kept = np.arange(len(self))[which]
        row = self._row_in_model()
        draws = tuple(table[row[kept[self.model[kept] == i]]] for i, table in enumerate(self.draws))
        return Walkers(bodies=self.bodies.part(kept), forces=self.forces, model=self.model[kept], draws=draws,
                       trajectories=[self.trajectories[k] for k in kept] if self.trajectories else (),
                       **{name: getattr(self, name)[kept] for name in ARRAYS})

    def at_step_frequency(self, step_frequency: Array) -> Walkers:
        """The same walkers at other step frequencies; their forces follow from the same draws.

        Parameters
        ----------
        step_frequency : array, shape (n,)
            New step frequencies [Hz].

        Returns
        -------
        Walkers

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
        >>> Walkers.of([walker]).at_step_frequency(np.array([1.9])).step_frequency
        array([1.9])
        """
        return replace(self, step_frequency=step_frequency)

    def periodic(self) -> Walkers:
        """The same walkers without intra-person variability, see `WalkingForce.periodic`.

        Returns
        -------
        Walkers

        Examples
        --------
        >>> from hsictrl.walking import ZivanovicForce
        >>> walker = Walker(force=ZivanovicForce(), step_frequency=2.0, speed=1.25)
        >>> [(who, force)] = Walkers.of([walker], rng=np.random.default_rng(1)).periodic().lines()
        >>> force.frequencies
        array([[ 2.,  4.,  6.,  8., 10.]])
        """
        return replace(self, forces=tuple(force.periodic() for force in self.forces))

    @property
    def followed(self) -> NDArray[np.bool_]:
        """Who follows a trajectory, shape (n,)."""
        return np.array([one is not None for one in self.trajectories] or np.zeros(len(self)), dtype=bool)

    def stay(self, length: float) -> Array:
        """For how long each walker is on a deck: while they cross it, or their trajectory lasts.

        Parameters
        ----------
        length : float
            Length of the deck [m].

        Returns
        -------
        array, shape (n,)
            [s]

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
        >>> Walkers.of([walker]).stay(50.0)
        array([40.])
        """
        if not self.trajectories:
            return np.asarray(length / self.speed)
        return np.array([length / v if one is None else one.departure - one.arrival
                         for v, one in zip(self.speed, self.trajectories, strict=True)])

    def departure(self, length: float) -> Array:
        """When each walker leaves a deck.

        Parameters
        ----------
        length : float
            Length of the deck [m].

        Returns
        -------
        array, shape (n,)
            [s]

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25, arrival=3.0)
        >>> Walkers.of([walker]).departure(50.0)
        array([43.])
        """
        return self.arrival + self.stay(length)

    def top_speed(self) -> Array:
        """Highest speed of each walker.

        Returns
        -------
        array, shape (n,)
            [m/s]

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
        >>> Walkers.of([walker]).top_speed()
        array([1.25])
        """
        if not self.trajectories:
            return self.speed
        return np.array([v if one is None else one.top_speed
                         for v, one in zip(self.speed, self.trajectories, strict=True)])

    def carried(self, bridge: Footbridge) -> NDArray[np.bool_]:
        """Who walks on the deck of a bridge, rather than beside it.

        Parameters
        ----------
        bridge : Footbridge
            The bridge, for its deck.

        Returns
        -------
        array of bool, shape (n,)

        Raises
        ------
        ValueError
            If a trajectory leaves the deck.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.walking import HarmonicForce
        >>> beside = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25, offset=3.0)
        >>> Walkers.of([beside]).carried(reference_bridge())
        array([False])
        """
        for one in self.trajectories:
            if one is not None:
                check_on_deck(one, bridge)
        return bridge.carries_across(self.offset)

    def along(self, times: Array, who: Any = slice(None)) -> tuple[Array, Array]:
        """Where some walkers are, each at times of their own; off the deck too.

        Parameters
        ----------
        times : array, shape (k, m)
            Times, a row for each of them [s].
        who : index array or mask
            Which k of the walkers; all if not given.

        Returns
        -------
        x, y : array, shape (k, m), or (k, 1) where y stays
            Positions [m].

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25, offset=0.5)
        >>> Walkers.of([walker]).along(np.array([[4.0]]))
        (array([[5.]]), array([[0.5]]))
        """
        x = self.speed[who, None] * (times - self.arrival[who, None])
        if not self.trajectories:
            return x, self.offset[who, None]
        y = np.broadcast_to(self.offset[who, None], x.shape).copy()
        for row, k in enumerate(np.arange(len(self))[who]):
            one = self.trajectories[k]
            if one is not None:
                x[row], y[row] = one(times[row]).T
        return x, y

    def position(self, times: Any) -> Array:
        """Where the walkers are along the line of the deck: x = v(t − t_a), or by trajectory; off the deck too.

        Parameters
        ----------
        times : array_like, shape (m,)
            Times [s].

        Returns
        -------
        array, shape (n, m)
            Position x [m].

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25, arrival=1.0)
        >>> Walkers.of([walker]).position([1.0, 5.0])
        array([[0., 5.]])
        """
        times = check.numbers("times", times, ndim=1, remedy="give a list of seconds")
        return self.along(np.broadcast_to(times, (len(self), len(times))))[0]

    def places(self, time: float) -> Array:
        """Where the walkers are at an instant; off the deck too.

        Parameters
        ----------
        time : float
            The instant [s].

        Returns
        -------
        array, shape (n, 2)
            Positions x and y [m].

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25, offset=0.5)
        >>> Walkers.of([walker]).places(4.0)
        array([[5. , 0.5]])
        """
        instant = check.number("time", time, remedy="give s")
        return np.column_stack([part[:, 0] for part in self.along(np.full((len(self), 1), instant))])

    def lines(self) -> list[tuple[Indices, ForceLines]]:
        """Walking forces of all walkers, model by model.

        Returns
        -------
        list of (array of int, ForceLines)
            Indices of the walkers who share a model [-], and their forces [N].

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
        >>> [(who, force)] = Walkers.of([walker, walker]).lines()
        >>> who, force.n_walkers
        (array([0, 1]), 2)
        """
        return [(who, parts.at(self.step_frequency[who])) for who, parts in self.parts()]

    def parts(self) -> list[tuple[Indices, ForceParts]]:
        """What the walking forces are made of at any step frequencies, model by model.

        Returns
        -------
        list of (array of int, ForceParts)
            Indices of the walkers who share a model [-], and the parts of their forces [N].

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25)
        >>> [(who, parts)] = Walkers.of([walker]).parts()
        >>> parts.at([1.8]).frequencies
        array([[1.8]])
        """
        members = [np.flatnonzero(self.model == i) for i in range(len(self.forces))]
        return [(who, force.parts(self.weight[who], draws))
                for who, force, draws in zip(members, self.forces, self.draws, strict=True) if len(who)]

    def _row_in_model(self) -> Indices:
        """Row of each walker in the draws of its model."""
        row = np.empty(len(self), dtype=np.intp)
        for i in range(len(self.forces)):
            row[self.model == i] = np.arange(np.sum(self.model == i))
        return row


ARRAYS = ("weight", "step_frequency", "speed", "arrival", "offset")


def _draws(force: WalkingForce, n: int, rng: np.random.Generator | None) -> Array:
    if rng is not None:
        check.instance("rng", rng, np.random.Generator, "give numpy.random.default_rng(seed)")
    elif force.n_draws:
        raise ValueError(f"{type(force).__name__} draws {force.n_draws} random numbers per walker, got no generator; "
                         "give rng=numpy.random.default_rng(seed)")
    return rng.random((n, force.n_draws)) if rng is not None else np.empty((n, 0))

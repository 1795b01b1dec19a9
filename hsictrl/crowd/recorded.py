"""Recorded people as walkers: each of their stays on the deck is one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.crowd.gait import preferred_step_frequency
from hsictrl.crowd.recording import Recording
from hsictrl.crowd.trajectory import Trajectory
from hsictrl.crowd.walker import BY_HAND
from hsictrl.crowd.walkers import Walkers
from hsictrl.pedestrian import Crowd, Population
from hsictrl.walking import HarmonicForce, WalkingForce

FREE_SPEED = 1.34     # m/s
SILENT = HarmonicForce([0.0])
Flags = NDArray[np.bool_]


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Recorded:
    """Somebody who comes on the deck.

    Parameters
    ----------
    rows : array of int
        Rows of the recording, in order of time [-].
    stays : list of Trajectory
        From one edge of the deck to the next; at least one.
    """

    rows: NDArray[np.intp]
    stays: list[Trajectory]

    @property
    def speed(self) -> float:
        """Median speed, averaged over all stays [m/s]."""
        lasting = [stay.departure - stay.arrival for stay in self.stays]
        return float(np.average([stay.speed for stay in self.stays], weights=lasting))


def on_deck(recording: Recording, bridge: Footbridge, origin: Any, angle: float) -> list[Recorded]:
    """Who comes on the deck; nobody is followed who is seen but once.

    Parameters
    ----------
    recording : Recording
        Who was where, and when.
    bridge : Footbridge
        The bridge, for its deck.
    origin : (float, float)
        Where the centre line of the deck begins, as the recording has it [m].
    angle : float
        Direction of the deck there [rad].

    Returns
    -------
    list of Recorded
    """
    places = _along_the_deck(recording, origin, angle)
    people = [Recorded(rows=rows, stays=_trajectory(recording, rows, places[rows]).stays_on(bridge))
              for rows in recording.persons() if len(rows) > 1]
    present = [one for one in people if one.stays]
    if not present:
        (x_low, y_low), (x_high, y_high) = places.min(axis=0), places.max(axis=0)
        raise ValueError(f"{recording.name}: somebody must come on the deck, 0 ≤ x ≤ {bridge.length:g} and |y| ≤ "
                         f"{bridge.width / 2:g} m, got x from {x_low:g} to {x_high:g} m and y from {y_low:g} to "
                         f"{y_high:g} m; give origin and angle of its centre line")
    return present


def step_frequencies(recording: Recording, people: list[Recorded], walking: Flags, given: Any) -> Array:
    """Step frequency of each person: by the rule, from a column, or one for all.

    Parameters
    ----------
    recording : Recording
        Who was where, and when.
    people : list of Recorded
        Who comes on the deck.
    walking : array of bool, shape (n,)
        Who walks; the others get the mean of these, which makes no difference.
    given : float or str, optional
        As in `Traffic.from_trajectories` [Hz].

    Returns
    -------
    array, shape (n,)
        [Hz]
    """
    found = np.array([_step_frequency(recording, one, given) if walks else np.nan
                      for one, walks in zip(people, walking, strict=True)])
    mean = np.mean(found[walking]) if np.any(walking) else preferred_step_frequency(FREE_SPEED)
    return np.where(walking, found, mean)


def drawn(
    people: list[Recorded], walking: Flags, frequencies: Array, *, rng: np.random.Generator, force: WalkingForce,
    populations: tuple[Population, Population], weight: float,
) -> Walkers:
    """Draw bodies and forces, one of each person for all stays.

    Parameters
    ----------
    people : list of Recorded
        Who comes on the deck.
    walking : array of bool, shape (n,)
        Who walks; the others have no force.
    frequencies : array, shape (n,)
        Step frequencies [Hz].
    rng : numpy.random.Generator
        Source of randomness.
    force : WalkingForce
        Force of those who walk.
    populations : (Population, Population)
        Whom the bodies are drawn from, of those who walk and of the others.
    weight : float
        Weight of each walker [N].

    Returns
    -------
    Walkers
    """
    bodies, others, forces = rng.spawn(3)
    n = len(people)
    crowd = _chosen(walking, populations[0].sample(n, bodies), populations[1].sample(n, others))
    draws = forces.random((n, force.n_draws))
    of = np.repeat(np.arange(n), [len(one.stays) for one in people])
    walks, nothing = walking[of], np.zeros(len(of))
    return Walkers(
        bodies=crowd.part(of), forces=(force, SILENT), model=np.where(walks, 0, 1),
        draws=(draws[of[walks]], np.empty((int(np.sum(~walks)), 0))), weight=np.full(len(of), weight),
        step_frequency=frequencies[of], speed=nothing, arrival=nothing, offset=nothing,
        trajectories=[stay for one in people for stay in one.stays])


def _along_the_deck(recording: Recording, origin: Any, angle: float) -> Array:
    """Places from the origin on, along the deck and across it, (n, 2)."""
    begins = check.numbers("origin", origin, ndim=1, remedy="give (x, y) in m")
    if len(begins) != 2:
        raise ValueError(f"origin must be (x, y), got {len(begins)} number(s); give both in m")
    angle = check.number("angle", angle, remedy="give rad")
    cosine, sine = (round(one(angle), 15) for one in (np.cos, np.sin))      # so that a right angle is one
    places = np.column_stack([recording.columns["x"], recording.columns["y"]]) - begins
    return np.asarray(places @ [[cosine, -sine], [sine, cosine]])


def _trajectory(recording: Recording, rows: NDArray[np.intp], places: Array) -> Trajectory:
    try:
        return Trajectory(recording.columns["time"][rows], *places.T)
    except ValueError as error:
        raise ValueError(f"{_person(recording, rows)}: {error}") from None


def _step_frequency(recording: Recording, one: Recorded, given: Any) -> float:
    if isinstance(given, str):
        return _told(recording, one.rows, given)
    if given is not None:
        return check.number("step_frequency", given, **BY_HAND)
    remedy = f"it follows from {one.speed:.3g} m/s; give step_frequency, or leave that person out"
    return check.number(f"{_person(recording, one.rows)}: step_frequency", preferred_step_frequency(one.speed),
                        **BY_HAND | {"remedy": remedy})


def _told(recording: Recording, rows: NDArray[np.intp], head: str) -> float:
    """What a column says in all rows of a person."""
    if head not in recording.columns:
        raise ValueError(f"{recording.name}: step_frequency must name a column, one of "
                         f"{', '.join(map(repr, recording.columns))}, got {head!r}; correct it, or give Hz")
    column = recording.columns[head][rows]
    other = np.flatnonzero(column != column[0])
    if other.size:
        raise ValueError(f"{recording.place(rows[other[0]], head)}: a person must keep one step frequency, got "
                         f"{column[other[0]]} after {column[0]}; give the mean")
    return check.number(recording.place(rows[0], head), column[0], **BY_HAND)


def _person(recording: Recording, rows: NDArray[np.intp]) -> str:
    return f"{recording.name}, person {recording.columns['id'][rows[0]]:g}"


def _chosen(which: Flags, ones: Crowd, others: Crowd) -> Crowd:
    """The bodies of some where `which` is true, and of others elsewhere."""
    return Crowd(**{name: np.where(which, getattr(ones, name), getattr(others, name)) for name in Crowd.__slots__})

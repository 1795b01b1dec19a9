"""A crowd of hundreds as a controller of a few states."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Protocol, final, runtime_checkable

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.pedestrian.bound import largest_difference
from hsictrl.pedestrian.crowd import Crowd
from hsictrl.pedestrian.fit import fit, merge

REMEDY = "describe the bridge by modes"


@runtime_checkable
class ModalBridge(Protocol):
    """What a crowd has to know of a bridge: modes, and how much a place takes part in them. A `Footbridge` is one."""

    @property
    def omega(self) -> Array: ...

    @property
    def damping(self) -> Array: ...

    @property
    def fixed(self) -> tuple[Crowd, Array]: ...

    def on_deck(self, name: str, positions: Any) -> Array: ...

    def participation(self, positions: Any, direction: Any = ...) -> Array: ...


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ReducedCrowd:
    """A few bodies that stand for many, made by `Crowd.reduced`; unpacks into people and positions for `couple`.

    They are ordinary bodies with positive masses in places where some of the crowd stood: a controller
    that is passive by construction.

    Parameters
    ----------
    people : Crowd
        The few bodies.
    positions : array, shape (p, 2)
        Where they stand [m].
    full_people : Crowd
        The n bodies that they stand for.
    full_positions : array, shape (n, 2)
        Where those stand [m].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> bridge, places = reference_bridge(frequency=2.0), np.linspace(0, 50, 16)
    >>> everyone = Crowd(mass=[70.0] * 16, frequency=[3.0, 3.5] * 8, damping=0.3)
    >>> small = everyone.reduced(order=4, bridge=bridge, positions=places)
    >>> couple(bridge, *small).nstates
    6
    >>> print(small)
    order 4 for 16 bodies: 2 bodies, 531 kg, 3.00–3.50 Hz, 30–30 %
    """

    people: Crowd
    positions: Array
    full_people: Crowd
    full_positions: Array

    @property
    def order(self) -> int:
        """Number of states [-]."""
        return 2 * len(self.people)

    def __iter__(self) -> Iterator[Any]:
        return iter((self.people, self.positions))

    def __str__(self) -> str:
        return f"order {self.order} for {len(self.full_people)} bodies: {self.people}"

    def bound(self, bridge: ModalBridge) -> float:
        """Bound the error of the occupied bridge's frequency response, relative to its peak.

        The error is the largest ``‖X̃(iω) − X(iω)‖`` over all frequencies from 0 to infinity, the peak the
        largest ``‖X(iω)‖``: X is the accelerance from modal forces to mass-normalised modal coordinates, the
        norm its largest singular value. On a single mode that is the error of any accelerance relative to its
        own peak. The bound is proven up to rounding; infinite means that nothing could be proven.

        Parameters
        ----------
        bridge : Footbridge
            The bridge, not only the one for which the crowd was reduced; its absorbers take part.

        Returns
        -------
        float
            No relative error is larger [-].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.pedestrian import Population
        >>> rng, bridge = np.random.default_rng(1), reference_bridge(frequency=2.0, damping=0.005)
        >>> people, places = Population.walking().sample(225, rng), rng.uniform(0, 50, 225)
        >>> small = people.reduced(order=8, bridge=bridge, positions=places)
        >>> small.bound(bridge) < 1e-3
        True
        """
        check.instance("bridge", bridge, ModalBridge, REMEDY)
        full, small = (_on_bridge(bridge, *crowd) for crowd in ((self.full_people, self.full_positions), self))
        return largest_difference(bridge.omega, bridge.damping, full, small)


def _on_bridge(bridge: ModalBridge, people: Crowd, positions: Array) -> tuple[Crowd, Array]:
    """All bodies on a bridge, its absorbers first, and their participations."""
    fixed, there = bridge.fixed
    everybody, places = fixed + people, np.vstack([there, bridge.on_deck("positions", positions)])
    return everybody, bridge.participation(places, everybody.direction)


def reduced(people: Crowd, order: int, bridge: ModalBridge, positions: Any) -> ReducedCrowd:
    """The work behind `Crowd.reduced`."""
    check.instance("bridge", bridge, ModalBridge, REMEDY)
    places = bridge.on_deck("positions", positions)
    if len(places) != len(people):
        raise ValueError(f"people and positions must be as many, got {len(people)} bodies and {len(places)} positions; "
                         "give one position per body")
    count = _count(order, len(people))
    rows = bridge.participation(places, people.direction)
    moved = np.flatnonzero(np.any(rows, axis=1))
    _check_bodies(people, moved)
    few, leaders = merge(people.part(moved), rows[moved])
    if len(few) > count:
        _check_modes(rows[moved], order)
        few, chosen = fit(few, rows[moved][leaders], count, float(bridge.damping.min()))
        leaders = leaders[chosen]
    return ReducedCrowd(people=few, positions=places[moved[leaders]], full_people=people, full_positions=places)


def _count(order: Any, n: int) -> int:
    """How many bodies have so many states."""
    order = check.whole("order", order, least=2, remedy="give two states for each body")
    if order % 2:
        raise ValueError(f"order must be even, got {order}; a body has two states")
    if order > 2 * n:
        raise ValueError(f"order must be at most {2 * n} for {n} bodies, got {order}; there is nothing to reduce")
    return order // 2


def _check_bodies(people: Crowd, moved: Any) -> None:
    if not len(moved):
        raise ValueError("somebody must take part in a mode, got nobody who does; leave this crowd out of the loop")
    still = moved[people.damping[moved] == 0]
    if len(still):
        raise ValueError(f"damping[{still[0]}] must be above 0, got 0; no other body has its resonance: "
                         "couple it as it is, and reduce the others")


def _check_modes(rows: Array, order: int) -> None:
    """Bodies are needed for each independent entry of the apparent mass."""
    pairs = (rows[:, :, None] * rows[:, None, :]).reshape(len(rows), -1)
    least = 2 * int(np.linalg.matrix_rank(pairs / np.linalg.norm(pairs, axis=1)[:, None]))
    if order < least:
        raise ValueError(f"order must be at least {least} for {rows.shape[1]} modes, got {order}; give more states")

"""Where one person is over time: a curve through recorded places."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, final

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge

FASTEST = 10.0     # m/s
STRIDE = 1.0       # s; over about a stride, the sway of a body adds nothing to its way
SHORTEST = 1e-6    # s; what a stay must last to be one
ON_EDGE = 1e-9     # m; as near an edge as makes no difference, and farther than rounding reaches
AWAY = -1.0        # m; a place x off every deck, which begins at 0


@final
@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """Where one person is, from arrival to departure, walking or standing.

    Between its places runs a cubic that keeps their order (PCHIP): it does not overshoot, so that whoever stands
    stays put, and whose places lie on the deck is on it in between, too. Before the first time and after the last
    nobody is there.

    Parameters
    ----------
    times : array_like, shape (n,)
        At least two times, increasing [s].
    x : array_like, shape (n,)
        Places along the deck, which begins at 0 [m].
    y : float or array_like, shape (n,)
        Places across the deck, 0 on the centre line [m].

    Attributes
    ----------
    speed : float
        Median speed, from places some one second apart: how fast the person walks, stops left aside [m/s].

    Raises
    ------
    ValueError
        If anybody would have to go faster than 10 m/s, for which units or a jump are to blame.

    Examples
    --------
    Out to midspan, a rest, and back:

    >>> there_and_back = Trajectory([0.0, 20.0, 30.0, 50.0], [0.0, 25.0, 25.0, 0.0], y=0.5)
    >>> there_and_back([20.0, 25.0, 60.0])      # the last one is off the deck
    array([[25. ,  0.5],
           [25. ,  0.5],
           [-1. ,  0. ]])
    >>> there_and_back.arrival, there_and_back.departure, round(there_and_back.speed, 2)
    (0.0, 50.0, 1.25)

    Somebody who stands for ten minutes:

    >>> Trajectory([0.0, 600.0], [25.0, 25.0]).speed
    0.0
    """

    times: Array
    x: Array
    y: Array = 0.0  # type: ignore[assignment]
    speed: float = field(init=False)
    _curve: PchipInterpolator = field(init=False, repr=False)

    def __post_init__(self) -> None:
        times = check.increasing("times", self.times, remedy="give seconds, each place once")
        x = check.numbers("x", self.x, remedy="give m")
        y = np.broadcast_to(check.numbers("y", self.y, remedy="give m"), np.shape(self.y) or times.shape)
        if not times.shape == x.shape == y.shape:
            raise ValueError(f"times, x and y must have the same length, got {len(times)}, {x.size} and {y.size}; "
                             "give a place for each time")
        check.store(self, times=times, x=x, y=y, _curve=PchipInterpolator(times, np.column_stack([x, y])))
        self._refuse_jumps()
        check.store(self, speed=self._median_speed())

    @property
    def arrival(self) -> float:
        """When the person comes [s]."""
        return float(self.times[0])

    @property
    def departure(self) -> float:
        """When the person goes [s]."""
        return float(self.times[-1])

    @property
    def offset(self) -> float:
        """Where across the deck the person comes [m]."""
        return float(self.y[0])

    @property
    def top_speed(self) -> float:
        """Highest speed from one of the places to the next [m/s]."""
        return float(np.max(self._speeds()))

    def __call__(self, times: Any) -> Array:
        """Where the person is; at x = −1 m, off every deck, before the arrival and after the departure.

        Parameters
        ----------
        times : array_like, shape (m,)
            Times [s].

        Returns
        -------
        array, shape (m, 2)
            Places x and y [m].
        """
        times = check.numbers("times", times, ndim=1, remedy="give a list of seconds")
        there = (times >= self.times[0]) & (times <= self.times[-1])
        return np.where(there[:, None], self._places(np.where(there, times, self.times[0])), [AWAY, 0.0])

    def stays_on(self, bridge: Footbridge) -> list[Trajectory]:
        """The parts of the trajectory that lie on a deck, from one of its edges to the next.

        Parameters
        ----------
        bridge : Footbridge
            The bridge, for its deck.

        Returns
        -------
        list of Trajectory
            In order of time; empty for somebody who never comes.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> [stay] = Trajectory([0.0, 100.0], [-25.0, 100.0]).stays_on(reference_bridge())     # of 50 m
        >>> stay.times, stay.x
        (array([20., 60.]), array([ 0., 50.]))
        """
        check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
        edges = [(0, 0.0), (0, bridge.length), (1, -bridge.width / 2), (1, bridge.width / 2)]
        ends = np.unique(np.concatenate([self.times[[0, -1]], *(self._crossings(*edge) for edge in edges)]))
        on = np.concatenate([[False], bridge.carries(self._places((ends[:-1] + ends[1:]) / 2)), [False]])
        changes = np.flatnonzero(on[1:] != on[:-1])
        return [self._between(ends[first], ends[last], bridge) for first, last in changes.reshape(-1, 2)
                if ends[last] - ends[first] > SHORTEST]

    def _crossings(self, axis: int, edge: float) -> Array:
        """When an edge of the deck is crossed or met: at most once between two known places, whose order is kept."""
        beyond = (self.x, self.y)[axis] - edge
        side = np.where(np.abs(beyond) > ON_EDGE, np.sign(beyond), 0)
        found = [brentq(lambda time: self._curve(time)[axis] - edge, *self.times[i:i + 2])
                 for i in np.flatnonzero(side[1:] * side[:-1] < 0)]
        return np.concatenate([self.times[side == 0], found])

    def _places(self, times: Array) -> Array:
        """Places at times of the stay, which rounding takes nowhere but between the known ones."""
        (x_low, x_high), (y_low, y_high) = ((np.min(one), np.max(one)) for one in (self.x, self.y))
        return np.clip(self._curve(times), [x_low, y_low], [x_high, y_high])

    def _between(self, start: float, stop: float, bridge: Footbridge) -> Trajectory:
        """The part from one time to another, which lies on the deck but for rounding."""
        inner = self.times[(self.times > start + SHORTEST) & (self.times < stop - SHORTEST)]
        times = np.concatenate([[start], inner, [stop]])
        x, y = self._places(times).T
        return Trajectory(times, np.clip(x, 0.0, bridge.length), np.clip(y, -bridge.width / 2, bridge.width / 2))

    def _refuse_jumps(self) -> None:
        speeds = self._speeds()
        i = int(np.argmax(speeds))
        if speeds[i] > FASTEST * (1 + 1e-9):
            raise ValueError(f"a trajectory must go at most {FASTEST:g} m/s, got {speeds[i]:.3g} m/s from "
                             f"{self.times[i]:g} to {self.times[i + 1]:g} s; give metres and seconds, and mend jumps")

    def _speeds(self) -> Array:
        return np.asarray(np.hypot(np.diff(self.x), np.diff(self.y)) / np.diff(self.times))

    def _median_speed(self) -> float:
        """Over the first place in each second, and the last one, by how long each speed lasts."""
        _, firsts = np.unique(np.floor((self.times - self.arrival) / STRIDE), return_index=True)
        kept = np.unique([*firsts, len(self.times) - 1])
        lasting = np.diff(self.times[kept])
        speeds = np.hypot(np.diff(self.x[kept]), np.diff(self.y[kept])) / lasting
        order = np.argsort(speeds)
        gone = np.cumsum(lasting[order])
        return float(speeds[order][np.searchsorted(gone, gone[-1] / 2)])


def check_on_deck(trajectory: Trajectory, bridge: Footbridge) -> None:
    """Refuse a trajectory that leaves the deck; places on it leave nothing off it in between."""
    places = np.column_stack([trajectory.x, trajectory.y])
    carried = bridge.carries(places)
    if not np.all(carried):
        i = int(np.argmin(carried))
        raise ValueError(f"a trajectory must lie on the deck, 0 ≤ x ≤ {bridge.length:g} and |y| ≤ "
                         f"{bridge.width / 2:g} m, got ({places[i, 0]:g}, {places[i, 1]:g}) m at "
                         f"{trajectory.times[i]:g} s; cut it by stays_on(bridge)")

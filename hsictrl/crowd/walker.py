"""Somebody on the way: a body, a walking force, and a way along the deck, straight or by a trajectory."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, final

import control as ct

from hsictrl import _checks as check
from hsictrl.crowd.trajectory import Trajectory
from hsictrl.pedestrian import Pedestrian
from hsictrl.walking import WalkingForce

BY_HAND: dict[str, Any] = {
    "least": 0.5, "most": 3.5, "remedy": "people step at 0.5 to 3.5 Hz; give f_s, not a bridge frequency"}
RULES: dict[str, dict[str, Any]] = {
    "weight": {"above": 0, "remedy": "give N"},
    "step_frequency": BY_HAND,
    "speed": {"above": 0, "most": 10, "remedy": "give m/s, at most 10"},
    "arrival": {"remedy": "give s"},
    "offset": {"remedy": "give m"},
}
FOLLOWED: dict[str, float | None] = {"speed": None, "arrival": 0.0, "offset": 0.0}    # and what they are if not given


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Walker:
    """One person who crosses the bridge straight on, or follows a trajectory.

    Parameters
    ----------
    body : Pedestrian
        The body.
    force : WalkingForce
        The walking force on rigid ground.
    weight : float
        Weight that drives the walking force, G; 700 N in the paper, beside a body of 70 kg [N].
    step_frequency : float
        Step frequency f_s, 0.5 to 3.5 [Hz].
    speed : float, optional
        Walking speed v_s [m/s].
    arrival : float
        Time at which the walker steps on, t_a [s].
    offset : float
        Lateral position y on the deck, 0 on the centre line [m].
    trajectory : Trajectory, optional
        Where the walker is, in place of a speed, an arrival and an offset, which are then read from it.

    Examples
    --------
    >>> from hsictrl.walking import HarmonicForce
    >>> walker = Walker(force=HarmonicForce([0.43, 0.08]), step_frequency=2.0, speed=1.25)
    >>> walker.weight, walker.arrival
    (700.0, 0.0)

    Somebody who stands at midspan, with no force of their own:

    >>> place = Trajectory([10.0, 70.0], [25.0, 25.0])
    >>> Walker(force=HarmonicForce([0.0]), step_frequency=2.0, trajectory=place).arrival
    10.0
    """

    body: Pedestrian = field(default_factory=Pedestrian)
    force: WalkingForce
    weight: float = 700.0
    step_frequency: float
    speed: float = None  # type: ignore[assignment]
    arrival: float = 0.0
    offset: float = 0.0
    trajectory: Trajectory | None = None

    def __post_init__(self) -> None:
        check.instance("body", self.body, Pedestrian, "use hsictrl.Pedestrian()")
        check.instance("force", self.force, WalkingForce, "use HarmonicForce, YoungForce or ZivanovicForce")
        if self.trajectory is not None:
            self._follow(check.instance("trajectory", self.trajectory, Trajectory, "give Trajectory(times, x, y)"))
        rules = {name: rule for name, rule in RULES.items() if self.trajectory is None or name not in FOLLOWED}
        check.store(self, **{name: check.number(name, getattr(self, name), **rule) for name, rule in rules.items()})

    def _follow(self, trajectory: Trajectory) -> None:
        """Read speed, arrival and offset from the trajectory; refuse others."""
        for name, default in FOLLOWED.items():
            given, own = getattr(self, name), getattr(trajectory, name)
            if given not in (default, own):
                raise ValueError(f"{name} must be left to the trajectory, got {given} beside one with {own:g}; give "
                                 "one of them")
            check.store(self, **{name: own})

    def ss(self, *, name: str = "walker") -> ct.StateSpace:
        """Give the walker's body as a block, see `Pedestrian.ss`.

        Parameters
        ----------
        name : str
            Name of the block.

        Returns
        -------
        control.StateSpace
            Inputs y, v, a of the contact point, output F [N].

        Examples
        --------
        >>> from hsictrl.walking import YoungForce
        >>> Walker(force=YoungForce(), step_frequency=2.0, speed=1.25).ss(name="anna").name
        'anna'
        """
        return self.body.ss(name=name)

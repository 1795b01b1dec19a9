"""Virtual tests on the footbridge in Eeklo: free decays, and people who walk to and fro for three minutes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, final

import numpy as np

from hsictrl._checks import Array
from hsictrl._draws import truncated_normal
from hsictrl.coupling import couple, moving_crowd
from hsictrl.crowd import Traffic, Walkers
from hsictrl.identify import subspace_identification
from hsictrl.measurement import virtual_measurement
from hsictrl.paper.eeklo import BRIDGE, POSTURES, setup
from hsictrl.paper.fig6 import decay
from hsictrl.resonance import effective
from hsictrl.walking import ZivanovicForce

VERTICAL, BENT = 1, "bent legs"
DURATION, STRIP = 180.0, 2.0                  # of a test [s]; width between the outer stringers [m]
SENSORS = BRIDGE.length * np.array([0.25, 0.5, 0.75])    # on the centre line, which the other mode leaves at rest
HIGHEST, ORDER = 4.0, 20                      # of the identification [Hz, -]
REACH = 0.1                                   # of the predicted frequency, within which a mode is the one sought


class Pace(NamedTuple):
    """How fast people walk [m/s], and their step frequency, mean and standard deviation [Hz]."""

    speed: float
    step: tuple[float, float]


PACES = {"walking slowly": Pace(1.0, (1.6, 0.175)), "walking": Pace(1.34, (1.9, 0.175)),
         "walking fast": Pace(1.7, (2.2, 0.175))}


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class SpanTrial:
    """A trial: a crowd with bent legs anywhere along the span, and f_eff [Hz] and ξ_eff of the vertical mode.

    Parameters
    ----------
    persons : int
        How many [-].

    Examples
    --------
    >>> SpanTrial(persons=9)(np.random.default_rng(1)).shape
    (2,)
    """

    persons: int

    def __str__(self) -> str:
        return f"{BENT} along the span, {self.persons} persons"

    def __call__(self, rng: np.random.Generator) -> Array:
        places = (rng.random((self.persons, 2)) - [0, 0.5]) * [BRIDGE.length, STRIP]
        return np.array([*effective(couple(BRIDGE, POSTURES[BENT].sample(self.persons, rng), places), mode=VERTICAL)])


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class DecayTrial:
    """A trial: a crowd in a setup, and frequency [Hz] and damping ratio from its free decay.

    Parameters
    ----------
    posture : str
        "upright" or "bent legs".
    persons : int
        The setup, by its number of persons [-].

    Examples
    --------
    >>> DecayTrial(posture="bent legs", persons=9)(np.random.default_rng(1)).shape
    (2,)
    """

    posture: str
    persons: int

    def __str__(self) -> str:
        return f"free decay, {self.posture}, {self.persons} persons"

    def __call__(self, rng: np.random.Generator) -> Array:
        people, middle = POSTURES[self.posture].sample(self.persons, rng), [BRIDGE.length / 2]
        return np.array([*decay(couple(BRIDGE, people, setup(self.persons), force_at=middle, sense_at=middle))])


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class WalkingTrial:
    """A trial: frequency [Hz] and damping ratio identified while people walk, and half widths of their intervals.

    Parameters
    ----------
    pace : str
        "walking slowly", "walking" or "walking fast".
    persons : int
        How many [-].
    expected : float
        Frequency at which the mode is sought; zeros are given back if there is none within a tenth of it [Hz].

    Examples
    --------
    >>> trial = WalkingTrial(pace="walking", persons=9, expected=2.96)
    >>> trial(np.random.default_rng(1)).shape
    (4,)
    """

    pace: str
    persons: int
    expected: float

    def __str__(self) -> str:
        return f"{self.pace}, {self.persons} persons"

    def __call__(self, rng: np.random.Generator) -> Array:
        crowd = moving_crowd(BRIDGE, to_and_fro(PACES[self.pace], self.persons, rng))
        record = virtual_measurement(crowd, rng=rng, sense_at=SENSORS)
        found = [mode for mode in subspace_identification(record, highest=HIGHEST, order=ORDER).modes
                 if abs(mode.frequency / self.expected - 1) < REACH]
        if not found:
            return np.zeros(4)
        mode = min(found, key=lambda one: abs(one.frequency - self.expected))
        return np.array([*mode, mode.frequency_interval[1] - mode.frequency, mode.damping_interval[1] - mode.damping])


def to_and_fro(pace: Pace, persons: int, rng: np.random.Generator) -> Traffic:
    """People who step on anew as soon as they have stepped off, so that as many are on the span at any time.

    Parameters
    ----------
    pace : Pace
        How they walk.
    persons : int
        How many [-].
    rng : numpy.random.Generator
        Source of randomness.

    Returns
    -------
    Traffic
        From two crossings before the test on.

    Examples
    --------
    >>> traffic = to_and_fro(PACES["walking"], 9, np.random.default_rng(1))
    >>> traffic.persons_on(BRIDGE, [0.0, 90.0, 180.0])
    array([9, 9, 9])
    """
    crossing, force = BRIDGE.length / pace.speed, ZivanovicForce()
    rounds = np.arange(-3, int(np.ceil(DURATION / crossing)) + 1)
    arrival = (rng.random(persons) + rounds[:, None]).ravel() * crossing
    who = np.tile(np.arange(persons), len(rounds))
    steps = truncated_normal(*pace.step, rng.random(persons))
    across = STRIP * (rng.random(persons) - 0.5)
    walkers = Walkers(
        bodies=POSTURES[BENT].sample(persons, rng).part(who), forces=(force,), model=np.zeros(len(who), dtype=np.intp),
        draws=(rng.random((len(who), force.n_draws)),), weight=np.full(len(who), 700.0), step_frequency=steps[who],
        speed=np.full(len(who), pace.speed), arrival=arrival, offset=across[who])
    return Traffic(walkers.part(np.argsort(arrival)), window=(0.0, DURATION))

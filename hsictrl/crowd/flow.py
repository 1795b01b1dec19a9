"""Streams of pedestrians: how many, how fast, in which step, and when they arrive (section 2.2)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._draws import truncated_normal
from hsictrl.bridge import Footbridge
from hsictrl.crowd.classes import TRAFFIC_CLASSES
from hsictrl.crowd.traffic import Traffic
from hsictrl.crowd.walker import BY_HAND
from hsictrl.crowd.walkers import Walkers
from hsictrl.pedestrian import Crowd, Population
from hsictrl.walking import WalkingForce, ZivanovicForce

FREE_SPEED, GAMMA, JAM_DENSITY = 1.34, 0.354, 5.4
SPARSE_BELOW, SPARSE_SPREAD = 1.0, 0.175
HIGHEST_STEP = 2.5
TIME_CONSTANTS = 5.0
MOST_WALKERS = 100_000     # in a sample: 50 crossings of the longest bridges, or a damping of 0.01 % at 1 Hz


def weidmann_speed(density: float) -> float:
    """Walking speed in a stream (eq. 9).

    Parameters
    ----------
    density : float
        Pedestrian density d, in (0, 5.4) [1/m²].

    Returns
    -------
    float
        v_s = 1.34 {1 − exp[−0.354 · 5.4 (1/d − 1/5.4)]} [m/s].

    Examples
    --------
    >>> round(weidmann_speed(1.0), 4)
    1.0577
    """
    density = check.number("density", density, above=0, below=JAM_DENSITY,
                           remedy="give persons per m² above zero and below the jam density")
    return float(-FREE_SPEED * np.expm1(-GAMMA * (JAM_DENSITY / density - 1)))


def resonant_step_frequency(frequency: float) -> tuple[float, int]:
    """Step frequency f_l at which a harmonic of walking meets a natural frequency (section 2.2).

    Parameters
    ----------
    frequency : float
        Natural frequency that is to be met [Hz].

    Returns
    -------
    float
        f_l = f/h [Hz].
    int
        The smallest harmonic h with f_l at most 2.5 Hz: the first up to 2.5 Hz, the second up to
        5 Hz, the third up to 7.5 Hz [-].

    Examples
    --------
    >>> resonant_step_frequency(2.5), resonant_step_frequency(3.25), resonant_step_frequency(5.0)
    ((2.5, 1), (1.625, 2), (2.5, 2))
    """
    frequency = check.number("frequency", frequency, above=0, remedy="give Hz")
    harmonic = max(1, int(np.ceil(frequency / HIGHEST_STEP - 1e-12)))
    return frequency / harmonic, harmonic


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class CrowdFlow:
    """A stream of pedestrians with Poisson arrivals (eqs. 9 and 10).

    Everybody walks at one speed along a straight line at a lateral offset of their own. In a sparse
    stream (d < 1 /m²) step frequencies are N(f_l, 0.175 Hz); in a dense one all step at f_l.

    Parameters
    ----------
    density : float, optional
        Pedestrian density d, in (0, 5.4) [1/m²].
    persons : int, optional
        Number of people on the deck, in place of a density [-].
    traffic_class : {"TC1", "TC2", "TC3", "TC4", "TC5"}, optional
        Traffic class of HiVoSS, in place of a density: 15 persons on the deck, 0.2, 0.5, 1.0, 1.5 persons/m².
    speed : float, optional
        Walking speed, in place of Weidmann's for the density [m/s].
    step_frequency : float or (float, float), optional
        Step frequency of everybody, or mean and standard deviation, in place of the rule above; the mean in
        0.5–3.5 [Hz].
    weight : float
        Weight of each walker, G [N].
    population : Population
        Whom the bodies are drawn from.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> traffic = CrowdFlow(persons=15).sample(reference_bridge(), rng=np.random.default_rng(1))
    >>> traffic.target, traffic.walkers.speed[0].round(2)
    (2.0, np.float64(1.34))
    >>> print(CrowdFlow(traffic_class="TC3"))
    TC3, 0.5 persons/m²
    """

    density: float | None = None
    persons: int | None = None
    traffic_class: str | None = None
    speed: float | None = None
    step_frequency: float | tuple[float, float] | None = None
    weight: float = 700.0
    population: Population = field(default_factory=Population.walking)

    def __post_init__(self) -> None:
        amounts = {name: getattr(self, name) for name in ("density", "persons", "traffic_class")}
        given = [f"{name}={value!r}" for name, value in amounts.items() if value is not None]
        if len(given) != 1:
            raise ValueError("a flow must have a density, or a number of persons, or a traffic_class, got "
                             f"{' and '.join(given) or 'none'}; give one of them")
        if self.density is not None:
            weidmann_speed(self.density)
        elif self.persons is not None:
            check.whole("persons", self.persons, least=1, remedy="give the number of people on the deck")
        else:
            check.choice("traffic_class", self.traffic_class, tuple(TRAFFIC_CLASSES))
        if self.speed is not None:
            check.number("speed", self.speed, above=0, most=10, remedy="give m/s, at most 10")
        if self.step_frequency is not None:
            check.store(self, step_frequency=_step_rule(self.step_frequency))
        check.number("weight", self.weight, above=0, remedy="give N")
        check.instance("population", self.population, Population, "use Population.walking()")

    def __str__(self) -> str:
        density, persons = self._amount
        amount = f"{density:g} persons/m²" if density is not None else f"{persons} persons"
        return f"{self.traffic_class}, {amount}" if self.traffic_class else amount

    @property
    def _amount(self) -> tuple[float | None, int | None]:
        """Density or persons, whichever is given."""
        return TRAFFIC_CLASSES[self.traffic_class] if self.traffic_class else (self.density, self.persons)

    def density_on(self, bridge: Footbridge) -> float:
        """Pedestrian density on a bridge.

        Parameters
        ----------
        bridge : Footbridge
            The bridge, for its deck.

        Returns
        -------
        float
            d [1/m²].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> CrowdFlow(persons=15).density_on(reference_bridge())
        0.1
        """
        check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
        density, persons = self._amount
        if density is not None:
            return density
        assert persons is not None
        return persons / bridge.area

    def persons_on(self, bridge: Footbridge) -> int:
        """Mean number of people on the deck, n_H = A d, rounded.

        Parameters
        ----------
        bridge : Footbridge
            The bridge, for its deck.

        Returns
        -------
        int
            n_H [-].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> CrowdFlow(density=1.5).persons_on(reference_bridge())
        225
        """
        return round(self.density_on(bridge) * bridge.area)

    def speed_on(self, bridge: Footbridge) -> float:
        """Walking speed on a bridge.

        Parameters
        ----------
        bridge : Footbridge
            The bridge, for its deck.

        Returns
        -------
        float
            v_s [m/s].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> CrowdFlow(density=1.0, speed=1.25).speed_on(reference_bridge())
        1.25
        """
        return self.speed if self.speed is not None else weidmann_speed(self.density_on(bridge))

    def step_rule_on(self, bridge: Footbridge, frequency: float) -> tuple[float, float]:
        """Step frequencies that meet a natural frequency, or those set by hand.

        Parameters
        ----------
        bridge : Footbridge
            The bridge, for its deck.
        frequency : float
            Natural frequency, of which `resonant_step_frequency` is the mean [Hz].

        Returns
        -------
        float
            Mean [Hz].
        float
            Standard deviation: 0.175 Hz in a sparse stream, none in a dense one [Hz].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> CrowdFlow(density=0.5).step_rule_on(reference_bridge(), frequency=3.25)
        (1.625, 0.175)
        """
        if isinstance(self.step_frequency, tuple):    # as it is stored
            return self.step_frequency
        spread = SPARSE_SPREAD if self.density_on(bridge) < SPARSE_BELOW else 0.0
        return resonant_step_frequency(frequency)[0], spread

    def crowd(self, bridge: Footbridge, rng: np.random.Generator) -> tuple[Crowd, Array]:
        """Draw a standing crowd of n_H bodies, anywhere on the deck with the same chance (section 3.1).

        Parameters
        ----------
        bridge : Footbridge
            The bridge, for its deck.
        rng : numpy.random.Generator
            Source of randomness.

        Returns
        -------
        Crowd
            The bodies.
        array, shape (n_H, 2)
            Where they stand [m].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> people, places = CrowdFlow(density=0.2).crowd(reference_bridge(), np.random.default_rng(1))
        >>> len(people), places.shape
        (30, (30, 2))
        """
        check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
        check.instance("rng", rng, np.random.Generator, "give numpy.random.default_rng(seed)")
        n = self.persons_on(bridge)
        places = (rng.random((n, 2)) - [0.0, 0.5]) * [bridge.length, bridge.width]
        return self.population.sample(n, rng), places

    def drawn_from(self, bridge: Footbridge) -> float:
        """Time from which arrivals are drawn, −(T + W), with W = max(T, 5/(ξ_B ω_B)) by the slowest mode.

        Parameters
        ----------
        bridge : Footbridge
            The bridge.

        Returns
        -------
        float
            [s]

        Raises
        ------
        ValueError
            If more than 100 000 people would come until the bridge has settled.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> round(CrowdFlow(density=0.2).drawn_from(reference_bridge(frequency=2.0, damping=0.005)), 2)
        -116.89
        """
        check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
        crossing = bridge.length / self.speed_on(bridge)
        earliest = -(crossing + settling_time(crossing, float(np.min(bridge.damping * bridge.omega))))
        persons = self.density_on(bridge) * bridge.area * (1 - earliest / crossing)
        if persons > MOST_WALKERS:
            raise ValueError(f"at most {MOST_WALKERS} people may come until a bridge has settled, got {persons:.3g} in "
                             f"{-earliest:.3g} s; give every mode more damping")
        return earliest

    def sample(
        self, bridge: Footbridge, *, rng: np.random.Generator, force: WalkingForce | None = None,
    ) -> Traffic:
        """Draw traffic: a window of one crossing time T, and arrivals from long enough before it.

        The window is [0, T]. Walkers arrive from −(T + W) on, where W = max(T, 5/(ξ_B ω_B)) lets the
        slowest vibration of the empty bridge settle after the deck has filled; models with more
        damping ignore the earliest. Later arrivals do not depend on how far back the draw reaches. Unless
        set by hand, step frequencies are tuned to the empty bridge's first mode; see `tune`.

        Parameters
        ----------
        bridge : Footbridge
            The bridge.
        rng : numpy.random.Generator
            Source of randomness; arrivals, gait, forces, bodies and the standing crowd have streams of their own.
        force : WalkingForce, optional
            Walking force; the narrow-band `ZivanovicForce` if not given.

        Returns
        -------
        Traffic

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.walking import YoungForce
        >>> flow = CrowdFlow(density=1.0)
        >>> traffic = flow.sample(reference_bridge(), rng=np.random.default_rng(1), force=YoungForce())
        >>> print(traffic)
        558 walkers at 2.00 Hz
        """
        check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
        check.instance("rng", rng, np.random.Generator, "give numpy.random.default_rng(seed)")
        force = ZivanovicForce() if force is None else force
        check.instance("force", force, WalkingForce, "use HarmonicForce, YoungForce or ZivanovicForce")
        arrivals, gait, across, forces, bodies, standing = rng.spawn(6)
        crossing, earliest = bridge.length / self.speed_on(bridge), self.drawn_from(bridge)
        latest_first = _arrivals(self.density_on(bridge) * bridge.area / crossing, crossing, earliest, arrivals)
        n = len(latest_first)
        mean, spread = self.step_rule_on(bridge, bridge.modes[0].frequency)
        walkers = Walkers(
            bodies=self.population.sample(n, bodies), forces=(force,), model=np.zeros(n, dtype=np.intp),
            draws=(forces.random((n, force.n_draws)),), weight=np.full(n, self.weight),
            step_frequency=truncated_normal(mean, spread, gait.random(n)),
            speed=np.full(n, self.speed_on(bridge)), arrival=latest_first,
            offset=(across.random(n) - 0.5) * bridge.width)
        return Traffic(walkers.part(slice(None, None, -1)), window=(0.0, crossing), target=mean,
                       standing=self.crowd(bridge, standing), spread=spread, drawn_from=earliest)


def check_somebody(flow: CrowdFlow, bridge: Footbridge) -> None:
    """Refuse a flow that leaves the deck empty.

    Parameters
    ----------
    flow : CrowdFlow
        The stream of people.
    bridge : Footbridge
        The bridge, for its deck.

    Raises
    ------
    ValueError
        If nobody is on the deck on average.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> check_somebody(CrowdFlow(persons=1), reference_bridge())
    """
    if not flow.persons_on(bridge):
        raise ValueError(f"density must put at least one person on the deck of {bridge.area:g} m², got {flow}; "
                         "give a higher one")


def settling_time(crossing: float, decay: float) -> float:
    """Time from a full deck to the observed window: max(T, 5/(ξω)) [s].

    Parameters
    ----------
    crossing : float
        Crossing time T [s].
    decay : float
        Decay rate ξω of the model's slowest mode; without damping nothing settles, and T it is [1/s].

    Returns
    -------
    float
        [s]

    Examples
    --------
    >>> settling_time(40.0, 0.05), settling_time(40.0, 0.5)
    (100.0, 40.0)
    """
    return max(crossing, TIME_CONSTANTS / decay) if decay > 0 else crossing


def _arrivals(rate: float, end: float, start: float, rng: np.random.Generator) -> Array:
    """A Poisson process on (start, end), drawn backwards in time so that an earlier start only adds arrivals [s]."""
    times = end - np.cumsum(rng.standard_exponential(_enough(rate * (end - start)))) / rate
    return times[times > start]


def _enough(mean: float) -> int:
    """A number that a Poisson variable of this mean never exceeds: ten standard deviations above."""
    return int(mean + 10 * np.sqrt(mean) + 20)


def _step_rule(rule: Any) -> tuple[float, float]:
    """Mean and standard deviation from a number or a pair [Hz]."""
    pair = np.atleast_1d(check.numbers("step_frequency", rule, least=0, remedy=BY_HAND["remedy"]))
    if pair.shape not in ((1,), (2,)):
        raise ValueError(f"step_frequency must be a number or (mean, standard deviation), got shape {pair.shape}; "
                         "give one of these")
    return check.number("step_frequency", pair[0], **BY_HAND), float(pair[1]) if len(pair) == 2 else 0.0

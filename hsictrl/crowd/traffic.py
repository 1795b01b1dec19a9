"""Walkers, the window in which they are observed, and the crowd that stands for them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, InitVar, dataclass, fields, replace
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._draws import retuned
from hsictrl.bridge import Footbridge
from hsictrl.crowd import recorded, recording, saving
from hsictrl.crowd.walker import Walker
from hsictrl.crowd.walkers import Walkers
from hsictrl.pedestrian import Crowd, Population
from hsictrl.walking import WalkingForce, ZivanovicForce

WALKING_RANGE = (1.0, 2.5)


@final
@dataclass(frozen=True, slots=True, eq=False)
class Traffic:
    """Walkers on their way over the bridge: drawn by `CrowdFlow.sample`, recorded, or made by hand.

    Parameters
    ----------
    walkers : sequence of Walker, or Walkers
        Who crosses.
    window : (float, float), optional
        Start and end of the time that is observed; from the first arrival to the last departure
        if not given [s].
    target : float, optional
        Step frequency f_l about which the walkers are tuned; the mean if not given [Hz].
    standing : (Crowd, array of shape (n, 2)), optional
        Bodies and places of the crowd that stands for the moving one in a pseudo-moving crowd; the
        walkers on the deck in the middle of the window if not given [m].
    spread : float
        Standard deviation of the normal from which step frequencies were drawn, truncated at zero [Hz].
    drawn_from : float, optional
        Time from which arrivals were drawn; nothing is left out of traffic made by hand [s].
    rng : numpy.random.Generator, optional
        Source of randomness, for walkers made by hand whose forces draw any.

    Examples
    --------
    >>> from hsictrl.walking import HarmonicForce
    >>> walker = Walker(force=HarmonicForce([0.43, 0.08]), step_frequency=2.0, speed=1.25)
    >>> print(Traffic([walker]))
    1 walker at 2.00 Hz
    """

    walkers: Walkers
    _: KW_ONLY
    window: tuple[float, float] | None = None
    target: float = None  # type: ignore[assignment]
    standing: tuple[Crowd, Array] | None = None
    spread: float = 0.0
    drawn_from: float | None = None
    rng: InitVar[np.random.Generator | None] = None

    def __post_init__(self, rng: np.random.Generator | None) -> None:
        given: Any = self.walkers
        walkers = given if isinstance(given, Walkers) else _by_hand(given, rng)
        target = _mean_step(walkers) if self.target is None else self.target
        check.store(
            self, walkers=walkers, target=check.number("target", target, above=0, remedy="give Hz"),
            window=None if self.window is None else _window(self.window),
            standing=None if self.standing is None else _standing(self.standing),
            spread=check.number("spread", self.spread, least=0, remedy="give Hz, 0 for none"))
        if self.drawn_from is not None:
            check.store(self, drawn_from=check.number("drawn_from", self.drawn_from, remedy="give s"))

    @classmethod
    def from_trajectories(
        cls, table: Any, bridge: Footbridge, *, rng: np.random.Generator, origin: tuple[float, float] = (0.0, 0.0),
        angle: float = 0.0, frame_rate: float | None = None, step_frequency: float | str | None = None,
        still: float = 0.2, force: WalkingForce | None = None, population: Population | None = None,
        standing_population: Population | None = None, weight: float = 700.0,
        window: tuple[float, float] | None = None,
    ) -> Traffic:
        """Let people walk as a simulation or a video has recorded them; each stay on the deck is a walker.

        Parameters
        ----------
        table : str, Path, or table with columns
            A SQLite file of JuPedSim; a text file as PedPy and PeTrack have it, with columns id, frame, x, y; or
            columns id, x, y [m], and time [s] or frame, in a dict, a structured array or a data frame. Rows may come in
            any order.
        bridge : Footbridge
            The bridge, for its deck.
        rng : numpy.random.Generator
            Source of randomness; bodies and forces have streams of their own.
        origin : (float, float)
            Where the centre line of the deck begins, x = 0, as the table has it [m].
        angle : float
            Direction of the deck from there, counter-clockwise from the table's x axis [rad].
        frame_rate : float, optional
            Frames per second, where the table has frames and does not say [Hz].
        step_frequency : float or str, optional
            One for all who walk, or the name of a column that tells it for each; `preferred_step_frequency` of their
            median speed on the deck if not given [Hz].
        still : float
            Median speed on the deck below which a person stands, without a force; 0 lets everybody step [m/s].
        force : WalkingForce, optional
            Walking force of the others; the narrow-band `ZivanovicForce` if not given.
        population, standing_population : Population, optional
            Whom the bodies of those who walk and of those who stand are drawn from; `Population.walking` and
            `Population.standing` if not given.
        weight : float
            Weight that drives the walking forces, G [N].
        window : (float, float), optional
            As in `Traffic`; 0 is the time of frame 0 [s].

        Returns
        -------
        Traffic

        Raises
        ------
        ValueError
            If the table can't be read or mapped; the message names the file, the row and the column.

        Examples
        --------
        Two people on a deck that points to the north, one of whom stands:

        >>> from hsictrl.bridge import reference_bridge
        >>> table = {"id": [1, 1, 2, 2], "time": [0.0, 40.0, 0.0, 40.0], "x": [8.0, 8.0, 7.0, 7.0],
        ...          "y": [100.0, 150.0, 125.0, 125.0]}
        >>> traffic = Traffic.from_trajectories(table, reference_bridge(), rng=np.random.default_rng(1),
        ...                                     origin=(8.0, 100.0), angle=np.pi / 2)
        >>> print(traffic)
        2 walkers at 1.86 Hz
        >>> traffic.walkers.places(20.0)
        array([[25.,  0.],
               [25.,  1.]])
        """
        check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
        check.instance("rng", rng, np.random.Generator, "give numpy.random.default_rng(seed)")
        still = check.number("still", still, least=0, remedy="give m/s, 0 if everybody steps")
        weight = check.number("weight", weight, above=0, remedy="give N")
        force = ZivanovicForce() if force is None else force
        check.instance("force", force, WalkingForce, "use HarmonicForce, YoungForce or ZivanovicForce")
        crowds = population or Population.walking(), standing_population or Population.standing()
        for one in crowds:
            check.instance("population", one, Population, "use Population.walking()")
        read = recording.read(table, frame_rate)
        people = recorded.on_deck(read, bridge, origin, angle)
        walking = np.array([one.speed >= still for one in people])
        frequencies = recorded.step_frequencies(read, people, walking, step_frequency)
        return cls(recorded.drawn(people, walking, frequencies, rng=rng, force=force, populations=crowds,
                                  weight=weight), window=window)

    @classmethod
    def load(cls, path: str | Path) -> Traffic:
        """Read traffic that `save` has written.

        Parameters
        ----------
        path : str or Path
            The file.

        Returns
        -------
        Traffic
            The same to the last digit.

        Raises
        ------
        ValueError
            If the file is none of `save`, damaged, or of a later format.

        Examples
        --------
        >>> Traffic.load("no such file")
        Traceback (most recent call last):
        ValueError: no such file: the traffic must be a file that can be read, got No such file or directory; ...
        """
        return cls(**saving.load(_path(path)))

    def save(self, path: str | Path) -> None:
        """Write traffic into a file, of which `load` makes the same traffic.

        The file is a ZIP of NumPy arrays and holds no code. It appears when all is written, and until then what was
        there before stays.

        Parameters
        ----------
        path : str or Path
            The file; one that is there is replaced.

        Raises
        ------
        ValueError
            If the folder can't be written, or a force is not one of hsictrl.

        Examples
        --------
        >>> from tempfile import TemporaryDirectory
        >>> from hsictrl.walking import YoungForce
        >>> walker = Walker(force=YoungForce(), step_frequency=2.0, speed=1.25)
        >>> with TemporaryDirectory() as folder:
        ...     Traffic([walker], rng=np.random.default_rng(1)).save(f"{folder}/one.npz")
        ...     print(Traffic.load(f"{folder}/one.npz"))
        1 walker at 2.00 Hz
        """
        saving.save(_path(path), {one.name: getattr(self, one.name) for one in fields(self)})

    def __str__(self) -> str:
        n = len(self.walkers)
        return f"{n} walker{'' if n == 1 else 's'} at {self.target:.2f} Hz"

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a reader of the results should know, in sentences."""
        return step_remarks(self.target)

    def tuned(self, step_frequency: float) -> Traffic:
        """The same walkers with step frequencies about another mean; forces are rebuilt from the same draws.

        Parameters
        ----------
        step_frequency : float
            New mean f_l [Hz].

        Returns
        -------
        Traffic

        Raises
        ------
        ValueError
            If a walker would have to step backwards.

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
        >>> Traffic([walker]).tuned(1.9).walkers.step_frequency
        array([1.9])
        """
        mean = check.number("step_frequency", step_frequency, above=0, remedy="give the mean step frequency in Hz")
        moved = retuned(self.walkers.step_frequency, self.target, mean, self.spread)
        if np.any(moved <= 0):
            k = int(np.argmin(moved))
            raise ValueError(f"every step frequency must be above 0, got {moved[k]:.3g} Hz for walker {k} tuned about "
                             f"{mean:g} Hz; tune to a higher frequency, or draw with less spread")
        return self._with(self.walkers.at_step_frequency(moved), mean)

    def since(self, time: float) -> Traffic:
        """Those who arrive at or after a time, and the same window if one was given.

        Parameters
        ----------
        time : float
            Earliest arrival [s].

        Returns
        -------
        Traffic

        Examples
        --------
        >>> from hsictrl.walking import HarmonicForce
        >>> early, late = (Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25, arrival=t)
        ...                for t in (0.0, 5.0))
        >>> len(Traffic([early, late]).since(1.0).walkers)
        1
        """
        late = self.walkers.arrival >= check.number("time", time, remedy="give s")
        return self._with(self.walkers.part(late), self.target)

    def observed(self, bridge: Footbridge) -> tuple[float, float]:
        """Start and end of the observed time.

        Parameters
        ----------
        bridge : Footbridge
            The bridge, whose length says when the last walker has left.

        Returns
        -------
        (float, float)
            [s]

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
        >>> Traffic([walker]).observed(reference_bridge())
        (0.0, 40.0)
        """
        check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
        if self.window is not None:
            return self.window
        if not len(self.walkers):
            raise ValueError("traffic must hold a walker or a window, got neither; give window=(start, end) in s")
        return float(self.walkers.arrival.min()), float(self.walkers.departure(bridge.length).max())

    def standing_on(self, bridge: Footbridge) -> tuple[Crowd, Array]:
        """The crowd that stands for the moving one in a pseudo-moving crowd (section 2.4).

        Parameters
        ----------
        bridge : Footbridge
            The bridge.

        Returns
        -------
        Crowd
            The bodies.
        array, shape (n, 2)
            Where they stand [m].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
        >>> people, places = Traffic([walker]).standing_on(reference_bridge())
        >>> len(people), places
        (1, array([[25.,  0.]]))
        """
        if self.standing is not None:
            return self.standing
        walkers, places = self._frozen(bridge)
        return walkers.bodies, places

    def stopped_on(self, bridge: Footbridge) -> tuple[Walkers, Array]:
        """The walkers who keep stepping where the standing crowd is, for the stationary force model (section 2.4).

        Where a standing crowd was drawn or given, its n places are taken by the last n walkers to arrive; the last
        places stay empty if there are fewer. Otherwise the walkers on the deck in the middle of the window step
        where they are then.

        Parameters
        ----------
        bridge : Footbridge
            The bridge.

        Returns
        -------
        Walkers
            Those who step in place.
        array, shape (n, 2)
            Where they do [m].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.walking import HarmonicForce
        >>> walker = Walker(force=HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
        >>> walkers, places = Traffic([walker]).stopped_on(reference_bridge())
        >>> len(walkers), places
        (1, array([[25.,  0.]]))
        """
        if self.standing is None:
            return self._frozen(bridge)
        places, order = self.standing[1], np.argsort(self.walkers.arrival, kind="stable")
        last = order[max(0, len(order) - len(places)):]
        return self.walkers.part(last), places[:len(last)]

    def persons_on(self, bridge: Footbridge, times: Any) -> NDArray[np.intp]:
        """How many walkers are on the deck.

        Parameters
        ----------
        bridge : Footbridge
            The bridge, for its deck.
        times : array_like, shape (m,)
            Times [s].

        Returns
        -------
        array of int, shape (m,)
            n_H(t) [-].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.walking import HarmonicForce
        >>> early, late = (Walker(force=HarmonicForce([0.4]), step_frequency=2.0, speed=1.25, arrival=t)
        ...                for t in (0.0, 30.0))
        >>> Traffic([early, late]).persons_on(reference_bridge(), [-1.0, 0.0, 35.0, 41.0, 71.0])
        array([0, 1, 2, 1, 0])
        """
        check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
        times = check.numbers("times", times, ndim=1, remedy="give a list of seconds")
        walkers = self.walkers.part(self.walkers.carried(bridge))
        left = np.searchsorted(np.sort(walkers.departure(bridge.length)), times, side="left")
        return np.searchsorted(np.sort(walkers.arrival), times, side="right") - left

    def _frozen(self, bridge: Footbridge) -> tuple[Walkers, Array]:
        """Walkers on the deck in the middle of the window, and where they are."""
        places = self.walkers.places(float(np.mean(self.observed(bridge))))
        present = bridge.carries(places)
        return self.walkers.part(present), places[present]

    def _with(self, walkers: Walkers, target: float) -> Traffic:
        return replace(self, walkers=walkers, target=target, rng=None)


def _path(path: Any) -> Path:
    return Path(check.instance("path", path, (str, Path), "give the name of a file"))


def step_remarks(mean: float) -> tuple[str, ...]:
    """What to say about a mean step frequency [Hz] at which nobody walks."""
    low, high = WALKING_RANGE
    if low <= mean <= high:
        return ()
    return (f"the mean step frequency {mean:.2f} Hz lies outside {low}–{high} Hz, where people walk",)


def _by_hand(walkers: Sequence[Walker], rng: np.random.Generator | None) -> Walkers:
    if isinstance(walkers, Sequence) and not walkers:
        raise ValueError("traffic must hold at least one walker, got none; use couple(bridge) for an empty deck")
    return Walkers.of(walkers, rng)


def _mean_step(walkers: Walkers) -> float:
    if not len(walkers):
        raise ValueError("target must be given where there are no walkers, got None; give target in Hz")
    return float(np.mean(walkers.step_frequency))


def _standing(standing: tuple[Crowd, Array]) -> tuple[Crowd, Array]:
    remedy = "give (people, places), as CrowdFlow.crowd does"
    if len(check.instance("standing", standing, tuple, remedy)) != 2:
        raise ValueError(f"standing must be a pair, got {len(standing)} values; {remedy}")
    people, places = check.instance("standing", standing[0], Crowd, remedy), check.points("standing", standing[1])
    if len(people) != len(places):
        raise ValueError(f"standing must hold one place per body, got {len(people)} bodies and {len(places)} places; "
                         f"{remedy}")
    return people, places


def _window(window: tuple[float, float]) -> tuple[float, float]:
    ends = check.numbers("window", window, ndim=1, remedy="give (start, end) in s")
    if len(ends) != 2 or ends[0] >= ends[1]:
        raise ValueError(f"window must be (start, end) with start before end, got {tuple(ends.tolist())}; "
                         "swap or widen it")
    return float(ends[0]), float(ends[1])

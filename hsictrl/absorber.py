"""A tuned mass damper: a body that stands still, sized by a closed form, or with the crowd on the deck."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, final

import numpy as np
from scipy.optimize import minimize

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.coupling import couple
from hsictrl.pedestrian import Body, Crowd
from hsictrl.pedestrian.body import RULES
from hsictrl.resonance.effective import effective

FINE = 1e-6      # to which the logarithms of frequency and damping, and of the peak, are found
REACH = 0.05     # first steps of the search in them
STILL = 1e-6     # of the motion at an antinode: an absorber there would be a millionth squared of its mass
ROUNDS = 2       # a simplex may lie flat along the kink where two peaks are equal: it is set up anew


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Absorber(Body):
    """A tuned mass damper: a mass on a spring and a damper, all of it sprung.

    It is a body like a `Pedestrian`. Hand it to `couple` with its position, or fix it to the bridge for good with
    `Footbridge.with_absorbers`. What it is made of may come from a closed form, or from a search with a crowd on the
    deck (`den_hartog`, `warburton`, `tuned`).

    Parameters
    ----------
    mass : float
        Mass on the spring [kg].
    frequency : float
        Natural frequency on rigid ground [Hz].
    damping : float
        Damping ratio on rigid ground, c/(2 m ω) with the absorber's own ω, in [0, 1) [-].
    direction : {"vertical", "lateral"}
        Direction in which it moves.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.resonance import effective
    >>> bridge = reference_bridge(frequency=2.0, damping=0.005)
    >>> print(Absorber(mass=500.0, frequency=1.96, damping=0.09))
    500 kg at 1.960 Hz, 9.0 %, vertical
    >>> round(effective(couple(bridge, Absorber(mass=500.0, frequency=1.96, damping=0.09), [25.0])).damping, 3)
    0.05
    """

    mass: float
    frequency: float
    damping: float
    direction: str = "vertical"
    sprung_ratio: float = field(default=1.0, init=False, repr=False)

    def __post_init__(self) -> None:
        check.store(self, **{name: check.number(name, getattr(self, name), **RULES[name])
                             for name in ("mass", "frequency", "damping")})
        check.choice("direction", self.direction, check.DIRECTIONS)

    def __str__(self) -> str:
        return f"{self.mass:.4g} kg at {self.frequency:.3f} Hz, {100 * self.damping:.1f} %, {self.direction}"

    @classmethod
    def den_hartog(
        cls, bridge: Footbridge, *, mass_ratio: float, at: Any = None, mode: int = 0, direction: str = "vertical",
    ) -> Absorber:
        """Size by Den Hartog's closed form: the lowest peaks of a mode's displacement under a harmonic force.

        With a mass μ m, a frequency f/(1 + μ) and ξ² = 3μ/(8(1 + μ)). Two points of the response of an undamped mode do
        not depend on the damping of the absorber. The frequency makes both as high, √(1 + 2/μ) times the
        static deflection; the damping makes them peaks, nearly.

        Parameters
        ----------
        bridge : Footbridge
            The bridge.
        mass_ratio : float
            Mass over the modal mass that moves at its place, μ; in (0, 1] [-].
        at : float or (float, float), optional
            Place x, or (x, y), on the deck; the mode's antinode if not given [m].
        mode : int
            Which mode of the bridge, from 0 [-].
        direction : {"vertical", "lateral"}
            Direction in which it moves.

        Returns
        -------
        Absorber

        Notes
        -----
        J.P. Den Hartog, Mechanical Vibrations, 4th ed., 1956, section 3.3. He divides c by 2 m ω with the frequency of
        the mode, which gives 3μ/(8(1 + μ)³).

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> print(Absorber.den_hartog(reference_bridge(frequency=2.0), mass_ratio=0.02))
        500 kg at 1.961 Hz, 8.6 %, vertical
        """
        mu = _checked_ratio(mass_ratio)
        return _Spot.of(bridge, at, mode, direction).sized(mu, 1 / (1 + mu), 3 * mu / (8 * (1 + mu)))

    @classmethod
    def warburton(
        cls, bridge: Footbridge, *, mass_ratio: float, at: Any = None, mode: int = 0, direction: str = "vertical",
    ) -> Absorber:
        """Size by Warburton's closed form: the lowest peaks of a mode's acceleration under a harmonic force.

        As `den_hartog`, with a frequency f/√(1 + μ) and ξ² = 3μ/(8(1 + μ/2)): two points of the accelerance, as high
        as √(2/(μ(1 + μ)))/m.

        Parameters
        ----------
        bridge, mass_ratio, at, mode, direction
            As in `den_hartog`.

        Returns
        -------
        Absorber

        Notes
        -----
        G.B. Warburton, Optimum absorber parameters for various combinations of response and excitation parameters,
        Earthquake Engineering and Structural Dynamics 10 (1982), 381–401, table I.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> print(Absorber.warburton(reference_bridge(frequency=2.0), mass_ratio=0.02))
        500 kg at 1.980 Hz, 8.6 %, vertical
        """
        mu = _checked_ratio(mass_ratio)
        return _Spot.of(bridge, at, mode, direction).sized(mu, (1 + mu)**-0.5, 3 * mu / (8 * (1 + mu / 2)))

    @classmethod
    def tuned(
        cls, bridge: Footbridge, people: Crowd | Body | Sequence[Body] = (), positions: Any = (), *,
        mass_ratio: float, at: Any = None, mode: int = 0, direction: str = "vertical",
    ) -> Absorber:
        """Size with the damping of the bridge, and the people on it: the lowest peak of a mode's accelerance.

        That peak is the one that `effective` reads on the mode's coordinate, so this absorber gives the highest
        effective damping (eq. 17) there is with its mass. The search starts from `warburton`.

        Parameters
        ----------
        bridge : Footbridge
            The bridge.
        people : Crowd, Pedestrian or sequence of bodies
            Who stands on it, as in `couple`; nobody by default.
        positions : array_like, shape (n,) or (n, 2)
            Where they stand [m].
        mass_ratio, at, mode, direction
            As in `den_hartog`; the mass ratio refers to the empty bridge.

        Returns
        -------
        Absorber

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.pedestrian import Pedestrian
        >>> bridge, x = reference_bridge(frequency=2.0), (np.arange(75) + 0.5) * 50 / 75
        >>> print(Absorber.tuned(bridge, mass_ratio=0.02))
        500 kg at 1.981 Hz, 8.7 %, vertical
        >>> print(Absorber.tuned(bridge, Pedestrian(), x, mass_ratio=0.02))
        500 kg at 1.849 Hz, 8.1 %, vertical
        """
        spot = _Spot.of(bridge, at, mode, direction)
        start = cls.warburton(bridge, mass_ratio=mass_ratio, at=at, mode=mode, direction=direction)

        def of(logarithms: Array) -> Absorber:
            frequency, damping = np.exp(logarithms)
            return replace(start, frequency=frequency, damping=damping)

        def peak(logarithms: Array) -> float:
            if logarithms[1] >= 0:      # a damping ratio of one
                return np.inf
            fixed = bridge.with_absorbers(of(logarithms), at=[spot.place])
            found = effective(couple(fixed, people, positions), mode=mode)
            return float(np.log(max([found.peak, *(height for _, height in found.competing)])))

        return of(_lowest(peak, np.log([start.frequency, start.damping])))


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class _Spot:
    """Where an absorber is to be fixed, and the mode that moves there."""

    place: tuple[float, float]
    frequency: float
    modal_mass: float
    direction: str

    @classmethod
    def of(cls, bridge: Footbridge, at: Any, mode: int, direction: str) -> _Spot:
        check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
        check.choice("direction", direction, check.DIRECTIONS)
        one = bridge.mode(mode)
        places = bridge.on_deck("at", [one.shape.antinode if at is None else _place(at)])
        share = float(bridge.participation(places, direction)[0, mode])
        if abs(share) * one.modal_mass**0.5 < STILL:
            raise ValueError(f"the mode must move at the absorber's place, got mode {mode} at rest in the {direction} "
                             f"direction at ({places[0, 0]:g}, {places[0, 1]:g}) m; move it, or leave out at=")
        return cls(place=(places[0, 0], places[0, 1]), frequency=one.frequency, modal_mass=share**-2,
                   direction=direction)

    def sized(self, mass_ratio: float, tuning: float, damping_squared: float) -> Absorber:
        return Absorber(mass=mass_ratio * self.modal_mass, frequency=tuning * self.frequency,
                        damping=damping_squared**0.5, direction=self.direction)


def _place(at: Any) -> Array:
    place = np.atleast_1d(check.numbers("at", at, remedy="give x [m], or (x, y) [m]"))
    if place.shape not in ((1,), (2,)):
        raise ValueError(f"at must be one place, got shape {place.shape}; give x [m], or (x, y) [m]")
    return np.pad(place, (0, 2 - len(place)))


def _checked_ratio(mass_ratio: float) -> float:
    return check.number("mass_ratio", mass_ratio, above=0, most=1, remedy=check.PERCENT)


def _lowest(function: Callable[[Array], float], start: Array) -> Array:
    """Where a function of two variables with kinks is lowest."""
    for _ in range(ROUNDS):
        simplex = start + REACH * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
        start = minimize(function, start, method="Nelder-Mead",
                         options={"initial_simplex": simplex, "xatol": FINE, "fatol": FINE}).x
    return start

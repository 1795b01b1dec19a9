"""Load models of Sétra and HiVoSS for streams of walkers: from a density to a design acceleration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Direction
from hsictrl.comfort.classes import comfort_class

_GUIDES = ("hivoss", "setra")
_FORCES = {"vertical": 280.0, "lateral": 35.0}    # N, of the first harmonic
_NEGLIGIBLE_MASS_RATIO = 0.05

# (guide, direction, harmonic): (corners [Hz], top [-])
_TRAPEZOIDS = {
    ("hivoss", "vertical", 1): ((1.25, 1.7, 2.1, 2.3), 1.0),
    ("hivoss", "vertical", 2): ((2.5, 3.4, 4.2, 4.6), 0.25),
    ("hivoss", "lateral", 1): ((0.5, 0.7, 1.0, 1.2), 1.0),
    ("setra", "vertical", 1): ((1.0, 1.7, 2.1, 2.6), 1.0),
    ("setra", "vertical", 2): ((2.6, 3.4, 4.2, 5.0), 0.25),
}
GUIDE_LOADS: tuple[tuple[str, Direction], ...] = (("hivoss", "vertical"), ("hivoss", "lateral"), ("setra", "vertical"))


def equivalent_pedestrians(density: float, *, area: float, damping: float) -> float:
    """Return the number of perfectly synchronised walkers per area that is worth a random stream.

    Parameters
    ----------
    density : float
        Walkers per area of the deck, up to 1.5 [1/m²].
    area : float
        Area of the deck [m²].
    damping : float
        Damping ratio of the mode; it matters below 1 person/m² [-].

    Returns
    -------
    float
        Equivalent walkers per area [1/m²].

    Notes
    -----
    n′ = 10.8 √(ξ n)/S for d < 1 and 1.85 √n/S from d = 1, with n = d S. Beyond 1.5 persons/m² walking is
    obstructed (Van Nimmen et al. 2017, section 2.2).

    Source: Sétra (2006) and HiVoSS (2008), load models of streams.

    Examples
    --------
    >>> round(equivalent_pedestrians(0.5, area=150.0, damping=0.015), 6)
    0.076368
    """
    d = check.number("density", density, above=0, most=1.5, remedy="beyond 1.5 persons/m² walking is obstructed")
    S = check.number("area", area, above=0, remedy="give the area of the deck in m²")
    xi = check.number("damping", damping, above=0, below=1, remedy=check.PERCENT)
    return float(10.8 * np.sqrt(xi * d * S) / S if d < 1 else 1.85 * np.sqrt(d * S) / S)


def load_reduction(
    frequency: float, guide: str = "hivoss", *, harmonic: int = 1, direction: str = "vertical",
) -> float:
    """Return the reduction of the stream's load at a frequency.

    Parameters
    ----------
    frequency : float
        Natural frequency of the mode [Hz].
    guide : {"hivoss", "setra"}
        The guide.
    harmonic : {1, 2}
        Harmonic of the walking load; the second is vertical only [-].
    direction : {"vertical", "lateral"}
        Direction of the mode; lateral for HiVoSS only.

    Returns
    -------
    float
        Reduction ψ of the load of the first harmonic (280 N vertical, 35 N lateral) [-].

    Notes
    -----
    A trapezoid over the frequency. The second harmonic has the top 0.25: in HiVoSS as such, in Sétra as 70 N
    of 280 N. The lateral trapezoid rests on one source.

    Source: Sétra (2006) and HiVoSS (2008), load models of streams.

    Examples
    --------
    >>> load_reduction(1.9), load_reduction(1.9, harmonic=2), load_reduction(3.8, "setra", harmonic=2)
    (1.0, 0.0, 0.25)
    """
    f = check.number("frequency", frequency, above=0, remedy="give the natural frequency in Hz")
    corners, top = _trapezoid(guide, direction, harmonic)
    return float(np.interp(f, corners, (0.0, top, top, 0.0)))


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class DesignResponse:
    """The design acceleration of a guide and what it was computed from.

    Parameters
    ----------
    guide : {"hivoss", "setra"}
        The guide.
    direction : {"vertical", "lateral"}
        Direction of load and acceleration.
    acceleration : float
        Peak acceleration where the mode shape is one [m/s²].
    equivalent_pedestrians : float
        Equivalent walkers per area n′ [1/m²].
    reduction : float
        Load reduction ψ, of the governing harmonic [-].
    frequency : float
        Frequency, with the crowd's mass where that counts [Hz].
    modal_mass : float
        Modal mass, with the crowd's where that counts [kg].

    Examples
    --------
    >>> design = design_acceleration(frequency=1.9, damping=0.01, modal_mass=50e3, loaded_area=100.0,
    ...                              density=0.5, area=150.0, crowd_modal_mass=5e3)
    >>> round(design.frequency, 4), design.modal_mass
    (1.8116, 55000.0)
    """

    guide: str
    direction: str
    acceleration: float
    equivalent_pedestrians: float
    reduction: float
    frequency: float
    modal_mass: float

    @property
    def comfort_class(self) -> str:
        """Comfort class of the acceleration."""
        return comfort_class(self.acceleration, self.direction)


def design_acceleration(
    *, frequency: float, damping: float, modal_mass: float, loaded_area: float, density: float, area: float,
    crowd_modal_mass: float, guide: str = "hivoss", direction: str = "vertical",
) -> DesignResponse:
    """Return the design acceleration of one mode under a stream of walkers.

    Parameters
    ----------
    frequency : float
        Natural frequency of the empty footbridge [Hz].
    damping : float
        Damping ratio [-].
    modal_mass : float
        Modal mass of the empty footbridge [kg].
    loaded_area : float
        ∫∫|φ| dx dy over the deck, for the shape φ, in the direction of the load, that goes with the modal mass [m²].
    density : float
        Walkers per area of the deck [1/m²].
    area : float
        Area of the deck [m²].
    crowd_modal_mass : float
        Modal mass of the walkers, 70 kg each: 70 d ∫∫φ² dx dy [kg].
    guide : {"hivoss", "setra"}
        The guide whose load applies.
    direction : {"vertical", "lateral"}
        Direction of the load; lateral for HiVoSS only.

    Returns
    -------
    DesignResponse
        Acceleration [m/s²] and what it was computed from.

    Notes
    -----
    Resonance with P n′ ψ(f) cos(2πft), P = 280 N vertical or 35 N lateral, applied with the sign of the shape:
    a = P ψ n′ ∫∫|φ| dx dy / (2 ξ m), the largest of the harmonics. A crowd of more than 5 % of the
    modal mass is added to it and lowers the frequency by √(m/(m + Δm)).

    Source: Sétra (2006) and HiVoSS (2008), load models of streams.

    Examples
    --------
    HiVoSS by hand: 50 m by 3 m, 2500 kg/m, 1.5 %, 0.5 persons/m², half-sine.

    >>> design = design_acceleration(frequency=1.7992, damping=0.015, modal_mass=62.5e3, density=0.5,
    ...                              loaded_area=300 / np.pi, area=150.0, crowd_modal_mass=2625.0)
    >>> round(design.acceleration, 4)
    1.089
    """
    f, m = _occupied(frequency, modal_mass, crowd_modal_mass)
    phi = check.number("loaded_area", loaded_area, above=0, remedy="integrate |shape| over the deck, in m²")
    n = equivalent_pedestrians(density, area=area, damping=damping)
    psi = max(load_reduction(f, guide, harmonic=harmonic, direction=direction)
              for harmonic in _harmonics(guide, direction))
    a = _FORCES[direction] * psi * n * phi / (2 * damping * m)
    return DesignResponse(guide=guide, direction=direction, acceleration=a, equivalent_pedestrians=n, reduction=psi,
                          frequency=f, modal_mass=m)


def _trapezoid(guide: str, direction: str, harmonic: int) -> tuple[tuple[float, ...], float]:
    known = _harmonics(guide, direction)
    if harmonic not in known:
        only = " or ".join(map(str, known))
        raise ValueError(f"harmonic must be {only} for the {direction} load of {guide}, got {harmonic!r}; "
                         "give one that the guide has")
    return _TRAPEZOIDS[guide, direction, harmonic]


def _harmonics(guide: str, direction: str) -> list[int]:
    check.choice("guide", guide, _GUIDES)
    check.choice("direction", direction, check.DIRECTIONS)
    known = [h for g, d, h in _TRAPEZOIDS if (g, d) == (guide, direction)]
    if not known:
        raise ValueError(f"direction must be one whose load {guide} gives, got {direction!r}; choose another guide")
    return known


def _occupied(frequency: float, modal_mass: float, crowd_modal_mass: float) -> tuple[float, float]:
    f = check.number("frequency", frequency, above=0, remedy="give the natural frequency in Hz")
    m = check.number("modal_mass", modal_mass, above=0, remedy="give the modal mass of the empty footbridge in kg")
    added = check.number("crowd_modal_mass", crowd_modal_mass, least=0, remedy="give 0 for an empty deck")
    if added <= _NEGLIGIBLE_MASS_RATIO * m:
        return f, m
    return f * (m / (m + added)) ** 0.5, m + added

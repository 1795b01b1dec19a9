"""Peak accelerations of many bridges under one traffic, which share what they can."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.fft import rfft, rfftfreq
from scipy.interpolate import CubicSpline

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge, Mode
from hsictrl.coupling import CondensedCrowd, couple
from hsictrl.crowd import Traffic, resonant_step_frequency
from hsictrl.prediction.forces import Parts, modal_forces
from hsictrl.prediction.grid import Grid, largest
from hsictrl.prediction.models import first_arrival, predict_tuned
from hsictrl.prediction.refusals import check_vertical
from hsictrl.prediction.spectral import period
from hsictrl.resonance import effective, effective_map

SHARED_MODELS = ("SF", "MF", "PMC")
KNOTS = 40     # of the apparent mass in half the width of a resonance
Complex = NDArray[np.complex128]


def tuned_peaks(models: Sequence[str], bridges: Sequence[Footbridge], traffic: Traffic) -> Array:
    """Peak accelerations of bridges that differ in frequency, damping and modal mass, each with traffic tuned to it.

    What `predict_tuned` finds for each of them, in a fraction of the time. Combs of the walking forces and shapes under
    the walkers are worked out once and read at every step frequency, the apparent mass of the crowd is the same per kg
    of modal mass, and forces that do not push back give accelerations in inverse proportion to modal mass.

    Parameters
    ----------
    models : sequence of {"SF", "MF", "PMC"}
        Stationary force, moving force or pseudo-moving crowd model.
    bridges : sequence of Footbridge
        Empty bridges of one mode, whose deck and shape are the same.
    traffic : Traffic
        Who walks over each of them.

    Returns
    -------
    array, shape (models, n)
        Largest absolute accelerations at the antinode over the observed window [m/s²].

    Notes
    -----
    Forces are sampled in time as the bridge that asks for the finest steps needs it. Where bridges are tuned to the
    same step frequency, all have the warm-up of the slowest: that changes what is left of transients, e⁻⁵ at most.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.crowd import CrowdFlow
    >>> bridges = [reference_bridge(frequency=2.0, damping=damping) for damping in (0.005, 0.02)]
    >>> traffic = CrowdFlow(density=0.2).sample(bridges[0], rng=np.random.default_rng(1))
    >>> tuned_peaks(["MF", "PMC"], bridges, traffic).round(2)
    array([[1.61, 0.83],
           [1.01, 0.64]])
    """
    for model in check.several("models", models):
        check.choice("models", model, SHARED_MODELS)
    check.instance("traffic", traffic, Traffic, "draw it with CrowdFlow.sample, or make it with Traffic([walker])")
    deck, table = check_alike(bridges), np.array([_properties(bridge.modes[0]) for bridge in bridges])
    crowd, places = _crowd(deck, traffic) if "PMC" in models else (None, np.empty((0, 2)))
    # what does not push back is found for a modal mass of 1 kg, and answers in inverse proportion to it
    unit, of = np.unique(table * [1, 1, 0] + [0, 0, 1], axis=0, return_inverse=True)
    moving = {"MF": (unit, None), "PMC": (unit if crowd is None else table, crowd)}
    groups = {model: _Group.of(*moving[model], deck, places) for model in models if model != "SF"}
    found = dict(zip(groups, _peaks(deck, traffic, list(groups.values())), strict=True))
    if "SF" in models:
        found["SF"] = _steady(deck, traffic, unit)
    return np.array([found[model] if model == "PMC" and crowd is not None else found[model][of.ravel()] / table[:, 2]
                     for model in models])


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class _Group:
    """Systems that carry the same crowd, or none."""

    systems: Array                  # (k, 3): frequency [Hz] and damping of the empty bridge, modal mass [kg]
    crowd: CondensedCrowd | None    # on a modal mass of 1 kg
    resonance: Array                # (k): where they resonate [Hz]
    decay: Array                    # (k): ξω of their slowest vibration [1/s]

    @classmethod
    def of(cls, systems: Array, crowd: CondensedCrowd | None, deck: Footbridge, places: Array) -> _Group:
        resonance, decay = _resonances(systems, crowd, deck, places)
        return cls(systems=systems, crowd=crowd, resonance=resonance, decay=decay)

    def peaks(self, force: Array, grid: Grid) -> Array:
        """Largest accelerations under modal forces, one row per system."""
        n, growth = period(grid, float(self.decay.min()))
        spectrum = rfft(force * np.exp(-growth * grid.step * np.arange(grid.count)), n)
        signals = grid.read(self._accelerance(growth, 2 * np.pi * rfftfreq(n, grid.step)) * spectrum, growth)
        return np.array([largest(signal) for signal in signals])

    def _accelerance(self, growth: float, omega: Array) -> Complex:
        """s²/(m (s² + 2ξω s + ω²) + s² S(s)), S being the apparent mass of the crowd, for each system [1/kg]."""
        s = growth + 1j * omega
        omega_b, damping, mass = 2 * np.pi * self.systems[:, :1], self.systems[:, 1:2], self.systems[:, 2:]
        stiffness = mass * (s**2 + 2 * damping * omega_b * s + omega_b**2)
        if self.crowd is not None:
            stiffness += s**2 * _apparent_mass(self.crowd, growth, omega)
        return np.asarray(s**2 / stiffness)


def _apparent_mass(crowd: CondensedCrowd, growth: float, omega: Array) -> Complex:
    """Apparent mass along growth + iω, by a spline with knots close enough for the narrowest resonance of a body."""
    width = float(np.min(crowd.people.damping * crowd.people.omega))
    enough = KNOTS * omega[-1] < width * (len(omega) - 4)
    knots = np.linspace(0.0, omega[-1], 4 + int(KNOTS * omega[-1] / width)) if enough else omega
    return np.asarray(CubicSpline(knots, crowd.apparent_mass(growth + 1j * knots)[:, 0, 0])(omega))


def _peaks(deck: Footbridge, traffic: Traffic, groups: list[_Group]) -> list[Array]:
    """Largest accelerations of the systems of each group under moving forces, each tuned to its resonance."""
    if not groups:
        return []
    decay = np.concatenate([group.decay for group in groups])
    tuned, of = np.unique([resonant_step_frequency(f)[0] for group in groups for f in group.resonance],
                          return_inverse=True)
    since = np.array([first_arrival(traffic, deck, float(decay[of == u].min())) for u in range(len(tuned))])
    traffic = traffic.since(float(since.min()))
    walkers, steps = traffic.walkers, np.array([traffic.tuned(f).walkers.step_frequency for f in tuned])
    parts = walkers.parts()
    grid = _grid(traffic, deck, parts, steps, float(max(group.systems[:, 0].max() for group in groups)))
    force = modal_forces(deck, walkers, parts, steps, walkers.arrival >= since[:, None], grid)[:, 0]
    of_groups = np.split(of, np.cumsum([len(group.systems) for group in groups])[:-1])
    return [group.peaks(*_since(force[own], grid, since[own].min()))
            for group, own in zip(groups, of_groups, strict=True)]


def _since(force: Array, grid: Grid, start: float) -> tuple[Array, Grid]:
    """The forces from some time on, before which there are none."""
    late = replace(grid, start=max(start, grid.start))
    return force[:, grid.before - late.before:], late


def _steady(deck: Footbridge, traffic: Traffic, systems: Array) -> Array:
    """Steady states, which are cheap one by one."""
    return np.array([predict_tuned("SF", _bridge(deck, *row), traffic).peak_acceleration for row in systems])


def _crowd(deck: Footbridge, traffic: Traffic) -> tuple[CondensedCrowd | None, Array]:
    """The standing crowd, whose apparent mass on this deck is in kg, and its places; none if nobody stands."""
    people, places = traffic.standing_on(deck)
    crowd = CondensedCrowd(people, deck.participation(places, people.direction)) if len(people) else None
    return crowd, places


def _resonances(
    systems: Array, crowd: CondensedCrowd | None, deck: Footbridge, places: Array,
) -> tuple[Array, Array]:
    """Frequency of each system [Hz], and ξω of its slowest vibration [1/s]."""
    if crowd is None:
        return systems[:, 0], 2 * np.pi * systems[:, 0] * systems[:, 1]
    found = np.empty((len(systems), 2))
    for mass in np.unique(systems[:, 2]):
        rows = np.flatnonzero(systems[:, 2] == mass)
        found[rows] = _effective(systems[rows], crowd, deck, places)
    bodies = np.min(crowd.people.damping * crowd.people.omega)
    return found[:, 0], np.minimum(bodies, 2 * np.pi * found.prod(axis=1))


def _effective(rows: Array, crowd: CondensedCrowd, deck: Footbridge, places: Array) -> Array:
    """Effective frequency [Hz] and damping of systems of one modal mass; one by one where that fails at once."""
    (f_b, i), (xi_b, j) = (np.unique(rows[:, k], return_inverse=True) for k in (0, 1))
    try:
        frequency, damping = effective_map(CondensedCrowd(crowd.people, crowd.rows / np.sqrt(rows[0, 2])), f_b, xi_b)
    except ValueError:
        return np.array([[*effective(couple(_bridge(deck, *row), crowd.people, places))] for row in rows])
    return np.column_stack([frequency[i, j], damping[i, j]])


def _bridge(deck: Footbridge, frequency: float, damping: float, mass: float) -> Footbridge:
    return replace(deck, modes=[replace(deck.modes[0], frequency=frequency, damping=damping, modal_mass=mass)])


def _grid(traffic: Traffic, deck: Footbridge, parts: Parts, steps: Array, highest: float) -> Grid:
    window = traffic.observed(deck)
    lines = max((one.spacing * one.indices[-1] * np.max(steps[:, who]) for who, one in parts), default=0.0)
    return Grid.over(window, float(np.min(traffic.walkers.arrival, initial=window[0])), float(lines), highest)


def check_alike(bridges: Sequence[Footbridge]) -> Footbridge:
    """Refuse bridges that differ in more than the frequency, damping and mass of a single mode.

    Parameters
    ----------
    bridges : sequence of Footbridge
        Empty bridges.

    Returns
    -------
    Footbridge
        The deck that all share, with a modal mass of 1 kg, so that it takes part with the shape itself.

    Raises
    ------
    ValueError
        If a bridge has several modes or an absorber, or a deck or shape of its own.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> check_alike([reference_bridge(), reference_bridge(damping=0.01)]).modes[0].modal_mass
    1.0
    """
    for bridge in check.several("bridges", bridges):
        check.instance("bridges", bridge, Footbridge, "describe each by its mode")
        if bridge.n_modes != 1:
            raise ValueError(f"bridges must have one mode each, got {bridge.n_modes}; use predict for each of them")
        if bridge.absorbers:    # they push back whatever the model, so that no response scales with the modal mass
            raise ValueError(f"bridges must have no absorbers, got {len(bridge.absorbers)}; use predict for each")
    decks = [replace(bridge, mass=1.0, modes=[replace(bridge.modes[0], frequency=1.0, damping=0.0, modal_mass=1.0)])
             for bridge in bridges]
    if any(deck != decks[0] for deck in decks):
        raise ValueError("bridges must have the same deck and shape, got several; use predict for each of them")
    check_vertical(decks[0])
    return decks[0]


def _properties(mode: Mode) -> tuple[float, float, float]:
    return mode.frequency, mode.damping, mode.modal_mass

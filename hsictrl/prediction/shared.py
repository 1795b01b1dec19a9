"""Peak accelerations of many bridges under one traffic, which share what they can."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.fft import rfft, rfftfreq

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge, Mode
from hsictrl.coupling import CondensedCrowd
from hsictrl.crowd import Traffic, resonant_step_frequency
from hsictrl.prediction.forces import Parts, modal_forces
from hsictrl.prediction.grid import Grid, largest
from hsictrl.prediction.models import predict_tuned, relevant
from hsictrl.prediction.refusals import check_vertical
from hsictrl.prediction.spectral import period
from hsictrl.resonance import effective_map

SHARED_MODELS = ("SF", "MF", "PMC")
Complex = NDArray[np.complex128]


def tuned_peaks(model: str, bridges: Sequence[Footbridge], traffic: Traffic) -> Array:
    """Peak accelerations of bridges that differ in frequency, damping and modal mass, each with traffic tuned to it.

    What `predict_tuned` finds for each of them, in a fraction of the time. Combs of the walking forces and shapes under
    the walkers are worked out once and read at every step frequency, the apparent mass of the crowd is the same per kg
    of modal mass, and forces that do not push back give accelerations in inverse proportion to modal mass.

    Parameters
    ----------
    model : {"SF", "MF", "PMC"}
        Stationary force, moving force or pseudo-moving crowd model.
    bridges : sequence of Footbridge
        Empty bridges of one mode, whose deck and shape are the same.
    traffic : Traffic
        Who walks over each of them.

    Returns
    -------
    array, shape (n,)
        Largest absolute accelerations at the antinode over the observed window [m/s²].

    Notes
    -----
    All bridges have the warm-up of the slowest one, and time steps of the one that asks for the finest. That changes
    what is left of transients, e⁻⁵ of a response at most.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.crowd import CrowdFlow
    >>> bridges = [reference_bridge(frequency=2.0, damping=damping) for damping in (0.005, 0.02)]
    >>> traffic = CrowdFlow(density=0.2).sample(bridges[0], rng=np.random.default_rng(1))
    >>> tuned_peaks("PMC", bridges, traffic).round(3)
    array([1.009, 0.643])
    """
    check.choice("model", model, SHARED_MODELS)
    check.instance("traffic", traffic, Traffic, "draw it with CrowdFlow.sample, or make it with Traffic([walker])")
    deck, table = check_alike(bridges), np.array([_properties(bridge.modes[0]) for bridge in bridges])
    crowd = _crowd(deck, traffic) if model == "PMC" else None
    if crowd is not None:
        return _peaks(_signals(deck, traffic, crowd, table))
    scale, table[:, 2] = 1 / table[:, 2], 1.0     # what does not push back answers in inverse proportion to modal mass
    systems, of = np.unique(table, axis=0, return_inverse=True)
    found = _steady(deck, traffic, systems) if model == "SF" else _peaks(_signals(deck, traffic, None, systems))
    return found[of.ravel()] * scale


def _steady(deck: Footbridge, traffic: Traffic, systems: Array) -> Array:
    """Steady states, which are cheap one by one."""
    bridges = [replace(deck, modes=[replace(deck.modes[0], frequency=frequency, damping=damping)])
               for frequency, damping, _ in systems]
    return np.array([predict_tuned("SF", bridge, traffic).peak_acceleration for bridge in bridges])


def _peaks(signals: Array) -> Array:
    return np.array([largest(signal) for signal in signals])


def _crowd(deck: Footbridge, traffic: Traffic) -> CondensedCrowd | None:
    """The standing crowd, whose apparent mass on this deck is in kg; none if nobody stands."""
    people, places = traffic.standing_on(deck)
    return CondensedCrowd(people, deck.participation(places)) if len(people) else None


def _signals(deck: Footbridge, traffic: Traffic, crowd: CondensedCrowd | None, systems: Array) -> Array:
    """Accelerations of systems of some frequency, damping and modal mass, each under its own traffic, (systems, m)."""
    resonance, decay = _resonances(systems, crowd)
    tuned, of = np.unique([resonant_step_frequency(f)[0] for f in resonance], return_inverse=True)
    slowest = float(decay.min())
    traffic = relevant(traffic, deck, slowest, traffic.observed(deck), None)
    steps = np.array([traffic.tuned(f).walkers.step_frequency for f in tuned])
    parts = traffic.walkers.parts()
    grid = _grid(traffic, deck, parts, steps, float(systems[:, 0].max()))
    n, growth = period(grid, slowest)
    force = modal_forces(deck, traffic.walkers, parts, steps, grid)[:, 0]
    spectrum = rfft(force * np.exp(-growth * grid.step * np.arange(grid.count)), n)
    s = np.asarray(growth + 2j * np.pi * rfftfreq(n, grid.step), dtype=np.complex128)
    return grid.read(_accelerance(systems, crowd, s) * spectrum[of], growth)


def _resonances(systems: Array, crowd: CondensedCrowd | None) -> tuple[Array, Array]:
    """Frequency of each system [Hz], and ξω of its slowest vibration [1/s]."""
    if crowd is None:
        return systems[:, 0], 2 * np.pi * systems[:, 0] * systems[:, 1]
    found = np.empty((len(systems), 2))
    for mass in np.unique(systems[:, 2]):
        rows = np.flatnonzero(systems[:, 2] == mass)
        (f_b, i), (xi_b, j) = (np.unique(systems[rows, k], return_inverse=True) for k in (0, 1))
        frequency, damping = effective_map(CondensedCrowd(crowd.people, crowd.rows / np.sqrt(mass)), f_b, xi_b)
        found[rows] = np.column_stack([frequency[i, j], damping[i, j]])
    bodies = np.min(crowd.people.damping * crowd.people.omega)
    return found[:, 0], np.minimum(bodies, 2 * np.pi * found.prod(axis=1))


def _accelerance(systems: Array, crowd: CondensedCrowd | None, s: Complex) -> Complex:
    """s²/(m (s² + 2ξω s + ω²) + s² S(s)) of each system, S being the apparent mass of the crowd [1/kg]."""
    omega, damping, mass = 2 * np.pi * systems[:, :1], systems[:, 1:2], systems[:, 2:]
    stiffness = mass * (s**2 + 2 * damping * omega * s + omega**2)
    if crowd is not None:
        stiffness += s**2 * crowd.apparent_mass(s)[:, 0, 0]
    return np.asarray(s**2 / stiffness)


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
        If a bridge has several modes, or a deck or shape of its own.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> check_alike([reference_bridge(), reference_bridge(damping=0.01)]).modes[0].modal_mass
    1.0
    """
    if not len(bridges):
        raise ValueError("bridges must hold at least one, got none; give [reference_bridge()]")
    for bridge in bridges:
        check.instance("bridges", bridge, Footbridge, "describe each by its mode")
        if bridge.n_modes != 1:
            raise ValueError(f"bridges must have one mode each, got {bridge.n_modes}; use predict for each of them")
    decks = [replace(bridge, mass=1.0, modes=[replace(bridge.modes[0], frequency=1.0, damping=0.0, modal_mass=1.0)])
             for bridge in bridges]
    if any(deck != decks[0] for deck in decks):
        raise ValueError("bridges must have the same deck and shape, got several; use predict for each of them")
    check_vertical(decks[0])
    return decks[0]


def _properties(mode: Mode) -> tuple[float, float, float]:
    return mode.frequency, mode.damping, mode.modal_mass

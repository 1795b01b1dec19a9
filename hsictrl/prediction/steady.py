"""The steady state under periodic forces that stay in place, line by line (section 2.4)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hsictrl._checks import Array
from hsictrl.coupling import OccupiedBridge
from hsictrl.crowd import Walkers
from hsictrl.prediction.grid import Grid
from hsictrl.walking import ForceLines

IN_TUNE = 1e-9     # relative distance within which rounding makes no difference between two frequencies


def steady_accelerations(system: OccupiedBridge, walkers: Walkers, places: Array, grid: Grid) -> Array:
    """Sum over walkers k and lines l of Re H(iω_kl; place_k → sensor) c_kl exp(iω_kl t).

    A linear system answers a comb of lines by a comb of the same lines, so that nothing is integrated. What is
    left of exactness is how the comb is read (`ForceLines.on_grid`), 1e-9 of the peak for five harmonics.

    Parameters
    ----------
    system : OccupiedBridge
        The system that responds.
    walkers : Walkers
        Who steps in place, with the forces as they are; `Walkers.periodic` makes these periodic.
    places : array, shape (n, 2)
        Where each of them does [m].
    grid : Grid
        Its `times` [s].

    Returns
    -------
    array, shape (p, m)
        Accelerations at `system.sense_at` [m/s²].

    Raises
    ------
    ValueError
        If a line meets the frequency of a mode without damping.
    """
    rows = system.bridge.participation(system.bridge.on_deck("places", places))
    total = np.zeros((len(system.sense_at), len(grid.times)))
    for who, force in walkers.lines():
        _refuse_resonance(system, force)
        for signal, response in zip(total, _responses(system, rows[who], force), strict=True):
            together = _in_step(response)
            starts = np.full(together.n_walkers, grid.times[0])
            signal += together.on_grid(starts, len(grid.times), grid.given).sum(axis=0)
    return total


def _responses(system: OccupiedBridge, rows: Array, force: ForceLines) -> list[ForceLines]:
    """Acceleration at each sensor due to each walker, as lines [m/s²]."""
    modal = np.einsum("kj,kl->jkl", rows, force.coefficients).reshape(system.bridge.n_modes, -1)
    s = np.asarray(2j * np.pi * force.frequencies.ravel(), dtype=np.complex128)
    return [replace(force, coefficients=spectrum.reshape(force.coefficients.shape))
            for spectrum in system.respond(s, modal)]


def _in_step(force: ForceLines) -> ForceLines:
    """The same sum, of one walker for all who step at the same frequency."""
    frequencies, of = np.unique(force.step_frequency, return_inverse=True)
    coefficients = np.zeros((len(frequencies), force.coefficients.shape[1]), dtype=complex)
    np.add.at(coefficients, of, force.coefficients)
    return replace(force, coefficients=coefficients, step_frequency=frequencies)


def _refuse_resonance(system: OccupiedBridge, force: ForceLines) -> None:
    """An undamped vibration driven at its own frequency has no steady state."""
    for pole in system.poles():
        frequency, undamped = abs(pole) / (2 * np.pi), abs(pole.real) < IN_TUNE * abs(pole)
        if undamped and np.any(np.isclose(force.frequencies, frequency, rtol=IN_TUNE, atol=0)):
            raise ValueError("a steady state needs damping where a harmonic of walking meets a mode, got 0 % and both "
                             f"at {frequency:.4g} Hz; give the bridge a damping ratio above 0, or take the "
                             "model 'MF'")

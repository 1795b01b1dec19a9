"""The response of a time-invariant system to forces that move, in the frequency domain."""

from __future__ import annotations

import numpy as np
from scipy.fft import next_fast_len

from hsictrl._checks import Array
from hsictrl.coupling import OccupiedBridge
from hsictrl.prediction.grid import Grid

NEPERS = 18.0     # decay of a record's end before it wraps around to its beginning: to 2e-8


def accelerations(system: OccupiedBridge, force: Array, grid: Grid, decay: float) -> Array:
    """Accelerations under modal forces, from rest.

    Parameters
    ----------
    system : OccupiedBridge
        The system that responds.
    force : array, shape (n_m, count)
        Modal forces at the steps of the grid, `modal_force` [N/√kg].
    grid : Grid
        Times [s].
    decay : float
        Decay rate ξω of the slowest vibration [1/s].

    Returns
    -------
    array, shape (p, m)
        At the times of the grid, at `system.sense_at` [m/s²].
    """
    n, growth = period(grid, decay)
    spectrum = np.fft.rfft(force * np.exp(-growth * grid.step * np.arange(grid.count)), n)
    s = np.asarray(growth + 2j * np.pi * np.fft.rfftfreq(n, grid.step), dtype=np.complex128)
    return grid.read(system.respond(s, spectrum), growth)


def period(grid: Grid, decay: float) -> tuple[int, float]:
    """Samples in a period, and rate of an exponential, such that the end of a response dies before it comes round.

    The vibration's own decay does that, if the period is long enough. Where it would have to be longer than
    four records, the rest is done by damping all signals with an exponential and taking it out at the end. That
    multiplies the error of sampled kinks by at most exp(NEPERS/4), which is why it is not done alone.
    """
    record = grid.count * grid.step
    pad = min(NEPERS / decay, 3 * record) if decay > 0 else 3 * record
    n = 2 * next_fast_len(int(np.ceil((record + pad) / grid.step / 2)), real=True)
    return n, max(0.0, NEPERS - decay * pad) / (n * grid.step)

"""The time grid of a prediction: coarse where forces are sampled, fine where the response is read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from hsictrl._checks import Array

FORCE_MARGIN, MODE_MARGIN = 2.5, 6.0     # samples per period of the highest force line, and of the highest mode
LONGEST_STEP = 0.04                      # s; resolves how walkers step on and off, where nothing else asks for more
READ_MARGIN = 40.0                        # points per period of the highest mode at which a response is given
TAPER = 3.0                               # s; nothing after the window acts on it


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Grid:
    """Times at which forces are sampled, and times at which the response is given.

    Parameters
    ----------
    times : array, shape (m,)
        Evenly spaced times at which the response is given [s].
    start : float
        No force acts before this time [s].
    finer, coarser : int
        Steps of `times` in a step of the forces, and steps of the forces in a step of `times`; one of
        them is 1 [-].
    """

    times: Array
    start: float
    finer: int = 1
    coarser: int = 1

    @classmethod
    def over(cls, window: tuple[float, float], start: float, highest_force: float, highest_mode: float) -> Grid:
        """As coarse for the forces, and as fine for reading peaks, as can be."""
        limit = _limit(highest_force, highest_mode)
        count = int(np.ceil((window[1] - window[0]) / limit))
        finer = int(np.ceil(READ_MARGIN * highest_mode * (window[1] - window[0]) / count))
        return cls(times=np.linspace(*window, count * finer + 1), start=start, finer=finer)

    @classmethod
    def at(cls, times: Array, start: float, highest_force: float, highest_mode: float) -> Grid:
        """For given times: forces are sampled at these, and between them where the forces ask for it."""
        given = (times[-1] - times[0]) / (len(times) - 1)
        return cls(times=times, start=start, coarser=int(np.ceil(given / _limit(highest_force, highest_mode) - 1e-9)))

    @property
    def given(self) -> float:
        """Step of the response [s]."""
        return float((self.times[-1] - self.times[0]) / (len(self.times) - 1))

    @property
    def step(self) -> float:
        """Step of the forces [s]."""
        return self.given * self.finer / self.coarser

    @property
    def before(self) -> int:
        """Number of force samples before the first of `times` [-]."""
        return int(np.ceil(max(0.0, self.times[0] - self.start) / self.step))

    @property
    def first(self) -> float:
        """Time of the first force sample [s]."""
        return float(self.times[0] - self.before * self.step)

    @property
    def count(self) -> int:
        """Number of force samples, up to where the taper has ended [-]."""
        return self.before + int(np.ceil((self.times[-1] - self.times[0] + TAPER) / self.step)) + 1

    @property
    def taper(self) -> Array:
        """One up to the last time that is asked for, then smoothly down to zero, shape (count,) [-]."""
        late = (self.first + self.step * np.arange(self.count) - self.times[-1]) / TAPER
        return np.asarray(0.5 + 0.5 * np.cos(np.pi * np.clip(late, 0.0, 1.0)))

    def read(self, spectrum: Any, growth: float) -> Array:
        """Signals at `times` from their damped spectrum, by band-limited interpolation.

        Parameters
        ----------
        spectrum : complex array, shape (p, w)
            ``numpy.fft.rfft`` of p signals times exp(−growth (t − first)).
        growth : float
            Rate of the exponential that is taken out again [1/s].

        Returns
        -------
        array, shape (p, m)
        """
        n = 2 * (spectrum.shape[-1] - 1)
        fine = np.fft.irfft(spectrum, n * self.finer) * self.finer
        first = self.before * self.finer
        signal = fine[:, first:first + self.coarser * len(self.times):self.coarser]
        return np.asarray(signal * np.exp(growth * (self.times - self.first)))


def _limit(highest_force: float, highest_mode: float) -> float:
    """Longest step that resolves forces and modes [s]."""
    return 1 / max(FORCE_MARGIN * highest_force, MODE_MARGIN * highest_mode, 1 / LONGEST_STEP)


def largest(signal: Array) -> float:
    """Largest absolute value of a sampled signal, at the vertex of the parabola about its largest sample."""
    i = int(np.argmax(np.abs(signal)))
    if i in (0, len(signal) - 1):    # the parabola would tell of times that were not asked for
        return float(abs(signal[i]))
    left, top, right = signal[i - 1:i + 2] * np.sign(signal[i])
    bend = left - 2 * top + right
    return float(top - (left - right)**2 / (8 * bend) if bend < 0 else top)

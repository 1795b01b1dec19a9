"""The modal force of a stream of walkers as shot noise: its spectrum, from the comb of lines of one walker."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.fft import fft, ifft, next_fast_len
from scipy.interpolate import CubicSpline
from scipy.stats import qmc

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.crowd.average import across
from hsictrl.walking import WalkingForce

Complex = NDArray[np.complex128]
WALKERS = 32            # stratified draws behind the mean square of each line
KNOTS, REACH = 13, 5.0  # step frequencies at which lines are asked for, and how many deviations they cover
MEMORY = 12.0           # nepers by which a correlation has decayed where it comes round
ROOM = 1.25             # of the highest line; what it smears comes round beyond
COHERENT = 0.25         # share of a line's mean square in its mean, above which phases are not random


@final
@dataclass(frozen=True, slots=True)
class StepRule:
    """How fast walkers step: a normal, truncated at zero.

    Parameters
    ----------
    mean, spread : float
        Mean and standard deviation [Hz].
    """

    mean: float
    spread: float

    def nodes(self, count: int) -> Array:
        """Even step frequencies over the normal; the mean alone without spread [Hz]."""
        if not self.spread:
            return np.array([self.mean])
        low = max(self.mean - REACH * self.spread, 0.02 * self.mean)
        return np.linspace(low, self.mean + REACH * self.spread, count)

    def shares(self, nodes: Array) -> Array:
        """Probability of each node [-]."""
        density = np.exp(-((nodes - self.mean) / (self.spread or 1.0))**2 / 2)
        return density / density.sum()


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Band:
    """Even frequencies 0, df, …: fine enough that a periodic correlation function has died where it repeats.

    The integral of a spectrum over such a grid is exact but for what has not died: what is integrated is the
    transform of a function of limited length.

    Parameters
    ----------
    crossing : float
        Crossing time T [s].
    samples : int
        Samples of a crossing [-].
    count : int
        Number of frequencies [-].
    """

    crossing: float
    samples: int
    count: int

    @classmethod
    def over(cls, highest: float, crossing: float, decay: float) -> Band:
        """Up to a highest frequency [Hz], for crossings [s] of a bridge with a decay rate [1/s]."""
        samples = int(np.ceil(ROOM * highest * crossing)) + 8
        memory = 2 * crossing + MEMORY / decay
        return cls(crossing=crossing, samples=samples, count=next_fast_len(int(samples * memory / crossing) + 1))

    @property
    def step(self) -> float:
        """df [Hz]."""
        return self.samples / (self.crossing * self.count)

    @property
    def frequencies(self) -> Array:
        """All of them [Hz]."""
        return np.asarray(self.step * np.arange(self.count))

    def deposited(self, frequencies: Array, power: Array) -> Array:
        """Lines shared among their two neighbours on the grid, as a density, shape (count,) [unit of power / Hz]."""
        place = frequencies.ravel() / self.step
        low = place.astype(np.intp)
        part = place - low
        lower, upper = (np.bincount(low + shift, power.ravel() * share, self.count)
                        for shift, share in ((0, 1 - part), (1, part)))
        return np.asarray((lower + upper) / self.step)


def mean_square_lines(force: WalkingForce, weight: float, steps: StepRule, crossing: float) -> tuple[Array, Array]:
    """Frequencies of the lines of walkers of all step frequencies [Hz], and their mean squares E|c|² [N²].

    Parameters
    ----------
    force : WalkingForce
        The force of one walker; phases are random.
    weight : float
        Weight of a walker [N].
    steps : StepRule
        Their step frequencies [Hz].
    crossing : float
        Crossing time [s].

    Returns
    -------
    frequencies, power : array, shape (n, L)

    Raises
    ------
    ValueError
        If the phases are not random.
    """
    knots = steps.nodes(KNOTS)
    multiples, power = _power(force, weight, knots)
    # so close that the sum over them is the integral: both a crossing and the normal's transform are of limited length
    nodes = steps.nodes(int(2 * REACH * (steps.spread * multiples[-1] * crossing + 1)) + 2)
    fine = np.maximum(CubicSpline(knots, power)(nodes), 0.0) if steps.spread else power
    return np.multiply.outer(nodes, multiples), fine * steps.shares(nodes)[:, None]


def _power(force: WalkingForce, weight: float, knots: Array) -> tuple[Array, Array]:
    """Lines as multiples of the step frequency [-], and their mean squares at each knot, shape (knots, L) [N²]."""
    draws = qmc.LatinHypercube(max(force.n_draws, 1), scramble=False, rng=0).random(WALKERS)[:, :force.n_draws]
    n = len(knots) * WALKERS
    lines = force.lines(np.repeat(knots, WALKERS), np.full(n, weight), np.tile(draws, (len(knots), 1)))
    coefficients = lines.coefficients.reshape(len(knots), WALKERS, -1)
    power = np.mean(coefficients.real**2 + coefficients.imag**2, axis=1)
    _refuse_coherent(force, np.abs(coefficients.mean(axis=1))**2, power)
    return lines.frequencies[0] / knots[0], power


def _refuse_coherent(force: WalkingForce, mean: Array, power: Array) -> None:
    """Phases that are the same for all make the walkers one, of whom a spectrum says nothing."""
    strongest = np.unravel_index(np.argmax(power), power.shape)
    if mean[strongest] > COHERENT * power[strongest]:
        raise ValueError(f"a spectrum needs walkers with random phases, got those of {type(force).__name__}, which are "
                         "given; use ZivanovicForce or YoungForce, or monte_carlo")


def modal_spectrum(bridge: Footbridge, speed: float, rate: float, density: Array, band: Band) -> Complex:
    """Spectrum of the modal forces of a Poisson stream, by Campbell's theorem: ½ λ Σ E|c|² Φ̂(f − f_l) Φ̂(f − f_l)ᴴ.

    Each line is smeared by the transform Φ̂ of the mode shapes along the walk.

    Parameters
    ----------
    bridge : Footbridge
        The bridge.
    speed : float
        Walking speed [m/s].
    rate : float
        Arrivals per second λ [1/s].
    density : array, shape (count,)
        Mean squares of the lines per frequency, `Band.deposited` [N²/Hz].
    band : Band
        Frequencies [Hz].

    Returns
    -------
    array, shape (count, n_m, n_m)
        One-sided spectral density in mass-normalised coordinates [N²/(kg Hz)].
    """
    lines, total = fft(density) * band.step, np.zeros((band.count, bridge.n_modes, bridge.n_modes), dtype=complex)
    for smear, share in _smears(bridge, speed, band):
        total += share * smear
    return np.asarray(rate / 2 * ifft(fft(total, axis=0) * lines[:, None, None], axis=0))


def _smears(bridge: Footbridge, speed: float, band: Band) -> list[tuple[Complex, float]]:
    """Φ̂Φ̂ᴴ of walks along lines at some distances from the centre line, and the share of each."""
    step = band.crossing / band.samples
    x = speed * step * (np.arange(band.samples) + 0.5)
    walks = [(fft(bridge.participation(np.column_stack([x, np.full_like(x, y)])), band.count, axis=0) * step, share)
             for y, share in zip(*across(bridge), strict=True)]
    return [(walk[:, :, None] * walk[:, None, :].conj(), share) for walk, share in walks]

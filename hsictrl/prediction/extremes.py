"""The largest absolute value that a stationary Gaussian process takes in a given time."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtr

from hsictrl import _checks as check
from hsictrl._checks import Array

LEVELS = (0.01, 20.0)      # where a peak factor is looked for


def envelope_correlation(density: Array, step: float) -> tuple[Array, float]:
    """Correlation of the complex envelope, from a one-sided spectrum.

    Parameters
    ----------
    density : array, shape (n,)
        Spectral density at frequencies 0, step, 2 step, … [any unit].
    step : float
        Their distance [Hz].

    Returns
    -------
    array, shape (n/2,)
        ``|ρ|`` at lags 0, δ, 2δ, … up to where it comes round [-].
    float
        δ [s].

    Examples
    --------
    >>> correlation, lag = envelope_correlation(np.ones(1000), step=0.01)
    >>> round(lag, 12), correlation[:2].round(6)      # white noise up to 10 Hz forgets within 0.1 s
    (0.1, array([1., 0.]))
    """
    correlation = np.abs(np.fft.ifft(density))[:len(density) // 2]
    return correlation / correlation[0], 1 / (len(density) * step)


def clump_length(level: float, correlation: Array, lag: float) -> float:
    """Mean length of a clump of exceedances of a high level by the envelope.

    Given that the envelope R crosses r, it is above r after a time τ with probability 1 − Φ(r √((1 − ρ)/(1 + ρ))),
    which falls from ½ to what it is by chance. The share above chance, integrated over τ, is the mean length of a
    clump that is found at its start (Aldous, 1989, Probability Approximations via the Poisson Clumping Heuristic).

    Parameters
    ----------
    level : float
        r, in standard deviations [-].
    correlation : array, shape (m,)
        ``|ρ|`` at even lags from 0 [-].
    lag : float
        Their distance [s].

    Returns
    -------
    float
        [s]

    Examples
    --------
    >>> round(clump_length(3.0, np.ones(101), 0.1), 12)     # as long as it is looked for
    10.0
    """
    distance, chance = np.sqrt(np.clip((1 - correlation) / (1 + correlation), 0.0, 1.0)), ndtr(-level)
    above = (ndtr(-level * distance) - chance) / (0.5 - chance)
    return float(np.trapezoid(above, dx=lag))


def independent_peaks(level: float, correlation: Array, lag: float, duration: float) -> float:
    """How many independent Rayleigh variables stay below a level as rarely as the envelope does.

    One is there when the time begins, and then one per length of a clump; an envelope that hardly changes has no other.

    Parameters
    ----------
    level : float
        r, in standard deviations [-].
    correlation : array, shape (m,)
        ``|ρ|`` at even lags from 0 [-].
    lag : float
        Their distance [s].
    duration : float
        T [s].

    Returns
    -------
    float
        [-]

    Examples
    --------
    >>> round(independent_peaks(3.0, np.ones(101), 0.1, duration=0.1), 12)
    1.01
    """
    return 1 + duration / clump_length(level, correlation, lag)


def peak_factor(percentile: float, correlation: Array, lag: float, duration: float) -> float:
    """Percentile of the largest absolute value, over the standard deviation: (1 − exp(−r²/2))^n(r) = p.

    Parameters
    ----------
    percentile : float
        100 p, in (0, 100) [-].
    correlation : array, shape (m,)
        ``|ρ|`` of the envelope at even lags from 0 [-].
    lag : float
        Their distance [s].
    duration : float
        T [s].

    Returns
    -------
    float
        r [-].

    Examples
    --------
    >>> frozen, fading = np.ones(1001), np.exp(-0.02 * np.arange(1001))
    >>> round(peak_factor(95.0, frozen, 0.1, duration=0.0), 3)        # √(−2 ln 0.05), one Rayleigh variable
    2.448
    >>> round(peak_factor(95.0, fading, 0.1, duration=100.0), 1)
    4.0
    """
    def excess(level: float) -> float:
        below = np.log(-np.expm1(-level**2 / 2))
        return float(independent_peaks(level, correlation, lag, duration) * below - np.log(percentile / 100))

    percentile = check.number("percentile", percentile, above=0, below=100, remedy="give 95")
    return float(brentq(excess, *LEVELS))

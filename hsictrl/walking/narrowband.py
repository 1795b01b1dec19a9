"""The narrow-band force of Živanović, Pavić and Reynolds: no two steps are alike."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._draws import truncated_normal
from hsictrl.walking.model import WalkingForce, phasors, walkers
from hsictrl.walking.parts import ForceParts

# Živanović, Pavić & Reynolds (2007): (a, b, c) of the Gaussians about main harmonic i, sub-harmonic i − ½
MAIN = (
    ((0.7852, 0.9999, 0.008314), (0.0206, 1.034, 0.2524), (0.1074, 1.001, 0.03653)),
    ((0.5130, 2.000, 0.01105), (0.1330, 1.957, 0.2632), (-0.04984, 1.882, 0.05807)),
    ((0.3908, 3.000, 0.009560), (0.1567, 3.000, 0.05525), (0.06866, 2.957, 0.5607)),
    ((0.3255, 4.000, 0.008797), (0.1647, 4.001, 0.06641), (0.06888, 3.991, 0.3750)),
    ((0.2806, 4.999, 0.007939), (0.1584, 5.004, 0.07825), (0.07289, 4.987, 0.4501)),
)
SUB = (
    ((0.3406, 0.4988, 0.008337), (0.2803, 1.133, 0.6388)),
    ((0.3024, 1.500, 0.008735), (0.1345, 1.532, 0.7233)),
    ((0.2627, 2.500, 0.009748), (0.2456, 0.2312, 2.932)),
    ((0.2344, 3.501, 0.009898), (0.2355, -1.576, 7.050)),
    ((0.2645, 4.499, 0.01019), (0.2389, 1.153, 4.561)),
)
KERR = (-0.2649, 1.3206, -1.7597, 0.7613)  # of f_s³, f_s², f_s, 1
# first the factor on Kerr's cubic, then the load factors of harmonics 2 to 5
FACTOR_MEAN = np.array([1.0, 0.07, 0.05, 0.05, 0.03])
FACTOR_STD = np.array([0.16, 0.03, 0.02, 0.02, 0.015])
SUB_SLOPE = np.array([0.026, 0.074, 0.012, 0.013, 0.015])
SUB_CONSTANT = np.array([0.0031, 0.0100, 0.0160, 0.0093, 0.0072])


def kerr_factor(step_frequency: ArrayLike) -> Array:
    """Mean load factor of the first harmonic by Kerr's cubic, as in Živanović et al. (2007).

    Parameters
    ----------
    step_frequency : array_like
        Step frequency; the cubic turns over above 2.4 Hz and is cut off at zero [Hz].

    Returns
    -------
    array, as `step_frequency`
        −0.2649 f_s³ + 1.3206 f_s² − 1.7597 f_s + 0.7613 [-].

    Examples
    --------
    >>> float(kerr_factor(2.0).round(4))
    0.4051
    """
    f_s = check.numbers("step_frequency", step_frequency, above=0, remedy="give Hz")
    return np.maximum(np.polyval(KERR, f_s), 0.0)


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class ZivanovicForce(WalkingForce):
    """The narrow-band force of Živanović, Pavić & Reynolds (2007): five main, five sub-harmonics.

    Every (sub-)harmonic is a bundle of lines with uniform phases, main harmonic i over f in [i − ¼, i + ¼)
    and sub-harmonic i over [i − ¾, i − ¼), where f is the frequency as a multiple of the step frequency. A
    record repeats only after 1 / spacing steps. The load factors are drawn once per walker: Kerr's cubic
    times N(1, 0.16), and N(0.07, 0.03), N(0.05, 0.02), N(0.05, 0.02), N(0.03, 0.015), all truncated at zero;
    the sub-harmonics follow the first one. The first five draws make the load factors, the others the phases,
    from low to high frequency.

    Parameters
    ----------
    spacing : float
        Distance between lines as a fraction of the step frequency, a whole part of 0.25 [-].
    scaling : {"published", "variance"}
        Amplitudes W DLF_i D̄_i(f) as printed, which hold at spacing 0.01 alone; or these divided by the
        root of Σ D̄_i² over the lines of the (sub-)harmonic, so that its variance is (W DLF_i)² / 2 at any
        spacing. The root of spacing / ∫ D̄_i² is this up to the error of the sum as a quadrature.

    Notes
    -----
    The table of the sub-harmonics has one source and is less well constrained than the main one. That phases
    are uniform is unverified: not checked against the source.

    Examples
    --------
    >>> model, rng = ZivanovicForce(), np.random.default_rng(1)
    >>> force = model.lines([2.0], weight=[700.0], draws=rng.random((1, model.n_draws)))
    >>> force.coefficients.shape, force.first
    ((1, 500), 25)
    >>> bool(np.allclose(force.at([1.0]), force.at([1.0 + 100 / 2.0])))
    True
    """

    spacing: float = 0.01
    scaling: str = "published"

    def __post_init__(self) -> None:
        spacing = check.number("spacing", self.spacing, above=0, most=0.25, remedy="give 0.01")
        check.choice("scaling", self.scaling, ("published", "variance"))
        if self.scaling == "published" and abs(spacing - 0.01) > 1e-9:
            raise ValueError(f"spacing must be 0.01 where scaling is 'published', got {spacing:g}; "
                             "give scaling='variance'")
        parts = round(0.25 / spacing)
        if abs(parts * spacing - 0.25) > 1e-9:
            raise ValueError(f"spacing must divide 0.25 into a whole number of lines, got {spacing:g}; "
                             f"give {0.25 / parts:.9g}")
        check.store(self, spacing=0.25 / parts)

    @property
    def n_draws(self) -> int:
        return len(FACTOR_MEAN) + _shapes(self.spacing, self.scaling).size

    def parts(self, weight: ArrayLike, draws: ArrayLike) -> ForceParts:
        W, draws = walkers(weight, draws, self.n_draws)
        amplitudes = W[:, np.newaxis] * _load_factors(draws[:, :5])
        coefficients = phasors(draws[:, 5:]) * _spread(amplitudes, _shapes(self.spacing, self.scaling))
        return ForceParts(coefficients=coefficients, first=round(0.25 / self.spacing), spacing=self.spacing,
                          factors=_growth)

    def periodic(self) -> MainHarmonics:
        return MainHarmonics(self)


@final
@dataclass(frozen=True, slots=True)
class MainHarmonics(WalkingForce):
    """The walkers of a narrow-band force, all of whose steps are alike: W Σ_i DLF_i cos(2πi f_s t + θ_i), i = 1 … 5.

    Load factors and phases come from the draws of the narrow-band force: DLF_i is the same, and θ_i is the phase
    of its line at i f_s. What is left out is the spread about the main harmonics, and the sub-harmonics.

    Parameters
    ----------
    narrow_band : ZivanovicForce
        The force whose walkers these are.

    Examples
    --------
    >>> model = ZivanovicForce().periodic()
    >>> force = model.lines([2.0], weight=[700.0], draws=np.full((1, model.n_draws), 0.5))
    >>> abs(force.coefficients).round(1)          # medians: 0.405 W, then some 7, 5, 5 and 3 % of W
    array([[283.6,  49.3,  35.1,  35.1,  21.3]])
    """

    narrow_band: ZivanovicForce

    def __post_init__(self) -> None:
        check.instance("narrow_band", self.narrow_band, ZivanovicForce, "use ZivanovicForce().periodic()")

    @property
    def n_draws(self) -> int:
        return self.narrow_band.n_draws

    def parts(self, weight: ArrayLike, draws: ArrayLike) -> ForceParts:
        W, draws = walkers(weight, draws, self.n_draws)
        centres = 5 + np.round((np.arange(1, 6) - 0.25) / self.narrow_band.spacing).astype(np.intp)
        amplitudes = W[:, np.newaxis] * _load_factors(draws[:, :5])[:, :, 1::2]
        return ForceParts(coefficients=amplitudes * phasors(draws[:, centres]), first=1, spacing=1.0, factors=_growth)

    def periodic(self) -> MainHarmonics:
        return self


@cache
def _shapes(spacing: float, scaling: str) -> Array:
    """Line amplitudes of sub 1, main 1, sub 2, …, shape (10, lines of one) [-]."""
    parts = round(0.25 / spacing)
    windows = np.arange(parts, 21 * parts).reshape(10, 2 * parts) * spacing
    gaussians = [terms for pair in zip(SUB, MAIN, strict=True) for terms in pair]
    shapes = np.array([_gaussians(f, terms) for f, terms in zip(windows, gaussians, strict=True)])
    if scaling == "variance":
        shapes /= np.sqrt(np.sum(shapes**2, axis=1, keepdims=True))
    shapes.flags.writeable = False
    return shapes


def _gaussians(f: Array, terms: tuple[tuple[float, float, float], ...]) -> Array:
    return np.sum([a * np.exp(-(((f - b) / c) ** 2)) for a, b, c in terms], axis=0)


def _spread(amplitudes: Array, shapes: Array) -> Array:
    return (amplitudes[..., np.newaxis] * shapes).reshape(*amplitudes.shape[:-1], -1)


def _load_factors(draws: Array) -> Array:
    """Load factors of sub 1, main 1, sub 2, …: what does not depend on the step frequency, and what grows by Kerr's
    cubic, shape (2, n, 10) [-]."""
    main = truncated_normal(FACTOR_MEAN, FACTOR_STD, draws)
    first = main[:, :1].copy()
    main[:, 0] = 0.0
    constant = np.stack([np.broadcast_to(SUB_CONSTANT, main.shape), main], axis=2)
    growing = np.stack([SUB_SLOPE * first, first * np.eye(5)[0]], axis=2)
    return np.stack([constant, growing]).reshape(2, -1, 10)


def _growth(step_frequency: Array) -> Array:
    return np.stack([np.ones(len(step_frequency)), kerr_factor(step_frequency)])

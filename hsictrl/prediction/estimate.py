"""The peak acceleration of a stream of walkers from spectra, without drawing any: a second road beside Monte Carlo."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, final

import numpy as np
from scipy.interpolate import CubicSpline

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.coupling import OccupiedBridge, couple
from hsictrl.crowd import CrowdFlow, resonant_step_frequency
from hsictrl.crowd.average import mean_crowd
from hsictrl.crowd.traffic import step_remarks
from hsictrl.prediction.extremes import envelope_correlation, independent_peaks, peak_factor
from hsictrl.prediction.refusals import check_case, check_excitable
from hsictrl.prediction.shotnoise import Band, Complex, StepRule, mean_square_lines, modal_spectrum
from hsictrl.resonance.effective import effective
from hsictrl.walking import WalkingForce, ZivanovicForce

MODELS = ("MF", "PMC")
SMOOTH = 12            # knots of the dynamic stiffness in half the width of the narrowest resonance of a body
COARSEST = 0.05        # Hz between these knots, at most
CROWDS_DIFFER = 0.01   # in the resonances that they give a bridge, relative
LARGEST = 2**20        # frequencies of a spectrum that still takes about a second


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SpectralEstimate:
    """A percentile of the peak acceleration over one crossing, from the spectrum of the acceleration.

    Parameters
    ----------
    model : str
        "MF" or "PMC".
    acceleration : float
        The percentile of the largest acceleration in the observed time [m/s²].
    rms : float
        Root mean square of the acceleration [m/s²].
    peak_factor : float
        Ratio of the two [-].
    peaks : float
        Number of independent peaks in the observed time, at that level [-].
    percentile : float
        Which percentile [-].
    duration : float
        Observed time, one crossing T [s].
    step_frequency : (float, float)
        Mean and standard deviation of the step frequencies [Hz].
    system : OccupiedBridge
        The system that responds: the empty bridge, or the one with the average crowd standing on it.
    frequencies : array, shape (n,)
        Frequencies of the spectrum [Hz].
    density : array, shape (n,)
        One-sided spectral density of the acceleration [m²/s⁴/Hz].
    remarks : tuple of str
        What a reader of the numbers should know.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> print(spectral_estimate("PMC", reference_bridge(), CrowdFlow(density=0.5)))
    PMC: 1.97 m/s², 3.5 times an rms of 0.557 m/s²
    """

    model: str
    acceleration: float
    rms: float
    peak_factor: float
    peaks: float
    percentile: float
    duration: float
    step_frequency: tuple[float, float]
    system: OccupiedBridge
    frequencies: Array
    density: Array
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check.freeze(self.frequencies, self.density)

    def __str__(self) -> str:
        return f"{self.model}: {self.acceleration:.3g} m/s², {self.peak_factor:.2g} times an rms of {self.rms:.3g} m/s²"

    def to_dict(self) -> dict[str, Any]:
        """Export with the units in the keys, without the spectrum.

        Returns
        -------
        dict
            Plain numbers and strings, ready for JSON, a CSV row or a data frame.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> spectral_estimate("MF", reference_bridge(), CrowdFlow(density=0.5)).to_dict()["step_frequency_hz"]
        2.0
        """
        return {"model": self.model, "a_m_per_s2": self.acceleration, "rms_m_per_s2": self.rms,
                "peak_factor": self.peak_factor, "peaks": self.peaks, "percentile": self.percentile,
                "duration_s": self.duration, "step_frequency_hz": self.step_frequency[0],
                "step_frequency_spread_hz": self.step_frequency[1], "remarks": "; ".join(self.remarks)}


def spectral_estimate(
    model: str, bridge: Footbridge, flow: CrowdFlow, *, percentile: float = 95.0, force: WalkingForce | None = None,
) -> SpectralEstimate:
    """Estimate a percentile of the peak acceleration from spectra, in some ten milliseconds.

    Walkers arrive at random and step with random phases, so that the modal force is shot noise, whose spectrum is
    known. The dynamic stiffness turns it into that of the acceleration at the antinode of the first mode. The peak over
    one crossing is then that of a stationary Gaussian process. Step frequencies are tuned as by `PeakTrial`, of which
    `monte_carlo` finds the same number by simulation.

    Parameters
    ----------
    model : {"MF", "PMC"}
        The empty bridge, or the bridge on which the crowd stands.
    bridge : Footbridge
        The empty bridge; its first mode is the one in resonance.
    flow : CrowdFlow
        The stream of people.
    percentile : float
        Which percentile of the peak acceleration, in (0, 100); meant for the upper half [-].
    force : WalkingForce, optional
        Walking force with random phases; the narrow-band `ZivanovicForce` if not given.

    Returns
    -------
    SpectralEstimate

    Raises
    ------
    ValueError
        If the bridge, an absorber or a body has no damping, or hardly any; if the bridge's first mode does not move
        vertically; if nobody is on the deck; or if the phases of the force are not random.

    Notes
    -----
    What is left out: that few walkers, or few in step with the bridge, make no Gaussian process; and that every trial
    has a standing crowd of its own, whose apparent mass is replaced by the mean. How far the estimate is from Monte
    Carlo is mapped in the documentation.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> bridge, flow = reference_bridge(frequency=2.0, damping=0.005), CrowdFlow(density=0.5)
    >>> without, within = (spectral_estimate(model, bridge, flow) for model in ("MF", "PMC"))
    >>> print(f"{without.acceleration:.1f} m/s² without interaction, {within.acceleration:.1f} m/s² with it")
    4.4 m/s² without interaction, 2.0 m/s² with it
    """
    force = _checked(model, bridge, flow, force)
    system = couple(bridge, *mean_crowd(bridge, flow), name=model) if model == "PMC" else couple(bridge, name=model)
    frequency = effective(system).frequency if len(system.people) else bridge.modes[0].frequency
    steps = StepRule(*flow.step_rule_on(bridge, frequency))
    density, band = _acceleration(system, flow, force, steps)
    found = _estimate(system, density, band, steps, percentile)
    return replace(found, remarks=(*found.remarks, *_switches(frequency))) if model == "PMC" else found


def _switches(frequency: float) -> tuple[str, ...]:
    """What to say where crowds of one flow are tuned to different harmonics."""
    harmonics = {resonant_step_frequency(frequency * (1 + part * CROWDS_DIFFER))[1] for part in (-1, 0, 1)}
    if len(harmonics) == 1:
        return ()
    return (f"at a resonance of {frequency:.3f} Hz one crowd is tuned to harmonic {min(harmonics)} and the next to "
            f"harmonic {max(harmonics)}: this is the average crowd's response, so take monte_carlo",)


def _checked(model: str, bridge: Any, flow: Any, force: WalkingForce | None) -> WalkingForce:
    """Refuse what has no spectrum."""
    check.choice("model", model, MODELS)
    check_case(bridge, flow)
    check_excitable(bridge, flow)
    force = ZivanovicForce() if force is None else force
    return check.instance("force", force, WalkingForce, "use YoungForce or ZivanovicForce")


def _acceleration(
    system: OccupiedBridge, flow: CrowdFlow, force: WalkingForce, steps: StepRule,
) -> tuple[Array, Band]:
    """Spectral density of the acceleration [m²/s⁴/Hz]."""
    bridge, speed = system.bridge, flow.speed_on(system.bridge)
    check.numbers("damping of absorbers and people", system.people.damping, above=0, below=1,
                  remedy="nothing settles without; give such as 0.05")
    crossing = bridge.length / speed
    lines, power = mean_square_lines(force, flow.weight, steps, crossing)
    band = _settled(Band.over(float(lines.max()), crossing, _slowest_decay(system)))
    rate = flow.density_on(bridge) * bridge.area / crossing
    return response_density(system, modal_spectrum(bridge, speed, rate, band.deposited(lines, power), band), band), band


def _slowest_decay(system: OccupiedBridge) -> float:
    """Smallest ξω of modes and bodies, which people on the bridge hardly lower [1/s]."""
    bodies = system.people.damping * system.people.omega
    return float(np.min(bodies, initial=np.min(system.bridge.damping * system.bridge.omega)))


def _settled(band: Band) -> Band:
    if band.count > LARGEST:
        raise ValueError(f"damping must settle a vibration within a spectrum of {LARGEST} frequencies, got "
                         f"{band.count}; give the bridge or the bodies more, or use monte_carlo")
    return band


def response_density(system: OccupiedBridge, spectrum: Complex, band: Band) -> Array:
    """Spectral density h S hᴴ of the acceleration at the antinode of the first mode.

    Parameters
    ----------
    system : OccupiedBridge
        The system that responds.
    spectrum : array, shape (count, n_m, n_m)
        Spectral density of the modal forces in mass-normalised coordinates [N²/(kg Hz)].
    band : Band
        Frequencies [Hz].

    Returns
    -------
    array, shape (count,)
        [m²/s⁴/Hz]
    """
    omega = 2 * np.pi * band.frequencies
    sensor = system.bridge.participation(system.sense_at)[0]
    # symmetric: the row of the sensor times the inverse is a solution itself
    motion = np.linalg.solve(_stiffness(system, omega), sensor[:, None])[:, :, 0]
    return np.asarray(omega**4 * np.einsum("wi,wij,wj->w", motion, spectrum, motion.conj()).real)


def _stiffness(system: OccupiedBridge, omega: Array) -> Complex:
    """Dynamic stiffness by a spline, which follows it everywhere but in resonances of bodies without knots."""
    width = float(np.min(system.people.damping * system.people.frequency, initial=SMOOTH * COARSEST))
    knots = np.linspace(0.0, omega[-1], 4 + int(omega[-1] / (2 * np.pi) * SMOOTH / width))
    return np.asarray(CubicSpline(knots, system.dynamic_stiffness(1j * knots))(omega))


def _estimate(
    system: OccupiedBridge, density: Array, band: Band, steps: StepRule, percentile: float,
) -> SpectralEstimate:
    """The peak of a Gaussian process with this spectrum."""
    rms = float(np.sqrt(np.sum(density) * band.step))
    correlation, lag = envelope_correlation(density, band.step)
    factor = peak_factor(percentile, correlation, lag, band.crossing)
    return SpectralEstimate(
        model=system.name, acceleration=factor * rms, rms=rms, peak_factor=factor, percentile=float(percentile),
        peaks=independent_peaks(factor, correlation, lag, band.crossing), duration=band.crossing,
        step_frequency=(steps.mean, steps.spread), system=system, frequencies=band.frequencies, density=density,
        remarks=step_remarks(steps.mean))

"""Claims about figure 3, and about stiff and soft bridges (sections 2.4 and 3.2)."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from scipy.signal import find_peaks

from hsictrl._checks import Array
from hsictrl.bridge import reference_bridge
from hsictrl.paper.fig3 import BODY, FREQUENCY_RATIOS, MASS_RATIOS, bridge_of, curve, occupied, persons_of
from hsictrl.paper.fig4 import SharedCrowdTrial
from hsictrl.paper.reports import Finding
from hsictrl.resonance import EffectiveProperties, effective
from hsictrl.study import MeanRule, monte_carlo

CASES = [(mass, ratio) for mass in MASS_RATIOS for ratio in FREQUENCY_RATIOS]


@cache
def _found(mass_ratio: float, frequency_ratio: float) -> EffectiveProperties:
    return effective(occupied(mass_ratio, frequency_ratio))


def single_peak() -> Finding:
    """Every occupied curve has one peak."""
    counts = [_prominent_peaks(mass, ratio) for mass, ratio in CASES]
    several = [f"μ {mass:g}, ratio {ratio:g}: {n}" for (mass, ratio), n in zip(CASES, counts, strict=True) if n != 1]
    return (f"{counts.count(1)} of {len(counts)} curves have one peak", not several,
            "; ".join(several) + " peaks of more than 1 % prominence")


def _prominent_peaks(mass_ratio: float, frequency_ratio: float) -> int:
    size = np.abs(curve(mass_ratio, frequency_ratio, np.linspace(0.3, 3.0, 5401)).frdata[0, 0])
    return len(find_peaks(size, prominence=0.01 * size.max())[0])


def lowest_peak() -> Finding:
    """The lowest peak lies slightly below a frequency ratio of one."""
    ratios = np.arange(0.3, 1.5 + 1e-9, 0.005)
    lowest = [ratios[np.argmin([_found(mass, float(ratio)).peak for ratio in ratios])] for mass in MASS_RATIOS]
    measured = ", ".join(f"{ratio:.3f} at μ = {mass:g}" for ratio, mass in zip(lowest, MASS_RATIOS, strict=True))
    return (f"lowest peak at f_H1/f_B = {measured}", all(0.75 <= ratio < 1.0 for ratio in lowest),
            "not within [0.75, 1.0) for both")


def peak_is_lower() -> Finding:
    """The occupied peak is much lower than the empty one."""
    shares = [_found(mass, ratio).peak / effective(bridge_of(ratio)).peak for mass, ratio in CASES]
    return (f"occupied peak {min(shares):.3f} to {max(shares):.3f} of the empty one", max(shares) <= 0.5,
            "more than half in at least one case")


def changes_grow() -> Finding:
    """Both changes grow with the mass ratio."""
    low, high = ([_changes(mass, ratio) for ratio in FREQUENCY_RATIOS] for mass in MASS_RATIOS)
    grown = [bool(np.all(np.abs(b) > np.abs(a))) for a, b in zip(low, high, strict=True)]
    short = [f"ratio {ratio:g}" for ratio, grows in zip(FREQUENCY_RATIOS, grown, strict=True) if not grows]
    return (f"both changes larger at μ = 0.4 for {sum(grown)} of {len(grown)} ratios", all(grown),
            "not for " + ", ".join(short))


def _changes(mass_ratio: float, frequency_ratio: float) -> Array:
    """Change of the peak [m/s² per N] and of its frequency [Hz]."""
    bridge, found = bridge_of(frequency_ratio), _found(mass_ratio, frequency_ratio)
    return np.array([found.peak - effective(bridge).peak, found.frequency - bridge.modes[0].frequency])


def side_of_the_empty_bridge() -> Finding:
    """f_eff lies above f_B for ratios below one, and below it for ratios above."""
    wanted = {0.4: 1, 0.6: 1, 0.8: 1, 1.2: -1}
    wrong = [f"μ {mass:g}, ratio {ratio:g}: {_changes(mass, ratio)[1]:+.3f} Hz" for mass in MASS_RATIOS
             for ratio, sign in wanted.items() if np.sign(_changes(mass, ratio)[1]) != sign]
    return f"{8 - len(wrong)} of 8 signs as stated", not wrong, "f_eff − f_B is " + "; ".join(wrong)


def stiff_and_soft_bridges() -> Finding:
    """Fixed drivers suffice for stiff bridges, added mass for soft ones."""
    soft, stiff, damping = 0.5, 12.0, 0.005
    trial = SharedCrowdTrial(mass_ratio=0.1, frequencies=(soft, stiff), dampings=(damping,))
    soft_f, stiff_f, soft_xi, stiff_xi = np.ravel(monte_carlo(trial, rule=MeanRule(), seed=39).estimate)
    added = 1 / np.sqrt(1 + _crowd_share())
    holds = (abs(stiff_xi - damping) <= 0.01 and abs(stiff_f - 1) <= 0.01
             and abs(soft_f / added - 1) <= 0.01 and soft_xi - damping <= 0.002)
    measured = (f"12 Hz: ξ_eff − ξ_B {100 * (stiff_xi - damping):+.2f} %, f_eff/f_B {stiff_f:.4f}; 0.5 Hz: f_eff over "
                f"added-mass value {soft_f / added:.4f}, ξ_eff − ξ_B {100 * (soft_xi - damping):+.3f} %")
    return measured, bool(holds), "outside the bounds of the criterion"


def _crowd_share() -> float:
    """Modal mass of a uniform crowd at mass ratio 0.1, over that of the bridge."""
    bridge = reference_bridge()
    return persons_of(0.1, bridge) * BODY.mass * bridge.modes[0].shape.mean_square / bridge.modes[0].modal_mass


FINDINGS: dict[str, Callable[[], Finding]] = {
    "C01": single_peak, "C02": lowest_peak, "C03": peak_is_lower, "C04": changes_grow,
    "C05": side_of_the_empty_bridge, "C39": stiff_and_soft_bridges}

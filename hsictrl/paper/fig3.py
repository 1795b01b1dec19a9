"""Figure 3: frequency responses of the occupied reference bridge (section 3.2)."""

from __future__ import annotations

import control as ct
import numpy as np

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge, reference_bridge
from hsictrl.coupling import OccupiedBridge, couple
from hsictrl.paper.reports import Report, Run
from hsictrl.pedestrian import Pedestrian
from hsictrl.resonance import effective, frf

MASS_RATIOS, FREQUENCY_RATIOS = (0.1, 0.4), (0.4, 0.6, 0.8, 1.0, 1.2)
BODY = Pedestrian()
COLUMNS = ["mass_ratio", "frequency_ratio", "f_b_hz", "persons", "f_eff_hz", "xi_eff", "peak_m_per_s2_per_n",
           "peak_over_empty"]


def bridge_of(frequency_ratio: float) -> Footbridge:
    """The reference bridge for which f_H1/f_B is as asked."""
    return reference_bridge(frequency=BODY.frequency / frequency_ratio, damping=0.005)


def persons_of(mass_ratio: float, bridge: Footbridge) -> int:
    """Number of people for a crowd to bridge mass ratio (eq. 13), rounded."""
    return round(mass_ratio * bridge.mass / BODY.mass)


def occupied(mass_ratio: float, frequency_ratio: float) -> OccupiedBridge:
    """A crowd of equal bodies at x = (i + ½)L/N on the reference bridge."""
    bridge = bridge_of(frequency_ratio)
    n = persons_of(mass_ratio, bridge)
    return couple(bridge, BODY, (np.arange(n) + 0.5) * bridge.length / n)


def report(run: Run) -> Report:
    """The ten curves; they take milliseconds, so they are always computed anew."""
    rows = [_row(mass, frequency) for mass in MASS_RATIOS for frequency in FREQUENCY_RATIOS]
    return Report(name="fig3", rows=rows, columns=COLUMNS, draw=_draw, caption=(
        "Fig. 3: occupied reference bridge (50 m, 50 t, ξ_B 0.5 %), equal bodies of 70 kg, 3.25 Hz, 30 %, "
        "at x = (i + ½)L/N; f_eff and ξ_eff by eq. (17)"))


def curve(mass_ratio: float, frequency_ratio: float, beta: Array) -> ct.FrequencyResponseData:
    """Accelerance of the occupied bridge over β = f/f_B."""
    system = occupied(mass_ratio, frequency_ratio)
    return frf(system, beta * system.bridge.modes[0].frequency)


def _row(mass_ratio: float, frequency_ratio: float) -> dict[str, float]:
    system = occupied(mass_ratio, frequency_ratio)
    found, empty = effective(system), effective(system.bridge)
    return {"mass_ratio": mass_ratio, "frequency_ratio": frequency_ratio,
            "f_b_hz": system.bridge.modes[0].frequency, "persons": len(system.people),
            "f_eff_hz": found.frequency, "xi_eff": found.damping, "peak_m_per_s2_per_n": found.peak,
            "peak_over_empty": found.peak / empty.peak}


def _draw() -> ct.ControlPlot:
    from hsictrl import plots
    beta = np.linspace(0.3, 2.0, 1701)
    empty = frf(bridge_of(1.0), beta * bridge_of(1.0).modes[0].frequency)
    panels = {f"mass ratio {mass:g}": {f"f_H/f_B = {ratio:g}": curve(mass, ratio, beta) for ratio in FREQUENCY_RATIOS}
              for mass in MASS_RATIOS}
    return plots.normalised_frf_plot(beta, panels, empty=empty)

"""Figure 6: free decay of the footbridge in Eeklo with people on it (section 3.4)."""

from __future__ import annotations

import control as ct
import numpy as np

from hsictrl.coupling import OccupiedBridge, couple
from hsictrl.identify import FreeDecay, free_decay
from hsictrl.paper.eeklo import BRIDGE, POSTURES, setup
from hsictrl.paper.reports import Finding, Report, Run, rounded
from hsictrl.resonance import effective

PERSONS, SEED, VERTICAL = 15, 6, 1
CYCLES, POINTS = 60, 50      # of bobbing, and of decay; samples in a cycle
BOBBING = 300.0              # N
COLUMNS = ["posture", "persons", "frequency_hz", "damping", "damping_low", "damping_high", "r_squared", "f_eff_hz",
           "xi_eff", "pole_damping"]


def report(run: Run) -> Report:
    """Both postures, 15 persons."""
    systems = {posture: occupied(posture) for posture in POSTURES}
    decays = {posture: decay(system) for posture, system in systems.items()}
    rows = [_row(posture, system, decays[posture]) for posture, system in systems.items()]
    return Report(name="fig6", rows=rows, columns=COLUMNS, draw=lambda: _draw(decays), caption=(
        f"Fig. 6: free decay of the vertical mode of the footbridge in Eeklo with {PERSONS} random bodies on it, after "
        f"bobbing at its resonance: exponential through the extremes between 90 and 20 %; beside it f_eff and ξ_eff "
        "(eq. 17) and the damping of the pole, which is what a decay shows"))


def occupied(posture: str) -> OccupiedBridge:
    """The bridge with people on it, where they stand in the third setup."""
    people = POSTURES[posture].sample(PERSONS, np.random.default_rng(SEED))
    middle = [BRIDGE.length / 2]
    return couple(BRIDGE, people, setup(PERSONS), force_at=middle, sense_at=middle)


def decay(system: OccupiedBridge) -> FreeDecay:
    """What is left of a vibration at resonance when the bobbing has stopped."""
    frequency = effective(system, mode=VERTICAL).frequency
    times = np.arange(2 * CYCLES * POINTS) / (POINTS * frequency)
    bobbing = BOBBING * np.sin(2 * np.pi * frequency * times) * (times < CYCLES / frequency)
    response = ct.forced_response(system, times, bobbing)
    after = CYCLES * POINTS
    return free_decay(response.outputs[after:], timepts=times[after:])


def straight() -> Finding:
    """Logarithms of the extremes lie on a line."""
    found = {posture: decay(occupied(posture)) for posture in POSTURES}
    told = all(one.r_squared >= 0.99 for one in found.values())
    return ("; ".join(f"{posture}: R² {one.r_squared:.4f} over {len(one.times)} extremes, {100 * one.damping:.2f} %"
                      for posture, one in found.items()), told, "the extremes do not lie on a line")


def _row(posture: str, system: OccupiedBridge, one: FreeDecay) -> dict[str, float | str | int]:
    read, pole = (effective(system, mode=VERTICAL, method=method) for method in ("peak", "pole"))
    low, high = one.damping_interval
    return {"posture": posture, "persons": PERSONS, "frequency_hz": rounded(one.frequency),
            "damping": rounded(one.damping), "damping_low": rounded(low), "damping_high": rounded(high),
            "r_squared": rounded(one.r_squared), "f_eff_hz": rounded(read.frequency), "xi_eff": rounded(read.damping),
            "pole_damping": rounded(pole.damping)}


def _draw(decays: dict[str, FreeDecay]) -> ct.ControlPlot:
    from hsictrl import plots
    return plots.decay_plot({f"{PERSONS} persons, {posture}": one for posture, one in decays.items()})

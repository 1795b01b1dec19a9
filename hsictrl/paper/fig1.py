"""Figure 1: the human body model, and the contact force as fixed-driver and interaction term (section 2.1)."""

from __future__ import annotations

import control as ct
import numpy as np

from hsictrl.bridge import reference_bridge
from hsictrl.crowd import Traffic, Walker, Walkers
from hsictrl.paper.reports import Report, Run
from hsictrl.walking import ZivanovicForce

BRIDGE, TIME = reference_bridge(), 36.0
TRAFFIC = Traffic(Walkers.of(
    [Walker(force=ZivanovicForce(), step_frequency=step_frequency, speed=1.25, arrival=arrival)
     for step_frequency, arrival in ((1.8, 28.8), (2.0, 16.0), (2.2, 3.2))], rng=np.random.default_rng(1)))
COLUMNS = ["x_m", "m_h1_kg", "m_h0_kg", "k_h1_n_per_m", "c_h1_ns_per_m", "f_h1_hz", "xi_h1", "step_frequency_hz"]


def report(run: Run) -> Report:
    """One row per walker that is drawn."""
    return Report(name="fig1", rows=[_row(i) for i in range(len(TRAFFIC.walkers))], columns=COLUMNS, draw=_draw,
                  caption=f"Fig. 1: walkers on the reference bridge at {TIME:g} s, their bodies, and the step "
                          "frequencies of their walking forces (ZivanovicForce, 700 N)")


def _row(index: int) -> dict[str, float]:
    walker, x = TRAFFIC.walkers[index], float(TRAFFIC.walkers.places(TIME)[index, 0])
    body = walker.body
    return {"x_m": x, "m_h1_kg": body.sprung_mass, "m_h0_kg": body.unsprung_mass, "k_h1_n_per_m": body.stiffness,
            "c_h1_ns_per_m": body.damping_coefficient, "f_h1_hz": body.frequency, "xi_h1": body.damping,
            "step_frequency_hz": walker.step_frequency, "weight_n": walker.weight}


def _draw() -> ct.ControlPlot:
    from hsictrl import plots
    return plots.contact_force_plot(BRIDGE, TRAFFIC, time=TIME)

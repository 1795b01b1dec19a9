"""Table 1: what each model assumes, with order and type (Table 2) found on the systems themselves."""

from __future__ import annotations

from typing import Any

import control as ct
import numpy as np

from hsictrl.bridge import Footbridge, reference_bridge
from hsictrl.coupling import moving_crowd
from hsictrl.crowd import Traffic, Walker, Walkers
from hsictrl.paper.reports import Report, Run
from hsictrl.prediction import ASSUMPTIONS, predict
from hsictrl.walking import HarmonicForce

PERSONS, SPEED, STEP_FREQUENCY = 15, 1.25, 2.0
COLUMNS = ["model", "name", "fixed_driver", "interaction", "order", "time_variant", "order_found", "time_variant_found"]


def traffic(bridge: Footbridge, persons: int) -> Traffic:
    """Walkers in single file who are on the deck together in the middle of the window, at x = (i + ½)L/n."""
    apart = bridge.length / SPEED / persons
    force = HarmonicForce([0.43])
    return Traffic(Walkers.of([Walker(force=force, step_frequency=STEP_FREQUENCY, speed=SPEED, arrival=i * apart)
                               for i in range(persons)]))


def system(model: str, bridge: Footbridge, walkers: Traffic) -> ct.NonlinearIOSystem:
    """The system that responds in a model; a `control.StateSpace` is one too."""
    return moving_crowd(bridge, walkers).to_nlsys() if model == "MC" else predict(model, bridge, walkers).system


def found(model: str, bridge: Footbridge, walkers: Traffic) -> tuple[int, bool]:
    """Order of the system, and whether its matrix A changes while nobody steps on or off."""
    responds = system(model, bridge, walkers)
    rest, still = np.zeros(responds.nstates), np.zeros(responds.ninputs)
    first, later = (ct.linearize(responds, rest, still, t=t).A for t in _instants(bridge, walkers))
    return len(first), not np.allclose(first, later)


def report(run: Run) -> Report:
    """Five rows, one per model; they take milliseconds, so they are always computed anew."""
    bridge = reference_bridge()
    walkers = traffic(bridge, PERSONS)
    return Report(name="table1", rows=[_row(model, bridge, walkers) for model in ASSUMPTIONS], columns=COLUMNS,
                  caption=f"Table 1: what the models assume; order n_s and type found on the reference bridge, "
                          f"n_m = {bridge.n_modes}, with n_H = {_on_deck(bridge, walkers)} persons on the deck")


def _row(model: str, bridge: Footbridge, walkers: Traffic) -> dict[str, Any]:
    row, (order, varies) = ASSUMPTIONS[model], found(model, bridge, walkers)
    return {"model": model, "name": row.name, "fixed_driver": row.fixed_driver, "interaction": row.interaction,
            "order": row.order, "time_variant": row.time_variant, "order_found": order, "time_variant_found": varies,
            "modes": bridge.n_modes, "persons_on_deck": _on_deck(bridge, walkers)}


def _on_deck(bridge: Footbridge, walkers: Traffic) -> int:
    """Number of people on the deck, n_H; everybody else in the traffic would have states of no use."""
    return min(len(moving_crowd(bridge, walkers).at(t).people) for t in _instants(bridge, walkers))


def _instants(bridge: Footbridge, walkers: Traffic) -> tuple[float, float]:
    """The middle of the window, and a quarter of the time between two arrivals later."""
    middle = float(np.mean(walkers.observed(bridge)))
    return middle, middle + bridge.length / SPEED / len(walkers.walkers) / 4

"""The tables of a page."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Sequence
from importlib import metadata
from itertools import groupby
from typing import Any

import numpy as np

from hsictrl import __version__
from hsictrl._digits import significant
from hsictrl.assessment import Assessment, GuideCase
from hsictrl.comfort import COMFORT_BOUNDS, COMFORT_CLASSES
from hsictrl.crowd import TRAFFIC_CLASSES, CrowdFlow
from hsictrl.report.sections import Cell, Table
from hsictrl.report.words import bodies, rule, stops
from hsictrl.resonance import effective
from hsictrl.study import Ensemble

NUMERICS = ("control", "numpy", "scipy", "numba", "matplotlib", "jinja2")
GUIDES = {"hivoss": "HiVoSS", "setra": "Sétra"}
NONE: Cell = ("–",)


def answer_table(found: Sequence[Assessment]) -> Table:
    """A row per flow: acceleration, reduction, class, and the verdict on a goal."""
    peak = _percentile(found)
    head = ["Traffic", f"{peak} without interaction (MF) [m/s²]", f"{peak} with interaction (PMC) [m/s²]",
            "Reduction R_HSI [-]", "Comfort class, without → with"]
    rows = [_answer(one) for one in found]
    if any(one.goal for one in found):
        head.append("Goal, without → with")
        rows = [[*row, _verdict(one)] for row, one in zip(rows, found, strict=True)]
    return Table(caption="Design accelerations", head=head, rows=rows)


def deck_table(one: Assessment) -> Table:
    """Bridge and what is fixed to it, force and rule."""
    bridge = one.bridge
    rows = [("Deck", f"{bridge.length:g} m × {bridge.width:g} m"), ("Mass of the bridge", f"{bridge.mass:g} kg"),
            *((f"Absorber at ({x:g}, {y:g}) m", str(body)) for body, (x, y) in bridge.absorbers),
            ("Walking force", str(one.force)), ("Seed", str(one.pmc.seed)), ("Trials", stops(rule(one.pmc)))]
    return Table(caption="Bridge, force and study", head=["Input", "Value"],
                 rows=[[(name,), (value,)] for name, value in rows])


def traffic_table(found: Sequence[Assessment]) -> Table:
    """Who walks."""
    head = ["Traffic", "Density [1/m²]", "People [-]", "Speed [m/s]", "Weight [N]", "Bodies: frequency, damping, mass"]
    return Table(caption="Traffic", head=head, rows=[[
        (str(one.flow),), (significant(one.flow.density_on(one.bridge)),), (str(one.flow.persons_on(one.bridge)),),
        (significant(one.flow.speed_on(one.bridge)),), (f"{one.flow.weight:g}",), (bodies(one.flow.population),)]
        for one in found])


def modes_table(found: Sequence[Assessment]) -> Table:
    """Modes of the empty bridge, and which of them matter."""
    one = found[0]
    critical = {case.mode for each in found for case in each.guides}
    head = ["Mode", "Frequency [Hz]", "Damping ratio [%]", "Modal mass [kg]", "Role"]
    without = ", without its absorbers" if one.bridge.absorbers else ""
    return Table(caption=f"Modes of the empty bridge{without}", head=head, rows=[[
        (str(j),), (significant(mode.frequency, 4),), (significant(100 * mode.damping),), (f"{mode.modal_mass:.0f}",),
        (", ".join(filter(None, ["in resonance" * (j == one.mode), "critical by a guide" * (j in critical)])) or "–",)]
        for j, mode in enumerate(one.bridge.modes)])


def effective_table(found: Sequence[Assessment]) -> Table:
    """Frequency and damping of the bridge with standing crowds."""
    alone = effective(found[0].bridge, mode=found[0].mode)     # with its absorbers, if it has some
    empty = [("empty",), (significant(alone.frequency, 4),), (significant(100 * alone.damping),)]
    return Table(caption=f"Mode {found[0].mode} with a crowd: means over standing crowds",
                 head=["Traffic", "f_eff [Hz]", "ξ_eff [%]"], rows=[empty, *map(_effective, found)])


def guide_table(found: Sequence[Assessment]) -> Table:
    """The guides' load cases, side by side."""
    head = ["Traffic", "Mode, direction", "f [Hz]", "Modal mass [kg]", "n′ [1/m²]",
            *(f"{name} a_max [m/s²]" for name in GUIDES.values()),
            *(f"{_percentile(found)} {model} [m/s²]" for model in ("MF", "PMC"))]
    return Table(caption="Design accelerations by the guides, and those simulated for the mode in resonance", head=head,
                 rows=[row for one in found for row in _guides(one)])


def class_tables() -> list[Table]:
    """What the words CL and TC mean."""
    bounds = [[(name,), *((_bound(COMFORT_BOUNDS[direction], k),) for direction in ("vertical", "lateral"))]
              for k, name in enumerate(COMFORT_CLASSES)]
    return [
        Table(caption="Comfort classes, by peak acceleration", rows=bounds,
              head=["Class", "Vertical [m/s²]", "Lateral [m/s²]"]),
        Table(caption="Traffic classes of HiVoSS", head=["Class", "Traffic"],
              rows=[[(name,), (str(CrowdFlow(traffic_class=name)).partition(", ")[2],)] for name in TRAFFIC_CLASSES])]


def versions_table() -> Table:
    """Where the numbers come from."""
    rows = [("hsictrl", __version__), *((name, metadata.version(name)) for name in NUMERICS),
            ("Python", platform.python_version()), ("Platform", platform.platform(terse=True))]
    return Table(caption="Versions", head=["Software", "Version"], rows=[[(name,), (one,)] for name, one in rows])


def _answer(one: Assessment) -> list[Cell]:
    return [(str(one.flow), f"{one.flow.persons_on(one.bridge)} people"), _estimate(one.mf), _estimate(one.pmc),
            (significant(one.reduction), _interval(*one.reduction_interval)), (" → ".join(one.classes),)]


def _verdict(one: Assessment) -> Cell:
    return (" → ".join(one.verdicts), f"goal {one.goal}") if one.verdicts else NONE


def _effective(one: Assessment) -> list[Cell]:
    mean, (low, high) = np.ravel(one.effective.estimate), map(np.ravel, one.effective.interval)
    trials = f"{one.effective.n_trials} trials"
    return [(str(one.flow),), (significant(mean[0], 4), _interval(low[0], high[0], 4), trials),
            (significant(100 * mean[1]), _interval(100 * low[1], 100 * high[1]), trials)]


def _guides(one: Assessment) -> Iterator[list[Cell]]:
    for (mode, direction), same in groupby(one.guides, key=lambda case: (case.mode, case.response.direction)):
        cases = {case.response.guide: case for case in same}
        first = next(iter(cases.values())).response
        resonant = (mode, direction) == (one.mode, "vertical")
        simulated = [_estimate(one.mf), _estimate(one.pmc)] if resonant else [NONE, NONE]
        yield [(str(one.flow),), (f"{mode}, {direction}",), (significant(first.frequency, 4),),
               (f"{first.modal_mass:.0f}",), (significant(first.equivalent_pedestrians),),
               *(_guide(cases.get(guide)) for guide in GUIDES), *simulated]


def _guide(case: GuideCase | None) -> Cell:
    if case is None:
        return NONE
    found = case.response
    return (f"{significant(found.acceleration)} {found.comfort_class}", f"ψ = {significant(found.reduction)}")


def _percentile(found: Sequence[Assessment]) -> str:
    return f"a{rule(found[0].pmc).percentile:g}"


def _estimate(ensemble: Ensemble) -> Cell:
    settled = "" if ensemble.converged else ", not settled"
    return (significant(float(ensemble.estimate)), _interval(*ensemble.interval),
            f"{ensemble.n_trials} trials{settled}")


def _interval(low: Any, high: Any, digits: int = 3) -> str:
    return f"{significant(float(low), digits)}–{significant(float(high), digits)}"


def _bound(bounds: tuple[float, ...], k: int) -> str:
    """CL1 ends below its bound, CL3 at its own."""
    low, middle, high = bounds
    return (f"below {low:g}", f"{low:g} to below {middle:g}", f"{middle:g} to {high:g}", f"above {high:g}")[k]

"""Figures and animations of commands; imported when one is asked for."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from hsictrl import plots
from hsictrl._progress import progress
from hsictrl.assessment import Assessment
from hsictrl.cli.crossing import Crossing
from hsictrl.cli.description import Description
from hsictrl.report.pictures import FirstTrial
from hsictrl.study import Estimates

MULTIPLES = 4                    # of the step frequency, marked on a spectrum
PANEL_TITLES: dict[str, Callable[[Any], str]] = {
    "density": lambda value: f"{value:.3g} /m²", "force": str,
    "damping": lambda value: rf"$\xi_B$ = {100 * value:.3g} %"}


def draw(path: Path, found: Assessment, case: Description) -> None:
    """Draw one assessment, with the frequency responses and histories of its first trial, into a file."""
    first = FirstTrial.of(found)
    plot = plots.assessment_figure(
        frfs=first.frfs, effective=first.effective, responses=first.responses, ensembles=[found.mf, found.pmc],
        title=f"{found.flow} on {str(case.bridge).splitlines()[0]}; (a), (b): trial 0 of seed {case.seed}")
    plots.save(plot, path)


def draw_crossing(path: Path, crossing: Crossing) -> None:
    """Draw acceleration, spectrum and people of one crossing into a file."""
    response = crossing.prediction.response
    plot = plots.simulation_figure(
        response=response, marks=_marks(crossing), title=crossing.title,
        persons=crossing.crowd.traffic.persons_on(crossing.crowd.bridge, response.time))
    plots.save(plot, path)


def animate_crossing(path: Path, crossing: Crossing) -> None:
    """Show the eight seconds about the peak in motion, in a file."""
    animation = plots.crossing_animation(crossing.crowd, crossing.prediction.response)
    with progress() as bar:
        task = bar.add_task("pictures", total=None)
        plots.save_animation(animation, path, after_each=lambda i, n: bar.update(task, completed=i + 1, total=n))


def _marks(crossing: Crossing) -> dict[str, ArrayLike]:
    """Frequencies that explain a spectrum, by their labels."""
    step, empty = crossing.crowd.traffic.target, crossing.crowd.bridge.modes[0].frequency
    return {rf"multiples of $f_l$ = {step:.3f} Hz": step * np.arange(1, MULTIPLES + 1),
            rf"$f_\mathrm{{B}}$ = {empty:.3f} Hz": empty,
            rf"$f_\mathrm{{eff}}$ = {crossing.standing.frequency:.3f} Hz": crossing.standing.frequency}


def draw_maps(path: Path, found: Estimates, quantity: str) -> None:
    """Draw estimates over frequency and modal mass, a panel for each of the other values, into a file."""
    panelled = {name: values for name, values in found.axes.items() if name in PANEL_TITLES}
    panels = {_panel_title(found, point): found.at(point).estimate.T for point in (
        dict(zip(panelled, values, strict=True)) for values in product(*panelled.values()))}
    across, along = found.axes["frequency"], np.array(found.axes["modal_mass"], dtype=float) / 1e3
    columns = len(found.axes["damping"])
    plots.save(plots.map_plot(across, along, panels, quantity=quantity, columns=columns if 1 < columns <= 5 else None),
               path)


def _panel_title(found: Estimates, point: dict[str, Any]) -> str:
    """What differs between panels."""
    return ", ".join(PANEL_TITLES[name](value) for name, value in point.items() if len(found.axes[name]) > 1)

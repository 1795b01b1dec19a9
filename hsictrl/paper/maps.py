"""The study behind figures 9 to 11: peak accelerations without and with interaction over bridges and crowds (4.4)."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import final

import control as ct
import numpy as np

from hsictrl.assessment import PeaksTrial
from hsictrl.bridge import reference_bridge
from hsictrl.crowd import CrowdFlow
from hsictrl.paper.intervals import Interval
from hsictrl.paper.reports import Report, Rows, Run, committed
from hsictrl.study import Estimates, Ledger, PercentileRule, Sweep, sweep

SEED = 9
DENSITIES, DAMPINGS, MODELS = (0.2, 0.5, 0.8, 1.0, 1.5), (0.002, 0.005, 0.02), ("MF", "PMC")
KEYS = ("density_per_m2", "f_b_hz", "m_b_kg", "xi_b")
STATIONARY_COLUMNS = [*KEYS, "a95_sf_m_per_s2", "a95_mf_m_per_s2", "sf_over_mf", "sf_over_mf_low", "sf_over_mf_high",
                      "trials"]
COLUMNS = [*KEYS, "a95_mf_m_per_s2", "a95_pmc_m_per_s2", "r_hsi", "r_hsi_low", "r_hsi_high", "trials"]
# no cell settles to this: all run as many trials as the grid asks for
EXHAUSTIVE = PercentileRule(tolerance=1e-3)


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class MapGrid:
    """Bridges and crowds of a map.

    Parameters
    ----------
    frequencies : tuple of float
        Natural frequencies f_B of the empty bridges [Hz].
    masses : tuple of float
        Their modal masses m_B [kg].
    trials : int
        Trials of each density and frequency, which all masses, dampings and models share [-].
    densities : tuple of float
        Pedestrian densities [1/m²].

    Examples
    --------
    >>> GRIDS["coarse"].trial(density=0.2, f_b=2.0)(np.random.default_rng(1)).shape   # MF, PMC; 4 masses; 3 dampings
    (24,)
    """

    frequencies: tuple[float, ...]
    masses: tuple[float, ...]
    trials: int
    densities: tuple[float, ...] = DENSITIES

    def trial(self, *, density: float, f_b: float, models: tuple[str, ...] = MODELS) -> PeaksTrial:
        """One sample of traffic on all bridges of one frequency.

        Parameters
        ----------
        density : float
            Pedestrian density [1/m²].
        f_b : float
            Natural frequency of the bridges [Hz].
        models : tuple of str
            What predicts.

        Returns
        -------
        PeaksTrial

        Examples
        --------
        >>> len(GRIDS["coarse"].trial(density=0.2, f_b=2.0).bridges)
        12
        """
        bridges = [reference_bridge(frequency=f_b, damping=damping, modal_mass=mass)
                   for mass, damping in product(self.masses, DAMPINGS)]
        return PeaksTrial(models=models, bridges=bridges, flow=CrowdFlow(density=density))


GRIDS = {
    "coarse": MapGrid(frequencies=(1.0, 1.5, 1.75, 2.0, 2.25, 2.5, 2.7, 3.0, 3.25, 3.5, 4.0, 4.25, 4.5, 5.0, 5.5, 6.0),
                      masses=(20e3, 30e3, 40e3, 50e3), trials=400),
    "paper": MapGrid(frequencies=tuple(np.linspace(1.0, 6.0, 51).round(3).tolist()),
                     masses=tuple(np.linspace(20e3, 50e3, 7).tolist()), trials=1000),
}
STATIONARY = MapGrid(frequencies=(1.5, 2.0, 2.7, 3.25, 4.0, 5.0), masses=(50e3,), trials=400)


def report(run: Run) -> Report:
    """All cells of a grid: a95 by MF and PMC, and their ratio."""
    rows = rows_of(run)
    return Report(name="maps", rows=rows, columns=COLUMNS, study=True, caption=(
        f"Figs. 9 to 11: a95 of the peak acceleration by MF and PMC, and R_HSI (eq. 18), {rows[0]['trials']} trials a "
        "cell, 95 % intervals, those of ratios by a paired bootstrap"))


def rows_of(run: Run) -> Rows:
    """One row per density, frequency, modal mass and damping."""
    if run.recompute:
        return _rows(study(GRIDS[run.grid], MODELS, run.executor, run.ledger), "r_hsi")
    return committed("maps")


def study(
    grid: MapGrid, models: tuple[str, ...] = MODELS, executor: Executor | None = None, ledger: Ledger | None = None, *,
    label: str = "maps",
) -> Sweep:
    """Run the trials of all cells of a grid.

    Parameters
    ----------
    grid : MapGrid
        Which cells.
    models : tuple of str
        What predicts.
    executor : concurrent.futures.Executor, optional
        Runs the trials; in place without one.
    ledger : Ledger, optional
        Keeps them.
    label : str
        What progress and ledger call the study.

    Returns
    -------
    Sweep
        a95 over density, frequency, model, modal mass and damping [m/s²].

    Examples
    --------
    >>> from dataclasses import replace
    >>> found = study(replace(GRIDS["coarse"], densities=(0.2,), frequencies=(5.0,), masses=(50e3,), trials=72))
    >>> found.estimate.shape, found.ratio("model", "MF", "PMC").estimate.round(1)
    ((1, 1, 2, 1, 3), array([[[[3.1, 2.4, 1.7]]]]))
    """
    return sweep(partial(grid.trial, models=models), {"density": grid.densities, "f_b": grid.frequencies},
                 shared={"model": models, "m_b": grid.masses, "xi_b": DAMPINGS}, name="a95",
                 units={"density": "1/m²", "f_b": "Hz", "m_b": "kg", "a95": "m/s²"}, rule=EXHAUSTIVE, seed=SEED,
                 executor=executor, max_trials=grid.trials, label=label, ledger=ledger)


def stationary(run: Run) -> Report:
    """SF beside MF in some of the cells; their ratio is the same for all modal masses."""
    rows = (_rows(study(STATIONARY, ("SF", "MF"), run.executor, run.ledger, label="stationary"), "sf_over_mf")
            if run.recompute else committed("stationary"))
    return Report(name="stationary", rows=rows, columns=STATIONARY_COLUMNS, study=True, caption=(
        f"a95 of the peak acceleration by SF and MF, {rows[0]['trials']} trials a cell, 95 % intervals, those of "
        "ratios by a paired bootstrap"))


def _rows(found: Sweep, ratio: str) -> Rows:
    """One row per cell: a95 by both models, and the first over the second."""
    models = found.axes["model"]
    by_model = {str(model).lower(): found.at({"model": model}) for model in models}
    quotient = found.ratio("model", *models)
    trials = np.broadcast_to(found.trials[..., None, None], quotient.estimate.shape)
    return [{**dict(zip(KEYS, cell, strict=True)),
             **{key: value for model, one in by_model.items()
                for key, value in _interval(one, place).row(f"a95_{model}", "_m_per_s2").items()},
             **_interval(quotient, place).row(ratio), "trials": int(trials[place])}
            for place, cell in zip(np.ndindex(trials.shape), product(*quotient.axes.values()), strict=True)]


def _interval(found: Estimates, place: tuple[int, ...]) -> Interval:
    return Interval(*(float(end[place]) for end in (found.estimate, found.low, found.high)))


def over(rows: Rows, name: str, unit: str = "") -> Estimates:
    """One quantity of the rows over density, frequency, modal mass and damping.

    Parameters
    ----------
    rows : list of dict
        Rows of the maps, all of a grid or those of some densities and dampings.
    name : str
        Beginning of the keys of the quantity.
    unit : str
        End of these keys.

    Returns
    -------
    Estimates

    Examples
    --------
    >>> row = {"density_per_m2": 0.2, "f_b_hz": 2.0, "m_b_kg": 2e4, "xi_b": 0.005,
    ...        "r_hsi": 2.0, "r_hsi_low": 1.9, "r_hsi_high": 2.1}
    >>> over([row], "r_hsi").high
    array([[[[2.1]]]])
    """
    axes = {key: tuple(dict.fromkeys(row[key] for row in rows)) for key in KEYS}
    ends = (np.reshape([row[f"{name}{end}{unit}"] for row in rows], tuple(map(len, axes.values())))
            for end in ("", "_low", "_high"))
    return Estimates(axes=axes, **dict(zip(("estimate", "low", "high"), ends, strict=True)))


def drawn(
    rows: Rows, name: str, unit: str = "", *, quantity: str, levels: tuple[float, ...],
) -> ct.ControlPlot:
    """Maps of a quantity over frequency and modal mass: a row per damping, a column per density.

    Parameters
    ----------
    rows : list of dict
        Rows of the maps.
    name, unit : str
        Which of their numbers, as in `over`.
    quantity : str
        What the colour bar calls it.
    levels : tuple of float
        Levels of the contours [unit of the quantity].

    Returns
    -------
    control.ControlPlot
    """
    from hsictrl import plots

    found = over(rows, name, unit)
    densities, frequencies, masses, dampings = (np.array(values, dtype=float) for values in found.axes.values())
    panels = {rf"{density:g}/m², $\xi_B$ {100 * damping:g} %": found.estimate[i, :, :, j].T
              for j, damping in enumerate(dampings) for i, density in enumerate(densities)}
    return plots.map_plot(frequencies, masses / 1e3, panels, quantity=quantity, levels=levels,
                          columns=len(densities))

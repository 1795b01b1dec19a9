"""The study behind figures 9 to 11: peak accelerations without and with interaction over bridges and crowds (4.4)."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import product
from typing import final

import numpy as np

from hsictrl.assessment import PeaksTrial
from hsictrl.bridge import reference_bridge
from hsictrl.crowd import CrowdFlow
from hsictrl.paper.reports import Report, Rows, committed, rounded
from hsictrl.study import Ledger, PercentileRule, Sweep, sweep

SEED = 9
DENSITIES, DAMPINGS = (0.2, 0.5, 0.8, 1.0, 1.5), (0.002, 0.005, 0.02)
RULE = PercentileRule()
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

    Examples
    --------
    >>> GRIDS["coarse"].trial(density=0.2, f_b=2.0)(np.random.default_rng(1)).shape   # MF, PMC; 4 masses; 3 dampings
    (24,)
    """

    frequencies: tuple[float, ...]
    masses: tuple[float, ...]
    trials: int

    def trial(self, *, density: float, f_b: float, models: tuple[str, ...] = ("MF", "PMC")) -> PeaksTrial:
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
    "coarse": MapGrid(frequencies=(1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.7, 3.0, 3.25, 3.5, 3.75, 4.0, 4.25, 4.5, 5.0,
                                   5.5, 6.0), masses=(20e3, 30e3, 40e3, 50e3), trials=400),
    "paper": MapGrid(frequencies=tuple(np.linspace(1.0, 6.0, 51).round(3).tolist()),
                     masses=tuple(np.linspace(20e3, 50e3, 7).tolist()), trials=1000),
}


def study(grid: MapGrid, executor: Executor | None = None, ledger: Ledger | None = None) -> Sweep:
    """Run the trials of all cells of a grid.

    Parameters
    ----------
    grid : MapGrid
        Which cells.
    executor : concurrent.futures.Executor, optional
        Runs the trials; in place without one.
    ledger : Ledger, optional
        Keeps them.

    Returns
    -------
    Sweep
        a95 over density, frequency, model, modal mass and damping.

    Examples
    --------
    >>> from dataclasses import replace
    >>> small = replace(GRIDS["coarse"], frequencies=(5.0,), masses=(50e3,), trials=100)
    >>> study(small).estimate.shape      # doctest: +SKIP
    (5, 1, 2, 1, 3)
    """
    return sweep(grid.trial, {"density": DENSITIES, "f_b": grid.frequencies},
                 shared={"model": ("MF", "PMC"), "m_b": grid.masses, "xi_b": DAMPINGS}, name="a95",
                 units={"density": "1/m²", "f_b": "Hz", "m_b": "kg", "a95": "m/s²"}, rule=EXHAUSTIVE, seed=SEED,
                 executor=executor, max_trials=grid.trials, label="maps", ledger=ledger)

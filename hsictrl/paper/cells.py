"""The cells of table 2 and figure 8: a bridge, a crowd, and what the paper leaves open about both (section 4.1)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import final

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge, reference_bridge
from hsictrl.crowd import CrowdFlow, Traffic, resonant_step_frequency
from hsictrl.prediction import MODELS, Prediction, predict, tune

FREQUENCIES, DENSITIES = (2.0, 3.25, 5.0), (0.2, 1.0)
SPREADS = {1: 0.175, 2: 0.0}       # of the step frequencies [Hz], by case
TUNED_TO = ("own", "empty")


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """A natural frequency, a density, and how much step frequencies differ between people.

    Parameters
    ----------
    frequency : float
        Natural frequency f_B of the empty bridge [Hz].
    density : float
        Pedestrian density [1/m²].
    case : {1, 2}
        Step frequencies N(f_l, 0.175 Hz), or all the same, whatever the density [-].

    Examples
    --------
    >>> print(Cell(frequency=2.0, density=0.2, case=1))
    0.2 /m², case 1, 2 Hz
    """

    frequency: float
    density: float
    case: int

    def __post_init__(self) -> None:
        if self.case not in SPREADS:
            raise ValueError(f"case must be 1 or 2, got {self.case}; choose one of these")

    def __str__(self) -> str:
        return f"{self.density:g} /m², case {self.case}, {self.frequency:g} Hz"

    @property
    def flow(self) -> CrowdFlow:
        """The stream of people, with step frequencies about the empty bridge's resonance."""
        mean, _ = resonant_step_frequency(self.frequency)
        return CrowdFlow(density=self.density, step_frequency=(mean, SPREADS[self.case]))


CELLS = tuple(Cell(frequency=f_b, density=density, case=case)
              for density, case, f_b in product(DENSITIES, SPREADS, FREQUENCIES))


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """One way to read what section 4.1 leaves open.

    Parameters
    ----------
    name : str
        What it is called.
    damping : float
        Modal damping ratio ξ_B [-].
    modal_mass : float
        Modal mass m_B [kg].
    warm_up : float, optional
        Time between a full deck and the window; max(T, 5/(ξω)) by each model's own damping if not given [s].
    tuned_to : {"own", "empty"}
        Whether step frequencies meet the resonance of each model, or that of the empty bridge for all.

    Examples
    --------
    >>> Reading(name="heavy", modal_mass=50e3).bridge(2.0).mass
    100000.0
    """

    name: str
    damping: float = 0.005
    modal_mass: float = 25e3
    warm_up: float | None = None
    tuned_to: str = "own"

    def __post_init__(self) -> None:
        check.choice("tuned_to", self.tuned_to, TUNED_TO)

    def bridge(self, frequency: float) -> Footbridge:
        """The reference bridge of this reading, empty."""
        return reference_bridge(frequency=frequency, damping=self.damping, modal_mass=self.modal_mass)

    def predict(self, model: str, bridge: Footbridge, traffic: Traffic) -> Prediction:
        """What a model predicts for traffic that is tuned to the empty bridge."""
        tuned = tune(model, bridge, traffic) if self.tuned_to == "own" else traffic
        return predict(model, bridge, tuned, warm_up=self.warm_up)


DEFAULT = Reading(name="default")


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class SharedTrafficTrial:
    """A trial: one sample of traffic, and the peak acceleration that each of the five models predicts for it [m/s²].

    Parameters
    ----------
    cell : Cell
        Bridge and crowd.
    reading : Reading
        What the paper leaves open.

    Examples
    --------
    >>> trial = SharedTrafficTrial(cell=Cell(frequency=2.0, density=0.2, case=1))
    >>> trial(np.random.default_rng(1)).shape       # SF, MF, MFAM, PMC, MC
    (5,)
    """

    cell: Cell
    reading: Reading = DEFAULT

    def __call__(self, rng: np.random.Generator) -> Array:
        bridge = self.reading.bridge(self.cell.frequency)
        traffic = self.cell.flow.sample(bridge, rng=rng)
        return np.array([self.reading.predict(model, bridge, traffic).peak_acceleration for model in MODELS])

"""What a sweep has found, as rows, a table, a document and labelled arrays."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any, final

from rich.table import Table

from hsictrl import __version__
from hsictrl.cli import tables
from hsictrl.cli.outcome import Rows, bridge_document
from hsictrl.cli.study import PAIR, Study
from hsictrl.cli.tables import Column, estimate
from hsictrl.study import Estimates, PercentileRule, Sweep

if TYPE_CHECKING:
    import xarray as xr

ENDS = {"": "estimate", "_low": "low", "_high": "high"}
COLUMNS = {
    "density": tables.FLOW,
    "frequency": Column("f_B", "[Hz]", lambda row: f"{row['frequency_hz']:.4g}"),
    "force": Column("force", "", lambda row: row["force"], "left"),
    "modal_mass": Column("m_B", "[t]", lambda row: f"{row['modal_mass_kg'] / 1e3:.4g}"),
    "damping": Column("ξ_B", "[%]", lambda row: f"{100 * row['damping']:.3g}"),
}
COUNT = Column("trials", "settled", lambda row: f"{row['trials']}\n{'yes' if row['converged'] else 'no'}")


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Swept:
    """A study and what its sweep has found.

    Parameters
    ----------
    asked : Study
        What was studied.
    rule : PercentileRule
        Until when.
    max_trials : int
        Trials after which a cell was left [-].
    found : Sweep
        The estimates.
    ratio : Estimates, optional
        R_HSI, where both of its models are among those studied.
    """

    asked: Study
    rule: PercentileRule
    max_trials: int
    found: Sweep
    ratio: Estimates | None

    @classmethod
    def of(cls, asked: Study, rule: PercentileRule, max_trials: int, found: Sweep) -> Swept:
        """The same with the ratio, if there is one."""
        ratio = found.ratio("model", *PAIR) if {*PAIR} <= {*asked.model} else None
        return cls(asked=asked, rule=rule, max_trials=max_trials, found=found, ratio=ratio)

    def rows(self) -> Rows:
        """A row per flow, bridge and force, the units in the keys."""
        peaks, cells = self.found.at({}), product(*self.asked.cells.values())
        return [
            {**self._place(point), **self._peaks(peaks, point), "trials": one.n_trials, "converged": one.converged}
            for cell, one in zip(cells, self.found.ensembles, strict=True) for point in self._points(cell)]

    def document(self) -> dict[str, Any]:
        """What a reader of the JSON file needs."""
        return {"bridge": bridge_document(self.asked.case.bridge), "settings": self._settings(), "rows": self.rows()}

    def dataset(self) -> xr.Dataset:
        """The same as labelled arrays; ImportError without xarray."""
        data = self.found.to_xarray()
        if self.ratio is None:
            return data
        return data.assign({f"r_hsi{end}": (list(self.ratio.axes), getattr(self.ratio, name))
                            for end, name in ENDS.items()})

    def table(self) -> Table:
        """A table of what varies and what was found."""
        peaks = [Column(f"a{self.rule.percentile:g} {model}", "[m/s²]", estimate(_key(model), unit="_m_per_s2"))
                 for model in self.asked.model]
        reduction = [] if self.ratio is None else [Column("R_HSI", "[-]", estimate("r_hsi"))]
        varying = [column for name, column in COLUMNS.items() if len(self.found.axes[name]) > 1]
        return tables.table([*varying, *peaks, *reduction, COUNT], self.rows())

    def notes(self) -> list[str]:
        """What stands below the table."""
        bridge, percentile = self.asked.case.bridge, f"a{self.rule.percentile:g}"
        reduction = "" if self.ratio is None else f" R_HSI: {percentile} MF / {percentile} PMC (eq. 18)."
        return [
            f"Deck: {bridge.length:g} m × {bridge.width:g} m.{self._constant()} Seed: {self.asked.case.seed}.",
            *(f"Force {name}: {force}." for name, force in self.asked.forces.items()),
            f"{percentile}: percentile {self.rule.percentile:g} of the peak acceleration.{reduction}",
            f"Below an estimate: its {100 * self.rule.confidence:g} % interval. Trials stop when the intervals of all "
            f"bridges and models under one traffic lie within ±{100 * self.rule.tolerance:g} %.",
            *self._remarks()]

    def _points(self, cell: tuple[Any, ...]) -> Iterator[dict[str, Any]]:
        """A value of every axis but the models', in one cell."""
        place = dict(zip(self.asked.cells, cell, strict=True))
        for modal_mass, damping in product(self.asked.modal_mass, self.asked.damping):
            yield {**place, "modal_mass": modal_mass, "damping": damping}

    def _place(self, point: dict[str, Any]) -> dict[str, Any]:
        density = point["density"]
        return {"density_per_m2": density, "persons": self.asked.flows[density].persons_on(self.asked.case.bridge),
                "frequency_hz": point["frequency"], "force": point["force"], "modal_mass_kg": point["modal_mass"],
                "damping": point["damping"]}

    def _peaks(self, peaks: Estimates, point: dict[str, Any]) -> dict[str, float]:
        found: dict[str, float] = {}
        for model in self.asked.model:
            found |= _quantity(_key(model), "_m_per_s2", peaks.at({**point, "model": model}))
        return found if self.ratio is None else found | _quantity("r_hsi", "", self.ratio.at(point))

    def _settings(self) -> dict[str, Any]:
        return {"percentile": self.rule.percentile, "tolerance": self.rule.tolerance,
                "confidence": self.rule.confidence, "max_trials": self.max_trials, "seed": self.asked.case.seed,
                "forces": {name: repr(force) for name, force in self.asked.forces.items()},
                "flows": list(map(repr, self.asked.case.flows)), "hsictrl": __version__}

    def _constant(self) -> str:
        """What has one value, and no column."""
        (density, flow), bridge = next(iter(self.asked.flows.items())), self.asked.case.bridge
        words = {"density": f"d = {density:.3g} /m² (n={flow.persons_on(bridge)})",
                 "frequency": f"f_B = {self.asked.frequency[0]:g} Hz",
                 "modal_mass": f"m_B = {self.asked.modal_mass[0] / 1e3:g} t",
                 "damping": f"ξ_B = {100 * self.asked.damping[0]:g} %"}
        return "".join(f" {told}." for name, told in words.items() if len(self.found.axes[name]) == 1)

    def _remarks(self) -> list[str]:
        settled = self.found.converged
        return [] if settled.all() else [f"Remark: {(~settled).sum()} of {settled.size} studies have not settled; go "
                                         "on with --resume and a larger --max-trials or --tolerance."]


def _key(model: str) -> str:
    return f"a_{model.lower()}"


def _quantity(name: str, unit: str, found: Estimates) -> dict[str, float]:
    return {f"{name}{end}{unit}": float(getattr(found, part)) for end, part in ENDS.items()}

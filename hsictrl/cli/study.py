"""What a sweep studies, read from a TOML file: a description (`hsictrl.cli.description`) with a table of axes.

Every axis may be left out. What is an axis takes the place of what the other tables say; what is none comes from
them. A number in place of a list is an axis of one value. Frequency, modal mass and damping are those of the first
mode; further modes change in proportion. An example::

    [bridge]
    kind = "reference"

    [sweep]
    frequency = [2.0, 2.5, 3.25]            # Hz
    modal_mass = [20e3, 50e3]               # kg; the mass of the bridge grows with it
    damping = [0.002, 0.005, 0.02]          # fractions
    density = [0.2, 0.5, 1.0]               # persons/m²
    model = ["MF", "PMC"]                   # these if left out; also "SF", "MFAM" and "MC"
    force = ["zivanovic", "young"]          # the model that [force] describes is taken as it stands there
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, final

from hsictrl import _checks as check
from hsictrl.assessment import JointTrial, PeaksTrial, PeakTrial, check_assessable
from hsictrl.bridge import Footbridge
from hsictrl.cli import schema
from hsictrl.cli.description import FORCE, Description, described, plain_force
from hsictrl.cli.schema import Keys, Table
from hsictrl.crowd import CrowdFlow
from hsictrl.prediction import MODELS
from hsictrl.prediction.shared import SHARED_MODELS
from hsictrl.walking import WalkingForce

NUMBERS = ("frequency", "modal_mass", "damping", "density")
AXES: Keys = {**dict.fromkeys(NUMBERS, schema.ONE_OR_MORE), "model": schema.WORDS, "force": schema.WORDS}
PAIR = ("MF", "PMC")    # whose ratio is R_HSI


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """Bridges, crowds, forces and models whose every combination is studied.

    Parameters
    ----------
    case : Description
        The bridge that the others differ from, the flows of people, and the seed.
    forces : mapping of str to WalkingForce
        Walking forces by their names.
    model : tuple of str
        Models.
    frequency, modal_mass, damping : tuple of float
        Those of the bridges' first modes; further modes change in proportion [Hz, kg, -].

    Examples
    --------
    >>> study = Study(case=Description(), forces={"zivanovic": Description().force}, model=("PMC",),
    ...               frequency=(2.0, 3.0), modal_mass=(20e3,), damping=(0.005, 0.01))
    >>> len(study.trial(density=0.2, frequency=3.0, force="zivanovic").bridges)
    2
    """

    case: Description
    forces: Mapping[str, WalkingForce]
    model: tuple[str, ...]
    frequency: tuple[float, ...]
    modal_mass: tuple[float, ...]
    damping: tuple[float, ...]

    @property
    def flows(self) -> dict[float, CrowdFlow]:
        """The flows by their densities [1/m²]."""
        return {flow.density_on(self.case.bridge): flow for flow in self.case.flows}

    @property
    def cells(self) -> dict[str, tuple[Any, ...]]:
        """The axes of which every combination has trials of its own."""
        return {"density": tuple(self.flows), "frequency": self.frequency, "force": tuple(self.forces)}

    @property
    def shared(self) -> dict[str, tuple[Any, ...]]:
        """The axes along which a trial has one sample of traffic."""
        return {"model": self.model, "modal_mass": self.modal_mass, "damping": self.damping}

    def trial(self, *, density: float, frequency: float, force: str) -> PeaksTrial | JointTrial:
        """One sample of traffic on all bridges of one frequency.

        Parameters
        ----------
        density : float
            Which of the flows [1/m²].
        frequency : float
            Natural frequency of the bridges [Hz].
        force : str
            Which of the walking forces.

        Returns
        -------
        PeaksTrial or JointTrial
            The latter if there is a model, a further mode or an absorber for which bridges share nothing.

        Examples
        --------
        >>> study = Study(case=Description(), forces={"zivanovic": Description().force}, model=("PMC",),
        ...               frequency=(2.0,), modal_mass=(20e3,), damping=(0.005,))
        >>> study.trial(density=0.5, frequency=2.0, force="zivanovic").flow.density
        0.5
        """
        bridges, flow, walking = self.bridges(frequency), self.flows[density], self.forces[force]
        plain = self.case.bridge.n_modes == 1 and not self.case.bridge.absorbers
        if plain and {*self.model} <= {*SHARED_MODELS}:
            return PeaksTrial(models=self.model, bridges=bridges, flow=flow, force=walking)
        return JointTrial([PeakTrial(model=model, bridge=bridge, flow=flow, force=walking)
                           for model in self.model for bridge in bridges])

    def bridges(self, frequency: float) -> list[Footbridge]:
        """The bridges of one frequency [Hz]."""
        return [changed(self.case.bridge, frequency=frequency, modal_mass=mass, damping=damping)
                for mass, damping in product(self.modal_mass, self.damping)]


def changed(bridge: Footbridge, *, frequency: float, modal_mass: float, damping: float) -> Footbridge:
    """A bridge with another first mode; mass grows as its modal mass does, and further modes change as it does."""
    was = bridge.modes[0]
    first = replace(was, frequency=frequency, modal_mass=modal_mass, damping=damping)
    further = [replace(mode, **{name: getattr(mode, name) * getattr(first, name) / getattr(was, name)
                                for name in ("frequency", "modal_mass", "damping")}) for mode in bridge.modes[1:]]
    return replace(bridge, modes=[first, *further], mass=bridge.mass * (modal_mass / was.modal_mass))


def read_study(path: Path) -> Study:
    """Read a study from a TOML file.

    Parameters
    ----------
    path : Path
        The file; the format is at the top of `hsictrl.cli.study`.

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If no study can be run from it; the message names the file, the line and the key.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "study.toml"
    >>> _ = path.write_text('[sweep]\\nfrequency = [3.25, 2.0]\\nmodel = "PMC"')
    >>> study = read_study(path)
    >>> study.frequency, study.model, study.damping
    ((2.0, 3.25), ('PMC',), (0.005,))
    """
    top = Table.of(path)
    case = described(top, {"sweep": schema.TABLE})
    _check_case(top, case)
    table = top.table("sweep")
    axes = {name: table.make(_axis, {"name": name, "given": given}) for name, given in table.read(AXES).items()}
    return table.make(_study, {"case": case, "described_force": top.values.get("force", {}).get("model", FORCE),
                               "axes": axes})


def _check_case(top: Table, case: Description) -> None:
    """Refuse what no trial on many bridges takes."""
    if case.bridge.n_modes > 1 and not case.bridge.modes[0].damping:
        top.table("bridge").refuse("damping", "the first of several modes must have damping above 0, to which the "
                                              "others stand in proportion, got 0; give the damping that it has")
    densities = [flow.density_on(case.bridge) for flow in case.flows]
    if len(set(densities)) < len(densities):
        told = ", ".join(f"{one:g}" for one in densities)
        top.table("traffic").refuse("persons", f"the flows of a sweep must differ in density, got {told} persons/m²; "
                                               "leave one out")
    step = case.flows[0].step_frequency
    if step is not None:
        top.table("traffic").refuse("step_frequency", "the steps of a sweep must be tuned to each bridge, got "
                                                      f"step_frequency={step}; leave it out, or use 'hsictrl assess'")


def _axis(name: str, given: Any) -> tuple[Any, ...]:
    """The values of an axis, numbers from low to high."""
    values = given if isinstance(given, tuple) else (given,)
    for k, value in enumerate(values):
        if value in values[:k]:
            raise ValueError(f"{name} must hold each value once, got {value!r} twice; leave one out")
    return tuple(sorted(map(float, values))) if name in NUMBERS else values


def _study(case: Description, described_force: str, axes: dict[str, tuple[Any, ...]]) -> Study:
    case = case.at_densities(list(axes["density"])) if "density" in axes else case
    for model in axes.get("model", PAIR):
        check.choice("model", model, MODELS)
    forces = {name: case.force if name == described_force else plain_force(name)
              for name in axes.get("force", (described_force,))}
    mode = case.bridge.modes[0]
    bridges = {name: axes.get(name, (getattr(mode, name),)) for name in ("frequency", "modal_mass", "damping")}
    study = Study(case=case, forces=forces, model=axes.get("model", PAIR), **bridges)
    _rehearse(study)
    return study


def _rehearse(study: Study) -> None:
    """Ask what refuses a cell once, before the long work."""
    bridges = [bridge for frequency in study.frequency for bridge in study.bridges(frequency)]
    for bridge, flow in product(bridges, study.case.flows):
        check_assessable(bridge, flow)

"""What is assessed, read from a TOML file.

Every table and key may be left out unless a kind needs it; what is left out is as in section 4.2 of the paper.
Unknown keys are refused. An example::

    seed = 1

    [bridge]
    kind = "simply_supported"
    length = 50.0               # m
    width = 3.0                 # m
    mass = 50e3                 # kg, of the whole bridge
    frequency = 3.25            # Hz
    damping = 0.005             # a fraction; or one per mode

    [[absorbers]]               # tuned mass dampers, as many as there are
    mass = 500.0                # kg
    frequency = 3.19            # Hz
    damping = 0.086             # a fraction
    at = 25.0                   # m along the deck; or [x, y]

    [traffic]
    density = [0.2, 0.5]        # persons/m², a row each; or persons = 15, or classes = ["TC2", "TC3"]
    goal = "CL2"                # the worst comfort class that will do; or one per row
    weight = 700.0              # N

    [traffic.population]
    frequency = [3.25, 0.32]    # Hz: a number, or [mean, standard deviation]

    [force]
    model = "young"
    values = "mean"

===================  ============================================================================================
``[bridge]`` kind    keys (those after the semicolon may be left out)
===================  ============================================================================================
"reference"          ; frequency, damping, modal_mass
"simply_supported"   length, width, mass, frequency, damping; n_modes
"beam"               spans, width, mass, frequency, damping; ends, n_modes
"csv"                shapes, modes (files of `Footbridge.from_csv`, seen from here), width, mass
``[[absorbers]]``    mass, frequency, damping, at (x or [x, y]); direction
``[traffic]``        ; density or persons or classes, goal, speed, step_frequency (a number or [mean, sd]), weight
``[.population]``    ; posture ("bent legs" or "upright"), and what differs from it: frequency, damping, mass (a
                     number or [mean, sd]), sprung_ratio
``[force]`` model    keys
"zivanovic"          ; spacing, scaling
"young"              ; values
"harmonic"           factors; phases
===================  ============================================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any, final

from hsictrl import _checks as check
from hsictrl.absorber import Absorber
from hsictrl.bridge import Footbridge, reference_bridge
from hsictrl.cli import schema
from hsictrl.cli.schema import Keys, Table
from hsictrl.comfort import COMFORT_CLASSES
from hsictrl.crowd import TRAFFIC_CLASSES, CrowdFlow, check_somebody
from hsictrl.pedestrian import Population
from hsictrl.pedestrian.population import POSTURES
from hsictrl.walking import HarmonicForce, WalkingForce, YoungForce, ZivanovicForce

FORCE, POSTURE = "zivanovic", "bent legs"
DENSITIES = (0.2, 0.5, 0.8, 1.0, 1.5)   # persons/m², section 4.2


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Description:
    """What is assessed: one bridge under several flows of people.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flows : tuple of CrowdFlow
        A row of the result each.
    goals : tuple of str
        The worst comfort class that will do, for each flow; none where there is no goal.
    force : WalkingForce
        Walking force.
    seed : int
        Seed of all trials [-].

    Examples
    --------
    >>> [flow.density for flow in Description().flows]
    [0.2, 0.5, 0.8, 1.0, 1.5]
    """

    bridge: Footbridge = field(default_factory=reference_bridge)
    flows: tuple[CrowdFlow, ...] = tuple(CrowdFlow(density=density) for density in DENSITIES)
    goals: tuple[str, ...] = ()
    force: WalkingForce = field(default_factory=ZivanovicForce)
    seed: int = 1

    def __post_init__(self) -> None:
        check.whole("seed", self.seed, least=0, remedy="give 0, 1, 2, …")
        for flow in self.flows:
            check_somebody(flow, self.bridge)

    @property
    def aims(self) -> list[tuple[CrowdFlow, str | None]]:
        """Each flow with its goal, if it has one."""
        return list(zip(self.flows, self.goals or (None,) * len(self.flows), strict=True))

    def at_densities(self, densities: list[float]) -> Description:
        """The same bridge and people in flows of other densities.

        Parameters
        ----------
        densities : list of float
            Pedestrian densities [1/m²].

        Returns
        -------
        Description

        Examples
        --------
        >>> len(Description().at_densities([0.2, 0.3]).flows)
        2
        """
        like = replace(self.flows[0], persons=None, traffic_class=None, density=densities[0])
        if len(set(self.goals)) > 1:
            raise ValueError(f"goal must be one for all densities that take the place of those described, got "
                             f"{', '.join(self.goals)}; write one goal, or give no densities")
        return replace(self, flows=tuple(replace(like, density=density) for density in densities),
                       goals=self.goals[:1] * len(densities))


def read_description(path: Path) -> Description:
    """Read a description from a TOML file.

    Parameters
    ----------
    path : Path
        The file; the format is at the top of `hsictrl.cli.description`.

    Returns
    -------
    Description

    Raises
    ------
    ValueError
        If the file can't be read or isn't TOML, or a key is unknown, missing, of the wrong type or physically
        impossible; the message names the file, the line and the key.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "bridge.toml"
    >>> _ = path.write_text('[bridge]\\nkind = "reference"\\nfrequency = 3.25\\n[traffic]\\npersons = [15, 75]')
    >>> description = read_description(path)
    >>> description.bridge.modes[0].frequency, [flow.persons for flow in description.flows]
    (3.25, [15, 75])
    """
    return described(Table.of(path))


def described(top: Table, further: Keys | None = None) -> Description:
    """What a document describes, beside further keys, which must be there for somebody else to read."""
    further = further or {}
    known = {**dict.fromkeys(PARTS, schema.TABLE), "absorbers": schema.TABLES, "seed": schema.WHOLE}
    values = top.read({**known, **further}, needs=further)
    parts = {name: make(top.table(key)) for key, (name, make) in PARTS.items() if key in values}
    for table in top.tables("absorbers") if "absorbers" in values else ():
        parts["bridge"] = _fixed(parts.get("bridge", reference_bridge()), table)
    if "flows" in parts:
        parts |= {"goals": _goals(top.table("traffic"), len(parts["flows"]))}
    return top.make(Description, parts | {key: value for key, value in values.items() if key == "seed"})


@final
@dataclass(frozen=True, slots=True)
class _Kind:
    """What makes a thing of one kind, from which keys."""

    make: Callable[..., Any]
    needs: Keys = field(default_factory=dict)
    may: Keys = field(default_factory=dict)


_BEAM: Keys = {"width": schema.NUMBER, "mass": schema.NUMBER, "frequency": schema.NUMBER, "damping": schema.ONE_OR_MORE}
_BRIDGES = {
    "reference": _Kind(reference_bridge, may=dict.fromkeys(("frequency", "damping", "modal_mass"), schema.NUMBER)),
    "simply_supported": _Kind(Footbridge.simply_supported, {"length": schema.NUMBER, **_BEAM},
                              {"n_modes": schema.WHOLE}),
    "beam": _Kind(Footbridge.beam, {"spans": schema.NUMBERS, **_BEAM},
                  {"ends": schema.ENDS, "n_modes": schema.WHOLE}),
    "csv": _Kind(Footbridge.from_csv, {"shapes": schema.FILE, "modes": schema.FILE, "width": schema.NUMBER,
                                       "mass": schema.NUMBER}),
}
_ABSORBER: Keys = {**dict.fromkeys(("mass", "frequency", "damping"), schema.NUMBER), "at": schema.PLACE}
_FORCES = {
    "zivanovic": _Kind(ZivanovicForce, may={"spacing": schema.NUMBER, "scaling": schema.TEXT}),
    "young": _Kind(YoungForce, may={"values": schema.TEXT}),
    "harmonic": _Kind(HarmonicForce, {"factors": schema.NUMBERS}, {"phases": schema.NUMBERS}),
}
_AMOUNTS: Keys = {"density": schema.ONE_OR_MORE, "persons": schema.COUNTS, "classes": schema.WORDS}
_TRAFFIC: Keys = {**_AMOUNTS, "goal": schema.WORDS, "speed": schema.NUMBER, "step_frequency": schema.NORMAL,
                  "weight": schema.NUMBER, "population": schema.TABLE}
_POPULATION: Keys = {**dict.fromkeys(("frequency", "damping", "mass"), schema.NORMAL), "sprung_ratio": schema.NUMBER,
                     "posture": schema.TEXT}


def _bridge(table: Table) -> Footbridge:
    bridge: Footbridge = _of_kind(table, "kind", _BRIDGES)
    return bridge


def _fixed(bridge: Footbridge, table: Table) -> Footbridge:
    """The bridge with one more absorber."""
    values = table.read({**_ABSORBER, "direction": schema.TEXT}, needs=_ABSORBER)
    place = values.pop("at")
    absorber = table.make(Absorber, values)
    return table.make(partial(bridge.with_absorbers, absorber), {"at": [place]})


def _force(table: Table) -> WalkingForce:
    force: WalkingForce = _of_kind(table, "model", _FORCES)
    return force


def plain_force(name: str) -> WalkingForce:
    """A walking force of which nothing but the name is given."""
    kind = _FORCES[check.choice("force", name, tuple(_FORCES))]
    if kind.needs:
        raise ValueError(f"force {name!r} must have its {', '.join(kind.needs)}, got none; describe it in [force]")
    force: WalkingForce = kind.make()
    return force


def _of_kind(table: Table, key: str, kinds: dict[str, _Kind]) -> Any:
    """What a table describes, when one of its keys says of which kind it is."""
    name = table.make(partial(check.choice, key, options=tuple(kinds)), {"value": table.values.get(key)})
    kind = kinds[name]
    values = table.read({key: schema.TEXT, **kind.needs, **kind.may}, needs=kind.needs)
    return table.make(kind.make, {name: value for name, value in values.items() if name != key})


def _flows(table: Table) -> tuple[CrowdFlow, ...]:
    values = table.read(_TRAFFIC)
    if "population" in values:
        values["population"] = _population(table.table("population"))
    values.pop("goal", None)
    counted, *others = [name for name in _AMOUNTS if name in values] or ["density"]
    if others:
        table.refuse(others[0], f"a flow must have one of {', '.join(_AMOUNTS)}, got {counted} and "
                                f"{' and '.join(others)}; leave out all but one")
    rows = _several(values.pop(counted, DENSITIES))
    if counted == "classes":
        rows, counted = _words(table, "classes", rows, tuple(TRAFFIC_CLASSES)), "traffic_class"
    return tuple(table.make(CrowdFlow, {**values, counted: row}) for row in rows)


def _goals(table: Table, n: int) -> tuple[str, ...]:
    """As many goals as there are flows, if there is one."""
    goals = _words(table, "goal", _several(table.values.get("goal", ())), COMFORT_CLASSES[:-1])
    if len(goals) not in (0, 1, n):
        table.refuse("goal", f"goal must be one for all rows or one per row ({n}), got {len(goals)}; match them")
    return goals * n if len(goals) == 1 else goals


def _several(given: Any) -> tuple[Any, ...]:
    return tuple(given) if isinstance(given, list | tuple) else (given,)


def _words(table: Table, key: str, given: tuple[Any, ...], options: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(table.make(partial(check.choice, key, options=options), {"value": word}) for word in given)


def _population(table: Table) -> Population:
    values = table.read(_POPULATION)
    posture = {"value": values.pop("posture", POSTURE)}
    people = POSTURES[table.make(partial(check.choice, "posture", options=tuple(POSTURES)), posture)]
    return table.make(partial(replace, people), values)


PARTS: dict[str, tuple[str, Callable[[Table], Any]]] = {
    "bridge": ("bridge", _bridge), "traffic": ("flows", _flows), "force": ("force", _force)}

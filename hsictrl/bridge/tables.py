"""Modes from the tables that finite-element models export; units and scaling are checked and told."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import final

import numpy as np
from scipy.interpolate import make_interp_spline

from hsictrl import _checks as check
from hsictrl._checks import DIRECTIONS, Array
from hsictrl.bridge.cells import Cells
from hsictrl.bridge.mode import Mode
from hsictrl.bridge.sampled import SampledShape

LENGTHS = (5.0, 1000.0)         # m
WIDEST = 50.0                   # m, from the centre line
FREQUENCIES = (0.1, 50.0)       # Hz
LARGEST_DAMPING = 0.2
MODAL_MASSES = (100.0, 1e8)     # kg
# Exports print the same place with such differences.
_SAME_PLACE = 6                 # digits after the point, of metres
_MOST_CELLS = 100     # places of a grid for each node
# A component as small beside the other one is what a solver has left of nothing.
_NOTHING = 1e-6
# Modes closer than this are one.
_TWIN = 1e-6
_REMEDIES = {False: "export mass-normalised shapes in 1/√kg, or give modal masses",
             True: "give kg, for the shapes as they are; none for mass-normalised ones"}


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Read:
    """What two tables tell of a bridge.

    Parameters
    ----------
    modes : tuple of Mode
        Its modes, in the order of their table.
    length : float
        Length of the deck [m].
    remarks : tuple of str
        What was inferred.
    """

    modes: tuple[Mode, ...]
    length: float
    remarks: tuple[str, ...]


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Grid:
    """Nodes on lines along the deck: their places, their rows in the table, and what was done to order them."""

    x: Array
    y: Array
    rows: np.ndarray
    remarks: tuple[str, ...]

    @classmethod
    def of(cls, nodes: Cells) -> _Grid:
        along = nodes.column("x") - np.min(nodes.column("x"))
        _check_length(nodes, along)
        across = (nodes.within("y", least=-WIDEST, most=WIDEST, remedy="give metres from the centre line")
                  if "y" in nodes.heads else 0 * along)
        _, first, i = np.unique(along.round(_SAME_PLACE), return_index=True, return_inverse=True)
        y, j = np.unique(across.round(_SAME_PLACE), return_inverse=True)
        nodes.refuse_repeated("x", i * len(y) + j)
        if len(first) * len(y) > _MOST_CELLS * len(along):     # of scattered nodes; not to be laid out before refused
            raise ValueError(f"{nodes.path}, columns x and y: every line along the deck must have nodes at the same x, "
                             f"got {len(along)} nodes at {len(first)} x and {len(y)} y; export whole lines")
        rows = np.full((len(first), len(y)), -1)
        rows[i, j] = np.arange(len(along))
        grid = cls(x=along[first], y=y, rows=rows, remarks=_order(nodes, rows))
        grid._check_lines(nodes)
        return grid

    def _check_lines(self, nodes: Cells) -> None:
        missing = np.argwhere(self.rows < 0)
        if missing.size:
            i, j = missing[0]
            raise ValueError(f"{nodes.path}, columns x and y: every line along the deck must have nodes at the same x, "
                             f"got none at x = {self.x[i] + np.min(nodes.column('x')):g}, y = {self.y[j]:g}; "
                             "export whole lines")
        if len(self.y) > 1 and not self.y[0] < 0 < self.y[-1]:
            raise ValueError(f"{nodes.place(int(self.rows[0, 0]), 'y')}: lines must lie on both sides of y = 0, got y "
                             f"from {self.y[0]:g} to {self.y[-1]:g}; count y from the centre line of the deck")

    def lines(self, width: float) -> tuple[Array, Array]:
        """Lines from edge to edge, the centre among them, and the weights with which those of the nodes give them."""
        if len(self.y) == 1:
            return np.zeros(1), np.ones((1, 1))
        lines = np.unique([-width / 2, 0.0, *self.y[np.abs(self.y) < width / 2], width / 2])
        return lines, make_interp_spline(self.y, np.eye(len(self.y)), k=1)(lines)


def read_modes(shapes: Path, modes: Path, *, width: float, mass: float) -> Read:
    """Read modes from a table of nodes and a table of modes.

    Parameters
    ----------
    shapes, modes : Path
        The tables, as `Footbridge.from_csv` describes them.
    width, mass : float
        Walkable width of the deck, and mass of the bridge [m, kg].

    Returns
    -------
    Read
    """
    nodes, table = Cells.of(shapes), _modes(modes)
    _check_components(nodes, table)
    grid = _Grid.of(nodes)
    found = [_shape(nodes, grid, number, width) for number in _numbers(table)]
    _refuse_twins(table, found)
    scaled = [_mode(table, index, shape) for index, shape in enumerate(found)]
    told = [_scaling(table, index, shape, mass) for index, shape in enumerate(found)]
    return Read(modes=tuple(scaled), length=float(grid.x[-1]), remarks=(*grid.remarks, *told))


def _modes(path: Path) -> Cells:
    """The table of modes, its numbers within what footbridges have."""
    table = Cells.of(path)
    table.need("mode", "frequency", "damping")
    table.refuse_unknown(("mode", "frequency", "damping", "modal_mass"))
    _check_numbers(table)
    table.within("frequency", least=FREQUENCIES[0], most=FREQUENCIES[1], remedy="give Hz")
    table.within("damping", least=0.0, below=LARGEST_DAMPING, remedy=check.PERCENT)
    return table


def _numbers(table: Cells) -> list[int]:
    return [int(number) for number in table.column("mode")]


def _check_numbers(table: Cells) -> None:
    """Modes are numbered 1, 2, …, or some of these."""
    for index, number in enumerate(table.within("mode", least=1, remedy="number the modes from one")):
        if number % 1:
            raise ValueError(f"{table.place(index, 'mode')}: mode must be a whole number, got {number:g}; give the one "
                             "behind its components")
    table.refuse_repeated("mode", table.column("mode"))


def _check_components(nodes: Cells, table: Cells) -> None:
    """Every mode of the table has a component, and every component a mode."""
    nodes.need("x")
    components = {number: [f"{one}_{number}" for one in DIRECTIONS] for number in _numbers(table)}
    for vertical, lateral in components.values():
        if lateral not in nodes.heads:
            nodes.need(vertical)
    nodes.refuse_unknown(("x", "y", *(head for pair in components.values() for head in pair)))


def _check_length(nodes: Cells, along: Array) -> None:
    place = nodes.place(int(np.argmax(along)), "x")
    check.number(f"{place}: the length of the deck", np.max(along), least=LENGTHS[0], most=LENGTHS[1],
                 remedy="give metres")


def _order(nodes: Cells, rows: np.ndarray) -> tuple[str, ...]:
    """What is to be said about the nodes, their origin and their order."""
    n, lines, start = *rows.shape, float(np.min(nodes.column("x")))
    told = f"{n} nodes along the deck on {lines} line(s); x is counted from {start:g} m, where they begin"
    behind = np.flatnonzero(np.any(np.diff(rows, axis=0) < 0, axis=1))
    return (told, "nodes were out of order along the deck and have been sorted by x") if behind.size else (told,)


def _shape(nodes: Cells, grid: _Grid, number: int, width: float) -> SampledShape:
    y, weights = grid.lines(width)
    values = {one: nodes.column(f"{one}_{number}")[grid.rows] @ weights.T for one in DIRECTIONS
              if f"{one}_{number}" in nodes.heads}
    most = max(np.max(np.abs(value)) for value in values.values())
    moving = {one: value for one, value in values.items() if np.max(np.abs(value)) > _NOTHING * most}
    try:
        return SampledShape(x=grid.x, y=y, **moving)
    except ValueError as error:
        raise ValueError(f"{nodes.path}, mode {number}: {error}") from None


def _refuse_twins(table: Cells, shapes: list[SampledShape]) -> None:
    """Two modes of one frequency and one shape are one."""
    frequency = table.column("frequency")
    flat = [np.concatenate([np.ravel(shape.vertical), np.ravel(shape.lateral)]) for shape in shapes]
    units = [values / np.linalg.norm(values) for values in flat]
    for i, j in combinations(range(len(shapes)), 2):
        if abs(units[i] @ units[j]) > 1 - _TWIN and abs(frequency[i] / frequency[j] - 1) < _TWIN:
            raise ValueError(f"{table.place(j, 'mode')}: modes must differ, got frequency and shape of mode "
                             f"{_numbers(table)[i]} again; leave one of them out")


def _mode(table: Cells, index: int, shape: SampledShape) -> Mode:
    """A mode whose modal mass belongs to the shape scaled to one."""
    given = "modal_mass" in table.heads
    as_exported = table.column("modal_mass")[index] if given else 1.0
    if not 1e-100 < abs(shape.scale) < 1e100:
        raise ValueError(f"{table.place(index, 'mode')}: the largest value of the shape must be a displacement or "
                         f"1/√kg, got {shape.scale:g}; see to the units of the export")
    name = f"{table.place(index, 'modal_mass')}: modal mass {as_exported:g} / (largest value {abs(shape.scale):g})²"
    modal_mass = check.number(name, as_exported / shape.scale**2, least=MODAL_MASSES[0], most=MODAL_MASSES[1],
                              remedy=_REMEDIES[given])
    return Mode(frequency=table.column("frequency")[index], damping=table.column("damping")[index],
                modal_mass=modal_mass, shape=shape)


def _scaling(table: Cells, index: int, shape: SampledShape, mass: float) -> str:
    """What was inferred about a mode."""
    (x, y), given = shape.antinode, "modal_mass" in table.heads
    as_exported = table.column("modal_mass")[index] if given else 1.0
    how = f"with {as_exported:g} kg" if given else "taken as mass-normalised (1/√kg)"
    modal_mass = as_exported / shape.scale**2
    return (f"{table.path.name}, mode {_numbers(table)[index]}: {abs(shape.scale):g} at its antinode ({x:g}, {y:g}) m, "
            f"{how}; scaled to one: {modal_mass:.0f} kg, {100 * modal_mass / mass:.0f} % of the bridge's mass")

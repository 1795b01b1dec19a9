"""Footbridges described by their modes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, final

import control as ct
import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge.beams import beam_modes
from hsictrl.bridge.deck import Deck
from hsictrl.bridge.mode import Mode
from hsictrl.bridge.plant import block
from hsictrl.bridge.shapes import Shape, SineShape
from hsictrl.bridge.tables import read_modes
from hsictrl.pedestrian import Body, Crowd


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Footbridge(Deck):
    """A footbridge: its modes and its deck.

    The deck reaches from x = 0 to `length` and from y = −`width`/2 to `width`/2; off it every mode
    shape counts as zero.

    Parameters
    ----------
    modes : sequence of Mode
        The modes that are retained.
    length : float
        Length of the deck, L [m].
    width : float
        Walkable width of the deck [m].
    mass : float
        Mass of the whole bridge, to which a crowd's mass ratio refers (eq. 13) [kg].
    remarks : sequence of str
        What was inferred where the bridge was read from tables.
    absorbers : sequence of (Body, (float, float))
        What is fixed to the deck for good, and where, see `with_absorbers`; its mass is not part of `mass` [m].

    Examples
    --------
    >>> bridge = Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=3.25, damping=0.005)
    >>> print(bridge)
    footbridge 50 m × 3 m, 50000 kg
      mode 0: 3.250 Hz, 0.50 %, 25000 kg
    """

    modes: Sequence[Mode]
    length: float
    width: float
    mass: float
    remarks: Sequence[str] = ()
    absorbers: Sequence[tuple[Body, tuple[float, float]]] = ()

    def __post_init__(self) -> None:
        check.store(self, modes=_modes(self.modes), remarks=tuple(self.remarks))
        for name, unit in (("length", "m"), ("width", "m"), ("mass", "kg")):
            check.store(self, **{name: check.number(name, getattr(self, name), above=0, remedy=f"give {unit}")})
        for mode in self.modes:
            if not np.isclose(mode.shape.length, self.length):
                raise ValueError(f"every shape must be as long as the deck, {self.length:g} m, got "
                                 f"{mode.shape.length:g} m; make shape and bridge of one length")
        check.store(self, absorbers=_fixed(self, self.absorbers))

    @classmethod
    def simply_supported(
        cls, *, length: float, width: float, mass: float, frequency: float,
        damping: float | Sequence[float], n_modes: int = 1,
    ) -> Footbridge:
        """Uniform simply supported beam: shapes sin(jπx/L), frequencies j²f₁, modal mass half the mass.

        Parameters
        ----------
        length, width : float
            Length and walkable width of the deck [m].
        mass : float
            Mass of the whole bridge [kg].
        frequency : float
            Fundamental frequency f₁ [Hz].
        damping : float or sequence of float
            Modal damping ratio, one for all modes or one per mode [-].
        n_modes : int
            Number of modes [-].

        Returns
        -------
        Footbridge

        Examples
        --------
        >>> bridge = Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0,
        ...                                      damping=[0.005, 0.01], n_modes=2)
        >>> [mode.frequency for mode in bridge.modes]
        [2.0, 8.0]
        """
        n_modes = check.whole("n_modes", n_modes, least=1, remedy="ask for at least one mode")
        length = check.number("length", length, above=0, remedy="give m")
        shapes = [(float(j**2), SineShape(length, j)) for j in range(1, n_modes + 1)]
        return cls._uniform(shapes, length, width, mass, frequency, damping)

    @classmethod
    def beam(
        cls, *, spans: Sequence[float], width: float, mass: float, frequency: float,
        damping: float | Sequence[float], ends: tuple[str, str] = ("pinned", "pinned"), n_modes: int = 1,
    ) -> Footbridge:
        """Uniform Euler–Bernoulli beam over several spans, on pinned inner supports.

        Parameters
        ----------
        spans : sequence of float
            Lengths of the spans [m].
        width : float
            Walkable width of the deck [m].
        mass : float
            Mass of the whole bridge [kg].
        frequency : float
            Fundamental frequency f₁; the higher ones follow from the beam [Hz].
        damping : float or sequence of float
            Modal damping ratio, one for all modes or one per mode [-].
        ends : (str, str)
            "pinned" or "clamped", at x = 0 and at the far end.
        n_modes : int
            Number of modes [-].

        Returns
        -------
        Footbridge

        Examples
        --------
        >>> bridge = Footbridge.beam(spans=[20.0, 30.0, 20.0], width=3.0, mass=70e3, frequency=2.5,
        ...                          damping=0.005, n_modes=3)
        >>> [round(mode.frequency, 2) for mode in bridge.modes]
        [2.5, 4.71, 5.52]
        """
        shapes = beam_modes(spans, ends=ends, n_modes=n_modes)
        return cls._uniform(shapes, float(np.sum(spans)), width, mass, frequency, damping)

    @classmethod
    def from_csv(cls, shapes: str | Path, *, modes: str | Path, width: float, mass: float) -> Footbridge:
        """Modes of a finite-element model, from a table of nodes and a table of modes.

        Units and scaling are checked; what was inferred stands in `remarks`. The deck reaches from the first
        node to the last.

        Parameters
        ----------
        shapes : str or Path
            CSV with a node in each row, in any order: columns x [m], y if there are several lines of nodes along
            the deck [m], and the components vertical_1, lateral_1, vertical_2, …, of which every mode has one or
            both.
        modes : str or Path
            CSV with a mode in each row: columns mode, the number 1, 2, … behind its components, frequency [Hz],
            damping [-], and modal_mass [kg], which belongs to the shape as it is scaled in `shapes`. Without
            modal_mass all shapes are taken as mass-normalised [1/√kg].
        width : float
            Walkable width of the deck; between lines of nodes and out to its edges shapes are straight [m].
        mass : float
            Mass of the whole bridge [kg].

        Returns
        -------
        Footbridge

        Raises
        ------
        ValueError
            If a table can't be read or holds what no footbridge has; the message names file, row and column.

        Examples
        --------
        >>> import tempfile
        >>> folder = Path(tempfile.mkdtemp())
        >>> rows = [f"{x}, {np.sin(np.pi * x / 50) / np.sqrt(25e3)}" for x in range(51)]
        >>> _ = (folder / "nodes.csv").write_text("\\n".join(["x, vertical_1", *rows]))
        >>> _ = (folder / "modes.csv").write_text("mode, frequency, damping\\n1, 2.0, 0.005")
        >>> bridge = Footbridge.from_csv(folder / "nodes.csv", modes=folder / "modes.csv", width=3.0, mass=50e3)
        >>> print(bridge, *bridge.remarks, sep="\\n")
        footbridge 50 m × 3 m, 50000 kg
          mode 0: 2.000 Hz, 0.50 %, 25000 kg
        51 nodes along the deck on 1 line(s); x is counted from 0 m, where they begin
        modes.csv, mode 1: 0.00632456 at its antinode (25, 0) m, taken as mass-normalised (1/√kg); scaled to one:
        25000 kg, 50 % of the bridge's mass
        """
        width = check.number("width", width, above=0, remedy="give m")
        mass = check.number("mass", mass, above=0, remedy="give kg")
        read = read_modes(Path(shapes), Path(modes), width=width, mass=mass)
        return cls(modes=read.modes, length=read.length, width=width, mass=mass, remarks=read.remarks)

    @classmethod
    def _uniform(
        cls, shapes: Sequence[tuple[float, Shape]], length: float, width: float, mass: float,
        frequency: float, damping: float | Sequence[float],
    ) -> Footbridge:
        """Modes of a beam of uniform mass, from shapes with their frequencies relative to the first."""
        mass = check.number("mass", mass, above=0, remedy="give kg")
        frequency = check.number("frequency", frequency, above=0, remedy="give Hz")
        dampings = _one_per_mode(damping, len(shapes))
        modes = [Mode(frequency=ratio * frequency, damping=float(xi), modal_mass=mass * shape.mean_square, shape=shape)
                 for (ratio, shape), xi in zip(shapes, dampings, strict=True)]
        return cls(modes=modes, length=length, width=width, mass=mass)

    def __str__(self) -> str:
        lines = [f"footbridge {self.length:g} m × {self.width:g} m, {self.mass:.0f} kg"]
        lines += [f"  mode {j}: {mode}" for j, mode in enumerate(self.modes)]
        return "\n".join(lines + [f"  fixed at ({x:g}, {y:g}) m: {body}" for body, (x, y) in self.absorbers])

    @property
    def n_modes(self) -> int:
        """Number of modes n_m [-]."""
        return len(self.modes)

    @property
    def omega(self) -> Array:
        """Natural angular frequencies ω_Bj, shape (n_m,) [rad/s]."""
        return np.array([mode.omega for mode in self.modes])

    @property
    def damping(self) -> Array:
        """Modal damping ratios ξ_Bj, shape (n_m,) [-]."""
        return np.array([mode.damping for mode in self.modes])

    @property
    def fixed(self) -> tuple[Crowd, Array]:
        """Bodies of the `absorbers`, and their places, shape (n, 2) [m]."""
        places = np.array([place for _, place in self.absorbers]).reshape(-1, 2)
        return Crowd.of([body for body, _ in self.absorbers]), places

    def mode(self, index: int) -> Mode:
        """Mode by its index.

        Parameters
        ----------
        index : int
            0 for the first mode [-].

        Returns
        -------
        Mode

        Examples
        --------
        >>> print(reference_bridge(frequency=2.0).mode(0))
        2.000 Hz, 0.50 %, 25000 kg
        """
        index = check.whole("mode", index, least=0, remedy="count modes from 0")
        if index >= self.n_modes:
            raise ValueError(f"mode must be below the number of modes {self.n_modes}, got {index}; "
                             "count modes from 0, or describe the bridge with more of them")
        return self.modes[index]

    def led_by(self, mode: int) -> Footbridge:
        """Put a mode first: the one to whose resonance traffic is tuned, and at whose antinode motion is read.

        Parameters
        ----------
        mode : int
            Index of the mode, from 0 [-].

        Returns
        -------
        Footbridge
            The same bridge; the other modes follow in their order.

        Examples
        --------
        >>> bridge = Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=1.0, damping=0.005,
        ...                                      n_modes=3)
        >>> [mode.frequency for mode in bridge.led_by(1).modes]
        [4.0, 1.0, 9.0]
        """
        first = self.mode(mode)
        return replace(self, modes=[first, *self.modes[:mode], *self.modes[mode + 1:]])

    def moves_vertically(self, mode: int) -> bool:
        """Whether a mode moves vertically at its antinode, so that walking can excite it.

        Parameters
        ----------
        mode : int
            Index of the mode, from 0 [-].

        Returns
        -------
        bool

        Examples
        --------
        >>> reference_bridge(frequency=2.0).moves_vertically(0)
        True
        """
        shape = self.mode(mode).shape
        return bool(np.any(shape(*shape.antinode, "vertical")))

    def participation(self, positions: Any, direction: Any = "vertical", order: int = 0) -> Array:
        """Rows with which points take part in the modes: mass-normalised shapes, zero off the deck.

        Parameters
        ----------
        positions : array_like, shape (n,) or (n, 2)
            Places x, or (x, y) [m].
        direction : str or array of str, shape (n,)
            Direction of the motion at each point, "vertical" or "lateral".
        order : int
            Order of a derivative of the shapes along the deck [-].

        Returns
        -------
        array, shape (n, n_m)
            Rows of Φ, or of its derivative [1/(√kg m^order)].

        Examples
        --------
        >>> reference_bridge(frequency=2.0).participation([0.0, 25.0]).round(6)      # sin(πx/L)/√25 t
        array([[0.      ],
               [0.006325]])
        """
        x, y = check.points("positions", positions).T
        given = check.directions(direction)
        if given.shape not in ((), x.shape):
            raise ValueError(f"direction must be one for all positions or one each, got {given.size} for {len(x)} "
                             "positions; match them")
        moving = {one: self.carries(positions) * (given == one) for one in check.DIRECTIONS if np.any(given == one)}
        return np.column_stack([
            sum((moves * mode.shape.derivative(x, y, one, order) for one, moves in moving.items()), np.zeros(len(x)))
            / np.sqrt(mode.modal_mass) for mode in self.modes])

    def with_crowd_mass(self, mass: float) -> Footbridge:
        """Load the deck evenly with a crowd that is nothing but mass (section 2.4, added mass).

        A modal mass m grows to m + mass · mean φ², and the stiffness stays: a frequency f falls to
        f √(m/(m + mass · mean φ²)). Shapes are kept, which is exact where the bridge's own mass is
        uniform along the deck, and so are damping ratios. φ is taken along the centre line.

        Parameters
        ----------
        mass : float
            Mass of the crowd [kg].

        Returns
        -------
        Footbridge
            The loaded bridge, whose mass includes the crowd's.

        Examples
        --------
        >>> print(reference_bridge(frequency=2.0).with_crowd_mass(150 * 70.0))     # a person per m²
        footbridge 50 m × 3 m, 60500 kg
          mode 0: 1.818 Hz, 0.50 %, 30250 kg
        """
        mass = check.number("mass", mass, least=0, remedy="give kg")
        return replace(self, modes=[_loaded(mode, mass) for mode in self.modes], mass=self.mass + mass)

    def with_absorbers(self, absorbers: Body | Sequence[Body], *, at: Any) -> Footbridge:
        """Fix tuned mass dampers to the deck: whatever is done with the bridge, they are there.

        They are bodies like those of people, and move as little along the deck as standing ones.

        Parameters
        ----------
        absorbers : Absorber or sequence of Absorber
            One per place, or one that is fixed at all of them.
        at : array_like, shape (n,) or (n, 2)
            Places x, or (x, y), on the deck [m].

        Returns
        -------
        Footbridge
            With those that it has already, and these.

        Examples
        --------
        >>> from hsictrl.absorber import Absorber
        >>> print(reference_bridge().with_absorbers(Absorber(mass=500.0, frequency=1.96, damping=0.09), at=[25.0]))
        footbridge 50 m × 3 m, 50000 kg
          mode 0: 2.000 Hz, 0.50 %, 25000 kg
          fixed at (25, 0) m: 500 kg at 1.960 Hz, 9.0 %, vertical
        """
        places = self.on_deck("at", check.points("at", at, least=1)).tolist()
        bodies = [absorbers] * len(places) if isinstance(absorbers, Body) else check.several("absorbers", absorbers)
        if len(bodies) != len(places):
            raise ValueError(f"absorbers and places must be as many, got {len(bodies)} and {len(places)}; give one "
                             "place per absorber")
        return replace(self, absorbers=(*self.absorbers, *zip(bodies, places, strict=True)))

    def ss(
        self, *, at: Any, ports: Sequence[str] = ("y", "v", "a"), name: str = "bridge",
    ) -> ct.StateSpace:
        """Give the bridge, without people, as a block with a vertical port at every given point (eqs. 5–8, 12).

        The outputs are ordered y[0], v[0], a[0], y[1], …, so that bodies put together by
        ``control.append`` close around it with ``control.feedback(plant, bodies, sign=+1)``.

        Parameters
        ----------
        at : array_like, shape (n,) or (n, 2)
            Places x, or (x, y) [m].
        ports : ("y", "v", "a") or ("y", "v")
            Motion given out at every point: displacement [m], velocity [m/s], acceleration [m/s²].
        name : str
            Name of the block.

        Returns
        -------
        control.StateSpace
            Inputs F[i] [N]; outputs y[i], v[i], a[i]; states z[j], dz[j], and u[k], du[k] of absorbers.

        Examples
        --------
        >>> reference_bridge(frequency=2.0).ss(at=[25.0]).output_labels
        ['y[0]', 'v[0]', 'a[0]']
        """
        ports = check.ports(ports)
        rows = self.participation(self.on_deck("at", check.points("at", at, least=1)))
        bodies, places = self.fixed
        own = self.participation(places, bodies.direction)
        return block(self.omega, self.damping, rows, bodies, own, ports, name)


def reference_bridge(*, frequency: float = 2.0, damping: float = 0.005, modal_mass: float = 25e3) -> Footbridge:
    """The paper's reference structure: a simply supported beam of 50 m × 3 m, first mode only (section 3.1).

    Parameters
    ----------
    frequency : float
        Natural frequency f_B, 1 to 6 Hz in the paper [Hz].
    damping : float
        Modal damping ratio ξ_B, 0.002 to 0.02 in the paper [-].
    modal_mass : float
        Modal mass m_B, half of the bridge's; 20 to 50 t in section 4.2 [kg].

    Returns
    -------
    Footbridge

    Examples
    --------
    >>> print(reference_bridge(frequency=3.25))
    footbridge 50 m × 3 m, 50000 kg
      mode 0: 3.250 Hz, 0.50 %, 25000 kg
    """
    modal_mass = check.number("modal_mass", modal_mass, above=0, remedy="give kg")
    return Footbridge.simply_supported(
        length=50.0, width=3.0, mass=2 * modal_mass, frequency=frequency, damping=damping)


def _loaded(mode: Mode, mass: float) -> Mode:
    """A mode that carries an evenly spread mass."""
    modal_mass = mode.modal_mass + mass * mode.shape.mean_square
    return replace(mode, modal_mass=modal_mass, frequency=mode.frequency * float(np.sqrt(mode.modal_mass / modal_mass)))


def _fixed(bridge: Footbridge, absorbers: Any) -> tuple[tuple[Body, tuple[float, float]], ...]:
    remedy = "use with_absorbers(absorbers, at=...)"
    pairs = check.instance("absorbers", absorbers, (list, tuple), remedy)
    for pair in pairs:
        if len(check.instance("absorbers", pair, tuple, remedy)) != 2:
            raise ValueError(f"absorbers must be pairs of a body and its place, got {len(pair)} in one; {remedy}")
    for body, _ in pairs:
        check.instance("absorbers", body, Body, "give an Absorber, or a sequence of Absorber")
    places = bridge.on_deck("absorbers", [place for _, place in pairs] or np.empty((0, 2)))
    return tuple((body, (x, y)) for (body, _), (x, y) in zip(pairs, places.tolist(), strict=True))


def _modes(modes: Any) -> tuple[Mode, ...]:
    modes = tuple(modes) if isinstance(modes, Iterable) else (modes,)
    if not modes:
        raise ValueError("modes must hold at least one Mode, got none; describe the bridge with its modes")
    for mode in modes:
        check.instance("modes", mode, Mode, "give a sequence of Mode")
    return modes


def _one_per_mode(damping: Any, n_modes: int) -> Array:
    ratios = check.numbers("damping", damping, least=0, below=1, remedy=check.PERCENT)
    if ratios.ndim and ratios.shape != (n_modes,):
        raise ValueError(f"damping must be one number or one per mode ({n_modes}), got shape {ratios.shape}; "
                         "match it to n_modes")
    return np.broadcast_to(ratios, n_modes)

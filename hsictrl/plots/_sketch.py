"""Symbols of schematic drawings: a deck, bodies, people, forces and their motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.plots import _canvas as canvas

FORCE, BODY = canvas.colour(4), canvas.colour(0)
PALE = "#CFE3F1"    # the colour of a body, light enough that black text stands on it
TRACE, BAR, CLEAR = 10.0, 3.0, 0.25    # fiftieths of the length of the deck
GAP = (np.nan, np.nan)
# Symbols about a contact point at (0, 0); a body is two units high.
UNSPRUNG = np.array([(-0.5, 0.0), (0.5, 0.0), (0.5, 0.22), (-0.5, 0.22)])
SPRUNG = UNSPRUNG * (1, 4) + (0, 1.3)
SPRING = np.array([(-0.25, 0.22), (-0.25, 0.4), *((-0.25 + 0.13 * (-1)**i, 0.46 + 0.1 * i) for i in range(6)),
                   (-0.25, 1.06), (-0.25, 1.3)])
DAMPER = np.array([(0.25, 0.22), (0.25, 0.55), GAP, (0.12, 0.95), (0.12, 0.55), (0.38, 0.55), (0.38, 0.95), GAP,
                   (0.14, 0.8), (0.36, 0.8), GAP, (0.25, 0.8), (0.25, 1.3)])
LIMBS = np.array([(-0.3, 0.0), (0.0, 0.9), (0.3, 0.0), GAP, (0.0, 0.9), (0.0, 1.55), GAP,
                  (-0.34, 0.95), (0.0, 1.4), (0.34, 0.98)])
HEAD = np.array([(0.18 * np.cos(a), 1.73 + 0.18 * np.sin(a)) for a in np.linspace(0, 2 * np.pi, 40)])
SUPPORT = np.array([(0.0, -0.15), (-0.5, -0.95), (0.5, -0.95)])


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Deck:
    """A bridge in its first mode, drawn on axes whose horizontal coordinate is the place along the deck [m].

    Nothing vertical is to scale: heights are counted from the deflected deck, upwards, in fiftieths of its length.
    """

    ax: Axes
    bridge: Footbridge
    low: float
    high: float
    deflection: float = 2.2

    def __post_init__(self) -> None:
        self.ax.set(xlim=(-3 * self.unit, self.bridge.length + 3 * self.unit), aspect="equal",
                    ylim=(self.low * self.unit, self.high * self.unit))
        self.ax.axis("off")

    @property
    def unit(self) -> float:
        """A fiftieth of the length of the deck [m]."""
        return self.bridge.length / 50

    def at(self, x: ArrayLike, height: ArrayLike = 0.0) -> Array:
        """Coordinates, shape (2, n) or (2,), of places at heights above the deflected deck."""
        deflected = np.asarray(height) - self.deflection * self.bridge.modes[0].shape(x)
        return np.stack(np.broadcast_arrays(np.asarray(x, float), self.unit * deflected))

    def draw(self) -> None:
        """The deflected deck, the line where it rests, and supports at its ends."""
        x = np.linspace(0, self.bridge.length, 201)
        self.ax.plot(x[[0, -1]], [0, 0], color="0.5", linewidth=0.8, linestyle=(0, (6, 3, 1, 3)), zorder=1, gid="rest")
        self.ground(x)
        for end in x[[0, -1]]:
            self.ax.fill(*self._placed(SUPPORT, end, 1.8), facecolor="white", edgecolor=canvas.INK, zorder=3)

    def ground(self, x: Array) -> None:
        """The deck at some places."""
        self.ax.plot(*self.at(x), color=canvas.INK, linewidth=2.4, solid_capstyle="butt", zorder=5, gid="deck")

    def added_mass(self, label: str) -> None:
        """An even mass on the whole deck, hatched."""
        x = np.linspace(0, self.bridge.length, 201)
        self.ax.fill_between(x, self.at(x)[1], self.at(x, 1.6)[1], facecolor=PALE, edgecolor=BODY, hatch="////",
                             linewidth=0.8, zorder=3, gid="added mass")
        self.note(self.bridge.length / 2, 3.8, label, align="center")

    def body(self, x: float, size: float = 3.0) -> None:
        """A sprung and an unsprung mass, with spring and damper in parallel."""
        for block in (UNSPRUNG, SPRUNG):
            self.ax.fill(*self._placed(block, x, size), facecolor=PALE, edgecolor=BODY, linewidth=1.1, zorder=3)
        self.ax.plot(*self._placed(SPRING, x, size), color=BODY, linewidth=1.1, zorder=3, gid="spring")
        self.ax.plot(*self._placed(DAMPER, x, size), color=BODY, linewidth=1.1, zorder=3, gid="damper")

    def person(self, x: float, size: float = 4.0) -> None:
        """A pedestrian, whose two feet count as one contact point."""
        self.ax.plot(*self._placed(LIMBS, x, size), color=canvas.INK, linewidth=1.8, gid="person",
                     solid_capstyle="round", solid_joinstyle="round")
        self.ax.fill(*self._placed(HEAD, x, size), color=canvas.INK, linewidth=0)

    def force(self, x: float, label: str, color: str) -> None:
        """A force on the deck, positive downwards, hung from its contact point."""
        self.arrow(x, 0.0, 4.5, color=color, linewidth=1.8, gid="force")
        self.note(x + 0.8 * self.unit, -3.0, label, color=color)

    def motion(self, x: float, height: float, gid: str) -> None:
        """Something at a height above the deck moves along it."""
        middle, half = self.at(x, height), np.array([1.6 * self.unit, 0.0])
        self._arrow(middle - half, middle + half, color=canvas.INK, linewidth=1.0, gid=gid)

    def trace(self, x: float, signal: Array) -> None:
        """A signal over time, at the height of people; one is as high as the bar of `scale`."""
        places = x + np.linspace(-0.5, 0.5, len(signal)) * TRACE * self.unit
        base = self.at(x, 5.2)[1]
        self.ax.plot(places[[0, -1]], [base, base], color="0.5", linewidth=0.8, gid="zero")
        self.ax.plot(places, base + BAR * self.unit * signal, color=FORCE, linewidth=1.4, gid="trace")

    def scale(self, share: float, along: str, upright: str) -> None:
        """Bars for a share of the length of a trace and for one, in the upper right corner."""
        right, top = self.bridge.length, (self.high - 0.5) * self.unit
        left, bottom = right - share * TRACE * self.unit, top - BAR * self.unit
        self.ax.plot([left, left, right], [top, bottom, bottom], color=canvas.INK, linewidth=1.0, gid="scale")
        self.ax.text(left - 0.5 * self.unit, (top + bottom) / 2, upright, ha="right", va="center", fontsize="small")
        self.ax.text((left + right) / 2, bottom - 0.4 * self.unit, along, ha="center", va="top", fontsize="small")

    def arrow(self, x: float, height: float, length: float, *, color: str, linewidth: float, gid: str) -> None:
        """Something that points down from a height above the deck."""
        self._arrow(self.at(x, height), self.at(x, height - length), color=color, linewidth=linewidth, gid=gid)

    def _arrow(self, tail: Array, tip: Array, *, color: str, linewidth: float, gid: str) -> None:
        look = {"arrowstyle": "-|>", "color": color, "linewidth": linewidth, "shrinkA": 0, "shrinkB": 0,
                "mutation_scale": 7 + 3 * linewidth}
        self.ax.annotate("", xy=tuple(tip), xytext=tuple(tail), arrowprops=look, gid=gid, zorder=4)

    def note(self, x: float, height: float, text: str, *, align: str = "left", color: str = canvas.INK) -> None:
        """Words at a height above the deck."""
        place, level = self.at(x, height)
        self.ax.text(place, level, text, ha=align, va="center", color=color)

    def _placed(self, symbol: Array, x: float, size: float) -> Array:
        """Coordinates of a symbol that stands on the deck, clear of its slope."""
        return size * self.unit * symbol.T + self.at(x, CLEAR)[:, None]

"""A crossing in motion: a deck that deflects under its walkers, and the acceleration so far."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import control as ct
import numpy as np
from matplotlib.animation import FuncAnimation
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.transforms import ScaledTranslation

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import BeamShape, Footbridge
from hsictrl.coupling import MovingCrowd
from hsictrl.plots import _canvas as canvas
from hsictrl.plots.history import one_output

STRETCH = 8.0                # s about the peak; at 25 pictures a second a GIF of it is a few megabytes
PLACES = 201                 # along the deck
DRAWN, ROOM = 0.08, 0.11     # largest deflection and half the height of its panel, in lengths of the deck
DOT = 4.5                    # size of a walker [points]
SUPPORT = [(0.0, 0.0), (-0.6, -1.0), (0.6, -1.0), (0.0, 0.0)]   # a triangle that hangs from its tip


def crossing_animation(
    crowd: MovingCrowd, response: ct.TimeResponseData, *, span: tuple[float, float] | None = None, rate: float = 25.0,
    ax: Sequence[Axes] | np.ndarray | None = None,
) -> FuncAnimation:
    """Show people who cross a bridge in real time: the deck with them on it, and below it the acceleration so far.

    Walkers are dots that ride on the deck. Its deflection is enlarged by a round factor that is written on the
    picture; as everywhere it is positive downwards, and counted from where the deck rests under their weight.

    Parameters
    ----------
    crowd : MovingCrowd
        Who crosses what.
    response : control.TimeResponseData
        One acceleration and the states of the modes, as ``simulate(crowd).response`` [m/s², m √kg, m √kg/s, s].
    span : (float, float), optional
        Start and end of what is shown; eight seconds about the peak if not given [s].
    rate : float
        Pictures per second [1/s].
    ax : array or sequence of matplotlib.axes.Axes, optional
        Two axes; those of a new figure if not given.

    Returns
    -------
    matplotlib.animation.FuncAnimation
        Write it with `save_animation`, or show it in a notebook with its ``to_jshtml()``.

    Raises
    ------
    ValueError
        If the response lacks the states of the modes, or the span leaves its times or holds fewer than two of them.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import hsictrl as hsi
    >>> from hsictrl.plots import save_animation
    >>> from matplotlib.figure import Figure
    >>> walker = hsi.Walker(force=hsi.HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> crowd = hsi.moving_crowd(hsi.reference_bridge(frequency=2.0), hsi.Traffic([walker]))
    >>> animation = crossing_animation(crowd, hsi.simulate(crowd).response, span=(20.0, 20.2), ax=Figure().subplots(2))
    >>> path = Path(tempfile.mkdtemp()) / "crossing.gif"
    >>> save_animation(animation, path)
    >>> path.exists()
    True
    """
    check.instance("crowd", crowd, MovingCrowd, "make it with moving_crowd(bridge, traffic)")
    z = _modal(crowd.bridge, one_output("response", response))
    start, end = _sampled(response, _span(response, span))
    rate = check.number("rate", rate, above=0, remedy="give pictures per second")
    axes = canvas.several_axes(ax, 2, figsize=(8.0, 4.5)).ravel()
    figure = check.instance("figure of ax", axes[0].figure, Figure, "make it with matplotlib.pyplot.subplots(2)")
    scene = _Scene.draw(crowd, response, z, axes, (start, end))
    _hold(figure)
    times = start + np.arange(int((end - start) * rate + 1e-6) + 1) / rate
    return FuncAnimation(figure, scene.show, frames=times, interval=1000 / rate)


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Scene:
    """What changes from picture to picture, and what it shows."""

    crowd: MovingCrowd
    response: ct.TimeResponseData
    z: Array
    ax: Axes
    deck: Line2D
    people: Line2D
    past: Line2D
    now: Line2D

    @classmethod
    def draw(
        cls, crowd: MovingCrowd, response: ct.TimeResponseData, z: Array, axes: np.ndarray, span: tuple[float, float],
    ) -> _Scene:
        """Draw the start of the span on two axes."""
        shown = (response.time >= span[0]) & (response.time <= span[1])
        deck, people = _bridge(axes[0], crowd.bridge, z[:, shown])
        past, now = _history(axes[1], np.ravel(response.outputs)[shown], span)
        scene = cls(crowd=crowd, response=response, z=z, ax=axes[0], deck=deck, people=people, past=past, now=now)
        scene.show(span[0])
        return scene

    def show(self, time: float) -> list[Artist]:
        """Show one instant."""
        z = np.array([np.interp(time, self.response.time, one) for one in self.z])
        persons = self._people(time, z)
        self.deck.set_ydata(_deflection(self.crowd.bridge, np.asarray(self.deck.get_xdata(), dtype=float), z))
        self.ax.set_title(f"{time:.2f} s, {persons} on the deck", loc="left", fontsize="medium")
        self._history(time)
        return [self.deck, self.people, self.past, self.now]

    def _people(self, time: float, z: Array) -> int:
        """Put walkers on the deck; how many there are."""
        places = self.crowd.traffic.walkers.places(time)
        present = places[self.crowd.bridge.carries(places)]
        self.people.set_data(present[:, 0], _deflection(self.crowd.bridge, present, z))
        return len(present)

    def _history(self, time: float) -> None:
        signal, times = np.ravel(self.response.outputs), self.response.time
        past, now = times < time, np.interp(time, times, signal)
        self.past.set_data(np.append(times[past], time), np.append(signal[past], now))
        self.now.set_data([time], [now])


def _bridge(ax: Axes, bridge: Footbridge, z: Array) -> tuple[Line2D, Line2D]:
    """The deck in mm over m, with supports; room and enlargement for these modal displacements."""
    x = np.linspace(0, bridge.length, PLACES)
    factor = _enlargement(bridge.length, float(np.max(np.abs(_deflection(bridge, x, z)))) / 1e3)
    reach = 1e3 * ROOM * bridge.length / factor
    ax.set(xlim=(-0.03 * bridge.length, 1.03 * bridge.length), ylim=(reach, -reach), aspect=factor / 1e3,
           xlabel="Place along the deck [m]", ylabel="Deflection [mm]")
    ax.set_title(f"deflection × {factor:,.0f}".replace(",", " "), loc="right", fontsize="medium")
    ax.axhline(0, color="0.6", linewidth=0.8, linestyle=(0, (6, 3, 1, 3)), zorder=1)
    ax.plot(_supports(bridge), np.zeros_like(_supports(bridge)), linestyle="none", marker=SUPPORT, markersize=18,
            markerfacecolor="white", markeredgecolor=canvas.INK, zorder=3)
    deck, = ax.plot(x, np.zeros_like(x), color=canvas.INK, linewidth=2.4, zorder=4, label="deck")
    on_top = ax.transData + ScaledTranslation(0, (DOT / 2 + 1.2) / 72, ax.figure.dpi_scale_trans)
    people, = ax.plot([], [], "o", color=canvas.colour(4), markersize=DOT, markeredgewidth=0, transform=on_top,
                      zorder=5, label="people")
    return deck, people


def _history(ax: Axes, signal: Array, span: tuple[float, float]) -> tuple[Line2D, Line2D]:
    """The acceleration up to now, with room for all of it."""
    canvas.grid(ax)
    top = 1.1 * float(np.max(np.abs(signal))) or 1.0
    ax.set(xlim=span, ylim=(-top, top), xlabel="Time [s]", ylabel="Acceleration [m/s²]")
    past, = ax.plot([], [], color=canvas.colour(0), linewidth=1.2, label="acceleration")
    now, = ax.plot([], [], "o", color=canvas.colour(0), markeredgecolor=canvas.INK, clip_on=False, zorder=5)
    return past, now


def _hold(figure: Figure) -> None:
    """Lay the figure out once: to do so takes as long as to draw a picture, and axes must stay where they are."""
    figure.draw_without_rendering()
    figure.set_layout_engine("none")


def _deflection(bridge: Footbridge, places: Array, z: Array) -> Array:
    """w(x, t) = Σ φ_j(x) z_j(t)/√m_j [mm]."""
    return 1e3 * bridge.participation(places) @ z if len(places) else np.empty(0)


def _enlargement(length: float, largest: float) -> float:
    """Largest of 1, 2 or 5 times a power of ten by which this deflection still fits its panel [-]."""
    most = DRAWN * length / largest if largest else 1.0
    power = 10.0**np.floor(np.log10(most))
    return float(power * max(step for step in (1, 2, 5) if step * power <= most))


def _supports(bridge: Footbridge) -> Array:
    """Places of the supports, as far as the first mode tells [m]."""
    shape = bridge.modes[0].shape
    return shape.supports if isinstance(shape, BeamShape) else np.array([0.0, bridge.length])


def _modal(bridge: Footbridge, response: ct.TimeResponseData) -> Array:
    """z of all modes, shape (n_m, m)."""
    wanted = (2 * bridge.n_modes, len(response.time))
    found = None if response.x is None else np.reshape(response.x, (-1, len(response.time)))
    if found is None or found.shape != wanted:
        raise ValueError(f"response must hold z and dz of {bridge.n_modes} mode(s), states of shape {wanted}, got "
                         f"{'none' if found is None else found.shape}; give simulate(crowd).response")
    return found[:bridge.n_modes]


def _span(response: ct.TimeResponseData, span: tuple[float, float] | None) -> tuple[float, float]:
    """What is shown, within the times of the response."""
    first, last = float(response.time[0]), float(response.time[-1])
    if span is None:
        peak = float(response.time[np.argmax(np.abs(np.ravel(response.outputs)))])
        start = min(max(peak - STRETCH / 2, first), max(last - STRETCH, first))
        return start, min(start + STRETCH, last)
    ends = check.numbers("span", span, ndim=1, remedy="give (start, end) in s")
    if len(ends) != 2 or not first <= ends[0] < ends[1] <= last:
        raise ValueError(f"span must be (start, end) within {first:g} to {last:g} s, got {tuple(ends.tolist())}; "
                         "choose times of the response")
    return float(ends[0]), float(ends[1])


def _sampled(response: ct.TimeResponseData, span: tuple[float, float]) -> tuple[float, float]:
    """The same span if the response has samples in it."""
    samples = np.count_nonzero((response.time >= span[0]) & (response.time <= span[1]))
    if samples < 2:
        raise ValueError(f"span must hold at least two samples of the response, got {samples} from {span[0]:g} to "
                         f"{span[1]:g} s; widen it")
    return span

"""Mode shapes along a deck, and places on it."""

from __future__ import annotations

from collections.abc import Mapping

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import DIRECTIONS, Array
from hsictrl.bridge import Footbridge, Mode
from hsictrl.plots import _canvas as canvas

MARKERS = ("o", "s", "^", "D", "v", "P", "X")


def modes_plot(
    bridge: Footbridge, places: Mapping[str, ArrayLike], *, ax: np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw the mode shapes of a bridge along its deck, over a plan with places on it (fig. 5).

    Parameters
    ----------
    bridge : Footbridge
        The bridge.
    places : mapping of str to array_like, shape (n,) or (n, 2)
        Places x, or (x, y), on the deck by their label [m].
    ax : array of matplotlib.axes.Axes, optional
        One axes per mode, and one for the plan; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        One row per mode, with the shape at the edge y = B/2, vertical and lateral where it is not zero; then the plan.

    Raises
    ------
    ValueError
        If there is no place, one lies off the deck, or `ax` holds more or fewer axes.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> plot = modes_plot(hsi.eeklo_bridge(), {"midspan": [(21.0, 0.0)]}, ax=Figure().subplots(3, 1))
    >>> [[line.get_label() for line in panel] for panel in plot.lines[:, 0]]
    [['vertical, at the edge', 'lateral'], ['vertical, at the edge'], ['midspan']]
    """
    check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
    held = check.entries("places", places, "label", "give {label: [(x, y), ...]}")
    found = {label: bridge.on_deck(f"places[{label!r}]", one) for label, one in held.items()}
    axes = canvas.several_axes(ax, bridge.n_modes + 1, figsize=(9.0, 2.1 * (bridge.n_modes + 1)), sharey=False)
    drawn = [_shape(one, bridge, mode) for one, mode in zip(axes.flat, bridge.modes, strict=False)]
    drawn.append(_plan(axes.flat[-1], bridge, found))
    canvas.head(axes.flat, [*(f"Mode {j}: {mode}" for j, mode in enumerate(bridge.modes)), "Plan"])
    axes.flat[-1].set_xlabel("Place along the deck $x$ [m]")
    return canvas.control_plot(drawn, axes, [_legend(one, lines) for one, lines in zip(axes.flat, drawn, strict=True)])


def _shape(ax: Axes, bridge: Footbridge, mode: Mode) -> list[Line2D]:
    """The shape in each direction in which it moves."""
    canvas.grid(ax)
    x = np.linspace(0.0, bridge.length, 201)
    values = [mode.shape(x, bridge.width / 2, direction) for direction in DIRECTIONS]
    ax.axhline(0.0, color="0.5", linewidth=0.8)
    ax.set_ylabel(r"$\phi$ [-]")
    names = {"vertical": "vertical, at the edge", "lateral": "lateral"}
    return [ax.plot(x, one, label=names[direction], **canvas.style(i))[0]
            for i, (direction, one) in enumerate(zip(DIRECTIONS, values, strict=True)) if np.any(one)]


def _plan(ax: Axes, bridge: Footbridge, places: dict[str, Array]) -> list[Line2D]:
    """The deck from above, and the places on it."""
    ax.axhspan(-bridge.width / 2, bridge.width / 2, facecolor="0.96", edgecolor=canvas.INK)
    ax.axhline(0.0, color="0.5", linewidth=0.8, linestyle=(0, (6, 3, 1, 3)))
    ax.set(xlim=(0.0, bridge.length), ylim=(-0.7 * bridge.width, 0.7 * bridge.width), ylabel="$y$ [m]")
    return [ax.plot(*one.T, linestyle="none", marker=MARKERS[i % len(MARKERS)], color=canvas.colour(i), label=label,
                    clip_on=False)[0] for i, (label, one) in enumerate(places.items())]


def _legend(ax: Axes, lines: list[Line2D]) -> Legend:
    return canvas.legend_above(ax, [[line] for line in lines])

"""Schematic drawings of what is modelled, made from the objects that model it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.crowd import Traffic, Walkers
from hsictrl.pedestrian import Pedestrian
from hsictrl.plots import _canvas as canvas
from hsictrl.plots._sketch import BODY, FORCE, PALE, Deck

SHOWN, NEWTONS = 1.5, 500.0    # a walking force is shown for so many seconds, to a scale with a bar of so many newtons
SCENE = ("forces_at_m", "forces_move", "added_mass_kg", "bodies_at_m", "bodies_move")


def contact_force_plot(
    bridge: Footbridge, traffic: Traffic, *, time: float, ax: np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw how contact forces are decomposed: body, walkers, their forces on rigid ground, bodies alone (fig. 1).

    The deck is deflected in the first mode, with supports at its ends, and places are those of the walkers. Walking
    forces are traces of 1.5 s to one scale, upwards for a force that points downwards; nothing else is to scale.

    Parameters
    ----------
    bridge : Footbridge
        The bridge.
    traffic : Traffic
        Who walks over it; a handful is clearest. The body in panel (a) is that of the first walker on the deck.
    time : float
        The instant that is shown, in the middle of the traces [s].
    ax : array of matplotlib.axes.Axes, optional
        Two rows of two axes; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Two rows of two panels.

    Raises
    ------
    ValueError
        If nobody is on the deck, or `ax` holds more or fewer than four axes.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> walker = hsi.Walker(force=hsi.HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    >>> plot = contact_force_plot(hsi.reference_bridge(), hsi.Traffic([walker]), time=20.0, ax=Figure().subplots(2, 2))
    >>> plot.axes[0, 1].get_title("left")
    '(b) Contact force $p_p = p_F + p_H$'
    """
    walkers, x = _on_deck(bridge, traffic, time)
    axes = canvas.several_axes(ax, 2, figsize=(10.0, 5.2), columns=2)
    decks = [Deck(ax=one, bridge=bridge, low=-9.0, high=13.5) for one in axes.flat]
    _large_body(replace(decks[0], deflection=0.0), walkers[0].body)
    _contact(decks[1], x)
    _fixed_driver(decks[2], x, walkers, time)
    _interaction(decks[3], x)
    canvas.head(axes.flat, ["Human body model", "Contact force $p_p = p_F + p_H$",
                            "Fixed-driver term $p_F$, as on rigid ground",
                            "Interaction term $p_H$, bodies without driver"])
    return canvas.control_plot([one.lines for one in axes.flat], axes, [None] * axes.size)


def models_plot(
    bridge: Footbridge, panels: Mapping[str, Mapping[str, Any]], *, ax: np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw what models put on a bridge: forces, and what stands for the crowd, at rest or in motion (fig. 2).

    The deck is deflected in the first mode, and places are as given; nothing else is to scale.

    Parameters
    ----------
    bridge : Footbridge
        The bridge.
    panels : mapping of str to mapping
        For the title of each panel, "forces_at_m" and "bodies_at_m", places along the deck, "forces_move" and
        "bodies_move", whether they do, and "added_mass_kg", the mass spread over the deck [m, kg].
    ax : array of matplotlib.axes.Axes, optional
        Rows of two axes, of which the last is for the key; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Rows of two panels, each panel with its lines; the legend is the key.

    Raises
    ------
    ValueError
        If there is no panel, a panel lacks a key, a place lies off the deck, or `ax` holds more or fewer axes.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> moving = {"forces_at_m": [10.0, 30.0], "forces_move": True, "added_mass_kg": 140.0,
    ...           "bodies_at_m": [], "bodies_move": False}
    >>> plot = models_plot(hsi.reference_bridge(), {"added mass": moving}, ax=Figure().subplots(1, 2))
    >>> [text.get_text() for text in plot.axes[0, 0].texts if text.get_text()]
    ['140 kg']
    """
    check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
    check.entries("panels", panels, "panel", "give {title: {...}}")
    scenes = {title: _checked(bridge, f"panels[{title!r}]", scene) for title, scene in panels.items()}
    rows = len(scenes) // 2 + 1
    axes = canvas.several_axes(ax, rows, figsize=(10.0, 2.2 * rows), columns=2)
    for one, scene in zip(axes.flat, scenes.values(), strict=False):
        _scene(Deck(ax=one, bridge=bridge, low=-8.5, high=9.0), scene)
    canvas.head(axes.flat, scenes)
    for spare in axes.flat[len(scenes):]:
        spare.axis("off")
    return canvas.control_plot([one.lines for one in axes.flat], axes, [*[None] * (axes.size - 1), _key(axes.flat[-1])])


def _scene(deck: Deck, scene: Mapping[str, Any]) -> None:
    """One panel of figure 2."""
    deck.draw()
    if scene["added_mass_kg"]:
        deck.added_mass(f"{scene['added_mass_kg']:g} kg")
    for x in scene["bodies_at_m"]:
        deck.body(x)
    for x in scene["forces_at_m"]:
        deck.force(x, "", FORCE)
    _moving(deck, scene["bodies_at_m"] if scene["bodies_move"] else (), 8.0, "body motion")
    _moving(deck, scene["forces_at_m"] if scene["forces_move"] else (), -5.6, "force motion")


def _moving(deck: Deck, places: Iterable[float], height: float, gid: str) -> None:
    for x in places:
        deck.motion(x, height, gid)


def _key(ax: Axes) -> Legend:
    """What the symbols of figure 2 stand for."""
    handles = [_symbol(r"$\downarrow$", FORCE, "fixed-driver term $p_F$ of a walker"),
               _symbol(r"$\rightarrow$", canvas.INK, "moves along the deck"),
               Patch(facecolor=PALE, edgecolor=BODY, hatch="////", label="evenly distributed crowd mass"),
               _symbol("s", PALE, "human body model", edge=BODY)]
    return ax.legend(handles=handles, loc="center", frameon=False, labelspacing=0.9)


def _symbol(marker: str, color: str, label: str, edge: str = "none") -> Line2D:
    return Line2D([], [], linestyle="none", marker=marker, markersize=13, color=color, markeredgecolor=edge,
                  label=label)


def _large_body(deck: Deck, body: Pedestrian) -> None:
    """Panel (a) of figure 1: the body and its numbers, beside what they belong to."""
    x, size, unit = deck.bridge.length / 2, 6.0, deck.unit
    deck.ground(np.array([x - 5 * unit, x + 5 * unit]))
    deck.body(x, size)
    for height, text in (
        (1.75, rf"$m_{{H1}}$ = {body.sprung_mass:.1f} kg"),
        (0.82, rf"$c_{{H1}}$ = {body.damping_coefficient:.0f} N s/m"),
        (0.15, rf"$m_{{H0}}$ = {body.unsprung_mass:.1f} kg"),
    ):
        deck.note(x + 5.4 * unit, height * size, text)
    deck.note(x - 4.4 * unit, 0.82 * size, rf"$k_{{H1}}$ = {body.stiffness / 1e3:.1f} kN/m", align="right")
    deck.note(x, -4.6, rf"$f_{{H1}}$ = {body.frequency:.2f} Hz, $\xi_{{H1}}$ = {100 * body.damping:.0f} %",
              align="center")
    for height, name in ((1.75 * size, "$u_{H1}$"), (0.0, "$u_B$")):
        _displacement(deck, x - 5.4 * unit, height, name)


def _displacement(deck: Deck, x: float, height: float, name: str) -> None:
    """A displacement from a height on, positive downwards."""
    deck.arrow(x, height, 3.0, color=canvas.INK, linewidth=1.0, gid="displacement")
    deck.note(x - 0.8 * deck.unit, height - 1.5, name, align="right")


def _contact(deck: Deck, places: Array) -> None:
    """Panel (b) of figure 1: who walks, and the whole force."""
    deck.draw()
    for x in places:
        deck.person(x)
        deck.force(x, "$p_p$", canvas.INK)
        deck.motion(x, 9.0, "motion")


def _fixed_driver(deck: Deck, places: Array, walkers: Walkers, time: float) -> None:
    """Panel (c) of figure 1: forces that act whether the deck moves or not, and how they go on in time."""
    deck.draw()
    times = np.linspace(time - SHOWN / 2, time + SHOWN / 2, 301)
    for who, force in walkers.lines():
        for k, signal in zip(who, force.at(times), strict=True):
            deck.trace(places[k], signal / NEWTONS)
    for x in places:
        deck.force(x, "$p_F$", FORCE)
        deck.motion(x, -5.6, "motion")
    deck.scale(0.5 / SHOWN, "0.5 s", f"{NEWTONS:g} N")


def _interaction(deck: Deck, places: Array) -> None:
    """Panel (d) of figure 1: bodies that are moved by the deck alone."""
    deck.draw()
    for x in places:
        deck.body(x, 3.6)
        deck.force(x, "$p_H$", BODY)
        deck.motion(x, 9.0, "motion")


def _on_deck(bridge: Footbridge, traffic: Traffic, time: float) -> tuple[Walkers, Array]:
    """Walkers on the deck at an instant, and where they are along it."""
    check.instance("bridge", bridge, Footbridge, "describe the bridge by its modes")
    check.instance("traffic", traffic, Traffic, "make it with Traffic([walker])")
    places = traffic.walkers.places(check.number("time", time, remedy="give s"))
    present = bridge.carries(places)
    if not np.any(present):
        raise ValueError(f"time must be an instant with somebody on the deck, got {time:g} s; choose another")
    return traffic.walkers.part(present), places[present, 0]


def _checked(bridge: Footbridge, name: str, scene: Mapping[str, Any]) -> Mapping[str, Any]:
    for key in SCENE:
        if key not in check.instance(name, scene, Mapping, "give {'forces_at_m': [...], ...}"):
            raise ValueError(f"{name} must hold {', '.join(map(repr, SCENE))}, got no {key!r}; give all")
    for key in ("forces_at_m", "bodies_at_m"):
        along = check.numbers(f"{name}[{key!r}]", scene[key], ndim=1, remedy="give a list of x [m]")
        bridge.on_deck(f"{name}[{key!r}]", along)
    for key in ("forces_move", "bodies_move"):
        check.instance(f"{name}[{key!r}]", scene[key], (bool, np.bool_), "give True or False")
    check.number(f"{name}['added_mass_kg']", scene["added_mass_kg"], least=0, remedy="give kg, 0 for none")
    return scene

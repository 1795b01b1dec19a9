"""A quantity over two axes, as contours."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal

import control as ct
import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.contour import ContourSet
from matplotlib.legend import Legend
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Affine2D
from numpy.typing import ArrayLike
from scipy.spatial import KDTree

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.plots import _canvas as canvas

COLOURS = "viridis"     # lightness rises evenly, so that it survives print in grey and colour-blindness
UNKNOWN: dict[str, Any] = {"facecolor": "0.93", "edgecolor": "0.6", "hatch": "////"}
BANDS = 10              # at most, where no levels are given
NAMED = 20              # pieces of lines in a panel, at most
FEW = 6                 # as many rows are named at the vertical axis one by one
REMEDY = "give {title: array of shape (len(y), len(x))}"


def map_plot(
    x: ArrayLike, y: ArrayLike, panels: Mapping[str, ArrayLike], *, quantity: str, levels: ArrayLike | None = None,
    xlabel: str = "Frequency $f_B$ [Hz]", ylabel: str = "Modal mass $m_B$ [t]", columns: int | None = None,
    ax: Sequence[Axes] | np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw maps of a quantity over two axes, a panel each: contours on one colour scale (fig. 9 to 11).

    Parameters
    ----------
    x : array_like, shape (n,)
        At least two values along the horizontal axis, increasing [unit of `xlabel`].
    y : array_like, shape (m,)
        At least two values along the vertical axis, increasing [unit of `ylabel`].
    panels : mapping of str to array_like, shape (m, n)
        For the title of each panel, the quantity at every y and x; nan where it is not known, and the fields around
        it are hatched [unit of the quantity].
    quantity : str
        What the colours show, with its unit in brackets.
    levels : array_like, optional
        At least two levels of the contours, increasing; a few round ones over the range of all panels if not given
        [unit of the quantity].
    xlabel, ylabel : str
        Names of the axes, with their units in brackets.
    columns : int, optional
        Number of panels side by side; that of `ax` if it is a table of axes, otherwise the largest up to five that
        leaves no gap [-].
    ax : array or sequence of matplotlib.axes.Axes, optional
        As many axes as there are panels; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Its lines are, per panel, the filled contours and then the contour lines, if any level lies within the
        panel's values.

    Raises
    ------
    ValueError
        If there is no panel, a panel has another shape, nothing is known, axes or levels do not increase, panels do
        not fill their rows, or `ax` holds more or fewer axes.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> found = {"0.2 /m²": [[1.0, 3.0], [0.5, 1.5]], "1.0 /m²": [[2.0, 4.0], [1.0, 2.0]]}
    >>> plot = map_plot([1.0, 2.0], [20.0, 50.0], found, quantity="Peak acceleration [m/s²]", levels=[0, 1, 2, 3, 4],
    ...                 ax=Figure().subplots(1, 2))
    >>> [contours.levels.tolist() for _, contours in plot.lines[0]]     # those within the values of the panel
    [[1.0, 2.0], [2.0, 3.0]]
    """
    check.instance("quantity", quantity, str, "give a name and a unit, such as 'Peak acceleration [m/s²]'")
    across = check.increasing("x", x, remedy="sort them, and the columns of the panels with them")
    along = check.increasing("y", y, remedy="sort them, and the rows of the panels with them")
    fields = _fields(panels, (len(along), len(across)))
    scale = _scale(np.concatenate([one.compressed() for one in fields.values()]), levels)
    axes = _axes(ax, len(fields), columns)
    drawn = [_panel(one, across, along, field, scale) for one, field in zip(axes.flat, fields.values(), strict=True)]
    _name(axes, fields, xlabel, ylabel)
    axes.flat[0].figure.colorbar(drawn[0][0], ax=list(axes.flat), label=quantity, pad=0.02)
    return canvas.control_plot(drawn, axes, _legends(axes, fields.values()))


def _panel(ax: Axes, x: Array, y: Array, field: np.ma.MaskedArray, scale: dict[str, Any]) -> list[ContourSet]:
    if np.ma.is_masked(field):
        ax.patch.set(**UNKNOWN)
    filled = ax.contourf(x, y, field, **scale)
    ax.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    if len(y) <= FEW:
        ax.set_yticks(y, [f"{one:g}" for one in y])
    return [filled, *_lines(ax, x, y, field, scale)]


def _lines(ax: Axes, x: Array, y: Array, field: np.ma.MaskedArray, scale: dict[str, Any]) -> list[ContourSet]:
    """Named lines at the levels that the field crosses, if there are any."""
    known = field.compressed()
    crossed = [level for level in scale["levels"] if np.any(known < level) and np.any(known > level)]
    if not crossed:
        return []
    lines = ax.contour(x, y, field, levels=crossed, linewidths=0.8,
                       colors=[_readable(scale["cmap"](scale["norm"](level))) for level in crossed])
    lines.clabel(fontsize="x-small", fmt="%g", manual=_places(lines, ax))
    return [lines]


def _places(lines: ContourSet, ax: Axes) -> list[tuple[float, float]]:
    """Where to name the longest pieces of the lines, clear of all else; matplotlib's own choice lets names meet."""
    points = ax.transData + Affine2D().scale(72 / ax.figure.dpi)
    frame = points.transform([(ax.viewLim.x0, ax.viewLim.y0), (ax.viewLim.x1, ax.viewLim.y1)])
    pieces = sorted((_close(points.transform(one)) for level in lines.allsegs for one in level if len(one)),
                    key=len, reverse=True)
    placed = np.empty((0, 2))
    for i, piece in enumerate(pieces[:NAMED]):
        room = _room(piece, [*pieces[:i], *pieces[i + 1:]], placed, frame)
        if room.max() >= 1:
            placed = np.vstack([placed, piece[room.argmax()]])
    return [tuple(one) for one in points.inverted().transform(placed)]


def _room(piece: Array, others: list[Array], placed: Array, frame: Array) -> Array:
    """Distance to other lines, names and the frame, over that which a name needs."""
    lines = np.concatenate([np.empty((0, 2)), *others])
    edges = np.abs(piece[:, None] - frame).min(axis=(1, 2))
    return np.min([_distance(piece, lines) / 5, _distance(piece, placed) / 22, edges / 12], axis=0)     # all in pt


def _close(corners: Array) -> Array:
    """Points of a polygon every 2 pt or so, at least its ends."""
    along = np.concatenate([[0.0], np.hypot(*np.diff(corners, axis=0).T).cumsum()])
    at = np.linspace(0.0, along[-1], 2 + int(along[-1] / 2))
    return np.column_stack([np.interp(at, along, one) for one in corners.T])


def _distance(points: Array, others: Array) -> Array:
    """From each point to the nearest of the others."""
    return np.asarray(KDTree(others).query(points)[0])


def _readable(fill: tuple[float, ...]) -> str:
    """White over what is dark, nearly black over what is light."""
    return "white" if np.dot(fill[:3], (0.299, 0.587, 0.114)) < 0.5 else canvas.INK


def _name(axes: np.ndarray, titles: Iterable[str], xlabel: str, ylabel: str) -> None:
    """Titles of all panels; names and numbers of the axes at the outer ones only."""
    canvas.head(axes.flat, titles)
    for ax in axes[-1]:
        ax.set_xlabel(xlabel)
    for ax in axes[:, 0]:
        ax.set_ylabel(ylabel)
    for ax in axes[:-1].flat:
        ax.tick_params(labelbottom=False)
    for ax in axes[:, 1:].flat:
        ax.tick_params(labelleft=False)


def _legends(axes: np.ndarray, fields: Iterable[np.ma.MaskedArray]) -> list[Legend | None]:
    """One for the figure, if something is not known."""
    if not any(map(np.ma.is_masked, fields)):
        return [None] * axes.size
    legend = axes.flat[0].figure.legend(handles=[Patch(**UNKNOWN, label="not known")], loc="outside upper right",
                                        frameon=False, fontsize="small")
    return [legend, *[None] * (axes.size - 1)]


def _scale(known: Array, levels: ArrayLike | None) -> dict[str, Any]:
    """Levels and colours that all panels share; each band differs by as much from the next."""
    if not known.size:
        raise ValueError(f"panels must hold at least one number, got only nan; {REMEDY}")
    low, high = float(known.min()), float(known.max())
    chosen = _round(low, high) if levels is None else check.increasing(
        "levels", levels, remedy="give them from low to high")
    extend, cmap = _open_ends(low < chosen[0], high > chosen[-1]), mpl.colormaps[COLOURS]
    return {"levels": chosen, "extend": extend, "cmap": cmap, "norm": BoundaryNorm(chosen, cmap.N, extend=extend)}


def _open_ends(below: bool, above: bool) -> Literal["neither", "min", "max", "both"]:
    """Whether the scale goes on beyond its levels."""
    if below:
        return "both" if above else "min"
    return "max" if above else "neither"


def _round(low: float, high: float) -> Array:
    """A few round levels, spread about a value that is the same everywhere."""
    about = 0.1 * abs(high) or 0.1
    ends = (low, high) if high - low > 1e-6 * about else (low - about, high + about)
    return np.asarray(MaxNLocator(BANDS, steps=[1, 2, 2.5, 5, 10]).tick_values(*ends))


def _axes(ax: Sequence[Axes] | np.ndarray | None, n: int, columns: int | None) -> np.ndarray:
    columns = _columns(ax, n) if columns is None else columns
    rows = canvas.rows(n, columns)
    width = min(max(2.6, 12.0 / columns), 4.6)
    size = (width * columns + 1.0, 0.78 * width * rows + 0.4)
    return canvas.several_axes(ax, rows, figsize=size, columns=columns, sharey=False)


def _columns(ax: Sequence[Axes] | np.ndarray | None, n: int) -> int:
    """Those of a table of axes, otherwise as many as leave no gap."""
    if isinstance(ax, np.ndarray) and ax.ndim == 2 and ax.size == n:
        return ax.shape[1]
    return max(one for one in range(1, 6) if n % one == 0)


def _fields(panels: Mapping[str, ArrayLike], shape: tuple[int, int]) -> dict[str, np.ma.MaskedArray]:
    """The panels by their titles, each checked; what is not known is masked."""
    held = check.entries("panels", panels, "panel", REMEDY)
    fields = {title: check.known(f"panels[{title!r}]", values, remedy=REMEDY) for title, values in held.items()}
    for title, field in fields.items():
        if field.shape != shape:
            raise ValueError(f"panels[{title!r}] must have shape {shape}, got {field.shape}; {REMEDY}")
    return fields

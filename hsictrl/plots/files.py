"""Plots and animations as files."""

from __future__ import annotations

import io
import os
from collections.abc import Callable
from pathlib import Path

import control as ct
import matplotlib.pyplot as plt
from matplotlib.animation import FuncAnimation, writers
from matplotlib.backend_bases import FigureCanvasBase

from hsictrl import _checks as check

WRITERS = {"gif": "pillow", "mp4": "ffmpeg"}


def file_endings() -> tuple[str, ...]:
    """Endings of files into which a plot can be saved.

    Returns
    -------
    tuple of str
        Without the dot.

    Examples
    --------
    >>> {"pdf", "png", "svg"} <= set(file_endings())
    True
    """
    return tuple(sorted(FigureCanvasBase.get_supported_filetypes()))


def save(plot: ct.ControlPlot, path: str | os.PathLike[str]) -> None:
    """Write the figure of a plot into a file and close it.

    Parameters
    ----------
    plot : control.ControlPlot
        What a plotting function returned.
    path : str or pathlib.Path
        The file; its ending chooses the format.

    Examples
    --------
    >>> import tempfile
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.plots import frf_plot
    >>> from hsictrl.resonance import frf
    >>> path = Path(tempfile.mkdtemp()) / "frf.png"
    >>> save(frf_plot(frf(reference_bridge(), [1.0, 2.0, 3.0])), path)
    >>> path.exists()
    True
    """
    plot.figure.savefig(_path(path), dpi=150)
    plt.close(plot.figure)


def svg(plot: ct.ControlPlot, *, size: tuple[float, float]) -> str:
    """Draw the figure of a plot as SVG, the same text for the same plot, and close it.

    Parameters
    ----------
    plot : control.ControlPlot
        What a plotting function returned.
    size : (float, float)
        Width and height of the figure [in].

    Returns
    -------
    str
        The document.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.plots import frf_plot
    >>> from hsictrl.resonance import frf
    >>> "<svg" in svg(frf_plot(frf(reference_bridge(), [1.0, 2.0, 3.0])), size=(6.0, 3.4))
    True
    """
    drawn = io.StringIO()
    plot.figure.set_size_inches(size)
    with plt.rc_context({"svg.hashsalt": "hsictrl"}):       # identifiers in the document are random without
        plot.figure.savefig(drawn, format="svg", metadata={"Date": None})
    plt.close(plot.figure)
    return drawn.getvalue()


def animation_endings() -> tuple[str, ...]:
    """Endings of files into which an animation can be saved on this machine.

    Returns
    -------
    tuple of str
        Without the dot; mp4 is among them where ffmpeg is installed.

    Examples
    --------
    >>> "gif" in animation_endings()
    True
    """
    return tuple(ending for ending, writer in WRITERS.items() if writers.is_available(writer))


def save_animation(
    animation: FuncAnimation, path: str | os.PathLike[str], *,
    after_each: Callable[[int, int], object] | None = None,
) -> None:
    """Write an animation into a file, at the rate for which it was made, and close its figure.

    Parameters
    ----------
    animation : matplotlib.animation.FuncAnimation
        What `crossing_animation` returned.
    path : str or pathlib.Path
        The file; its ending chooses the format.
    after_each : callable, optional
        Called after each picture with its index and the number of pictures.

    Raises
    ------
    ValueError
        If no writer on this machine knows the ending.

    Examples
    --------
    >>> import tempfile
    >>> from matplotlib.figure import Figure
    >>> figure = Figure(figsize=(2.0, 1.0))
    >>> path = Path(tempfile.mkdtemp()) / "empty.gif"
    >>> save_animation(FuncAnimation(figure, lambda time: [], frames=3), path)
    >>> path.exists()
    True
    """
    file = _path(path)
    ending = check.choice("ending of the file", file.suffix.lstrip("."), animation_endings())
    animation.save(file, writer=WRITERS[ending], dpi=100, progress_callback=after_each)
    plt.close(animation._fig)  # type: ignore[attr-defined]  # it has no public name


def _path(path: str | os.PathLike[str]) -> Path:
    return Path(check.instance("path", path, (str, os.PathLike), "give the name of a file"))

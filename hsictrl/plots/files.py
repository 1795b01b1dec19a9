"""Plots as files."""

from __future__ import annotations

from pathlib import Path

import control as ct
import matplotlib.pyplot as plt
from matplotlib.backend_bases import FigureCanvasBase


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


def save(plot: ct.ControlPlot, path: Path) -> None:
    """Write the figure of a plot into a file and close it.

    Parameters
    ----------
    plot : control.ControlPlot
        What a plotting function returned.
    path : pathlib.Path
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
    plot.figure.savefig(path, dpi=150)
    plt.close(plot.figure)

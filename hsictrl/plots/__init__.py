"""Draws results on given axes, and computes nothing; the only room that imports matplotlib.

Every function returns a `control.ControlPlot` with the lines, axes, figure and legends it drew. Colours are those
of Okabe and Ito; line styles differ too, so that pictures survive print. Legends stand above the axes, at the
right, and leave the place at the left to a title: ``ax.set_title("...", loc="left")``. Figures made here stay open
in pyplot: close them with ``matplotlib.pyplot.close(plot.figure)``.
"""

from hsictrl.plots.bars import bars_plot
from hsictrl.plots.composed import assessment_figure
from hsictrl.plots.convergence import convergence_plot
from hsictrl.plots.effective_map import effective_map_plot, effective_panels
from hsictrl.plots.files import file_endings, save
from hsictrl.plots.frequency import frf_plot, normalised_frf_plot
from hsictrl.plots.history import response_plot
from hsictrl.plots.schematic import contact_force_plot, models_plot

__all__ = [
    "assessment_figure", "bars_plot", "contact_force_plot", "convergence_plot", "effective_map_plot",
    "effective_panels", "file_endings", "frf_plot", "models_plot", "normalised_frf_plot", "response_plot", "save",
]

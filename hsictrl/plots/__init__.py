"""Draws results on given axes, and computes nothing; the only room that imports matplotlib.

Every function returns a `control.ControlPlot` with the lines, axes, figure and legends it drew. Colours are those
of Okabe and Ito; line styles differ too, so that pictures survive print; those of maps grow lighter evenly. Legends
stand above the axes, at the right, and leave the place at the left to a title: ``ax.set_title("...", loc="left")``.
Figures made here stay open in pyplot: close them with ``matplotlib.pyplot.close(plot.figure)``.
"""

from hsictrl.plots.animation import crossing_animation
from hsictrl.plots.bands import bands_plot
from hsictrl.plots.bars import bars_plot
from hsictrl.plots.composed import assessment_figure, simulation_figure
from hsictrl.plots.convergence import convergence_plot
from hsictrl.plots.decay import decay_plot
from hsictrl.plots.effective_map import effective_map_plot, effective_panels
from hsictrl.plots.files import animation_endings, file_endings, save, save_animation, svg
from hsictrl.plots.frequency import frf_plot, normalised_frf_plot
from hsictrl.plots.history import persons_plot, response_plot
from hsictrl.plots.loop import nyquist_plot, sensitivity_plot
from hsictrl.plots.maps import map_plot
from hsictrl.plots.modes import modes_plot
from hsictrl.plots.poles import pole_scatter_plot, root_locus_plot
from hsictrl.plots.schematic import contact_force_plot, models_plot
from hsictrl.plots.spectrum import spectrum_plot

__all__ = [
    "animation_endings", "assessment_figure", "bands_plot", "bars_plot", "contact_force_plot", "convergence_plot",
    "crossing_animation", "decay_plot", "effective_map_plot", "effective_panels", "file_endings", "frf_plot",
    "map_plot", "models_plot", "modes_plot", "normalised_frf_plot", "nyquist_plot", "persons_plot", "pole_scatter_plot",
    "response_plot", "root_locus_plot", "save", "save_animation", "sensitivity_plot", "simulation_figure",
    "spectrum_plot", "svg",
]

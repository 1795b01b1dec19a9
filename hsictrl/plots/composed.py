"""Figures composed of the other plots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import control as ct
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from hsictrl.plots import _canvas as canvas
from hsictrl.plots.convergence import convergence_plot
from hsictrl.plots.frequency import frf_plot
from hsictrl.plots.history import persons_plot, response_plot
from hsictrl.plots.spectrum import spectrum_plot
from hsictrl.resonance import EffectiveProperties
from hsictrl.study import Ensemble

BRIDGES = ("empty bridge", "occupied bridge")


def assessment_figure(
    *, frfs: Sequence[ct.FrequencyResponseData], effective: Sequence[EffectiveProperties],
    responses: Sequence[ct.TimeResponseData], ensembles: Sequence[Ensemble], labels: Sequence[str] = ("MF", "PMC"),
    title: str, ax: Sequence[Axes] | np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw an assessment in three panels: frequency response, one history, and how the percentile settles.

    Parameters
    ----------
    frfs : sequence of control.FrequencyResponseData
        Of the empty and of the occupied bridge [m/s² per N].
    effective : sequence of EffectiveProperties
        Of the same two [Hz, m/s² per N].
    responses : sequence of control.TimeResponseData
        Accelerations without and with interaction [m/s², s].
    ensembles : sequence of Ensemble
        Peak accelerations without and with interaction [m/s²].
    labels : sequence of str
        Names of the models without and with interaction.
    title : str
        Title of the figure.
    ax : array or sequence of matplotlib.axes.Axes, optional
        Three axes; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        One row per panel.

    Raises
    ------
    ValueError
        If `ax` holds more or fewer than three axes, or results are not a pair.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> bridge, rng = hsi.reference_bridge(frequency=2.0), np.random.default_rng(1)
    >>> traffic = hsi.CrowdFlow(persons=15).sample(bridge, rng=rng)
    >>> found = [hsi.predict(model, bridge, hsi.tune(model, bridge, traffic)) for model in ("MF", "PMC")]
    >>> peaks = hsi.monte_carlo(lambda rng: rng.rayleigh(), rule=hsi.PercentileRule(tolerance=0.2))
    >>> plot = assessment_figure(
    ...     frfs=[hsi.frf(one.system, np.linspace(1.0, 3.0, 201)) for one in found],
    ...     effective=[hsi.effective(one.system) for one in found], responses=[one.response for one in found],
    ...     ensembles=[peaks, peaks], title="Reference bridge, 15 persons", ax=Figure().subplots(3, 1))
    >>> plot.axes.shape
    (3, 1)
    """
    axes = canvas.several_axes(ax, 3, figsize=(10.0, 9.0))
    panels = [frf_plot(frfs, labels=BRIDGES, effective=effective, ax=axes[0, 0]),
              response_plot(responses, labels=labels, ax=axes[1, 0]),
              convergence_plot(ensembles, labels=labels, ax=axes[2, 0])]
    settles = f"Convergence of {ensembles[0].rule.labels[0]}"
    canvas.head(axes.flat, ["Frequency response", "Acceleration", settles])
    axes[0, 0].figure.suptitle(title)
    return canvas.control_plot([one.lines[0, 0] for one in panels], axes, [one.legend[0, 0] for one in panels])


def simulation_figure(
    *, response: ct.TimeResponseData, marks: Mapping[str, ArrayLike], persons: ArrayLike, title: str,
    ax: Sequence[Axes] | np.ndarray | None = None,
) -> ct.ControlPlot:
    """Draw how a crowd crosses in three panels: acceleration, its amplitude spectrum, and people on the deck.

    Parameters
    ----------
    response : control.TimeResponseData
        The acceleration [m/s², s].
    marks : mapping of str to float or array_like
        As in `spectrum_plot` [Hz].
    persons : array_like, shape (m,)
        People on the deck at the times of the response [-].
    title : str
        Title of the figure.
    ax : array or sequence of matplotlib.axes.Axes, optional
        Three axes; those of a new figure if not given.

    Returns
    -------
    control.ControlPlot
        One row per panel.

    Raises
    ------
    ValueError
        If `ax` holds more or fewer than three axes, or people are not counted once for each time.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> bridge = hsi.reference_bridge(frequency=2.0)
    >>> traffic = hsi.Traffic([hsi.Walker(force=hsi.HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)])
    >>> response = hsi.simulate(hsi.moving_crowd(bridge, traffic)).response
    >>> plot = simulation_figure(response=response, marks={"bridge": 2.0}, title="One walker", ax=Figure().subplots(3),
    ...                          persons=traffic.persons_on(bridge, response.time))
    >>> plot.axes.shape
    (3, 1)
    """
    axes = canvas.several_axes(ax, 3, figsize=(10.0, 9.0))
    panels = [response_plot(response, ax=axes[0, 0]), spectrum_plot(response, marks=marks, ax=axes[1, 0]),
              persons_plot(response.time, persons, ax=axes[2, 0])]
    canvas.head(axes.flat, ["Acceleration", "Amplitude spectrum", "People on the deck"])
    axes[0, 0].figure.suptitle(title)
    return canvas.control_plot([one.lines[0, 0] for one in panels], axes, [one.legend[0, 0] for one in panels])

"""How the estimates of a study settle."""

from __future__ import annotations

from collections.abc import Sequence

import control as ct
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl.plots import _canvas as canvas
from hsictrl.study import Ensemble, MeanRule, PercentileRule


def convergence_plot(
    ensembles: Ensemble | Sequence[Ensemble], *, labels: str | Sequence[str] | None = None,
    quantity: str = "Peak acceleration [m/s²]", ax: Axes | None = None,
) -> ct.ControlPlot:
    """Draw how estimates settle: running estimate, its interval, and the tolerance about the last estimate.

    Parameters
    ----------
    ensembles : Ensemble or sequence of them
        Of one quantity and one rule each, as `hsictrl.monte_carlo` returns them [unit of the quantity].
    labels : str or sequence of str, optional
        One per ensemble; the names of their estimates if not given.
    quantity : str
        What the vertical axis shows, with its unit in brackets.
    ax : matplotlib.axes.Axes, optional
        Where to draw; on a new figure if not given.

    Returns
    -------
    control.ControlPlot
        Its lines are all estimates, then the lower and upper limit of each tolerance.

    Raises
    ------
    ValueError
        If an ensemble holds several estimates, or labels are not one per ensemble.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> from matplotlib.figure import Figure
    >>> ensemble = hsi.monte_carlo(lambda rng: rng.rayleigh(), rule=hsi.PercentileRule(tolerance=0.1))
    >>> plot = convergence_plot(ensemble, labels="Rayleigh", quantity="Amplitude [-]", ax=Figure().subplots())
    >>> bool(plot.lines[0, 0][0].get_xdata()[-1] == ensemble.n_trials)
    True
    """
    studies = _checked(ensembles)
    labels = canvas.names(labels, [study.rule.labels[0] for study in studies])
    ax = canvas.one_axes(ax)
    canvas.grid(ax)
    drawn = [_settling(ax, i, *pair) for i, pair in enumerate(zip(studies, labels, strict=True))]
    lines, bands, limits = zip(*drawn, strict=True)
    ax.set(xlabel="Number of trials [-]", ylabel=quantity)
    legend = canvas.legend_above(ax, [lines, bands, [upper for upper, _ in limits]])
    return canvas.control_plot([[*lines, *(line for pair in limits for line in pair)]], np.array([[ax]]), [legend])


def _settling(ax: Axes, index: int, study: Ensemble, label: str) -> tuple[Line2D, PolyCollection, list[Line2D]]:
    """The running estimate, its interval, and the limits of the tolerance: upper and lower."""
    history, level = study.history(), _rule(study).confidence
    line, = ax.plot(history.trials, history.estimate, linewidth=2.0, label=label, **canvas.style(index))
    band = ax.fill_between(history.trials, history.low, history.high, color=canvas.colour(index), alpha=0.25,
                           linewidth=0, label=f"{100 * level:g} % interval")
    return line, band, _tolerance(ax, index, study, history.trials[[0, -1]])


def _tolerance(ax: Axes, index: int, study: Ensemble, ends: NDArray[np.int_]) -> list[Line2D]:
    share = _rule(study).tolerance
    return [ax.plot(ends, np.full(2, study.estimate * (1 + part)), color=canvas.colour(index), linestyle="dashed",
                    linewidth=1.0, label=f"±{100 * share:g} % tolerance")[0] for part in (share, -share)]


def _checked(ensembles: object) -> list[Ensemble]:
    studies = canvas.one_or_several("ensembles", ensembles, Ensemble, "run hsictrl.monte_carlo")
    for study in studies:
        _rule(study)
        if study.samples.ndim > 1:
            raise ValueError(f"ensembles must hold one quantity, got samples of shape {study.samples.shape}; "
                             "run one study per quantity")
    return studies


def _rule(study: Ensemble) -> PercentileRule | MeanRule:
    """The rule of a study of one estimate."""
    return check.instance("rule of each ensemble", study.rule, (PercentileRule, MeanRule), "draw one estimate each")

"""Pictures of an assessment, each a data URI."""

from __future__ import annotations

import base64
from typing import NamedTuple, cast

import control as ct
import numpy as np

from hsictrl import plots
from hsictrl.assessment import Assessment
from hsictrl.coupling import OccupiedBridge
from hsictrl.report.sections import Picture
from hsictrl.resonance import EffectiveProperties, effective, frf

BAND, LINES = (0.5, 1.5), 2001    # of the frequency of the mode in resonance
MODELS = ("MF", "PMC")
WIDTH, WIDER = 4.8, 6.4           # inches; narrow, so that letters can be read on a narrow screen


class FirstTrial(NamedTuple):
    """The first trial of a study, without and with interaction."""

    responses: list[ct.TimeResponseData]
    systems: list[OccupiedBridge]
    frfs: list[ct.FrequencyResponseData]     # about the mode in resonance
    effective: list[EffectiveProperties]

    @classmethod
    def of(cls, found: Assessment) -> FirstTrial:
        predictions = [found.prediction(model) for model in MODELS]
        systems = [cast(OccupiedBridge, one.system) for one in predictions]     # neither model is MC
        return cls(responses=[one.response for one in predictions], systems=systems,
                   frfs=[_about_resonance(system) for system in systems],
                   effective=[effective(system) for system in systems])


def _about_resonance(system: OccupiedBridge) -> ct.FrequencyResponseData:
    return frf(system, system.bridge.modes[0].frequency * np.linspace(*BAND, LINES))


def shapes_picture(found: Assessment, first: FirstTrial) -> Picture:
    """The mode shapes, over the crowd of the first trial."""
    bridge, crowd = found.bridge, first.systems[-1]
    n = len(bridge.absorbers)     # which come first among the bodies
    absorbers = {"absorbers": crowd.positions[:n]} if n else {}
    plot = plots.modes_plot(bridge, {"standing crowd of trial 0": crowd.positions[n:]} | absorbers)
    size = (WIDER, 1.6 * (bridge.n_modes + 1))
    return _picture(plot, size, f"Shapes of the {bridge.n_modes} mode(s) along the deck, and a plan of the deck with a "
                    "crowd on it", "Mode shapes, and where people stand in trial 0.")


def response_pictures(found: Assessment, first: FirstTrial) -> list[Picture]:
    """Frequency responses, one history, and how the percentile settles."""
    responses = plots.frf_plot(first.frfs, labels=("empty bridge", "occupied bridge"), effective=first.effective)
    history = plots.response_plot(first.responses, labels=MODELS)
    settles = plots.convergence_plot([found.mf, found.pmc], labels=MODELS)
    where, size = f"under {found.flow}, trial 0 of seed {found.pmc.seed}", (WIDTH, 3.2)
    return [
        _picture(responses, size, "Accelerance over frequency, empty and occupied, with the peaks marked",
                 f"Frequency responses at the antinode of mode {found.mode}, empty and with its crowd, {where}."),
        _picture(history, size, "Acceleration over time without and with interaction, with running RMS and peaks",
                 f"One history {where}, without (MF) and with (PMC) interaction; bold: running 1-s RMS."),
        _picture(settles, size, "Percentile of the peak acceleration over the number of trials, with its interval",
                 f"How {found.pmc.rule.labels[0]} of the peak acceleration settles under {found.flow}.")]


def _picture(plot: ct.ControlPlot, size: tuple[float, float], alternative: str, caption: str) -> Picture:
    drawn = base64.b64encode(plots.svg(plot, size=size).encode()).decode()
    return Picture(source=f"data:image/svg+xml;base64,{drawn}", alternative=alternative, caption=caption)

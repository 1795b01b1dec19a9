"""The figure of an assessment; imported when one is asked for."""

from __future__ import annotations

from pathlib import Path

import control as ct
import numpy as np

from hsictrl import plots
from hsictrl.assessment import Assessment, PeakTrial
from hsictrl.cli.description import Description
from hsictrl.prediction import Prediction
from hsictrl.resonance import effective, frf
from hsictrl.study import trial_rng

BAND, LINES = (0.5, 1.5), 2001   # of the empty bridge's frequency


def draw(path: Path, found: Assessment, case: Description) -> None:
    """Draw one assessment, with the frequency responses and histories of its first trial, into a file."""
    trials = [PeakTrial(model=model, bridge=found.bridge, flow=found.flow, force=case.force) for model in ("MF", "PMC")]
    first = [trial.prediction(trial_rng(case.seed, 0)) for trial in trials]
    plot = plots.assessment_figure(
        frfs=[_frf(one) for one in first], effective=[effective(one.system) for one in first],
        responses=[one.response for one in first], ensembles=[found.mf, found.pmc],
        title=f"{found.flow} on {str(case.bridge).splitlines()[0]}; (a), (b): trial 0 of seed {case.seed}")
    plots.save(plot, path)


def _frf(prediction: Prediction) -> ct.FrequencyResponseData:
    frequency = prediction.system.bridge.modes[0].frequency
    return frf(prediction.system, frequency * np.linspace(*BAND, LINES))

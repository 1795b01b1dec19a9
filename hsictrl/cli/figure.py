"""The figure of an assessment; imported when one is asked for."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import control as ct
import numpy as np

from hsictrl import plots
from hsictrl.assessment import Assessment, PeakTrial
from hsictrl.cli.description import Description
from hsictrl.coupling import OccupiedBridge
from hsictrl.resonance import effective, frf
from hsictrl.study import trial_rng

BAND, LINES = (0.5, 1.5), 2001   # of the empty bridge's frequency


def draw(path: Path, found: Assessment, case: Description) -> None:
    """Draw one assessment, with the frequency responses and histories of its first trial, into a file."""
    trials = [PeakTrial(model=model, bridge=found.bridge, flow=found.flow, force=case.force) for model in ("MF", "PMC")]
    first = [trial.prediction(trial_rng(case.seed, 0)) for trial in trials]
    systems = [cast(OccupiedBridge, one.system) for one in first]     # neither model is MC
    plot = plots.assessment_figure(
        frfs=[_frf(system) for system in systems], effective=[effective(system) for system in systems],
        responses=[one.response for one in first], ensembles=[found.mf, found.pmc],
        title=f"{found.flow} on {str(case.bridge).splitlines()[0]}; (a), (b): trial 0 of seed {case.seed}")
    plots.save(plot, path)


def _frf(system: OccupiedBridge) -> ct.FrequencyResponseData:
    return frf(system, system.bridge.modes[0].frequency * np.linspace(*BAND, LINES))

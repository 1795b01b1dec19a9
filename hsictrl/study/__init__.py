"""Independent trials until a percentile has settled.

A trial is a function of a random generator that returns a number, or one number per quantity. `monte_carlo`
runs trials until its stop rule says that the estimate has settled, and returns an `Ensemble` that keeps every
sample. Trial i draws from a random stream of its own and a rule reads the trials in index order, so the
answer doesn't depend on the number of workers, and any trial can be run again alone. A `Ledger` keeps what has
been run. `sweep` runs a study for every combination of the values of some axes.

Source: Van Nimmen et al. (2017), section 2.3.
"""

from hsictrl.study.batches import TrialError, trial_rng
from hsictrl.study.ensembles import Ensemble, History
from hsictrl.study.estimates import Estimates
from hsictrl.study.ledger import ChangedStudyError, Ledger
from hsictrl.study.rules import AllRules, Judgement, MeanRule, PercentileRule, StopRule
from hsictrl.study.sweeps import Sweep, sweep
from hsictrl.study.trials import checkpoints, monte_carlo

__all__ = [
    "AllRules", "ChangedStudyError", "Ensemble", "Estimates", "History", "Judgement", "Ledger", "MeanRule",
    "PercentileRule", "StopRule", "Sweep", "TrialError", "checkpoints", "monte_carlo", "sweep", "trial_rng",
]

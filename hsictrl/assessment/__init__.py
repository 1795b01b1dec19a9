"""From a bridge and a flow of people to a design acceleration, with and without interaction, and a comfort class."""

from hsictrl.assessment.assessed import Assessment
from hsictrl.assessment.assessing import assess, check_assessable, effective_rule, guide_value, study_effective
from hsictrl.assessment.trials import EffectiveTrial, JointTrial, PeaksTrial, PeakTrial

__all__ = ["Assessment", "EffectiveTrial", "JointTrial", "PeakTrial", "PeaksTrial", "assess", "check_assessable",
           "effective_rule", "guide_value", "study_effective"]

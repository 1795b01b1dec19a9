"""From a bridge and a flow of people to a design acceleration, with and without interaction, and a comfort class."""

from hsictrl.assessment.assessed import Assessment
from hsictrl.assessment.assessing import assess, check_assessable, effective_rule, study_effective
from hsictrl.assessment.guides import GuideCase, guide_cases, guide_value
from hsictrl.assessment.trials import EffectiveTrial, JointTrial, PeaksTrial, PeakTrial

__all__ = ["Assessment", "EffectiveTrial", "GuideCase", "JointTrial", "PeakTrial", "PeaksTrial", "assess",
           "check_assessable", "effective_rule", "guide_cases", "guide_value", "study_effective"]

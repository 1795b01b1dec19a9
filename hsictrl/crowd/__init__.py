"""Who arrives when, how fast the density lets them walk, at which step frequency, and where each is at time t."""

from hsictrl.crowd.classes import TRAFFIC_CLASSES
from hsictrl.crowd.flow import CrowdFlow, resonant_step_frequency, settling_time, weidmann_speed
from hsictrl.crowd.traffic import Traffic
from hsictrl.crowd.walkers import Walker, Walkers

__all__ = ["TRAFFIC_CLASSES", "CrowdFlow", "Traffic", "Walker", "Walkers", "resonant_step_frequency", "settling_time",
           "weidmann_speed"]

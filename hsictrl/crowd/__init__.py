"""Who arrives when, how fast the density lets them walk, at which step frequency, and where each is at time t."""

from hsictrl.crowd.classes import TRAFFIC_CLASSES
from hsictrl.crowd.flow import CrowdFlow, check_somebody, resonant_step_frequency, settling_time, weidmann_speed
from hsictrl.crowd.gait import preferred_step_frequency
from hsictrl.crowd.traffic import Traffic
from hsictrl.crowd.trajectory import Trajectory
from hsictrl.crowd.walker import Walker
from hsictrl.crowd.walkers import Walkers

__all__ = [
    "TRAFFIC_CLASSES", "CrowdFlow", "Traffic", "Trajectory", "Walker", "Walkers", "check_somebody",
    "preferred_step_frequency", "resonant_step_frequency", "settling_time", "weidmann_speed",
]

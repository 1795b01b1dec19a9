"""A body is sprung mass, unsprung mass, spring and damper, in a direction, drawn from a population."""

from hsictrl.pedestrian.body import Body, Pedestrian
from hsictrl.pedestrian.crowd import Crowd
from hsictrl.pedestrian.population import Population
from hsictrl.pedestrian.reduced import ReducedCrowd

__all__ = ["Body", "Crowd", "Pedestrian", "Population", "ReducedCrowd"]

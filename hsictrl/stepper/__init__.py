"""Advances the time-varying system of a moving crowd."""

from hsictrl.stepper.simulation import Simulation, simulate

__all__ = ["Simulation", "simulate"]

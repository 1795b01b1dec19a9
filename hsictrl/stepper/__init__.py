"""Advances the time-varying system of a moving crowd."""

from hsictrl.stepper.simulation import TOLERANCE, Simulation, simulate

__all__ = ["TOLERANCE", "Simulation", "simulate"]

"""Simulation of a move and its settling, one plant a file."""

from flexbase.simulation.many.result import Runs
from flexbase.simulation.many.run import simulate_many
from flexbase.simulation.result import Run
from flexbase.simulation.run import simulate

__all__ = ["Run", "Runs", "simulate", "simulate_many"]

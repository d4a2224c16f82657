"""Simulation of a move and its settling, one plant a file."""

from flexbase.simulate.many import simulate_many
from flexbase.simulate.many_result import Runs
from flexbase.simulate.result import Run
from flexbase.simulate.run import simulate

__all__ = ["Run", "Runs", "simulate", "simulate_many"]

"""Simulation of a move and its settling, one plant a file."""

from flexbase.simulate.result import Run
from flexbase.simulate.run import simulate

__all__ = ["Run", "simulate"]

"""Runs of the nonlinear plant: a move and its settling, one ideal run, many, or as hardware makes them."""

from flexbase.simulation.hardware.push import Push
from flexbase.simulation.hardware.result import SampledRun
from flexbase.simulation.hardware.run import simulate_sampled, simulate_sampled_many
from flexbase.simulation.many.result import Runs
from flexbase.simulation.many.run import simulate_many
from flexbase.simulation.move import Move, Moves, SampledMove
from flexbase.simulation.result import Run
from flexbase.simulation.run import simulate

__all__ = [
    "Move",
    "Moves",
    "Push",
    "Run",
    "Runs",
    "SampledMove",
    "SampledRun",
    "simulate",
    "simulate_many",
    "simulate_sampled",
    "simulate_sampled_many",
]

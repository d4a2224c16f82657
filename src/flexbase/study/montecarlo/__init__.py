"""Monte Carlo: the probability that a design holds when the plant is not known exactly."""

from flexbase.study.montecarlo.criterion import CRITERIA, Criterion
from flexbase.study.montecarlo.distribution import DISTRIBUTIONS, Fixed, Lognormal, Normal, Uniform
from flexbase.study.montecarlo.draws import Draws
from flexbase.study.montecarlo.interval import Estimate
from flexbase.study.montecarlo.result import LEVELS, MonteCarlo, is_study
from flexbase.study.montecarlo.run import montecarlo

__all__ = [
    "CRITERIA",
    "DISTRIBUTIONS",
    "LEVELS",
    "Criterion",
    "Draws",
    "Estimate",
    "Fixed",
    "Lognormal",
    "Normal",
    "MonteCarlo",
    "Uniform",
    "is_study",
    "montecarlo",
]

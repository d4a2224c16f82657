"""Monte Carlo: the probability that a design holds when the plant is not known exactly."""

from flexbase.study.montecarlo.criterion import CRITERIA, Criterion
from flexbase.study.montecarlo.distribution import DISTRIBUTIONS, Fixed, Lognormal, Normal, Uniform
from flexbase.study.montecarlo.interval import Estimate
from flexbase.study.montecarlo.result import LEVELS, Probability, is_study, shown
from flexbase.study.montecarlo.run import montecarlo

__all__ = [
    "CRITERIA",
    "DISTRIBUTIONS",
    "LEVELS",
    "Criterion",
    "Estimate",
    "Fixed",
    "Lognormal",
    "Normal",
    "Probability",
    "Uniform",
    "is_study",
    "montecarlo",
    "shown",
]

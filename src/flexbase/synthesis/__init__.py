"""Controllers for the loop as it runs, one file a method; importing them fills the registry."""

from flexbase.synthesis.methods import compensated, constant, coprime, deflection, lqg, notch, robust, sampled, viscous
from flexbase.synthesis.registry import HARDWARE_METHODS, controller_for

__all__ = [
    "HARDWARE_METHODS",
    "compensated",
    "constant",
    "controller_for",
    "coprime",
    "deflection",
    "lqg",
    "notch",
    "robust",
    "sampled",
    "viscous",
]

"""Controllers for the loop as it runs, one file a method; importing them fills the registry."""

from flexbase.design.hardware import compensated, coprime, sampled
from flexbase.design.hardware.registry import HARDWARE_METHODS, controller_for

__all__ = ["compensated", "controller_for", "coprime", "sampled", "HARDWARE_METHODS"]

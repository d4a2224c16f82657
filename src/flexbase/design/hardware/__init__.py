"""Controllers for the loop as it runs, one file a method; importing them fills the registry."""

from flexbase.design.hardware import compensated, coprime
from flexbase.design.hardware.registry import HARDWARE_METHODS, controller_for

__all__ = ["HARDWARE_METHODS", "compensated", "controller_for", "coprime"]

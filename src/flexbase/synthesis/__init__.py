"""Controllers for the loop as it runs; every file in `methods` fills the registry."""

from flexbase.errors import import_all
from flexbase.synthesis import methods
from flexbase.synthesis.registry import HARDWARE_METHODS, controller_for

import_all(methods)

__all__ = ["HARDWARE_METHODS", "controller_for"]

"""Design of compensators; every file in `methods` fills the registry."""

from flexbase.compensators import methods
from flexbase.compensators.registry import METHODS, Method, design
from flexbase.errors import import_all

import_all(methods)

__all__ = ["METHODS", "Method", "design"]

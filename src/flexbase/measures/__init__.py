"""Measures of a configuration; every file here fills the registry."""

import sys

from flexbase.errors import import_all
from flexbase.measures.registry import MEASURES, Configuration, Measure

import_all(sys.modules[__name__])

__all__ = ["MEASURES", "Configuration", "Measure"]

"""Measures of a configuration, one file each; importing them fills the registry."""

from flexbase.measures import (
    alignment,
    compensability,
    exact_design,
    frequency,
    loop,
    manipulability,
    robustness,
    turn,
)
from flexbase.measures.registry import MEASURES, Configuration, Measure

__all__ = [
    "MEASURES",
    "Configuration",
    "Measure",
    "alignment",
    "compensability",
    "exact_design",
    "frequency",
    "loop",
    "manipulability",
    "robustness",
    "turn",
]

"""Measures of a configuration, one file each; importing them fills the registry."""

from flexbase.measures import (
    algebraic_loop,
    alignment,
    compensability,
    exact_design,
    frequency,
    manipulability,
    passivity_shortage,
    robustness,
    shortage,
    task_loop,
    turn,
)
from flexbase.measures.registry import MEASURES, Configuration, Measure

__all__ = [
    "MEASURES",
    "Configuration",
    "Measure",
    "algebraic_loop",
    "alignment",
    "compensability",
    "exact_design",
    "frequency",
    "manipulability",
    "passivity_shortage",
    "robustness",
    "shortage",
    "task_loop",
    "turn",
]

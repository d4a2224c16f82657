"""The eleven panels of the paper, a file for each kind: study result -> Figure."""

from flexbase.report.panels.configuration import configuration
from flexbase.report.panels.ellipses import ellipses
from flexbase.report.panels.iterations import CURVES, Curve, exact_value, iteration_curve
from flexbase.report.panels.maps import contours, surface
from flexbase.report.panels.settling import positioning_error

__all__ = [
    "CURVES",
    "Curve",
    "configuration",
    "contours",
    "ellipses",
    "exact_value",
    "iteration_curve",
    "positioning_error",
    "surface",
]

"""The eleven panels of the paper, a file for each kind: study result -> Figure."""

from flexbase.report.paper.configuration import configuration
from flexbase.report.paper.ellipses import ellipses
from flexbase.report.paper.iterations import CURVES, Curve, exact_value, iteration_curve
from flexbase.report.paper.maps import contours, surface
from flexbase.report.paper.settling import positioning_error

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

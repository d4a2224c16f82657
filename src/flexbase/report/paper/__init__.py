"""The eleven panels of the paper, a file for each kind: study result -> Figure."""

from flexbase.report.paper.fig05_arm import configuration
from flexbase.report.paper.fig06_fig08_maps import contours, surface
from flexbase.report.paper.fig07_iterations import CURVES, Curve, exact_value, iteration_curve
from flexbase.report.paper.fig09_settling import positioning_error
from flexbase.report.paper.fig10_ellipses import ellipses

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

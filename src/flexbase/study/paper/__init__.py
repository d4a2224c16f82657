"""Everything behind the figures and the table of Ueda and Yoshikawa, ICRA 2003, computed and not yet drawn."""

from flexbase.study.paper.ellipses import EllipseCell, EllipseField, ellipse_cell, ellipse_field, ellipse_tips
from flexbase.study.paper.example import DESIGN_TIP, START_TIP, TARGET_FREQUENCY, Example, example
from flexbase.study.paper.paper_and_ours import compare
from flexbase.study.paper.robustness_map import RobustnessMap, robustness_map
from flexbase.study.paper.table import PaperRow, Reproduction
from flexbase.study.paper.two_designs import Shaping, shaping
from flexbase.study.paper.two_moves import Settling, settling

__all__ = [
    "DESIGN_TIP",
    "START_TIP",
    "TARGET_FREQUENCY",
    "EllipseCell",
    "EllipseField",
    "Example",
    "PaperRow",
    "Reproduction",
    "RobustnessMap",
    "Settling",
    "Shaping",
    "compare",
    "ellipse_cell",
    "ellipse_field",
    "ellipse_tips",
    "example",
    "robustness_map",
    "settling",
    "shaping",
]

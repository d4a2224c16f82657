"""Fig. 10: what the compensator does to the dynamic manipulability ellipses, over the whole region."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import spearmanr

from flexbase.cautions import collected
from flexbase.checks import Array
from flexbase.compensators import design
from flexbase.compensators.methods.exact import compensability
from flexbase.errors import Infeasible, InputError
from flexbase.linear.modal import modes
from flexbase.measures.manipulability import Manipulability, manipulability
from flexbase.model.loop import Gain
from flexbase.plant import Plant, Pose
from flexbase.requests import Progress, no_progress
from flexbase.study.paper.example import DESIGN_TIP

SPACING = 0.14  # m, between ellipses; the grid passes through the paper's design point
RAISE = 100.0  # rad/s above omega_1 in each configuration  [U03 §IV C]
NEAR = 1e-3  # of the targets: beyond, the recursion counts as not converged

REACHED, OUT_OF_REACH, NO_GAIN, LOST, UNFINISHED = (
    "ok",
    "frequency out of reach",
    "no gain aligns the mode",
    "M - E not positive definite",
    "not converged",
)


@dataclass(frozen=True, eq=False)
class EllipseCell:
    """One configuration: the ellipses |f| <= 1 of the rigid arm as it is and under a compensator.

    tip : [m]; robustness : w_1 without compensator [m/(N s^2)]; alignment : cos(a, b) without compensator
    frequency : omega_1 without compensator [rad/s]
    original : the arm's own ellipse
    recursion, exact : E and both ellipses by the paper's recursion (exact slopes) and by the least-gain design, or None
    recursion_status, exact_status : "ok", or why there is none
    """

    tip: tuple[float, float]
    robustness: float
    alignment: float
    frequency: float
    original: Manipulability
    recursion: Manipulability | None
    recursion_gain: Array | None
    recursion_status: str
    exact: Manipulability | None
    exact_gain: Array | None
    exact_status: str


@dataclass(frozen=True, eq=False)
class EllipseField:
    """All configurations of Fig. 10 that the arm reaches."""

    cells: tuple[EllipseCell, ...]

    def count(self, status: str, method: str = "recursion") -> int:
        """How many cells of a method, "recursion" or "exact", have a status."""
        return sum(getattr(cell, f"{method}_status") == status for cell in self.cells)

    def rotations(self, method: str = "recursion") -> Array:
        """Columns: w_1, alignment, turn of the longest axis without sign [deg], area ratio; a row a designed cell."""
        found = [(cell, getattr(cell, method)) for cell in self.cells]
        return np.array(
            [
                (cell.robustness, cell.alignment, abs(np.degrees(pair.rotation)), pair.volume_ratio)
                for cell, pair in found
                if pair is not None
            ]
        )

    def rank_correlation(self, method: str = "recursion") -> tuple[float, float]:
        """Spearman's coefficient of |turn| against -w_1, and its p-value: 1 if the less robust always turn more."""
        table = self.rotations(method)
        found = spearmanr(-table[:, 0], table[:, 2])
        return float(found.statistic), float(found.pvalue)


def ellipse_tips(plant: Plant, spacing: float = SPACING) -> list[tuple[float, float]]:
    """Tips on a square grid through the design point, that the arm reaches without being singular."""
    steps = np.arange(-round(1.0 / spacing), round(1.0 / spacing) + 1) * spacing
    tips = []
    for y in DESIGN_TIP[1] + steps:
        for x in DESIGN_TIP[0] + steps:
            try:
                plant.at_tip([x, y])
            except InputError:  # out of reach, or singular
                continue
            tips.append((float(x), float(y)))
    return tips


def ellipse_cell(plant: Plant, tip: tuple[float, float]) -> EllipseCell:
    """Design at one tip for omega_1 + 100 rad/s, by the paper's recursion and exactly."""
    pose = plant.at_tip(tip)
    mode = modes(pose)[0]
    wanted = mode.frequency + RAISE
    recursion, by_recursion = _designed(pose, "recursive", wanted, derivatives="exact")
    exact, by_exact = _designed(pose, "exact", wanted)
    return EllipseCell(
        tip=tip,
        robustness=mode.robustness,
        alignment=1.0 if mode.alignment is None else mode.alignment,
        frequency=mode.frequency,
        original=manipulability(pose),
        recursion=None if recursion is None else manipulability(pose, Gain(recursion)),
        recursion_gain=recursion,
        recursion_status=by_recursion,
        exact=None if exact is None else manipulability(pose, Gain(exact)),
        exact_gain=exact,
        exact_status=by_exact,
    )


def ellipse_field(plant: Plant, spacing: float = SPACING, progress: Progress = no_progress) -> EllipseField:
    """All cells; `progress` is called before each with "ellipse", the cells done and all cells."""
    tips = ellipse_tips(plant, spacing)
    cells: list[EllipseCell] = []
    for tip in tips:
        progress("ellipse", len(cells), len(tips))
        cells.append(ellipse_cell(plant, tip))
    return EllipseField(tuple(cells))


def _designed(pose: Pose, method: str, frequency: float, **options: Any) -> tuple[Array | None, str]:
    """E, or None, and a status."""
    try:
        with collected(quietly=True):
            found = design(pose, method, natural_frequency=frequency, **options)
    except Infeasible:
        if method == "recursive":
            return None, LOST
        return None, OUT_OF_REACH if np.isfinite(compensability(pose).slowest) else NO_GAIN
    if (found.certificate.target_residual or 0.0) > NEAR:
        return None, UNFINISHED
    return found.E, REACHED

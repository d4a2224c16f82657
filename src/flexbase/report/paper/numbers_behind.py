"""The numbers behind each panel of the paper, as tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from flexbase.measures.manipulability import Manipulability
from flexbase.report import paper as panels
from flexbase.report.arm.in_plane import joint_points
from flexbase.simulation import Run
from flexbase.study.paper import EllipseCell, EllipseField, Example, RobustnessMap, Shaping
from flexbase.sweeps import STATUS


class Numbers(NamedTuple):
    """The numbers behind a panel: a CSV table."""

    header: Sequence[str]
    rows: Iterable[Sequence[object]]


def configuration(case: Example) -> Numbers:
    """Joint positions of Fig. 5."""
    points = joint_points(case.pose)
    names = [*case.plant.arm.mechanism.joint_names, "tip"]
    angles = [*case.pose.q.tolist(), None]
    return Numbers(
        ("point", "x_m", "y_m", "angle_rad"),
        [(name, x, y, angle) for name, (x, y, _), angle in zip(names, points.tolist(), angles, strict=True)],
    )


def robustness(chart: RobustnessMap) -> Numbers:
    """Every point of a map, Fig. 6 and 8."""
    columns = (chart.x, chart.y, chart.robustness, chart.turn, chart.smallest_inertia)
    numbers = zip(*(column.ravel().tolist() for column in columns), strict=True)
    return Numbers(
        ("x_m", "y_m", "w_1_m_per_N_s2", "angle_from_b_to_a_rad", "min_eig_modified_inertia", "status"),
        [(*row, STATUS[code]) for row, code in zip(numbers, chart.status.ravel().tolist(), strict=True)],
    )


def iterations(shaped: Shaping, curve: panels.Curve) -> Numbers:
    """One curve of Fig. 7 beside the exact design."""
    exact = panels.exact_value(shaped, curve.key)
    values = shaped.recursion.history[curve.key].tolist()
    return Numbers(("iteration", curve.key, "exact_design"), [(i, value, exact) for i, value in enumerate(values)])


def errors(run: Run) -> Numbers:
    """Tip errors of Fig. 9."""
    rows = zip(run.t.tolist(), *run.tip_error.T.tolist(), run.settling.tolist(), strict=True)
    return Numbers(
        ("t_s", "error_x_m", "error_y_m", "phase"),
        [(t, x, y, "settling" if settling else "move") for t, x, y, settling in rows],
    )


def ellipse_table(field: EllipseField) -> Numbers:
    """Every configuration of Fig. 10, by the recursion and by the exact design."""
    ours = ("status", "E11", "E12", "E22", "semi_axis_1", "semi_axis_2", "rotation_rad", "area_ratio")
    header = [
        "x_m",
        "y_m",
        "w_1_m_per_N_s2",
        "alignment",
        "omega_1_rad_s",
        "original_semi_axis_1",
        "original_semi_axis_2",
    ]
    header += ["original_angle_rad", *(f"{method}_{name}" for method in ("recursion", "exact") for name in ours)]
    return Numbers(header, [_ellipse_row(cell) for cell in field.cells])


def _ellipse_row(cell: EllipseCell) -> list[object]:
    original = cell.original.original
    angle = float(np.arctan(original.directions[1, 0] / original.directions[0, 0]))
    return [
        *cell.tip,
        cell.robustness,
        cell.alignment,
        cell.frequency,
        *original.semi_axes.tolist(),
        angle,
        *_designed(cell.recursion, cell.recursion_gain, cell.recursion_status),
        *_designed(cell.exact, cell.exact_gain, cell.exact_status),
    ]


def _designed(pair: Manipulability | None, gain: np.ndarray | None, status: str) -> list[object]:
    if pair is None or gain is None:
        return [status, *[None] * 7]
    entries = [gain[0, 0], gain[0, 1], gain[1, 1]]
    return [status, *entries, *pair.compensated.semi_axes.tolist(), pair.rotation, pair.volume_ratio]

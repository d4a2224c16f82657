"""The map's rows against one pose at a time, on the same cells."""

from __future__ import annotations

import numpy as np
from timing import Ratio, Side, race

import flexbase as fb


def map_rows_vs_poses() -> list[Ratio]:
    """A 40 x 40 robustness map against `modes` at each reachable cell."""
    plant = fb.load("ueda2003")
    chart = fb.sweep(plant, cells=fb.Cells(shape=(40, 40)))
    cells = [(i, j) for i, j in zip(*np.nonzero(chart.status.values == 0), strict=True)]
    x, y = chart.x.values, chart.y.values

    def poses() -> list[float]:
        return [fb.modes(plant.at_tip([x[j], y[i]]))[0].robustness for i, j in cells]

    mapped = np.array([float(chart.robustness[i, j, 0]) for i, j in cells])
    if not np.allclose(poses(), mapped, rtol=1e-9, atol=1e-12) or np.allclose(np.zeros(len(cells)), mapped, atol=1e-12):
        raise SystemExit("control failed: the map and the poses disagree, or a map of zeros would pass")
    mapping = Side(lambda: fb.sweep(plant, cells=fb.Cells(shape=(40, 40))), times=5)
    return [race("map_rows_vs_poses", mapping, "modes() pose by pose", Side(poses), rounds=7)]

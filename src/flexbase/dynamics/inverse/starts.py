"""Where numeric inverse kinematics begins: low-discrepancy points over the arm's joints."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.inverse.branches import elbow_of
from flexbase.model.mechanism import Mechanism
from flexbase.model.parts import Parts

STARTS = 128


def spread_starts(mechanism: Mechanism, parts: Parts, branch: str, count: int) -> Array:
    """Halton points over the ranges of the arm joints, shape (count, n).

    The elbow's joint is on the side that the branch names.
    """
    from scipy.stats import qmc  # half a second to import, and only arms without a closed form need it

    n = len(parts.active)
    unit = qmc.Halton(n, scramble=False).random(count + 1)[1:]  # the first point is a corner
    low, high = np.array(parts.arm(mechanism.ranges)).T
    starts = np.asarray(0.5 * (low + high) + (2.0 * unit - 1.0) * (0.5 * (high - low)))
    elbow = elbow_of(n)
    if elbow is not None:
        starts[:, elbow] = np.abs(starts[:, elbow]) * (1.0 if branch[len(branch) // 2] == "+" else -1.0)
    return starts

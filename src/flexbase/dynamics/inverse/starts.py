"""Where numeric inverse kinematics begins: low-discrepancy points over the arm's joints."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.inverse.branches import elbow_of
from flexbase.dynamics.inverse.newton import reach
from flexbase.model.mechanism import Mechanism

STARTS = 128


def spread_starts(mechanism: Mechanism, m: int, branch: str, count: int) -> Array:
    """Halton points over a turn of each revolute and the reach of each prismatic arm joint, shape (count, n).

    The elbow's joint is on the side that the branch names.
    """
    from scipy.stats import qmc  # half a second to import, and only arms without a closed form need it

    n = mechanism.N - m
    unit = qmc.Halton(n, scramble=False).random(count + 1)[1:]  # the first point is a corner
    span = np.array([np.pi if kind == "revolute" else reach(mechanism) for kind in mechanism.joint_types[m:]])
    starts = np.asarray((2.0 * unit - 1.0) * span)
    elbow = elbow_of(n)
    if elbow is not None:
        starts[:, elbow] = np.abs(starts[:, elbow]) * (1.0 if branch[len(branch) // 2] == "+" else -1.0)
    return starts

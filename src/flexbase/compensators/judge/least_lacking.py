"""Which of several gains to hand back: the one whose whole response lacks least, and never one worse than none."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexbase.checks import Array
from flexbase.compensators.judge.gain_shortage import relative_shortage
from flexbase.errors import Infeasible
from flexbase.plant import Pose

NOTHING = 1e-9  # relative shortage that counts as none, and as no difference: the smaller gain then wins
PARTS = tuple(np.linspace(1.0, 0.0, 13)[1:-1].tolist())  # of a gain that by itself is worse than none


def least_lacking(pose: Pose, gains: Sequence[Array]) -> Array:
    """The gain with the smallest `relative_shortage`; parts of the gains, and E = 0, where all are worse than none.

    The modal shortage that the methods descend on is not that of the whole response where modes overlap or where the
    damping couples them, and a smaller one may come with a smaller response. A part of a gain obeys the same radius.
    """
    none = np.zeros((pose.arm.n, pose.arm.n))
    without = relative_shortage(pose, none)
    best = _least(pose, gains)
    if best[0] <= without + NOTHING:
        return best[1]
    return _least(pose, [none, *(part * E for E in gains for part in PARTS)])[1]


def check_no_worse(pose: Pose, E: Array) -> None:
    """Raises Infeasible where the whole response lacks more with a gain than without."""
    after, before = relative_shortage(pose, E), relative_shortage(pose, np.zeros_like(E))
    if after > before + NOTHING:
        raise Infeasible(
            f"the natural frequencies bind: within them the least-misaligned gain lacks {100.0 * after:.2g} % of the "
            f"largest response in passivity, more than no gain, {100.0 * before:.2g} %. Leave the frequencies free, or "
            "ask for others."
        )


def _least(pose: Pose, gains: Sequence[Array]) -> tuple[float, Array]:
    found = [(relative_shortage(pose, E), E) for E in gains]
    least = min(value for value, _ in found)
    return min((one for one in found if one[0] <= least + NOTHING), key=lambda one: float(np.linalg.norm(one[1])))

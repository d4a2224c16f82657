"""Bounded design for several base joints: the least passivity shortage among implementable gains.  [theory §7]"""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.compensators.judge.certificate import certify
from flexbase.compensators.judge.gain_shortage import cautions_of_shortage, target_residual
from flexbase.compensators.judge.implementable import RADIUS, BoundedGain, checked_radius
from flexbase.compensators.judge.least_lacking import least_lacking
from flexbase.compensators.options import Radius, Seed
from flexbase.compensators.registry import method
from flexbase.compensators.search.descent import descend, shortage_and_slope
from flexbase.compensators.search.least_misalignment import MARGIN, least_misalignment
from flexbase.compensators.search.mobility_program import MobilityProgram
from flexbase.control.compensator import Compensator
from flexbase.errors import Infeasible, InputError, MissingExtra
from flexbase.model.loop import Asked
from flexbase.plant import Pose

SPREAD = 0.5  # of the random start's entries


@method("bounded", "any base, arm and task: least passivity shortage by descent, the radius bounded by construction")
def bounded(pose: Pose, *, radius: Radius = RADIUS, seed: Seed = 0, loop: Asked = None) -> Compensator:
    """Least -sum_i w_i / (4 zeta_i omega_i) over all gains with rho(Ms^-1 E) < radius.  [theory §7]

    Assumes a compliant base; natural frequencies are not aimed at; leaves gravity stiffness out of the equations. BFGS
    with exact slopes over a free symmetric matrix, from three starts: no gain, a random one (`seed`), and the
    least-misaligned one where the extra "convex" is installed. An undamped base is designed as if it had 1 % damping.
    Of what the descents find, the gain whose whole response lacks least is taken, and never one that lacks more than
    no gain. The certificate's `target_residual` is what is left missing, in a mode or in the whole response, relative.
    """
    if pose.arm.m == 0:
        raise InputError("bounded: the base is rigid, so there is no mode to shape.")
    g = checked_radius(radius)
    none = np.zeros((pose.arm.n, pose.arm.n))
    if shortage_and_slope(pose, none)[0] == 0.0:
        return certify(pose, "bounded", none, target_residual=0.0, loop=loop)
    random = SPREAD * np.random.default_rng(seed).standard_normal(none.shape)
    starts = [none, BoundedGain(pose, g).at(0.5 * (random + random.T))[0], *_convex_start(pose, g)]
    E = least_lacking(pose, [descend(pose, g, start)[1] for start in starts])
    missing, cautions = target_residual(pose, E), cautions_of_shortage(pose, E)
    return certify(pose, "bounded", E, target_residual=missing, loop=loop, cautions=cautions)


def _convex_start(pose: Pose, radius: float) -> list[Array]:
    """The least-misaligned gain; none without the extra or where its solver fails."""
    try:
        return [least_misalignment(MobilityProgram(pose, radius), MARGIN)]
    except (MissingExtra, Infeasible):
        return []

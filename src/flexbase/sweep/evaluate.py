"""Configuration -> measures, many at once, in blocks that fit the processor's cache."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import forward, task_jacobian
from flexbase.linear.real_modes import real_modes
from flexbase.linear.reduced import Reduced, reduce_arm
from flexbase.measures import Configuration, Measure
from flexbase.model.mounted import MountedArm
from flexbase.plant import SINGULAR as SINGULAR_RATIO
from flexbase.sweep.chart import INDEFINITE, OK, SINGULAR
from flexbase.trace.algebra import Matrix, ldl, stack, unstack


class Block(NamedTuple):
    """Measures and status of some configurations; values are NaN unless the status is OK."""

    values: dict[str, Array]
    status: NDArray[np.int8]


def evaluate(arm: MountedArm, joints: Array, measures: list[Measure], E: Array | None) -> Block:
    """Measures of arm joints, shape (cells, n), with the base at its equilibrium."""
    status = _status(arm, joints, E)
    good = status == OK
    values = {one.name: np.full((len(joints), arm.m) if one.per_mode else len(joints), np.nan) for one in measures}
    if good.any():
        M, J, reduced = _reduced(arm, joints[good], E)
        configuration = Configuration(M, J, arm.m, reduced, real_modes(reduced, arm.base))
        for one in measures:
            if one.per_mode:
                for i, mode in enumerate(configuration.modes):
                    values[one.name][good, i] = one.run(mode)
            else:
                values[one.name][good] = one.run(configuration)
    return Block(values, status)


def _reduced(arm: MountedArm, joints: Array, E: Array | None) -> tuple[Matrix, Matrix, Reduced]:
    frames = forward(arm.mechanism, (*arm.base.equilibrium.tolist(), *unstack(joints, 1)))
    M, J = mass_matrix(frames), task_jacobian(frames, arm.task.indices)
    return M, J, reduce_arm(M, J, arm.m, None if E is None else E.tolist())


def _status(arm: MountedArm, joints: Array, E: Array | None) -> NDArray[np.int8]:
    """Which configurations can be judged, decided before anything is divided by."""
    _, J, reduced = _reduced(arm, joints, E)
    status = np.zeros(len(joints), dtype=np.int8)
    pivots = [*reduced.pivots, *(ldl(reduced.S)[1] if arm.m else ())]
    for pivot in pivots:
        status[np.broadcast_to(np.asarray(pivot) <= 0.0, len(joints))] = INDEFINITE
    Jv = np.broadcast_to(stack(J)[..., arm.m :], (len(joints), arm.k, arm.n))
    singular_values = np.linalg.svd(Jv, compute_uv=False)
    status[singular_values[:, -1] <= SINGULAR_RATIO * singular_values[:, 0]] = SINGULAR
    return status

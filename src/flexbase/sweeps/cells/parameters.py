"""What measures read of a configuration whose parameters differ from nominal."""

from __future__ import annotations

from collections.abc import Mapping

from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import forward, task_jacobian
from flexbase.dynamics.variation import PARAMETERS, Parameter, parameters_of, varied_base, varied_frames
from flexbase.measures import Configuration
from flexbase.model.mounted import MountedArm
from flexbase.trace.algebra import Matrix, Scalar, Vector

__all__ = ["PARAMETERS", "Parameter", "configuration_of", "parameters_of"]


def configuration_of(
    arm: MountedArm, joints: Vector, parameters: Mapping[str, Scalar], E: Matrix | None
) -> Configuration:
    """What measures read, of arm joints (n scalars) with the base at rest, under parameters that differ from nominal.

    Leaves out gravity's stiffness and sag, and joint friction.
    """
    q = arm.parts.whole(arm.base.equilibrium.tolist(), joints)
    frames = varied_frames(arm, forward(arm.mechanism, q), parameters)
    return Configuration(
        M=mass_matrix(frames),
        J=task_jacobian(frames, arm.task.indices),
        parts=arm.parts,
        stiffness=varied_base(arm, "stiffness", parameters),
        damping=varied_base(arm, "damping", parameters),
        E=E,
        gains=arm.gains,
    )

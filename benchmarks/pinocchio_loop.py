"""The pipeline that a Python programmer has without flexbase's engine: Pinocchio in a loop, then batched NumPy.

As fast as we could write it: joints specialised to their axes, `crba` in world convention so that the frame Jacobian
needs no second pass over the kinematics, results written into arrays made once, blocks that stay in the cache, and our
modal formula on rows of NumPy, which is several times faster than `numpy.linalg` on stacks of small matrices.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pinocchio as pin

from flexbase.measures import Configuration
from flexbase.measures.robustness import robustness
from flexbase.model.mechanism import Mechanism
from flexbase.model.mounted import MountedArm

BLOCK = 2048  # configurations: 1 MB of M and J for eight joints


def pinocchio_model(mechanism: Mechanism) -> tuple[pin.Model, int]:
    """The mechanism joint by joint, and the number of its tool frame."""
    model, parent = pin.Model(), 0
    for i, kind in enumerate(mechanism.joint_types):
        placement = pin.SE3(mechanism.placement_rotation[i], mechanism.placement_position[i])
        parent = model.addJoint(parent, _joint(kind, mechanism.axes[i]), placement, mechanism.joint_names[i])
        body = pin.Inertia(float(mechanism.mass[i]), mechanism.com[i], mechanism.inertia[i])
        model.appendBodyToJoint(parent, body, pin.SE3.Identity())
    tool = pin.SE3(mechanism.tool_rotation, mechanism.tool_position)
    return model, model.addFrame(pin.Frame("tool", parent, 0, tool, pin.FrameType.OP_FRAME))


def _joint(kind: str, axis: np.ndarray) -> object:
    letter = {"revolute": "R", "prismatic": "P"}[kind]
    if np.count_nonzero(axis) == 1 and axis.max() == 1.0:
        return getattr(pin, f"JointModel{letter}{'XYZ'[int(np.argmax(axis))]}")()
    return {"R": pin.JointModelRevoluteUnaligned, "P": pin.JointModelPrismaticUnaligned}[letter](axis)


def pipeline(arm: MountedArm) -> Callable[[np.ndarray], np.ndarray]:
    """A function: arm joints (n, cells) -> robustness of every mode (m, cells). No status, so a little less work."""
    model, tool = pinocchio_model(arm.mechanism)
    data, N, m, rows = model.createData(), arm.N, arm.m, list(arm.task.indices)
    M, J, q = np.empty((BLOCK, N, N)), np.empty((BLOCK, 6, N)), np.empty((BLOCK, N))
    q[:, :m] = arm.base.equilibrium
    stiffness, damping = arm.base.stiffness.tolist(), arm.base.damping.tolist()

    def inertia_and_jacobian(count: int) -> None:
        crba, jacobian, world, axes = pin.crba, pin.getFrameJacobian, pin.Convention.WORLD, pin.LOCAL_WORLD_ALIGNED
        for one, inertia, rates in zip(q[:count], M, J, strict=False):
            inertia[:] = crba(model, data, one, world)
            rates[:] = jacobian(model, data, tool, axes)

    def modal(count: int) -> np.ndarray:
        upper = np.ascontiguousarray(M[:count].reshape(count, -1).T).reshape(N, N, count)
        task = np.ascontiguousarray(J[:count, rows].reshape(count, -1).T).reshape(len(rows), N, count)
        inertia = tuple(tuple(upper[min(i, j), max(i, j)] for j in range(N)) for i in range(N))
        configuration = Configuration(inertia, tuple(map(tuple, task)), arm.parts, stiffness, damping)
        return np.array([robustness(mode) for mode in configuration.modes])

    def run(joints: np.ndarray) -> np.ndarray:
        result = np.empty((m, joints.shape[1]))
        for begin in range(0, joints.shape[1], BLOCK):
            part = joints[:, begin : begin + BLOCK].T
            q[: len(part), m:] = part
            inertia_and_jacobian(len(part))
            result[:, begin : begin + BLOCK] = modal(len(part))
        return result

    return run

"""What the engines say of the original file: inertia, Jacobian and bias of the chain, all other joints held still."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

GRAVITY = np.array([1.5, -3.0, -9.0])


class Answer(NamedTuple):
    """M without armature, the 6 x N Jacobian of the tool (x y z rx ry rz), h + g, and where the tool is."""

    M: np.ndarray
    J: np.ndarray
    bias: np.ndarray
    position: np.ndarray
    rotation: np.ndarray


def pinocchio_answer(path: Path, tool: str, joints: Sequence[str], q: np.ndarray, rates: np.ndarray) -> Answer:
    """Pinocchio reads the file itself; its continuous joints are cosine and sine."""
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(path))
    model.gravity.linear = GRAVITY
    data = model.createData()
    full, v = pin.neutral(model), np.zeros(model.nv)
    columns = []
    for name, angle, rate in zip(joints, q, rates, strict=True):
        joint = model.joints[model.getJointId(name)]
        full[joint.idx_q : joint.idx_q + joint.nq] = [np.cos(angle), np.sin(angle)] if joint.nq == 2 else [angle]
        v[joint.idx_v] = rate
        columns.append(joint.idx_v)
    M = np.triu(pin.crba(model, data, full))
    M = M + np.triu(M, 1).T
    bias = pin.nonLinearEffects(model, data, full, v)
    frame = model.getFrameId(tool)
    J = pin.computeFrameJacobian(model, data, full, frame, pin.LOCAL_WORLD_ALIGNED)
    pin.framesForwardKinematics(model, data, full)
    at = data.oMf[frame]
    return Answer(M[np.ix_(columns, columns)], J[:, columns], bias[columns], at.translation, at.rotation)


def mujoco_answer(model, tool: tuple[str, str], joints: Sequence[str], q: np.ndarray, rates: np.ndarray) -> Answer:
    """MuJoCo on a model that it compiled from the original text. tool : "body" or "site", and its name."""
    import mujoco

    model.opt.gravity[:] = GRAVITY
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    data = mujoco.MjData(model)
    columns = [int(model.joint(name).dofadr[0]) for name in joints]
    data.qpos[[int(model.joint(name).qposadr[0]) for name in joints]] = q
    data.qvel[columns] = rates
    mujoco.mj_forward(model, data)
    M = mujoco_inertia(model, data)
    J = np.zeros((6, model.nv))
    kind, name = tool
    number = getattr(model, kind)(name).id
    (mujoco.mj_jacBody if kind == "body" else mujoco.mj_jacSite)(model, data, J[:3], J[3:], number)
    at = getattr(data, kind)(name)
    armature = np.diag(model.dof_armature[columns])
    return Answer(
        M[np.ix_(columns, columns)] - armature,
        J[:, columns],
        data.qfrc_bias[columns].copy(),
        at.xpos.copy(),
        at.xmat.reshape(3, 3).copy(),
    )


def mujoco_inertia(model, data) -> np.ndarray:
    """M of all joints, a column at a time, because the way to ask for all of it differs between versions."""
    import mujoco

    M, column = np.zeros((model.nv, model.nv)), np.zeros(model.nv)
    for number, unit in enumerate(np.eye(model.nv)):
        mujoco.mj_mulM(model, data, column, unit)
        M[:, number] = column
    return M

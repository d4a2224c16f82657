"""The nonlinear plant by MuJoCo: its inertia matrix, its bias forces, its springs; nothing of our dynamics."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.kinematics import Frames
from flexbase.errors import InputError
from flexbase.model.formats.quiet_mujoco import quiet_mujoco
from flexbase.model.mounted import MountedArm
from flexbase.plant import Pose
from flexbase.simulation.plants.builtin import solved
from flexbase.simulation.plants.mjcf import mjcf_of


@dataclass(frozen=True, eq=False)
class MujocoPlant:
    """A plant compiled by MuJoCo. Made by `mujoco_plant`; not to be shared between threads.

    arm : that was compiled; model, data : MuJoCo's MjModel, and an MjData of it
    """

    arm: MountedArm
    model: Any
    data: Any

    def equation(self, q: Array, rates: Array) -> tuple[Array, Array]:
        """M and f of M q'' = f + [0; tau] in one state: f is springs and dampers less bias.  [U03 eq 1, 2]"""
        self.data.qpos[:], self.data.qvel[:] = q, rates
        M, units = np.zeros((len(q), len(q))), np.eye(len(q))
        with quiet_mujoco("mujoco") as mujoco:
            mujoco.mj_forward(self.model, self.data)
            for column, unit in zip(M, units, strict=True):  # mj_fullM's arguments differ between versions of MuJoCo
                mujoco.mj_mulM(self.model, self.data, column, unit)
        return M, self.data.qfrc_passive - self.data.qfrc_bias

    def accelerations(self, frames: Frames, q: Array, rates: Array, torque: Array, E: Array | None) -> Array:
        """q'' of (M - blkdiag(0, E)) q'' = f + [0; tau~], shape (..., N), with M and f from MuJoCo.  [U03 eq 1, 11]

        q, rates : shape (..., N); `frames`, our own placement at q, is not looked at
        torque : tau~, without the compensator's share, shape (..., n)
        Assumes M - E positive definite.
        """
        result = np.empty(q.shape)
        for state in np.ndindex(q.shape[:-1]):
            M, force = self.equation(q[state], rates[state])
            driven = self.arm.parts.whole(np.zeros(self.arm.m), torque[state])
            result[state] = solved(self.arm, M.tolist(), force + driven, E)
        return result


def mujoco_plant(pose: Pose) -> MujocoPlant:
    """Compile a plant in MuJoCo, its base springs at rest where the pose's are. Raises InputError, MissingExtra."""
    text = mjcf_of(replace(pose.arm, base=replace(pose.arm.base, equilibrium=pose.equilibrium)))
    try:
        with quiet_mujoco("mujoco") as mujoco:
            model = mujoco.MjModel.from_xml_string(text)
            return MujocoPlant(pose.arm, model, mujoco.MjData(model))
    except ValueError as fault:
        raise InputError(f"{pose.plant.name}: MuJoCo refuses the plant: {' '.join(str(fault).split())}") from fault

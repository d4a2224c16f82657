"""Many runs in MuJoCo under held torques: its own equations, its own integrator, its own kinematics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.dynamics.task import Target, tool_error
from flexbase.model.formats.quiet_mujoco import quiet_mujoco
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose
from flexbase.simulation.plants.builtin_held import pace_of
from flexbase.simulation.plants.mujoco_plant import mujoco_plant
from flexbase.simulation.plants.physics import Seen

FINEST = 2e-4  # s: longest time step


@dataclass(eq=False)
class _One:
    """One run: MuJoCo's model and state, the lagged rates of the arm, the target."""

    model: Any
    data: Any
    lagged: Array
    target: Target


class MujocoHeld:
    """Runs with a goal pose each. Implements `Physics`; MuJoCo steps by its RK4, `timestep` at most 0.2 ms."""

    def __init__(self, goals: Sequence[Pose], start: Array, sensing: Sensing) -> None:
        self._arm = goals[0].arm
        self._steps = int(np.ceil(sensing.step / FINEST - 1e-9))
        self._runs = []
        for goal, q in zip(goals, start, strict=True):
            plant = mujoco_plant(goal)
            plant.model.opt.timestep = sensing.step / self._steps
            plant.data.qpos[:] = q
            with quiet_mujoco("mujoco") as mujoco:
                plant.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
                mujoco.mj_forward(plant.model, plant.data)
            self._runs.append(_One(plant.model, plant.data, np.zeros(self._arm.n), goal.target))
        self._tool = self._runs[0].model.site("tool").id
        self._pace = pace_of(sensing)
        self._filter = _first_order(sensing.step / self._steps, self._pace) if self._pace else None

    def observe(self, torque: Array, tip_force: Array) -> Seen:
        """See `Physics`."""
        with quiet_mujoco("mujoco") as mujoco:
            return self._observed(mujoco, torque, tip_force)

    def _observed(self, mujoco: Any, torque: Array, tip_force: Array) -> Seen:
        arm, parts = self._arm, []
        for run, u, f in zip(self._runs, torque, tip_force, strict=True):
            data = run.data
            if self._pace:
                mujoco.mj_kinematics(run.model, data)
                acceleration = (arm.parts.arm(data.qvel) - run.lagged) * self._pace
            else:
                data.ctrl[:] = u
                self._push(mujoco, run, f)
                mujoco.mj_forward(run.model, data)
                acceleration = arm.parts.arm(data.qacc)
            place, turned = data.site_xpos[self._tool], data.site_xmat[self._tool].reshape(3, 3)
            error = tool_error(place, turned, arm.task, run.target)
            parts.append((data.qpos.copy(), data.qvel.copy(), error, acceleration))
        return Seen(*(np.stack(column) for column in zip(*parts, strict=True)))

    def advance(self, torque: Array, tip_force: Array, alive: Array) -> None:
        """See `Physics`."""
        with quiet_mujoco("mujoco") as mujoco:
            self._advance(mujoco, torque, tip_force, alive)

    def _advance(self, mujoco: Any, torque: Array, tip_force: Array, alive: Array) -> None:
        parts = self._arm.parts
        for run, u, f, going in zip(self._runs, torque, tip_force, alive, strict=True):
            if not going:
                continue
            run.data.ctrl[:] = u
            if self._filter is None and not f.any():
                run.data.qfrc_applied[:] = 0.0
                mujoco.mj_step(run.model, run.data, self._steps)
                continue
            for _ in range(self._steps):
                self._push(mujoco, run, f)
                before = parts.arm(run.data.qvel)
                mujoco.mj_step(run.model, run.data)
                if self._filter is not None:
                    kept, old, new = self._filter
                    run.lagged = kept * run.lagged + old * before + new * parts.arm(run.data.qvel)

    def _push(self, mujoco: Any, run: _One, force: Array) -> None:
        """Joint forces of a force on the tool, by MuJoCo's Jacobian at its present place."""
        run.data.qfrc_applied[:] = 0.0
        if not force.any():
            return
        mujoco.mj_kinematics(run.model, run.data)
        mujoco.mj_comPos(run.model, run.data)
        J = np.zeros((6, run.model.nv))
        mujoco.mj_jacSite(run.model, run.data, J[:3], J[3:], self._tool)
        run.data.qfrc_applied[:] = J[list(self._arm.task.indices)].T @ force


def _first_order(time: float, pace: float) -> tuple[float, float, float]:
    """w at the end of a step from w, v at its begin and v at its end: w' = (v - w)/T, exact for a straight line of v.

    The line's error is (omega time)^2/12 of the rates at omega: 3e-4 at 277 rad/s and 0.2 ms.
    """
    x = time * pace
    kept = float(np.exp(-x))
    mean = -float(np.expm1(-x)) / x  # of exp(-s) over the step
    return kept, mean - kept, 1.0 - mean

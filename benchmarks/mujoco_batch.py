"""MuJoCo's own batch, `mujoco.rollout` on one thread: one Euler step from each configuration."""

from __future__ import annotations

import mujoco
import mujoco.rollout
import numpy as np
from controls import must_agree
from kernels import MANY, SOME, kernel
from models import PANDA1, joints, plant
from timing import Ratio, Side, race

from flexbase.dynamics.kinematics import forward
from flexbase.simulation.plants.builtin import accelerations
from flexbase.simulation.plants.mjcf import mjcf_of

STEP = 1e-6  # s
CLOSE = 1e-9  # of the largest speed gained: what M's condition number and the step's own rounding leave


def panda1_vs_mujoco_batch() -> list[Ratio]:
    """Robustness by the kernel against a step by MuJoCo, which computes M and its factors, bias forces and sensors.

    To MuJoCo's advantage: it neither hands out M and J nor goes on to modes.
    """
    arm, made, many = plant(PANDA1).arm, kernel(PANDA1), joints(PANDA1, MANY)
    model = mujoco.MjModel.from_xml_string(mjcf_of(arm))
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_EULER, STEP
    for flag in ("CONSTRAINT", "CONTACT", "EULERDAMP"):
        model.opt.disableflags |= getattr(mujoco.mjtDisableBit, f"mjDSBL_{flag}")
    states = np.zeros((SOME, mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    q, rates = states[:, 1 : 1 + arm.N], states[:, 1 + arm.N : 1 + 2 * arm.N]
    q[:, arm.m :] = many[:, :SOME].T
    rates[:] = np.random.default_rng(2).uniform(-1.0, 1.0, rates.shape)
    data, after = [mujoco.MjData(model)], np.empty((SOME, 1, states.shape[1]))

    def step() -> np.ndarray:
        mujoco.rollout.rollout(model, data, states, nstep=1, state=after)
        return (after[:, 0, 1 + arm.N : 1 + 2 * arm.N] - rates).T / STEP

    pose = plant(PANDA1).at(q[0, arm.m :])
    ours = accelerations(pose, forward(arm.mechanism, tuple(q.T)), q, rates, np.zeros((SOME, arm.n)), None)
    must_agree("MuJoCo", step(), ours.T, np.full(SOME, CLOSE))
    out = np.empty((made.outputs, MANY))
    fast = Side(lambda: made(many, out, threads=1), times=5, work=MANY)
    return [race("panda1_vs_mujoco_batch", fast, "one step of mujoco.rollout", Side(step, work=SOME))]

"""Many runs of the nonlinear plant: the iterated kernel against MuJoCo's rollouts, and against runs one at a time."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import mujoco
import mujoco.rollout
import numpy as np
from models import PLANAR3R, plant
from scipy.integrate import solve_ivp
from timing import Ratio, Side, race

import flexbase as fb
from flexbase.control.measured import Measured
from flexbase.dynamics.kinematics import forward
from flexbase.simulation.many.phase import Always, Phase
from flexbase.simulation.many.step import Step
from flexbase.simulation.plants.builtin import accelerations
from flexbase.simulation.plants.mjcf import mjcf_of
from flexbase.trace.algebra import Vector

END, STEP = 0.1, 5e-4  # s; both sides take the same steps of the same Runge-Kutta method
RUNS, FEW, CHECKED = 2048, 256, 3  # by the kernel, by MuJoCo, and of those by DOP853
CLOSE = 1e-8  # rad
TIP, NEAR = [0.33, -0.25], [0.33, -0.2]


@dataclass(frozen=True)
class JointPD:
    """tau = stiffness (goal - q_a) - damping q_a': a law that MuJoCo's own actuators have too."""

    goal: fb.Pose
    stiffness: float
    damping: float

    def torque(self, seen: Measured) -> Vector:
        wanted = self.goal.joints.tolist()
        return tuple(
            self.stiffness * (to - joint) - self.damping * rate
            for to, joint, rate in zip(wanted, seen.joints, seen.rates, strict=True)
        )


def simulate_vs_mujoco() -> list[Ratio]:
    """Runs a second a thread of the paper's arm under joint control, from random starts to the same 1e-8 rad.

    The kernel also watches the tip error and M's pivots in every step; `mujoco.rollout` also writes every state.
    """
    goal = plant(PLANAR3R).at_tip(TIP)
    law = JointPD(goal, 2e3, 40.0)
    starts = np.tile(goal.q[:, None], (1, RUNS))
    starts[list(goal.arm.parts.active)] += np.random.default_rng(0).uniform(-0.1, 0.1, (goal.arm.n, RUNS))
    rollout, few = _rollout(goal, law, starts[:, :FEW]), np.ascontiguousarray(starts[:, :FEW])
    truth = np.array([_reference(goal, law, start) for start in few.T[:CHECKED]]).T
    ours, theirs = _kernel(law, few), rollout()
    for name, answers in (("the kernel", ours), ("MuJoCo", theirs)):
        if not _same(answers[:, :CHECKED], truth):
            raise SystemExit(f"control failed: {name} is {np.abs(answers[:, :CHECKED] - truth).max():.1e} rad off")
    if not _same(ours, theirs):
        raise SystemExit("control failed: the kernel and MuJoCo end elsewhere")
    wrong = {
        "no gain": _kernel(replace(law, stiffness=0.0), few),
        "steps ten times as long": _kernel(law, few, 10.0 * STEP),
        "the neighbour's run": np.roll(ours, 1, axis=1),
    }
    for kind, answers in wrong.items():
        if _same(answers[:, :CHECKED], truth):
            raise SystemExit(f"control failed: {kind} would pass")
    fast = Side(lambda: _kernel(law, starts), work=RUNS)
    return [race("simulate_vs_mujoco", fast, "mujoco.rollout, same law, steps and method", Side(rollout, work=FEW))]


def _same(one: np.ndarray, other: np.ndarray) -> bool:
    return bool(np.abs(one - other).max() <= CLOSE)


def _kernel(law: JointPD, starts: np.ndarray, step: float = STEP) -> np.ndarray:
    """Joints at the end, shape (N, runs), on one thread."""
    phase, N = Phase(Step(law.goal, Always(law), None), 0.0, END), len(starts)
    state = np.zeros((phase.step.state, starts.shape[1]))
    state[:N] = starts
    return phase.run(state, starts[list(law.goal.arm.parts.active)], step, threads=1)[:N]


def _rollout(goal: fb.Pose, law: JointPD, starts: np.ndarray):  # type: ignore[no-untyped-def]
    """MuJoCo's batch on one thread, with nothing switched on that these runs do not need."""
    N = goal.arm.N
    model = mujoco.MjModel.from_xml_string(mjcf_of(goal.arm))
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, STEP
    for flag in ("CONSTRAINT", "CONTACT"):
        model.opt.disableflags |= getattr(mujoco.mjtDisableBit, f"mjDSBL_{flag}")
    model.actuator_biastype[:] = mujoco.mjtBias.mjBIAS_AFFINE
    model.actuator_gainprm[:, 0] = 0.0
    model.actuator_biasprm[:, 0] = law.stiffness * goal.joints
    model.actuator_biasprm[:, 1:3] = -law.stiffness, -law.damping
    states = np.zeros((starts.shape[1], mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    states[:, 1 : 1 + N] = starts.T
    steps, data = round(END / STEP), [mujoco.MjData(model)]
    after = np.empty((len(states), steps, states.shape[1]))

    def run() -> np.ndarray:
        mujoco.rollout.rollout(model, data, states, nstep=steps, state=after)
        return after[:, -1, 1 : 1 + N].T

    return run


def _reference(goal: fb.Pose, law: JointPD, start: np.ndarray) -> np.ndarray:
    """Joints at the end by DOP853, far below `CLOSE`."""
    arm, N = goal.arm, goal.arm.N

    def rate(time: float, x: np.ndarray) -> np.ndarray:
        q, rates = x[:N], x[N:]
        torque = np.array(law.torque(Measured(time, arm.parts.arm(q), arm.parts.arm(rates), (), ())))
        return np.concatenate([rates, accelerations(goal, forward(arm.mechanism, tuple(q)), q, rates, torque, None)])

    x = np.concatenate([start, np.zeros(N)])
    return solve_ivp(rate, (0.0, END), x, method="DOP853", rtol=1e-11, atol=1e-13).y[:N, -1]


def simulate_many_vs_simulate() -> list[Ratio]:
    """The paper's move and settling with its compensator, on one thread, against `simulate` run by run."""
    paper = plant(PLANAR3R)
    goal = paper.at_tip(TIP)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fb.FlexbaseWarning)
        gain = fb.design(goal, "exact", natural_frequency=346.8)
    centre = paper.at_tip(NEAR).joints
    starts = centre + np.random.default_rng(0).uniform(-0.1, 0.1, (RUNS, 2))

    def many(compensator: fb.Compensator | None = gain) -> np.ndarray:
        return fb.simulate_many(paper, starts, goal, compensator, move=fb.Moves(threads=1)).q

    def one() -> np.ndarray:
        return fb.simulate(paper, paper.at(starts[0]), goal, gain, move=fb.Move(interval=1e-2)).q[-1]

    if not _same(many()[0], one()):
        raise SystemExit("control failed: simulate_many and simulate end elsewhere")
    if _same(many(None)[0], one()):
        raise SystemExit("control failed: a run without the compensator would pass")
    return [race("simulate_many_vs_simulate", Side(many, work=RUNS), "simulate, run by run", Side(one), rounds=7)]

"""MuJoCo as second plant: the same machine from its own equations, and the same motion from its own integrator."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import flexbase
from flexbase import InputError, MissingExtra
from flexbase.control.joint_tracking import JointTracking
from flexbase.control.measured import Measured
from flexbase.control.task_pd import TaskPD
from flexbase.control.trajectories import LAWS, JointPath
from flexbase.dynamics.forces import bias_forces
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import forward, jacobian
from flexbase.model.base import make_base
from flexbase.model.loop import Gain
from flexbase.model.mounted import MountedArm
from flexbase.model.task import Task
from flexbase.plant import Plant
from flexbase.simulation import Move
from flexbase.simulation.plants.engines import ENGINES
from flexbase.simulation.plants.mjcf import LEAST, to_mjcf
from flexbase.simulation.plants.mujoco_plant import mujoco_plant
from systems.planar import planar, sliding_pair
from systems.random_plants import random_mechanism, random_pose

mujoco = pytest.importorskip("mujoco")

POSES = 200
EQUAL = 1e-10  # of M, J and forces, in SI units
SAME_PATH = 1e-6  # m or rad of tip error
START, GOAL = [0.33, 0.25], [0.33, -0.25]


def tool_jacobian(model, data):
    """MuJoCo's Jacobian of the tool site, 6 x N: positions, then rotations, world axes."""
    J = np.zeros((6, model.nv))
    mujoco.mj_jacSite(model, data, J[:3], J[3:], model.site("tool").id)
    return J


def spring_forces(pose, q, rates):
    """tau_p of [U03 eq 2] and zeros for the arm."""
    m, base = pose.arm.m, pose.arm.base
    tau = base.stiffness @ (pose.equilibrium - q[:m]) - base.damping @ rates[:m]
    return np.concatenate([tau, np.zeros(pose.arm.n)])


def assert_same_equation(pose, seed, poses=POSES, equal=EQUAL):
    """Tool, J, M, springs and bias of MuJoCo and ours in random states of a plant."""
    arm, rng, plant = pose.arm, np.random.default_rng(seed), mujoco_plant(pose)
    data = plant.data
    for _ in range(poses):
        q, rates = rng.uniform(-2.0, 2.0, arm.N), rng.uniform(-2.0, 2.0, arm.N)
        M, force = plant.equation(q, rates)
        frames = forward(arm.mechanism, tuple(q.tolist()))
        assert data.site("tool").xpos == pytest.approx(np.array(frames.tool_position), rel=0.0, abs=equal)
        assert data.site("tool").xmat.reshape(3, 3) == pytest.approx(np.array(frames.tool_rotation), rel=0.0, abs=equal)
        assert tool_jacobian(plant.model, data) == pytest.approx(np.array(jacobian(frames)), rel=0.0, abs=equal)
        inertia = np.array(mass_matrix(frames))
        assert inertia == pytest.approx(M, rel=0.0, abs=equal)
        bias = np.array(bias_forces(frames, tuple(rates.tolist()), tuple(arm.gravity.tolist())))
        assert data.qfrc_bias == pytest.approx(bias, rel=0.0, abs=equal)
        springs = spring_forces(pose, q, rates)
        size = 1.0 + np.abs(springs).max()  # springs of 1e5 N m/rad, bent by 2 rad: 1e-10 is beyond doubles there
        assert data.qfrc_passive == pytest.approx(springs, rel=0.0, abs=1e-14 * size + equal)
        assert force == pytest.approx(springs - bias, rel=0.0, abs=1e-14 * size + equal)


CHAINS = [(1, 2, 2, 0.0), (1, 3, 3, 0.5), (2, 4, 3, 0.3), (3, 6, 6, 0.2), (6, 7, 6, 0.3)]


@pytest.mark.parametrize(("m", "n", "k", "prismatic"), CHAINS)
def test_equations_are_ours_to_1e_10(m, n, k, prismatic):
    """Tool, J, M, bias and base forces, in 200 random states of 3-D arms: gravity, sliding joints, full matrices."""
    pose = random_pose(11, m, n, k, gravity=True, prismatic=prismatic)
    assert m == 1 or pose.arm.base.stiffness[0, 1] != 0.0
    assert_same_equation(pose, seed=m + n)


def test_a_wrong_mass_would_be_seen():
    """The control: one gram more on one link moves M by a thousand times the tolerance and more."""
    pose = random_pose(11, 2, 4, 3, gravity=True)
    plant, q = mujoco_plant(pose), pose.q
    plant.model.body_mass[3] += 1e-3
    M, _ = plant.equation(q, np.zeros_like(q))
    assert np.abs(M - pose.M).max() > 1e3 * EQUAL


def test_the_papers_arm_has_its_equations(paper_pose):
    """Planar links have Izz alone, which no body has: balls with the same Izz give the same equations."""
    assert_same_equation(paper_pose, seed=1)


def test_planar_links_slide_and_turn_under_gravity():
    """A sliding joint between planar turning ones, and a cart whose bodies never turn at all."""
    assert_same_equation(planar([0.2, 0.3, 0.25, 0.2], slide=(2,), gravity=(1.0, -9.81, 0.0)).at([0.3, 0.4, 0.5]), 2)
    assert_same_equation(sliding_pair(0.6).at([0.2]), 3)


def random_arm(seed, mass=None, inertia=None, N=6, m=2):
    """A random 3-D arm on its base, with masses and inertias of one's own."""
    rng = np.random.default_rng(seed)
    mechanism = random_mechanism(rng, N, payload=False, prismatic=0.4)
    changes = {} if mass is None else {"mass": np.array(mass)}
    if inertia is not None:
        changes["inertia"] = np.array(inertia)
    base = make_base(2e4 * np.array([[2.0, 0.5], [0.5, 1.0]]), [0.0, 12.0], [0.05, -0.1], m)
    arm = MountedArm("made up", replace(mechanism, **changes), base, Task(("x", "y", "z")), np.array([1.0, 2.0, -9.0]))
    return Plant(arm)


def test_joints_of_massless_links_go_to_the_next_body():
    """Bodies 0, 2 and 3 have no mass: MuJoCo gets three bodies with six joints, and the same equations."""
    rng = np.random.default_rng(5)
    solid = random_mechanism(rng, 6).inertia
    inertia = [np.zeros((3, 3)) if i in (0, 2, 3) else solid[i] for i in range(6)]
    plant = random_arm(4, [0.0, 2.0, 0.0, 0.0, 1.5, 2.5], inertia)
    pose = plant.at([0.3, -0.4, 0.5, 0.6])
    model = mujoco_plant(pose).model
    assert model.body_jntnum.tolist() == [0, 2, 3, 1]
    assert [model.joint(i).name for i in range(6)] == list(plant.arm.mechanism.joint_names)
    assert_same_equation(pose, seed=6)


def test_point_masses_and_rods_get_the_least_inertia():
    """Zero principal inertias become 1e-15 kg m^2, far below the tolerance; so does the mass of a rotor."""
    rod = np.diag([0.0, 0.02, 0.02])
    solid = random_mechanism(np.random.default_rng(5), 6).inertia
    inertia = [solid[0], np.zeros((3, 3)), rod, np.zeros((3, 3)), solid[4], solid[5]]
    pose = random_arm(4, [3.0, 2.0, 1.0, 1.0, 0.0, 2.5], inertia).at([0.3, -0.4, 0.5, 0.6])
    model = mujoco_plant(pose).model
    assert model.body_inertia[2] == pytest.approx([LEAST] * 3, rel=1e-12)
    assert model.body_mass[5] == LEAST
    assert_same_equation(pose, seed=7)


def test_flat_bodies_pass_whatever_the_rounding():
    """A lamina has A + B = C; turned about, rounding makes C the larger half of the time, which MuJoCo would refuse."""
    rng = np.random.default_rng(8)
    for _ in range(20):
        turns = Rotation.from_rotvec(rng.normal(size=(6, 3))).as_matrix()
        inertia = turns @ np.diag([0.01, 0.03, 0.04]) @ np.swapaxes(turns, 1, 2)
        pose = random_arm(4, None, inertia).at([0.3, -0.4, 0.5, 0.6])
        assert_same_equation(pose, seed=9, poses=2)


def test_an_impossible_inertia_is_refused_by_name():
    """C above A + B, on a link that turns about many directions: MuJoCo refuses it, and so do we, with words."""
    inertia = random_mechanism(np.random.default_rng(5), 6).inertia.copy()
    inertia[4] = np.diag([0.01, 0.01, 0.05])
    with pytest.raises(InputError, match=r'joint "j4" has principal inertias \[0.01, 0.01, 0.05\]'):
        to_mjcf(random_arm(4, None, inertia))


def test_springs_rest_where_the_pose_says():
    """A pose may shift the base's equilibrium: then MuJoCo's springs, tendons or not, are at rest there."""
    pose = random_pose(12, 2, 3, 3, gravity=True)
    shifted = pose.plant.at(pose.q + 0.02)
    assert np.abs(shifted.equilibrium - pose.arm.base.equilibrium).max() > 1e-3
    assert_same_equation(shifted, seed=10, poses=5)
    plant = mujoco_plant(shifted)
    _, force = plant.equation(shifted.q, np.zeros(5))
    assert force[:2] == pytest.approx([0.0, 0.0], abs=1e-8)  # it rests there, sagged
    assert force[2:] == pytest.approx(-shifted.holding_torque, abs=1e-8)


def test_mjcf_compiles_to_the_plant():
    """to_mjcf is text that MuJoCo compiles: names, order, motors, springs, gravity, tool; and it is all in radians."""
    plant = planar([0.2, 0.3, 0.25, 0.2], m=2, gravity=(0.0, -9.81, 0.0))
    model = mujoco.MjModel.from_xml_string(to_mjcf(plant))
    assert [model.joint(i).name for i in range(model.njnt)] == list(plant.arm.mechanism.joint_names)
    assert [model.actuator(i).name for i in range(model.nu)] == ["q3", "q4"]
    assert model.jnt_stiffness.ravel()[:2] == pytest.approx(np.diag(plant.arm.base.stiffness), rel=1e-15)
    assert model.dof_damping.ravel()[:4] == pytest.approx([10.0, 10.0, 0.0, 0.0], rel=1e-15)
    assert model.opt.gravity.tolist() == [0.0, -9.81, 0.0]
    assert model.body_mass[1:] == pytest.approx(plant.arm.mechanism.mass, rel=1e-15)
    assert not model.jnt_limited.any()
    assert (model.ngeom, model.ntendon, model.neq) == (0, 0, 0)


def test_a_motor_is_the_arm_torque():
    """ctrl of the exported file's motors enters the equation as tau: M q'' = f + [0; tau]."""
    pose = random_pose(13, 2, 4, 3, gravity=True)
    plant, torque = mujoco_plant(pose), np.array([1.0, -2.0, 3.0, -4.0])
    rates = np.linspace(-1.0, 1.0, 6)
    M, force = plant.equation(pose.q, rates)
    plant.data.ctrl[:] = torque
    mujoco.mj_forward(plant.model, plant.data)
    force[2:] += torque
    assert plant.data.qacc == pytest.approx(np.linalg.solve(M, force), rel=1e-9)


def test_markup_in_names_survives_and_control_characters_do_not():
    """A name is data: quotes and angle brackets come back as they were; what XML cannot hold is refused."""
    names = ('<joint name="x"/>', "a & b", "'\"", "ünï", "world", "tool")
    plant = random_arm(4)
    arm = replace(plant.arm, mechanism=replace(plant.arm.mechanism, joint_names=names), name="</mujoco>")
    model = mujoco.MjModel.from_xml_string(to_mjcf(Plant(arm)))
    assert tuple(model.joint(i).name for i in range(6)) == names
    with pytest.raises(InputError, match=r"'bell\\x07' holds a character"):
        to_mjcf(Plant(replace(arm, name="bell\x07")))


def test_what_mujoco_refuses_becomes_our_error():
    """Two joints with one name: refused by MuJoCo's compiler, reported as an input error in one line."""
    plant = random_arm(4)
    arm = replace(plant.arm, mechanism=replace(plant.arm.mechanism, joint_names=("a",) * 6))
    with pytest.raises(InputError, match=r"MuJoCo refuses the plant: .*repeated") as caught:
        mujoco_plant(Plant(arm).at([0.3, -0.4, 0.5, 0.6]))
    assert "\n" not in str(caught.value)


# --- runs -------------------------------------------------------------------------------------------------------------


def run_cases():
    """Name, start, goal, gain matrix, and times: the paper's arm and 3-D arms, with and without compensator."""
    paper = flexbase.load("ueda2003")
    goal = paper.at_tip(GOAL)
    exact = flexbase.design(goal, "exact", natural_frequency=346.8)
    yield "paper", paper.at_tip(START), goal, None
    yield "paper, compensated", paper.at_tip(START), goal, exact
    flat = planar([0.2, 0.3, 0.25, 0.2], slide=(2,), gravity=(1.0, -9.81, 0.0), rows=("x", "y", "rz"))
    goal = flat.at([0.3, 0.9, 0.1])
    yield "sliding, gravity", flat.at([0.5, 0.7, 0.15]), goal, None
    for m, n, k, seed in ((2, 4, 3, 22), (3, 6, 6, 23)):
        goal = random_pose(seed, m, n, k, gravity=True, prismatic=0.3)
        start = goal.plant.at(goal.q[m:] + 0.1)
        lightest = np.linalg.eigvalsh(goal.M)[0]
        rng = np.random.default_rng(seed)
        gain = rng.normal(size=(n, n))
        gain = 0.5 * lightest * (gain + gain.T) / np.linalg.norm(gain + gain.T, 2)
        yield f"3-D {m}+{n}", start, goal, None
        yield f"3-D {m}+{n}, compensated", start, goal, Gain(gain)


CASES = {name: case for name, *case in run_cases()}
TIMES = {"switch": 0.05, "end": 0.1, "interval": 1e-3}


QUICK = {"paper", "paper, compensated", "3-D 2+4, compensated"}


@cache
def builtin_run(name):
    start, goal, gain = CASES[name]
    return flexbase.simulate(goal.plant, start, goal, gain, move=Move(**TIMES, self_motion=0.0))


@pytest.mark.parametrize("name", [pytest.param(one, marks=[pytest.mark.slow] * (one not in QUICK)) for one in CASES])
def test_the_same_run_with_mujocos_accelerations(name):
    """Same laws and integrator, on MuJoCo's M and forces: tips within 1e-6 m, torques within 1e-6 of their peak."""
    start, goal, gain = CASES[name]
    ours = builtin_run(name)
    run = flexbase.simulate(goal.plant, start, goal, gain, move=Move(**TIMES, self_motion=0.0, engine="mujoco"))
    assert ours.stopped is None
    assert np.abs(ours.tip_error).max() > 1e-2
    assert run.tip_error == pytest.approx(ours.tip_error, rel=0.0, abs=SAME_PATH)
    assert run.torque == pytest.approx(ours.torque, rel=0.0, abs=1e-6 * ours.peak_torque.max())
    assert (run.engine, ours.engine) == ("mujoco", "builtin")
    assert (run.to_dict()["engine"], run.stopped) == ("mujoco", None)


class MujocoLoop:
    """A control law inside MuJoCo: called by its integrator at every stage, it measures by MuJoCo and sets the motors.

    Nothing but the law itself is ours: no integrator, no dynamics, no kinematics of the plant.
    """

    def __init__(self, goal, law, E):
        self.goal, self.law, self.E = goal, law, E
        self.wanted = np.zeros(6)
        self.wanted[:3] = goal.frames.tool_position

    def measured(self, model, data):
        m, rows = self.goal.arm.m, list(self.goal.arm.task.indices)
        turned = (
            Rotation.from_matrix(data.site("tool").xmat.reshape(3, 3))
            * Rotation.from_matrix(np.array(self.goal.frames.tool_rotation)).inv()
        )
        error = np.concatenate([data.site("tool").xpos - self.wanted[:3], turned.as_rotvec()])[rows]
        rate = tool_jacobian(model, data)[rows] @ data.qvel
        return Measured(data.time, tuple(data.qpos[m:]), tuple(data.qvel[m:]), tuple(error), tuple(rate))

    def __call__(self, model, data):
        m = self.goal.arm.m
        torque = np.array(self.law.torque(self.measured(model, data)), dtype=float)
        if self.E is not None:
            M = np.zeros((model.nv, model.nv))
            for row, unit in zip(M, np.eye(model.nv), strict=True):
                mujoco.mj_mulM(model, data, row, unit)
            force = data.qfrc_passive - data.qfrc_bias
            force[m:] += torque
            M[m:, m:] -= self.E
            torque += self.E @ np.linalg.solve(M, force)[m:]
        data.qfrc_applied[m:] = torque


def stepped(start, goal, E, step):
    """The two phases of `simulate`, by MuJoCo's own Runge-Kutta steps; tip errors at the samples."""
    plant = mujoco_plant(goal)
    model, data, m = plant.model, plant.data, goal.arm.m
    model.opt.timestep = step
    assert model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4
    path = JointPath(start.q[m:], goal.q[m:], TIMES["switch"], LAWS["quintic"])
    laws = ((JointTracking(goal, path), None, TIMES["switch"]), (TaskPD(goal, goal.arm.gains), E, TIMES["end"]))
    every = round(TIMES["interval"] / step)
    data.qpos[:] = start.q
    mujoco.mj_forward(model, data)
    errors = []
    try:
        for law, gain, finish in laws:
            loop = MujocoLoop(goal, law, gain)
            mujoco.set_mjcb_control(loop)
            for count in range(round((finish - data.time) / step)):
                if count % every == 0:
                    mujoco.mj_forward(model, data)
                    errors.append(loop.measured(model, data).tip_error)
                mujoco.mj_step(model, data)
    finally:
        mujoco.set_mjcb_control(None)
    mujoco.mj_forward(model, data)
    return np.array([*errors, loop.measured(model, data).tip_error])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["paper", "paper, compensated", "sliding, gravity", "3-D 2+4", "3-D 2+4, compensated"])
def test_the_same_motion_by_mujocos_own_integrator(name):
    """MuJoCo steps itself, with the law at every stage of its Runge-Kutta steps: tips within 1e-6 m of ours."""
    start, goal, gain = CASES[name]
    errors = stepped(start, goal, None if gain is None else gain.E, 1e-4)
    assert errors == pytest.approx(builtin_run(name).tip_error, rel=0.0, abs=SAME_PATH)


def test_a_tenth_of_a_percent_of_stiffness_would_be_seen():
    """The control: base springs 0.1 % stiffer in MuJoCo, and the tip leaves ours by more than the tolerance."""
    goal = CASES["paper"][1]
    stiffer = replace(goal.arm, base=replace(goal.arm.base, stiffness=1.001 * goal.arm.base.stiffness))
    run = flexbase.simulate(Plant(stiffer), START, GOAL, move=Move(**TIMES, engine="mujoco"))
    assert np.abs(run.tip_error - builtin_run("paper").tip_error).max() > SAME_PATH


def test_a_run_that_must_stop_stops_as_ours_does(paper):
    """The goal's gain acting from a start where M - E is not positive: same reason, same time, on either engine."""
    _, goal, compensator = CASES["paper, compensated"]
    for name in ENGINES:
        always = Move(compensate="always", engine=name)
        run = flexbase.simulate(paper, paper.at([0.5, 0.6]), goal, compensator, move=always)
        assert run.stopped == "M - E was no longer positive definite at 0.0000 s"
        assert len(run.t) == 1


# --- around it --------------------------------------------------------------------------------------------------------


def test_an_unknown_engine_is_refused(paper):
    with pytest.raises(InputError, match=r'engine: "mujco" is unknown. Did you mean "mujoco"'):
        flexbase.simulate(paper, START, GOAL, move=Move(engine="mujco"))
    assert list(ENGINES) == ["builtin", "mujoco"]


def test_without_mujoco_the_extra_is_named(paper, monkeypatch):
    """No MuJoCo: its engine names the extra; to_mjcf, which only writes text, still works."""
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(MissingExtra, match=r'mujoco is not installed.*"flexbase\[mujoco\]"'):
        flexbase.simulate(paper, START, GOAL, move=Move(engine="mujoco"))
    assert to_mjcf(paper).startswith('<mujoco model="ueda2003">')


def test_importing_flexbase_does_not_import_mujoco():
    program = "import sys, flexbase.simulation.plants.engines; print('mujoco' in sys.modules)"
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    assert run.stdout.strip() == "False"

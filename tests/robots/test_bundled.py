"""Every bundled robot: its equations are those of Pinocchio and MuJoCo, its modes those of the full state space.

The promise is 1e-10 of the largest entry for M, J and bias, in 200 random states each, and 1e-8 for modal quantities.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import flexbase as fb
from files.engines import GRAVITY, mujoco_answer, pinocchio_answer
from flexbase.cli.main import run
from flexbase.dynamics.forces import bias_forces
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import forward, jacobian
from flexbase.model.files.bundled import robots
from flexbase.simulation.plants.mujoco_plant import mujoco_plant

from .witness import LIBRARY, Answer, Witness, tables

mujoco = pytest.importorskip("mujoco")

STATES = 200
EQUAL = 1e-10
EQUAL_MODES = 1e-8
SAME_PATH = 1e-6  # m or rad of tip error between the two engines
DOCS = Path(__file__).parents[2] / "docs"
NAMES = sorted(robots().descriptions)
FILES = {"ur5e": "tool0", "panda": "panda_hand_tcp", "iiwa": "lbr_iiwa_link_7", "scara": "tool"}


def our_answer(mechanism, q, rates):
    frames = forward(mechanism, tuple(q.tolist()))
    return Answer(
        np.array(mass_matrix(frames)),
        np.array(jacobian(frames)),
        np.array(bias_forces(frames, tuple(rates.tolist()), tuple(GRAVITY.tolist()))),
        np.array(frames.tool_position),
        np.array(frames.tool_rotation),
    )


def assert_same(ours, theirs):
    for name, mine, wanted in zip(Answer._fields, ours, theirs, strict=True):
        allowed = EQUAL * max(1.0, np.abs(wanted).max())
        assert mine == pytest.approx(wanted, rel=0.0, abs=allowed), name


def random_states(N, seed):
    rng = np.random.default_rng(seed)
    return zip(rng.uniform(-3.0, 3.0, (STATES, N)), rng.uniform(-2.0, 2.0, (STATES, N)), strict=True)


def poses(plant, count, seed=0):
    """Random poses, the elbow bent; base at rest."""
    rng = np.random.default_rng(seed)
    return [plant.at(rng.uniform(0.2, 1.5, plant.arm.n) * rng.choice([-1.0, 1.0], plant.arm.n)) for _ in range(count)]


# --- the equations ----------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module", params=sorted(FILES))
def bare(request):
    """An arm by its file alone, on a rigid base: which is said."""
    with pytest.warns(fb.FlexbaseWarning, match=r"no \[base\] joints: a rigid base"):
        plant = fb.load(LIBRARY / "robots" / f"{request.param}.urdf")
    assert plant.arm.m == 0
    return request.param, plant.arm.mechanism


def test_an_arm_alone_is_pinocchios(bare):
    """M, J, bias and tool of the file, as Pinocchio reads it."""
    name, mechanism = bare
    for q, rates in random_states(mechanism.N, 1):
        theirs = pinocchio_answer(LIBRARY / "robots" / f"{name}.urdf", FILES[name], mechanism.joint_names, q, rates)
        assert_same(our_answer(mechanism, q, rates), theirs)


def test_an_arm_alone_is_mujocos(bare):
    """MuJoCo reads the URDF itself; it drops what weighs on the world."""
    name, mechanism = bare
    spec = mujoco.MjSpec.from_file(str(LIBRARY / "robots" / f"{name}.urdf"))
    spec.compiler.fusestatic = False  # keep the tool's link
    model = spec.compile()
    for q, rates in random_states(mechanism.N, 2):
        theirs = mujoco_answer(model, ("body", FILES[name]), mechanism.joint_names, q, rates)
        assert_same(our_answer(mechanism, q, rates), theirs)


@pytest.mark.parametrize("name", NAMES)
def test_the_mounted_arm_is_pinocchios(name):
    """Base joints, their body, the mount and the arm, composed in Pinocchio from the text of the files."""
    mechanism, witness = fb.load(name).arm.mechanism, Witness(name)
    assert mechanism.joint_names == tuple(witness.model.names)[1:]
    for q, rates in random_states(mechanism.N, 3):
        assert_same(our_answer(mechanism, q, rates), witness(q, rates))


def test_a_gram_would_be_seen():
    """The control: a carriage one gram heavier moves M by far more than the tolerance."""
    witness, q = Witness("ur5e-gantry"), np.zeros(8)
    mechanism = fb.load("ur5e-gantry").arm.mechanism
    witness.model.inertias[2] += type(witness.model.inertias[2])(1e-3, np.zeros(3), np.zeros((3, 3)))
    assert np.abs(our_answer(mechanism, q, q).M - witness(q, q).M).max() > 1e3 * EQUAL


@pytest.mark.parametrize("name", NAMES)
def test_the_mounted_arm_is_mujocos(name):
    """M, J, bias, springs and tool of the model that MuJoCo compiles from our MJCF."""
    pose = poses(fb.load(name), 1)[0]
    plant, mechanism, m = mujoco_plant(pose), pose.arm.mechanism, pose.arm.m
    plant.model.opt.gravity[:] = GRAVITY
    project = tables(name)["base"]
    for q, rates in random_states(mechanism.N, 4):
        M, force = plant.equation(q, rates)
        J = np.zeros((6, mechanism.N))
        mujoco.mj_jacSite(plant.model, plant.data, J[:3], J[3:], plant.model.site("tool").id)
        at = plant.data.site("tool")
        theirs = Answer(M, J, plant.data.qfrc_bias, at.xpos, at.xmat.reshape(3, 3))
        assert_same(our_answer(mechanism, q, rates), theirs)
        springs = np.zeros(mechanism.N)
        springs[:m] = -np.array(project["stiffness"]) * q[:m] - np.array(project["damping"]) * rates[:m]
        size = max(1.0, np.abs(springs).max())
        assert force + plant.data.qfrc_bias == pytest.approx(springs, rel=0.0, abs=1e-14 * size + EQUAL)


# --- the modes --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_modes_are_those_of_the_full_state_space(name):
    """Frequency, damping, R, R', w and R_0 against eigenvectors of the 2N system from Pinocchio's matrices."""
    for pose in poses(fb.load(name), 4, seed=5):
        found, system = fb.modes(pose), Witness(name).state_space(pose.q)
        assert len(found) == len(system.vibrations) == pose.arm.m
        for mode, (pole, dyad) in zip(found.modes, system.vibrations, strict=True):
            assert mode.frequency == pytest.approx(abs(pole), rel=EQUAL_MODES)
            assert mode.damping_ratio == pytest.approx(-pole.real / abs(pole), rel=EQUAL_MODES)
            R, R_s = -2.0 * np.real(np.conj(pole) * dyad), 2.0 * np.real(dyad)
            size = np.abs(R).max()
            assert mode.residue == pytest.approx(R, rel=0.0, abs=EQUAL_MODES * size)
            assert mode.residue_s == pytest.approx(R_s, rel=0.0, abs=EQUAL_MODES * size)
            assert mode.robustness == pytest.approx(np.linalg.eigvalsh(R + R.T)[0], rel=0.0, abs=EQUAL_MODES * size)
        R_0 = system.rigid
        assert found.rigid_mode == pytest.approx(R_0, rel=0.0, abs=EQUAL_MODES * np.abs(R_0).max())


@pytest.mark.parametrize("name", sorted(robots().descriptions.keys() - {"ueda2003"}))
def test_bases_vibrate_as_bases_do(name):
    """2 to 60 Hz and less than a tenth of critical damping, wherever the arm stands. The paper's base is its own."""
    for pose in poses(fb.load(name), 20, seed=6):
        for mode in fb.modes(pose).modes:
            assert 2.0 < mode.frequency / (2.0 * np.pi) < 60.0
            assert 0.005 < mode.damping_ratio < 0.1


# --- what a user does with them ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_each_is_named_and_described(name):
    """A line in `flexbase robots`, its own name inside, gains to simulate with, a place in the docs; no warning."""
    assert 10 < len(robots().descriptions[name]) <= 120
    plant = fb.load(name)
    assert plant.name == name
    assert plant.arm.gains is not None
    assert f"`{name}`" in (DOCS / "robots.md").read_text("utf-8")


@pytest.mark.parametrize("name", sorted(FILES.keys() - {"scara"}))
def test_each_vendored_arm_has_its_licence_and_no_mesh(name):
    """The licence lies beside the file, which says where it is from and names no mesh."""
    text = (LIBRARY / "robots" / f"{name}.urdf").read_text("utf-8")
    assert len((LIBRARY / "robots" / f"LICENSE.{name}").read_text("utf-8")) > 500
    assert f"LICENSE.{name}" in text
    assert not any(word in text for word in ("<visual", "<collision", "<mesh", "package://", "filename"))


def called(capsys, *words):
    """Exit status, standard output and standard error of one command."""
    status = run(words)
    return status, *capsys.readouterr()


def joints_of(pose):
    return ",".join(repr(x) for x in pose.q[pose.arm.m :].tolist())


@pytest.mark.parametrize("name", NAMES)
def test_check_and_modes_run(name, capsys):
    pose = poses(fb.load(name), 1, seed=7)[0]
    for words in (["check", name], ["check", name, "--joints", joints_of(pose)]):
        status, out, err = called(capsys, *words)
        assert (status, err) == (0, "")
        assert pose.arm.mechanism.joint_names[-1] in out
    status, out, err = called(capsys, "modes", name, "--joints", joints_of(pose), "--json")
    assert (status, err) == (0, "")
    shown = [mode["frequency_rad_s"] for mode in json.loads(out)["modes"]]
    assert shown == [mode.frequency for mode in fb.modes(pose).modes]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("method", [None, "exact", "convex", "bounded"])
def test_design_answers_or_says_why_not(name, method, capsys):
    """An answer that can be built, or a line on why there is none; convex and bounded always answer."""
    pytest.importorskip("cvxpy")
    pose = poses(fb.load(name), 1, seed=8)[0]
    chosen = [] if method is None else ["--method", method]
    status, out, err = called(capsys, "design", name, "--joints", joints_of(pose), *chosen, "--json")
    if status:
        assert method == "exact" or (method is None and pose.arm.m == 1)  # where exact fits, it is the default
        assert "infeasible" in json.loads(out) if status == 1 else err.startswith("error: exact: ")
        return
    document = json.loads(out)
    certificate, E = document["certificate"], np.array(document["E"])
    assert E.shape == (pose.arm.n, pose.arm.n)
    assert certificate["min_eig_modified_inertia"] > 0.0
    if method in ("convex", "bounded"):
        assert certificate["algebraic_loop_radius"] <= 0.9 + 1e-9


@pytest.mark.parametrize("name", NAMES)
def test_both_engines_move_it_the_same_way(name):
    """A short move and the start of settling: the tips stay within 1e-6 m of each other."""
    plant = fb.load(name)
    start = poses(plant, 1, seed=9)[0]
    goal = plant.at(start.q[plant.arm.m :] + 0.01)
    times = {"switch": 0.006, "end": 0.012, "interval": 1e-3}
    ours = fb.simulate(plant, start, goal, move=fb.Move(**times))
    theirs = fb.simulate(plant, start, goal, move=fb.Move(**times, engine="mujoco"))
    assert (ours.stopped, theirs.stopped) == (None, None)
    assert np.abs(ours.tip_error).max() > 1e-3
    assert theirs.tip_error == pytest.approx(ours.tip_error, rel=0.0, abs=SAME_PATH)

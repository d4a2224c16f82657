"""The chain that is read from a file moves and weighs what Pinocchio and MuJoCo make of the same file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from files.engines import GRAVITY, Answer, mujoco_answer, pinocchio_answer
from flexbase.dynamics.forces import bias_forces
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import forward, jacobian
from flexbase.model.formats.robot import read_robot_file

DATA = Path(__file__).parent / "data"
POSES = 50


def our_answer(mechanism, q, rates) -> Answer:
    frames = forward(mechanism, tuple(q.tolist()))
    return Answer(
        np.array(mass_matrix(frames)),
        np.array(jacobian(frames)),
        np.array(bias_forces(frames, tuple(rates.tolist()), tuple(GRAVITY.tolist()))),
        np.array(frames.tool_position),
        np.array(frames.tool_rotation),
    )


def assert_same(robot, theirs):
    """1e-10 of the largest entry is the project's promise; rounding leaves some 1e-14."""
    N = robot.mechanism.N
    rng = np.random.default_rng(N)
    for q, rates in zip(rng.uniform(-3.0, 3.0, (POSES, N)), rng.uniform(-2.0, 2.0, (POSES, N)), strict=True):
        for name, ours, wanted in zip(
            Answer._fields, our_answer(robot.mechanism, q, rates), theirs(q, rates), strict=True
        ):
            allowed = 1e-10 * max(1.0, np.abs(wanted).max())
            assert ours == pytest.approx(wanted, rel=0.0, abs=allowed), name


@pytest.mark.parametrize("tool", ["tool", "wrist", "counterweight", "probe", "turret"])
def test_urdf_equals_pinocchio(tool):
    """Also frames half-way, at side branches, and with massless links at the end of the chain."""
    robot = read_robot_file(DATA / "spatial.urdf", tool, folder=DATA)
    joints = robot.mechanism.joint_names
    assert joints[:2] == ("slide", "pan")
    assert_same(robot, lambda q, v: pinocchio_answer(DATA / "spatial.urdf", tool, joints, q, v))


@pytest.mark.parametrize("name", ["tip", "hand", "lower", "ballast", "vane", "carriage"])
def test_mjcf_equals_mujoco(name):
    """Joint positions are MuJoCo's qpos, also where the reference is not zero."""
    import mujoco

    text = (DATA / "spatial.xml").read_text()
    start, end = text.index("<asset>"), text.index("</asset>")
    text = text[:start] + '<asset><mesh name="shell" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>' + text[end:]
    model = mujoco.MjModel.from_xml_string(text)
    robot = read_robot_file(DATA / "spatial.xml", name, folder=DATA)
    joints = robot.mechanism.joint_names
    assert joints[:2] == ("x", "tilt")
    kind = "site" if name == "tip" else "body"
    assert_same(robot, lambda q, v: mujoco_answer(model, (kind, name), joints, q, v))
    for ours, theirs in [
        (robot.armature, [model.joint(joint).armature[0] for joint in joints]),
        (robot.friction, [model.joint(joint).damping[0] for joint in joints]),
        (robot.stiffness, [model.joint(joint).stiffness[0] for joint in joints]),
        (robot.reference, [model.joint(joint).qpos0[0] for joint in joints]),
    ]:
        assert np.array_equal(ours, theirs)
    for joint, (low, high) in zip(joints, robot.limits, strict=True):
        known = model.joint(joint)
        limited = model.jnt_limited[known.id]
        assert (low, high) == (tuple(known.range) if limited else (-np.inf, np.inf))

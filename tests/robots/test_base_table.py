"""[base] and [robot] of a project that names a robot file: joints, body, mount, springs, friction, rotors, paths."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import flexbase as fb
from files.engines import mujoco_answer
from flexbase import FlexbaseWarning, InputError
from flexbase.dynamics.kinematics import forward
from flexbase.model.files.project import parse_project
from flexbase.simulation.plants.engines import ENGINES
from systems.oracle import RigidBodies

from .witness import LIBRARY

DATA = Path(__file__).parents[1] / "files" / "data"

ARM = """<?xml version="1.0"?>
<robot name="arm">
  <link name="root">
    <inertial><mass value="7"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="one">
    <inertial><origin xyz="0.02 0 0.1"/><mass value="4"/>
      <inertia ixx="0.05" iyy="0.06" izz="0.03" ixy="0.002" ixz="0" iyz="0.001"/></inertial>
  </link>
  <link name="two">
    <inertial><origin xyz="0.2 0.01 0"/><mass value="3"/>
      <inertia ixx="0.01" iyy="0.04" izz="0.042" ixy="0" ixz="0.001" iyz="0"/></inertial>
  </link>
  <link name="three">
    <inertial><origin xyz="0.15 0 0.02"/><mass value="2"/>
      <inertia ixx="0.004" iyy="0.015" izz="0.016" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="tool"/>
  <joint name="pan" type="continuous">
    <parent link="root"/><child link="one"/><origin xyz="0 0 0.1"/><axis xyz="0 0 2"/>
  </joint>
  <joint name="lift" type="revolute">
    <parent link="one"/><child link="two"/><origin xyz="0.05 0 0.2" rpy="0.1 0.2 0"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/>
  </joint>
  <joint name="elbow" type="revolute">
    <parent link="two"/><child link="three"/><origin xyz="0.4 0 0"/><axis xyz="0 1 0.5"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/>
  </joint>
  <joint name="end" type="fixed"><parent link="three"/><child link="tool"/><origin xyz="0.3 0 0"/></joint>
</robot>
"""
TOP = 'name = "test"\n'
TASK = '\n[task]\nrows = ["x", "y", "z"]\n'
ROBOT = '[robot]\nfile = "arm.urdf"\ntool = "tool"\n'
SPRINGS = "stiffness = [3.0e5, 2.0e4]\ndamping = [100.0, 8.0]\n"
JOINTS = (
    '\n[[base.joint]]\nname = "slide"\ntype = "prismatic"\naxis = [0.0, 3.0, 4.0]\n'
    '\n[[base.joint]]\nname = "twist"\ntype = "revolute"\naxis = [1.0, 2.0, -2.0]\n'
)
BODY = "\n[base.body]\nmass = 20.0\ncom = [0.1, -0.05, 0.2]\ninertia = [0.5, 0.6, 0.7, 0.01, -0.02, 0.03]\n"
MOUNT = "\n[base.mount]\nxyz = [0.1, 0.2, 0.3]\nrpy = [0.4, -0.5, 0.6]\n"
WHOLE = f"{TOP}{ROBOT}\n[base]\n{SPRINGS}{JOINTS}{BODY}{MOUNT}{TASK}"
IN_FREQUENCIES = (SPRINGS, "frequency = [60.0, 90.0]\ndamping_ratio = [0.01, 0.03]\nreference = [0.3, -0.6, 0.9]\n")
Q = np.array([0.02, -0.1, 0.3, -0.6, 0.9])


@pytest.fixture
def folder(tmp_path):
    """A folder with the arm in it."""
    home = tmp_path / "project"
    home.mkdir()
    (home / "arm.urdf").write_text(ARM)
    return home


def changed(text, *changes):
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def loaded(folder, *changes, text=WHOLE):
    (folder / "arm.toml").write_text(changed(text, *changes))
    return fb.load(folder / "arm.toml")


def refused(folder, *changes, text=WHOLE):
    """What the InputError says, in a line or two."""
    with pytest.raises(InputError) as fault:
        loaded(folder, *changes, text=text)
    message = str(fault.value)
    assert message.count("\n") <= 1
    return message


def inertia(mechanism, q):
    return RigidBodies(mechanism).inertia(np.asarray(q, dtype=float)) + np.diag(mechanism.armature)


# --- where things are and what they weigh -----------------------------------------------------------------------------


def test_added_joints_stand_before_the_arms(folder):
    """Names, kinds, unit axes; the file's root link rides on the body."""
    arm = loaded(folder).arm
    assert arm.mechanism.joint_names == ("slide", "twist", "pan", "lift", "elbow")
    assert arm.mechanism.joint_types == ("prismatic", "revolute", "revolute", "revolute", "revolute")
    assert arm.mechanism.axes[:3] == pytest.approx(np.array([[0, 0.6, 0.8], [1 / 3, 2 / 3, -2 / 3], [0, 0, 1]]))
    assert arm.mechanism.mass.tolist() == [0.0, 27.0, 4.0, 3.0, 2.0]
    assert (arm.m, arm.n, arm.k) == (2, 3, 3)
    assert np.array_equal(arm.base.stiffness, np.diag([3e5, 2e4]))
    assert np.array_equal(arm.base.damping, np.diag([100.0, 8.0]))


def test_mount_and_axes_place_the_arm(folder):
    """slide, twist, then the mount (turns about the fixed x, y, z), then the arm: by rotations multiplied out here."""
    pose = loaded(folder).at(Q)
    twist = Rotation.from_rotvec(Q[1] * np.array([1.0, 2.0, -2.0]) / 3.0)
    x, y, z = (Rotation.from_rotvec(angle * axis) for angle, axis in zip([0.4, -0.5, 0.6], np.eye(3), strict=True))
    seat = twist * z * y * x
    root = Q[0] * np.array([0.0, 0.6, 0.8]) + twist.apply([0.1, 0.2, 0.3])
    one = seat * Rotation.from_rotvec([0.0, 0.0, Q[2]])
    two = one * Rotation.from_rotvec([0.0, 0.2, 0.0]) * Rotation.from_rotvec([0.1, 0.0, 0.0])
    two = two * Rotation.from_rotvec([0.0, Q[3], 0.0])
    three = two * Rotation.from_rotvec(Q[4] * np.array([0.0, 1.0, 0.5]) / np.sqrt(1.25))
    shoulder = root + seat.apply([0.0, 0.0, 0.1]) + one.apply([0.05, 0.0, 0.2])
    tip = shoulder + two.apply([0.4, 0.0, 0.0]) + three.apply([0.3, 0.0, 0.0])
    assert pose.tip == pytest.approx(tip, abs=1e-14)
    assert np.array(pose.frames.tool_rotation) == pytest.approx(three.as_matrix(), abs=1e-14)


def test_the_body_is_carried_by_the_last_added_joint(folder):
    """The difference that the body makes to M: m along the slide, I + Steiner about the twist, the coupling of both."""
    with_body = loaded(folder).at(Q).M
    mass, com = 20.0, np.array([0.1, -0.05, 0.2])
    about_com = np.array([[0.5, 0.01, -0.02], [0.01, 0.6, 0.03], [-0.02, 0.03, 0.7]])
    axis, along = np.array([1.0, 2.0, -2.0]) / 3.0, np.array([0.0, 0.6, 0.8])
    turned = Rotation.from_rotvec(Q[1] * axis).apply(com)
    swing = np.cross(axis, turned)
    without = loaded(folder, (BODY, "")).at(Q).M
    added = np.zeros((5, 5))
    added[0, 0], added[1, 1] = mass, axis @ about_com @ axis + mass * swing @ swing
    added[0, 1] = added[1, 0] = mass * along @ swing
    assert with_body - without == pytest.approx(added, abs=1e-12)


SIDE = """
  <link name="plate"><inertial><origin xyz="0.1 0.2 0"/><mass value="3"/>
    <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0.001" ixz="0" iyz="0"/></inertial></link>
  <link name="hook"><inertial><origin xyz="0 0 0.3"/><mass value="2"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="bolts" type="fixed"><parent link="root"/><child link="plate"/><origin xyz="0 0.3 0" rpy="1 2 3"/></joint>
  <joint name="swing" type="continuous">
    <parent link="plate"/><child link="hook"/><origin xyz="0.2 0 0" rpy="0.3 0 0"/><axis xyz="1 0 0"/>
  </joint>
</robot>"""


@pytest.mark.parametrize("body", [BODY, ""], ids=["with a body", "without"])
@pytest.mark.parametrize("side", ["</robot>", SIDE], ids=["root alone", "with what hangs on it"])
def test_what_the_file_fixes_to_its_root_rides_along(folder, body, side):
    """M is that of the same tree on a free root (Pinocchio's free flyer), whose motion the base joints give."""
    pin = pytest.importorskip("pinocchio")
    text = changed(ARM, ("</robot>", side))
    (folder / "arm.urdf").write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FlexbaseWarning)  # the side branch is locked, and said
        pose, bodiless = loaded(folder, (BODY, body)).at(Q), loaded(folder, (BODY, "")).at(Q)
    model = pin.buildModelFromXML(text, pin.JointModelFreeFlyer())
    axis, along = np.array([1.0, 2.0, -2.0]) / 3.0, np.array([0.0, 0.6, 0.8])
    twist = Rotation.from_rotvec(Q[1] * axis)
    seat, root = twist * Rotation.from_euler("xyz", [0.4, -0.5, 0.6]), twist.apply([0.1, 0.2, 0.3])
    q, moving = pin.neutral(model), [model.joints[model.getJointId(name)] for name in ("pan", "lift", "elbow")]
    q[:7] = [*(Q[0] * along + root), *seat.as_quat()]
    T = np.zeros((model.nv, 5))
    T[:3, 0], T[:3, 1] = seat.inv().apply(along), seat.inv().apply(np.cross(axis, root))
    T[3:6, 1] = seat.inv().apply(axis)
    for column, (joint, angle) in enumerate(zip(moving, Q[2:], strict=True), start=2):
        q[joint.idx_q : joint.idx_q + joint.nq] = [np.cos(angle), np.sin(angle)] if joint.nq == 2 else [angle]
        T[joint.idx_v, column] = 1.0
    M = np.triu(pin.crba(model, model.createData(), q))
    theirs = T.T @ (M + np.triu(M, 1).T) @ T
    assert pytest.approx(theirs, rel=0.0, abs=1e-12) == bodiless.M
    assert (pose.M - bodiless.M).any() == bool(body)


FOOT = """<mujoco>
  <compiler angle="degree"/>
  <worldbody>
    <geom type="box" size="1 1 1"/>
    <body name="table"><geom type="mesh"/><inertial pos="0 0 0" mass="99" diaginertia="1 1 1"/></body>
    <body name="foot" pos="0 0 1" euler="0 0 90">
      <inertial pos="0.1 0 0" mass="6" diaginertia="0.1 0.2 0.25"/>
      <body name="block" pos="0 0 0.5"><geom type="box" size="0.1 0.2 0.3" mass="2"/></body>
      <body name="arm" pos="0 0 0.2"><joint name="a" axis="0 1 0"/><inertial pos="1 0 0" mass="1" diaginertia="1 1 1"/>
        <body name="hand"><joint name="b" axis="0 1 0"/><inertial pos="1 0 0" mass="1" diaginertia="1 1 1"/></body>
      </body>
      <body name="other"><joint name="c" axis="0 1 0"/><inertial pos="0 0 1" mass="4" diaginertia="1 1 1"/></body>
    </body>
    <body name="second"><joint name="d"/><inertial pos="0 0 1" mass="50" diaginertia="1 1 1"/></body>
  </worldbody>
</mujoco>
"""
ON_FOOT = (
    f'{TOP}[robot]\nfile = "arm.xml"\ntool = "hand"\n[base]\nstiffness = [9e4]\ndamping = [30.0]\n'
    '[[base.joint]]\nname = "twist"\ntype = "revolute"\naxis = [0, 0, 1]\n'
    '[base.mount]\nxyz = [1.0, 0.0, 0.0]\n[task]\nrows = ["x"]\n'
)


def test_of_an_mjcf_the_body_that_the_arm_stands_on_rides_along(folder):
    """With what is fixed to it and what hangs from it; the scenery of the file stays where it is. By hand."""
    (folder / "arm.xml").write_text(FOOT)
    with pytest.warns(FlexbaseWarning, match='joints "c", "d": of a side branch'):
        mechanism = loaded(folder, text=ON_FOOT).arm.mechanism
    parts = [(6.0, [1.0, 0.1, 1.0], [0.2, 0.1, 0.25]), (4.0, [1.0, 0.0, 2.0], [1.0, 1.0, 1.0])]
    parts.append((2.0, [1.0, 0.0, 1.5], 2.0 / 3.0 * np.array([0.1, 0.13, 0.05])))  # the box, turned by 90 degrees
    com = sum(mass * np.array(at) for mass, at, _ in parts) / 12.0
    inertia = np.zeros((3, 3))
    for mass, at, about_com in parts:
        r = np.array(at) - com
        inertia += np.diag(about_com) + mass * (r @ r * np.eye(3) - np.outer(r, r))
    assert mechanism.mass.tolist() == [12.0, 1.0, 1.0]
    assert mechanism.com[0] == pytest.approx(com)
    assert mechanism.inertia[0] == pytest.approx(inertia)


def test_a_foot_is_remarked_on_only_where_it_moves(folder):
    """A mesh that nobody reads, a placeholder: said where base joints are added below, of no interest otherwise."""
    mesh = ('<geom type="box" size="0.1 0.2 0.3" mass="2"/>', '<geom type="mesh" mesh="m"/>')
    (folder / "arm.xml").write_text(changed(FOOT, mesh, ("0.1 0.2 0.25", "0 0 0")))
    with pytest.warns(FlexbaseWarning) as said:
        loaded(folder, text=ON_FOOT)
    texts = {str(one.message) for one in said}
    assert 'arm.xml: body "foot": a mass without inertia (a placeholder?), taken as a point mass' in texts
    assert (
        'arm.xml: body "block": takes mass from a mesh, which is not read: not counted, so give it in [base.body]'
        in texts
    )
    with pytest.warns(FlexbaseWarning) as said:
        loaded(folder, text=f'{TOP}[robot]\nfile = "arm.xml"\ntool = "hand"\n[task]\nrows = ["x"]\n')
    assert not any('"foot"' in str(one.message) or '"block"' in str(one.message) for one in said)


def test_joints_of_the_file_can_be_the_base(folder):
    """`joints = ["pan"]` and the same joint added below the rest of the arm are the same machine."""
    springs, rows = "stiffness = [2e4]\ndamping = [0]\n", '[task]\nrows = ["x", "z"]\n'
    own = loaded(folder, text=f'{TOP}{ROBOT}\n[base]\njoints = ["pan"]\n{springs}{rows}')
    root = '  <link name="one"/>\n'
    rest = ARM[: ARM.index('  <link name="root">')] + root + ARM[ARM.index('  <link name="two">') :]
    rest = rest[: rest.index('  <joint name="pan"')] + rest[rest.index('  <joint name="lift"') :]
    (folder / "rest.urdf").write_text(rest)
    added = (
        f"{TOP}{changed(ROBOT, ('arm.urdf', 'rest.urdf'))}\n[base]\n{springs}"
        '[[base.joint]]\nname = "pan"\ntype = "revolute"\naxis = [0, 0, 1]\n'
        f"[base.body]\nmass = 4.0\ncom = [0.02, 0.0, 0.1]\ninertia = [0.05, 0.06, 0.03, 0.002, 0.0, 0.001]\n{rows}"
    )
    other = loaded(folder, text=added)
    assert own.arm.mechanism.joint_names == other.arm.mechanism.joint_names
    for q in ([0.2, 0.5, 0.7], [-1.0, 0.3, -1.2]):
        ours, theirs = own.at(q), other.at(q)
        assert pytest.approx(theirs.M, abs=1e-13) == ours.M
        assert pytest.approx(theirs.J, abs=1e-13) == ours.J
        assert ours.tip - theirs.tip == pytest.approx([0.0, 0.1], abs=1e-14)  # `pan` sits 0.1 m above the root


def test_planar_links_can_stand_on_added_joints(folder):
    """Links written in the project, on a base that slides along z: the tip then moves along z too."""
    links = "".join(
        f'[[robot.links]]\njoint = "q{i}"\nlength = 0.3\nmass = 2.0\ncom = 0.1\ninertia = 0.02\n' for i in (1, 2)
    )
    base = "[base]\nstiffness = [1e5]\ndamping = [0]\n"
    base += '[[base.joint]]\nname = "lift"\ntype = "prismatic"\naxis = [0, 0, 1]\n'
    plant = loaded(folder, text=f'{TOP}[robot]\n{links}{base}[task]\nrows = ["x", "y"]\n')
    assert plant.arm.mechanism.joint_names == ("lift", "q1", "q2")
    assert plant.at([0.01, 0.4, 0.8]).frames.tool_position[2] == pytest.approx(0.01)


def test_base_may_have_full_matrices_and_an_equilibrium(folder):
    full = "stiffness = [[3e5, 1e3], [1e3, 2e4]]\ndamping = [[9.0, 1.0], [1.0, 5.0]]\nequilibrium = [0.01, -0.02]\n"
    arm = loaded(folder, (SPRINGS, full)).arm
    assert arm.base.stiffness.tolist() == [[3e5, 1e3], [1e3, 2e4]]
    assert arm.base.damping.tolist() == [[9.0, 1.0], [1.0, 5.0]]
    assert arm.base.equilibrium.tolist() == [0.01, -0.02]


def test_six_base_joints_are_the_most(folder):
    six = "".join(
        f'\n[[base.joint]]\nname = "b{i}"\ntype = "{"prismatic" if i < 3 else "revolute"}"\n'
        f"axis = {np.eye(3)[i % 3].tolist()}\n"
        for i in range(6)
    )
    plant = loaded(folder, (JOINTS, six), (SPRINGS, f"stiffness = {[1e5] * 6}\ndamping = {[9.0] * 6}\n"))
    assert (plant.arm.m, plant.arm.n) == (6, 3)
    assert len(fb.modes(plant.at(Q[2:]))) == 6
    seventh = '\n[[base.joint]]\nname = "b7"\ntype = "revolute"\naxis = [1, 1, 0]\n'
    assert "[base] joint: " in refused(
        folder, (JOINTS, six + seventh), (SPRINGS, f"stiffness = {[1e5] * 7}\ndamping = {[9.0] * 7}\n")
    )
    (folder / "iiwa.urdf").write_text((LIBRARY / "robots" / "iiwa.urdf").read_text())
    names = [f"lbr_iiwa_joint_{i}" for i in range(1, 8)]
    text = (
        f'{TOP}[robot]\nfile = "iiwa.urdf"\n[base]\njoints = {names}\n'
        f'stiffness = {[1e5] * 7}\ndamping = {[0.0] * 7}\n[task]\nrows = ["x"]\n'
    )
    assert "7 passive joints, at most 6" in refused(folder, text=text)


# --- frequencies ------------------------------------------------------------------------------------------------------


def test_frequencies_become_stiffness(folder):
    """K_i = omega_i^2 M_ii and D_i = 2 zeta_i omega_i M_ii with the arm at its reference, M by Pinocchio; and said."""
    with pytest.warns(FlexbaseWarning) as said:
        arm = loaded(folder, IN_FREQUENCIES).arm
    omega, zeta = np.array([60.0, 90.0]), np.array([0.01, 0.03])
    M = np.diag(inertia(arm.mechanism, [0.0, 0.0, 0.3, -0.6, 0.9]))[:2]
    assert np.diag(arm.base.stiffness) == pytest.approx(omega**2 * M, rel=1e-12)
    assert np.diag(arm.base.damping) == pytest.approx(2.0 * zeta * omega * M, rel=1e-12)
    assert [str(one.message) for one in said] == [
        f"{folder / 'arm.toml'}, [base] frequency: taken as stiffness "
        f"{np.round(omega**2 * M, 6).tolist()} and damping {np.round(2.0 * zeta * omega * M, 6).tolist()}, "
        "each joint alone with the arm locked at [0.3, -0.6, 0.9]."
    ]


@pytest.mark.parametrize("joint", [0, 1])
def test_a_frequency_is_heard_again(folder, joint):
    """One joint on a base of its own, and rotors so heavy that the arm stands still: its mode is what was asked for."""
    omega, zeta = [60.0, 90.0][joint], [0.01, 0.03][joint]
    one = "\n[[base.joint]]" + JOINTS.split("\n[[base.joint]]")[1 + joint]
    asked = f"frequency = [{omega}]\ndamping_ratio = [{zeta}]\nreference = [0.3, -0.6, 0.9]\n"
    changes = ((SPRINGS, asked), (JOINTS, one), (ROBOT, ROBOT + "rotor_inertia = [1e7, 1e7, 1e7]\n"))
    with pytest.warns(FlexbaseWarning, match="taken as stiffness"):
        plant = loaded(folder, *changes)
    mode = fb.modes(plant.at([0.3, -0.6, 0.9]))[0]
    assert mode.frequency == pytest.approx(omega, rel=1e-5)
    assert mode.damping_ratio == pytest.approx(zeta, rel=1e-5)
    elsewhere = fb.modes(plant.at([0.3, 0.4, -0.9]))[0].frequency
    assert (elsewhere == pytest.approx(omega, rel=1e-4)) == (joint == 0)  # a slide carries the same mass anywhere


def test_reference_and_damping_ratio_may_be_left_out(folder):
    """The arm then stands at zero, without damping."""
    with pytest.warns(FlexbaseWarning, match=r"locked at \[0.0, 0.0, 0.0\]"):
        arm = loaded(folder, (SPRINGS, "frequency = [60.0, 90.0]\n")).arm
    M = np.diag(inertia(arm.mechanism, np.zeros(5)))[:2]
    assert np.diag(arm.base.stiffness) == pytest.approx(np.array([60.0, 90.0]) ** 2 * M, rel=1e-12)
    assert not arm.base.damping.any()


def test_joints_of_the_file_take_frequencies_too(folder):
    text = f'{TOP}{ROBOT}\n[base]\njoints = ["pan"]\nfrequency = [80.0]\n[task]\nrows = ["x", "z"]\n'
    with pytest.warns(FlexbaseWarning, match="taken as stiffness"):
        arm = loaded(folder, text=text).arm
    assert arm.base.stiffness[0, 0] == pytest.approx(80.0**2 * inertia(arm.mechanism, np.zeros(3))[0, 0], rel=1e-12)


# --- payload, friction, rotors ----------------------------------------------------------------------------------------

PAYLOAD = "\n[robot.payload]\nmass = 1.5\ncom = [0.0, 0.0, 0.1]\ninertia = [0.01, 0.01, 0.002]\n"


def test_payload_hangs_on_the_tool(folder):
    """M grows by what a body in the tool frame adds, by the tool's own Jacobian."""
    without, pose = loaded(folder).at(Q), loaded(folder, (ROBOT, ROBOT + PAYLOAD)).at(Q)
    J = RigidBodies(pose.arm.mechanism).jacobian(Q)
    R = np.array(pose.frames.tool_rotation)
    offset = R @ [0.0, 0.0, 0.1]
    linear = J[:3] + np.cross(J[3:].T, offset).T
    added = 1.5 * linear.T @ linear + J[3:].T @ R @ np.diag([0.01, 0.01, 0.002]) @ R.T @ J[3:]
    assert pytest.approx(added, abs=1e-12) == pose.M - without.M


DRIVES = (ROBOT, ROBOT + "friction = [2.0, 3.0, 4.0]\nrotor_inertia = [0.5, 0.25, 0.125]\n")


def test_rotors_stand_on_the_diagonal_of_M_and_friction_in_D(folder):
    """Of the arm's joints alone; the base keeps its own damping."""
    bare, pose = loaded(folder).at(Q), loaded(folder, DRIVES).at(Q)
    assert pytest.approx(np.diag([0.0, 0.0, 0.5, 0.25, 0.125]), abs=1e-14) == pose.M - bare.M
    assert np.array_equal(pose.D, np.diag([100.0, 8.0, 2.0, 3.0, 4.0]))
    assert np.array_equal(fb.linearise(pose).D, pose.D)


@pytest.mark.parametrize("engine", list(ENGINES))
def test_both_engines_feel_friction_and_rotors(folder, engine):
    """q'' of either engine in the same state, against Pinocchio's M with the rotors and its forces with friction."""
    if engine == "mujoco":
        pytest.importorskip("mujoco")
    plant = loaded(folder, DRIVES)
    pose, mechanism = plant.at(Q), plant.arm.mechanism
    rates, torque = np.array([0.3, -0.5, 1.0, -2.0, 1.5]), np.array([1.0, 2.0, -3.0])
    q = Q + 0.1
    physics = ENGINES[engine].accelerations(pose)
    found = physics(forward(mechanism, tuple(q.tolist())), q, rates, torque, None)
    force = -RigidBodies(mechanism).bias(q, rates) - np.array([100.0, 8.0, 2.0, 3.0, 4.0]) * rates
    force[:2] += np.array([3e5, 2e4]) * (Q - q)[:2]
    force[2:] += torque
    assert found == pytest.approx(np.linalg.solve(inertia(mechanism, q), force), rel=1e-10)


DAMPED = (
    ('<axis xyz="0 0 2"/>', '<axis xyz="0 0 2"/><dynamics damping="5"/>'),
    ('<axis xyz="0 1 0.5"/>', '<axis xyz="0 1 0.5"/><dynamics damping="3"/>'),
)


def test_friction_of_the_file_is_left_out_unless_asked_for(folder):
    """Often a simulator's, so never taken silently; a base joint of the file never takes it; own numbers come first."""
    (folder / "arm.urdf").write_text(changed(ARM, *DAMPED))
    with pytest.warns(FlexbaseWarning, match='joints "pan", "elbow": damping in the file, not used unless'):
        plant = loaded(folder)
    assert not plant.arm.mechanism.friction.any()
    asked = changed(ROBOT, ("tool =", "file_friction = true\ntool ="))
    assert loaded(folder, (ROBOT, asked)).arm.mechanism.friction.tolist() == [0.0, 0.0, 5.0, 0.0, 3.0]
    own = asked + "friction = [1.0, 2.0, 4.0]\n"
    assert loaded(folder, (ROBOT, own)).arm.mechanism.friction.tolist() == [0.0, 0.0, 1.0, 2.0, 4.0]
    base = '\n[base]\njoints = ["pan"]\nstiffness = [2e4]\ndamping = [0]\n[task]\nrows = ["x", "z"]\n'
    assert loaded(folder, text=TOP + asked + base).arm.mechanism.friction.tolist() == [0.0, 0.0, 3.0]


MJCF = """<mujoco>
  <compiler angle="radian"/>
  <default><joint armature="0.2"/></default>
  <worldbody>
    <body name="cart">
      <joint name="slide" type="slide" axis="1 0 0" stiffness="500" armature="0"/>
      <inertial pos="0 0 0" mass="10" diaginertia="0.1 0.1 0.1"/>
      <body name="upper" pos="0 0 0.2">
        <joint name="shoulder" axis="0 1 0"/>
        <inertial pos="0.15 0 0" mass="3" diaginertia="0.01 0.03 0.03"/>
        <body name="fore" pos="0.3 0 0">
          <joint name="elbow" axis="0 1 0" armature="0.1"/>
          <inertial pos="0.1 0 0" mass="2" diaginertia="0.005 0.01 0.01"/>
          <site name="tip" pos="0.25 0 0"/>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""
ON_MJCF = (
    f'{TOP}[robot]\nfile = "arm.xml"\ntool = "tip"\n[base]\njoints = ["slide"]\nstiffness = [9e4]\ndamping = [30.0]\n'
    '[task]\nrows = ["x", "z"]\n'
)


def test_mjcf_armature_counts_and_its_stiffness_does_not(folder):
    """Rotors of the file are on the diagonal of M; a spring of the file is said to be left out, so it counts once."""
    (folder / "arm.xml").write_text(MJCF)
    with pytest.warns(FlexbaseWarning) as said:
        plant = loaded(folder, text=ON_MJCF)
    assert any("its joint stiffness (slide) is left out: only [base] stiffness counts" in str(w.message) for w in said)
    assert plant.arm.base.stiffness.tolist() == [[9e4]]
    assert plant.arm.mechanism.armature.tolist() == [0.0, 0.2, 0.1]
    pose = plant.at([0.4, 0.8])
    assert pytest.approx(inertia(plant.arm.mechanism, pose.q), abs=1e-13) == pose.M


def test_rotor_inertia_given_replaces_the_files_of_the_arm_alone(folder):
    """The project's numbers stand for the arm's joints; the base keeps what its file says."""
    (folder / "arm.xml").write_text(changed(MJCF, (' stiffness="500" armature="0"', ' armature="0.7"')))
    text = changed(ON_MJCF, ('tool = "tip"\n', 'tool = "tip"\nrotor_inertia = [0.3, 0.05]\n'))
    assert loaded(folder, text=text).arm.mechanism.armature.tolist() == [0.7, 0.3, 0.05]


# --- bare files -------------------------------------------------------------------------------------------------------


def test_a_bare_urdf_is_an_arm_on_a_rigid_base(folder):
    with pytest.warns(FlexbaseWarning, match=r"arm.urdf: no \[base\] joints: a rigid base"):
        plant = fb.load(folder / "arm.urdf")
    assert (plant.name, plant.arm.m, plant.arm.n) == ("arm", 0, 3)
    assert plant.arm.task.rows == ("x", "y", "z")
    assert len(fb.modes(plant.at(Q[2:]))) == 0


def test_a_bare_mjcf_is_an_arm_on_a_rigid_base():
    """plain.xml: M with its armature is MuJoCo's own."""
    mujoco = pytest.importorskip("mujoco")
    with pytest.warns(FlexbaseWarning, match=r"plain.xml: no \[base\] joints: a rigid base"):
        plant = fb.load(DATA / "plain.xml")
    mechanism = plant.arm.mechanism
    assert mechanism.armature.tolist() == [0.1, 0.0]
    q = np.array([0.3, -0.7])
    theirs = mujoco_answer(
        mujoco.MjModel.from_xml_path(str(DATA / "plain.xml")), ("body", "tool"), mechanism.joint_names, q, q
    )
    assert inertia(mechanism, q) == pytest.approx(theirs.M + np.diag([0.1, 0.0]), abs=1e-10)


def test_the_ending_of_a_bare_file_decides(folder):
    """.urdf, .xml and .mjcf are robot files, whatever is in them; anything else is a project."""
    (folder / "arm.txt").write_text(ARM)
    with pytest.raises(InputError, match=r"arm.txt: not valid TOML"):
        fb.load(folder / "arm.txt")
    (folder / "arm.URDF").write_text(ARM)
    with pytest.warns(FlexbaseWarning, match="rigid base"):
        assert fb.load(folder / "arm.URDF").arm.n == 3


# --- refusals ---------------------------------------------------------------------------------------------------------

ALSO_JOINTS = ("[base]\n", '[base]\njoints = ["pan"]\n')
REFUSALS = {
    "joints twice": ([ALSO_JOINTS], ["[base] joints", "exclude each other"]),
    "body without joints": ([(JOINTS, "")], ["[base] body and mount belong to added joints"]),
    "mount without joints": ([(JOINTS, ""), (BODY, "")], ["[base] body and mount belong to added joints"]),
    "a joint's name twice": ([('"twist"', '"slide"')], ["[[base.joint]] name", '"slide" is given twice']),
    "a name of the file": ([('"twist"', '"pan"')], ["[[base.joint]] name", '"pan" is given twice']),
    "unknown kind": ([('"prismatic"', '"ball"')], ["[[base.joint]] number 1, type", '"ball"', "'prismatic'"]),
    "unknown key": ([("axis = [0.0", "axes = [0.0")], ["[[base.joint]] number 1, axes", 'Did you mean "axis"?']),
    "axis of two": ([("[0.0, 3.0, 4.0]", "[0.0, 3.0]")], ["[[base.joint]] number 1, axis", "2", "3", "x y z"]),
    "axis of zeros": ([("[1.0, 2.0, -2.0]", "[0, 0, 0]")], ["[[base.joint]] number 2, axis", "no direction"]),
    "no body mass": ([("mass = 20.0", "mass = 0.0")], ["[base.body] mass", "0 must be above 0"]),
    "impossible body": ([("[0.5, 0.6, 0.7, 0.01", "[0.5, 0.6, 0.7, 0.9")], ["[base.body] inertia", "negative"]),
    "body of four": ([(", 0.01, -0.02, 0.03]", ", 0.01]")], ["[base.body] inertia", "xx yy zz"]),
    "mount of two": ([("[0.1, 0.2, 0.3]", "[0.1, 0.2]")], ["[base.mount] xyz", "x y z"]),
    "rpy of four": ([("[0.4, -0.5, 0.6]", "[0.4, -0.5, 0.6, 0.0]")], ["[base.mount] rpy", "roll pitch yaw"]),
    "no dampers": ([("damping = [100.0, 8.0]\n", "")], ["[base] damping: is missing", "zeros say"]),
    "no springs": ([(SPRINGS, "")], ["[base] stiffness", "either stiffness and damping, or frequency"]),
    "one spring of two": ([("[3.0e5, 2.0e4]", "[3.0e5]")], ["[base] stiffness: 1 value given, 2 needed"]),
    "one damper of two": ([("[100.0, 8.0]", "[100.0]")], ["[base] damping: 1 value given, 2 needed"]),
    "equilibrium of one": ([("damping", "equilibrium = [0.0]\ndamping")], ["[base] equilibrium", "each base joint"]),
    "both kinds": ([("damping", "frequency = [60.0, 90.0]\ndamping")], ["[base] stiffness", "either"]),
    "frequency and damping": (
        [("stiffness = [3.0e5, 2.0e4]", "frequency = [60.0, 90.0]")],
        ["[base] damping: with frequency, give damping_ratio instead"],
    ),
    "ratio alone": ([("damping", "damping_ratio = [0.01, 0.02]\ndamping")], ["[base] damping_ratio and reference"]),
    "reference alone": ([("damping", "reference = [0, 0, 0]\ndamping")], ["[base] damping_ratio and reference"]),
    "frequency of zero": ([IN_FREQUENCIES, ("[60.0, 90.0]", "[60.0, 0.0]")], ["[base] frequency", "above 0"]),
    "negative ratio": ([IN_FREQUENCIES, ("[0.01, 0.03]", "[0.01, -0.03]")], ["[base] frequency", "0 or more"]),
    "one frequency": ([IN_FREQUENCIES, ("[60.0, 90.0]", "[60.0]")], ["[base] frequency", "each base joint"]),
    "one ratio": ([IN_FREQUENCIES, ("[0.01, 0.03]", "[0.01]")], ["[base] damping_ratio", "each base joint"]),
    "reference of two": ([IN_FREQUENCIES, ("[0.3, -0.6, 0.9]", "[0.3, 0]")], ["[base] reference", "each arm joint"]),
    "friction of five": ([(ROBOT, ROBOT + "friction = [1, 1, 1, 1, 1]\n")], ["[robot] friction", "each arm joint"]),
    "negative friction": ([(ROBOT, ROBOT + "friction = [1, -1, 1]\n")], ["[robot] friction: -1 is negative"]),
    "one rotor": ([(ROBOT, ROBOT + "rotor_inertia = [1]\n")], ["[robot] rotor_inertia", "each arm joint"]),
    "negative rotor": ([(ROBOT, ROBOT + "rotor_inertia = [1, 1, -2]\n")], ["[robot] rotor_inertia: -2 is negative"]),
    "tool misspelt": ([('tool = "tool"', 'tool = "toll"')], ['no frame "toll"', 'Did you mean "tool"?']),
    "tool that stands still": ([('tool = "tool"', 'tool = "root"')], ["no moving joint", "Name a tool frame"]),
    "neither file nor links": ([(ROBOT, "[robot]\n")], ["[robot]", "either [[robot.links]] or a file"]),
    "missing file": ([('"arm.urdf"', '"amr.urdf"')], ["amr.urdf: no such file"]),
    "a folder": ([('"arm.urdf"', '"meshes"')], ["meshes: ", "Give a"]),
    "the folder above": ([('"arm.urdf"', '"../arm.urdf"')], ["leaves the folder of the project"]),
    "around a corner": ([('"arm.urdf"', '"../project/../arm.urdf"')], ["leaves the folder of the project"]),
    "an absolute path": ([('"arm.urdf"', '"/etc/passwd"')], ["leaves the folder of the project"]),
    "through a link": ([('"arm.urdf"', '"link.urdf"')], ["leaves the folder of the project"]),
    "more rows than joints": ([('"z"]', '"z", "rx"]')], ["[task] rows", "4 rows but only 3 arm joints"]),
}


@pytest.mark.parametrize(("changes", "words"), REFUSALS.values(), ids=REFUSALS.keys())
def test_what_does_not_fit_is_refused_with_its_place(folder, changes, words):
    (folder.parent / "arm.urdf").write_text(ARM)  # a sound file, but outside
    os.symlink(folder.parent / "arm.urdf", folder / "link.urdf")
    (folder / "meshes").mkdir()
    message = refused(folder, *changes)
    for word in words:
        assert word in message


def test_unknown_base_joints_of_a_file_get_the_nearest(folder):
    base = "\n[base]\nstiffness = [2e4]\n"
    for joints, words in [
        ('["pam"]', 'no joint "pam". Did you mean "pan"?'),
        ('["lift"]', "not the first of the chain"),
    ]:
        text = f"{TOP}{ROBOT}{base}joints = {joints}\n{TASK}"
        assert words in refused(folder, text=text)


def test_a_project_given_as_text_has_no_folder():
    with pytest.raises(InputError, match=r"a project given as text has no folder. Save it as a file"):
        parse_project(WHOLE, "text")


def test_paths_are_seen_from_the_project_not_from_here(folder, tmp_path, monkeypatch):
    """Also below it."""
    monkeypatch.chdir(tmp_path)
    (folder / "robots").mkdir()
    (folder / "arm.urdf").rename(folder / "robots" / "arm.urdf")
    assert loaded(folder, ("arm.urdf", "robots/arm.urdf")).arm.N == 5
    assert "no such file" in refused(folder)

"""URDF: what is sound is read as the file means it, what is not is refused by name, what is odd is noted."""

from __future__ import annotations

import numpy as np
import pytest

from flexbase.model.formats.chain import MOST_JOINTS
from flexbase.model.formats.robot import read_robot_file
from flexbase.model.formats.urdf import MOST_LINKS

ARM_INERTIA = 'ixx="0.01" iyy="0.17" izz="0.17"'
JOINT = '<joint name="swing" type="revolute">'
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
END = "</robot>"


def test_a_chain_and_what_hangs_on_it(changed):
    robot = changed.read("spatial.urdf")
    assert robot.mechanism.joint_names == ("slide", "pan", "shoulder", "elbow", "roll")
    assert robot.mechanism.joint_types == ("prismatic", "revolute", "revolute", "revolute", "revolute")
    assert np.linalg.norm(robot.mechanism.axes, axis=1) == pytest.approx(np.ones(5), abs=1e-15)
    assert robot.mechanism.mass == pytest.approx([12.5, 0.0, 8.0, 3.6, 0.8])
    assert robot.friction.tolist() == [7.5, 0.0, 0.5, 0.0, 0.0]
    assert robot.limits.tolist() == [[-0.5, 0.8], [-np.inf, np.inf], [-2, 2], [-2.5, 2.5], [-np.inf, np.inf]]
    assert not robot.armature.any()
    assert not robot.stiffness.any()
    assert not robot.reference.any()
    assert any('"probing"' in note and "side branch" in note for note in robot.notes)
    assert any('"slide", "shoulder"' in note and "damping" in note for note in robot.notes)
    assert len(robot.notes) == 2


def test_arrays_are_frozen(changed):
    robot = changed.read("spatial.urdf")
    names = (
        "axes",
        "placement_rotation",
        "placement_position",
        "mass",
        "com",
        "inertia",
        "tool_rotation",
        "tool_position",
    )
    arrays = [getattr(robot.mechanism, name) for name in names]
    arrays += [robot.friction, robot.armature, robot.stiffness, robot.reference, robot.limits]
    assert not any(array.flags.writeable for array in arrays)


@pytest.mark.parametrize(
    ("changes", "words"),
    {
        "negative mass": ([('value="2"', 'value="-2"')], ['"arm"', "mass is negative"]),
        "NaN mass": ([('value="2"', 'value="NaN"')], ['<mass> of "arm"', "plain numbers"]),
        "infinite mass": ([('value="2"', 'value="1e400"')], ["<mass>", "not finite"]),
        "mass with unit": ([('value="2"', 'value="7 kg"')], ["<mass>", "without units"]),
        "hexadecimal": ([('value="2"', 'value="0x10"')], ["<mass>", "plain numbers"]),
        "underscore": ([('value="2"', 'value="1_0"')], ["<mass>", "plain numbers"]),
        "other digits": ([('value="2"', 'value="\u0662"')], ["<mass>", "plain numbers"]),
        "xacro": ([('value="2"', 'value="${m}"')], ["<mass>", "xacro"]),
        "no mass": ([('<mass value="2"/>', "")], ['"arm"', "<mass>"]),
        "negative moment": ([(ARM_INERTIA, 'ixx="-0.01" iyy="0.17" izz="0.17"')], ['"arm"', "negative principal"]),
        "indefinite": ([('ixy="0"', 'ixy="0.3"')], ['"arm"', "negative principal"]),
        "triangle": ([(ARM_INERTIA, 'ixx="0.01" iyy="0.1" izz="0.17"')], ['link "arm"', "A + B >= C", "10% of C"]),
        "missing moment": ([('ixz="0"', "")], ["<inertia>", "ixz"]),
        "zero axis": ([('<axis xyz="0 0 1"/>', '<axis xyz="0 0 0"/>')], ["<axis>", "direction"]),
        "short axis": ([('<axis xyz="0 0 1"/>', '<axis xyz="0 1"/>')], ["<axis>", "3 numbers"]),
        "floating": ([('type="revolute"', 'type="floating"')], ['"swing"', "floating", "not supported"]),
        "planar": ([('type="revolute"', 'type="planar"')], ['"swing"', "planar", "not supported"]),
        "unknown type": ([('type="revolute"', 'type="SECRET"')], ['"swing"', "revolute"]),
        "no type": ([(' type="revolute"', "")], ['"swing"', "type"]),
        "no parent": ([(JOINT + "\n    " + '<parent link="base"/>', JOINT)], ['"swing"', "<parent>"]),
        "lost parent": ([('<parent link="base"/>', '<parent link="bse"/>')], ['"swing"', '"bse"', "does not exist"]),
        "lost child": ([('<child link="arm"/>', '<child link="amr"/>')], ['"swing"', '"amr"', "does not exist"]),
        "two parents": ([('<child link="tool"/>', '<child link="arm"/>')], ['"arm"', "two joints"]),
        "itself": ([('<parent link="base"/>', '<parent link="arm"/>')], ['"arm"', "loop"]),
        "cycle": ([('<parent link="base"/>', '<parent link="tool"/>')], ['"arm", "tool"', "loop"]),
        "two roots": ([('<link name="base"/>', '<link name="base"/><link name="lost"/>')], ['"base", "lost"', "root"]),
        "link twice": ([('<link name="base"/>', '<link name="base"/><link name="arm"/>')], ['"arm"', "twice"]),
        "joint twice": ([('name="end"', 'name="swing"')], ['"swing"', "twice"]),
        "two inertials": ([("<inertial>", '<inertial><mass value="1"/></inertial><inertial>')], ['"arm"', "2 times"]),
        "no name": ([('<link name="base"/>', "<link/>")], ["<link>", "name"]),
        "empty name": ([('"base"', '" "')], ["<link>", "name"]),
        "long name": ([('"base"', f'"{"b" * 201}"')], ["<link>", "200 characters"]),
        "unprintable name": ([('"base"', '"b&#x9b;31m"')], ["<link>", "printed"]),
        "negative damping": ([(LIMIT, LIMIT + '<dynamics damping="-1"/>')], ['"swing"', "damping"]),
        "mimic": ([(LIMIT, LIMIT + '<mimic joint="other"/>')], ['"swing"', '"other"', "does not exist"]),
        "nothing": ([("<link", "<lnik"), ("</link", "</lnik")], ["no <link>"]),
        "nothing moves": ([('type="revolute"', 'type="fixed"')], ["nothing in it moves"]),
    }.values(),
)
def test_what_is_not_sound_is_refused_by_name(changed, changes, words):
    message = changed.refused("plain.urdf", *changes)
    assert message.startswith("plain.urdf: ")
    assert message.isprintable()
    assert "SECRET" not in message
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("changes", "words"),
    {
        "triangle inequality": ([(ARM_INERTIA, 'ixx="0.01" iyy="0.15" izz="0.17"')], '"arm": principal moments'),
        "slightly indefinite": ([(ARM_INERTIA, 'ixx="-0.000001" iyy="0.17" izz="0.17"')], '"arm": a slightly negative'),
        "placeholder": ([(ARM_INERTIA, 'ixx="0" iyy="0" izz="0"')], '"arm": a mass without inertia'),
        "no inertia": ([("<inertia ", "<intertia ")], '"arm": a mass without inertia'),
        "inertia without mass": ([('value="2"', 'value="0"')], '"arm": an inertia without mass'),
        "no limits": ([(LIMIT, "")], '"swing": no limits'),
        "swapped limits": ([('lower="-1" upper="1"', 'lower="1" upper="-1"')], '"swing": limits that leave no room'),
        "dry friction": ([(LIMIT, LIMIT + '<dynamics friction="0.1"/>')], '"swing": dry friction'),
    }.values(),
)
def test_what_is_odd_is_noted_by_name(changed, changes, words):
    robot = changed.read("plain.urdf", *changes)
    assert len(robot.notes) == 1
    assert words in robot.notes[0]


def test_a_sound_file_needs_no_notes(changed):
    assert changed.read("plain.urdf").notes == ()


def test_a_joint_that_moves_nothing_is_noted(changed):
    body = changed.read("plain.urdf", ("<inertial>", "<weight>"), ("</inertial>", "</weight>"))
    assert body.notes == ('joint "swing": no inertia to move, so give a payload or a rotor inertia',)


MIMIC = '<limit lower="0" upper="0.1" effort="10" velocity="1"/>'


@pytest.mark.parametrize(
    ("tool", "leader", "words"),
    [
        ("tool", "elbow", '"probing": it mimics "elbow"'),
        ("probe", "roll", '"probing": it mimics "roll"'),
        ("probe", "probing", '"probing": it mimics "probing"'),
    ],
)
def test_mimic_in_the_chain_is_refused(changed, tool, leader, words):
    change = (MIMIC, f'{MIMIC}<mimic joint="{leader}"/>')
    assert words in changed.refused("spatial.urdf", change, tool=tool)


def test_mimic_beside_the_chain_is_noted(changed):
    robot = changed.read("spatial.urdf", (MIMIC, f'{MIMIC}<mimic joint="elbow"/>'), tool="turret")
    assert any(note.startswith('joint "probing": mimic ignored') for note in robot.notes)


def test_the_tool_is_named_or_the_only_leaf(changed):
    assert changed.read("plain.urdf", tool=None).mechanism.tool_position.tolist() == [1.0, 0.0, 0.0]
    for_none = changed.refused("spatial.urdf", tool=None)
    assert all(leaf in for_none for leaf in ('"counterweight"', '"probe"', '"tool"', "3 frames"))
    assert 'Did you mean "wrist"?' in changed.refused("spatial.urdf", tool="wirst")
    assert '"counterweight"' in changed.refused("spatial.urdf", tool="zzz")
    assert "moving joint" in changed.refused("spatial.urdf", tool="riser")
    assert "x" * 41 not in changed.refused("spatial.urdf", tool="x" * 100_000)


def long_chain(folder, size: int):
    parts = ['<robot name="long"><link name="l0"/>']
    for number in range(1, size + 1):
        parts.append(
            f'<link name="l{number}"/><joint name="j{number}" type="continuous">'
            f'<parent link="l{number - 1}"/><child link="l{number}"/></joint>'
        )
    (folder / "long.urdf").write_text("".join([*parts, END]))
    return folder / "long.urdf"


def test_long_chains_end_in_a_message(changed, tmp_path):
    path = long_chain(tmp_path, MOST_JOINTS)
    assert read_robot_file(path, None, folder=tmp_path).mechanism.N == MOST_JOINTS
    for size, words in ((MOST_JOINTS + 1, "at most 64"), (MOST_LINKS - 1, "at most 64"), (MOST_LINKS, "500 links")):
        with pytest.raises(changed.error, match=words):
            read_robot_file(long_chain(tmp_path, size), None, folder=tmp_path)

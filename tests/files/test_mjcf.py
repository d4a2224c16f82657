"""MJCF: what is sound is read as MuJoCo means it, what is not is refused by name, what is odd is noted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from flexbase.model.formats.robot import read_robot_file

from .conftest import DATA

SWING = '<joint name="swing" axis="0 0 1" armature="0.1"/>'
GEOM = '<geom type="box" size="0.5 0.1 0.1" pos="0.5 0 0"/>'
INERTIAL = '<inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/>'
COMPILER = '<compiler angle="radian"/>'
WORLD_END = "</worldbody>"
OFF_AXIS = ('<inertial pos="0 0 0"', '<inertial pos="0 0.1 0"')


def test_a_chain_and_what_hangs_on_it(changed):
    robot = changed.read("spatial.xml", tool="tip")
    assert robot.mechanism.joint_names == ("x", "tilt", "shoulder", "elbow", "wrist")
    assert robot.mechanism.joint_types == ("prismatic", "revolute", "revolute", "revolute", "revolute")
    assert robot.mechanism.mass[0] == 0.0  # both joints move the carriage, the first without a body of its own
    assert robot.mechanism.mass[1] == 9.0
    assert robot.armature.tolist() == [0.3, 0.3, 0.3, 0.0, 0.3]
    assert robot.friction.tolist() == [9.0, 1.5, 1.5, 1.5, 1.5]
    assert robot.stiffness.tolist() == [0.0, 120.0, 0.0, 0.0, 0.0]
    assert robot.reference == pytest.approx([0.1, np.radians(25.0), np.radians(-15.0), 0.0, 0.0])
    assert robot.limits[0].tolist() == [-0.4, 0.6]
    assert robot.limits[3] == pytest.approx(np.radians([-2.0, 150.0]))
    assert robot.limits[4].tolist() == [-np.inf, np.inf]
    for name, words in (
        ("flap", "side branch"),
        ("x", "servo"),
        ("tilt", "stiffness"),
        ("shoulder", "dry friction"),
    ):
        assert any(f'"{name}"' in note and words in note for note in robot.notes)
    assert any(note.startswith('actuator "<position> of elbow": servo gains (kp, kv') for note in robot.notes)
    assert len(robot.notes) == 5


def test_nothing_is_opened_and_nothing_is_written(changed, tmp_path, monkeypatch):
    """Not even MuJoCo's log, which otherwise lands in the working folder."""
    monkeypatch.chdir(tmp_path)
    changed.read("spatial.xml", tool="tip")
    changed.read("plain.xml", (INERTIAL, INERTIAL.replace("0.1 0.1 0.1", "1e-14 1e-14 1e-14")))
    assert sorted(path.name for path in Path().iterdir()) == ["plain.xml", "spatial.xml"]


@pytest.mark.parametrize(
    ("changes", "words"),
    {
        "negative mass": ([('mass="1"', 'mass="-1"')], ['"tool"', "mass is negative"]),
        "NaN": ([('mass="1"', 'mass="nan"')], ['<inertial> of "tool"', "plain numbers"]),
        "overflow": ([('mass="1"', 'mass="1e400"')], ['<inertial> of "tool"', "not finite"]),
        "with unit": ([('mass="1"', 'mass="7 kg"')], ['"tool"', "without units"]),
        "no mass": ([('mass="1" ', "")], ['"tool"', "mass is missing"]),
        "indefinite": ([('diaginertia="0.1 0.1 0.1"', 'fullinertia="1 1 1 2 0 0"')], ['"tool"', "negative principal"]),
        "negative moment": ([("0.1 0.1 0.1", "0.1 -0.1 0.1")], ['"tool"', "negative principal"]),
        "triangle": ([("0.1 0.1 0.1", "0.1 0.1 0.3")], ['body "tool"', "A + B >= C", "10% of C"]),
        "two inertials": ([(INERTIAL, INERTIAL + f"<frame>{INERTIAL}</frame>")], ['"tool"', "2 times"]),
        "inertia in two ways": (
            [("diaginertia", 'fullinertia="1 1 1 0 0 0" diaginertia')],
            ["MuJoCo refuses", "fullinertia", '"tool"'],
        ),
        "inertial of the world": ([("<worldbody>", f"<worldbody>{INERTIAL}")], ["the world has no inertial"]),
        "ball": ([(SWING, '<joint name="swing" type="ball"/>')], ['"swing"', "ball and free"]),
        "free": ([(SWING, '<joint name="swing" type="free"/>')], ['"swing"', "ball and free"]),
        "free joint": ([(SWING, '<freejoint name="swing"/>')], ['"swing"', "free joints"]),
        "default ball": ([(COMPILER, '<default><joint type="ball"/></default>')], ["ball and free"]),
        "zero axis": ([('axis="0 0 1"', 'axis="0 0 0"')], ['"swing"', "direction"]),
        "zero quaternion": ([('pos="0 0 1"', 'quat="0 0 0 0"')], ['"arm"', "direction"]),
        "two orientations": ([('pos="0 0 1"', 'euler="1 0 0" quat="1 0 0 0"')], ["MuJoCo refuses"]),
        "negative armature": ([('armature="0.1"', 'armature="-0.1"')], ['"swing"', "armature is negative"]),
        "negative damping": ([('armature="0.1"', 'damping="-0.1"')], ['"swing"', "damping is negative"]),
        "nonlinear damping": ([('armature="0.1"', 'damping="1 2 3"')], ['"swing"', "damping", "1 number"]),
        "mesh": ([(GEOM, '<geom type="mesh" mesh="SECRET"/>')], ['"arm"', "mesh", "<inertial>"]),
        "fitted mesh": ([(GEOM, '<geom type="box" mesh="SECRET"/>')], ['"arm"', "mesh", "<inertial>"]),
        "mesh by class": (
            [
                (COMPILER, '<default><default class="m"><geom type="mesh"/></default></default>'),
                (GEOM, '<geom class="m" mesh="SECRET"/>'),
            ],
            ['"arm"', "mesh", "<inertial>"],
        ),
        "mesh with mass and without density": (
            [(GEOM, '<geom type="mesh" mesh="SECRET" mass="1" density="0"/>')],
            ['"arm"', "mesh", "<inertial>"],
        ),
        "mesh by rule": (
            [(COMPILER, '<compiler inertiafromgeom="true"/>'), (INERTIAL, INERTIAL + '<geom type="mesh" mesh="m"/>')],
            ['"tool"', "mesh"],
        ),
        "bad solid": ([('size="0.5 0.1 0.1"', 'size="0.5"')], ['geom of body "arm"', "size"]),
        "attached model": ([(GEOM, GEOM + '<attach model="SECRET"/>')], ["<attach>", "not supported"]),
        "plugin": ([(GEOM, GEOM + '<plugin plugin="SECRET"/>')], ["<plugin>", "not supported"]),
        "composite": ([(GEOM, GEOM + '<composite type="cable"/>')], ["<composite>", "not supported"]),
        "replicate": ([(GEOM, f'{GEOM}<replicate count="99999999"/>')], ["<replicate>", "not supported"]),
        "flex": ([(WORLD_END, WORLD_END + "<deformable/>")], ["<deformable>", "not supported"]),
        "include": ([(GEOM, '<include file="/SECRET"/>')], ["includes another file"]),
        "unknown attribute": ([('armature="0.1"', 'armatur="0.1"')], ['"swing"', '"armatur"']),
        "unknown class": ([('armature="0.1"', 'class="nope"')], ['"swing"', '"nope"']),
        "unknown childclass": ([('pos="0 0 1"', 'childclass="nope"')], ['"arm"', '"nope"']),
        "class twice": (
            [(COMPILER, '<default><default class="a"/><default class="a"/></default>')],
            ['"a"', "twice"],
        ),
        "class without name": ([(COMPILER, "<default><default/></default>")], ["<default>", "class"]),
        "renamed main": ([(COMPILER, '<default class="a"/>')], ["main"]),
        "body twice": ([('name="tool"', 'name="arm"')], ['"arm"', "twice"]),
        "joint twice": ([('name="turn"', 'name="swing"')], ['"swing"', "twice"]),
        "a second world": ([('name="arm"', 'name="world"')], ['"world"', "twice"]),
        "global": ([(COMPILER, '<compiler coordinate="global"/>')], ["local coordinates"]),
        "total mass": ([(COMPILER, '<compiler settotalmass="3"/>')], ["settotalmass"]),
        "bad euler": ([(COMPILER, '<compiler eulerseq="abc"/>')], ["eulerseq"]),
        "mocap": ([('pos="0 0 1"', 'mocap="true"')], ['"arm"', "mocap"]),
        "attributes of the world": ([("<worldbody>", '<worldbody pos="1 0 0">')], ["the world takes no attributes"]),
        "seven joints": ([(SWING, "<joint/>" * 7)], ['more than 6 dofs in body "arm", at']),
        "joint of the world": ([("<worldbody>", "<worldbody><joint/>")], ["the world has no joints"]),
    }.values(),
)
def test_what_is_not_sound_is_refused_by_name(changed, changes, words):
    message = changed.refused("plain.xml", *changes)
    assert message.startswith("plain.xml: ")
    assert message.isprintable()
    assert "SECRET" not in message
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ((GEOM, GEOM * 2001), "2000 geoms"),
        ((GEOM, GEOM + "<body/>" * 501), "500 bodies"),
        ((GEOM, GEOM + "<frame/>" * 501), "500 frames"),
        ((SWING, SWING + "<joint/>" * 501), "500 joints"),
        ((GEOM, GEOM + "".join(f'<site name="s{number}"/>' for number in range(501))), "500 named sites"),
        (
            (COMPILER, "<default>" + "".join(f'<default class="{number}"/>' for number in range(501)) + "</default>"),
            "500 default classes",
        ),
    ],
)
def test_limits_are_named(changed, change, what):
    assert f"more than {what}" in changed.refused("plain.xml", change)


COUPLINGS = {
    "joint equality": '<equality><joint joint1="flap" joint2="{}"/></equality>',
    "fixed joint": '<equality><joint joint1="{}"/></equality>',
    "fixed tendon": '<tendon><fixed><joint joint="flap" coef="1"/><joint joint="{}" coef="1"/></fixed></tendon>',
}


@pytest.mark.parametrize("coupling", COUPLINGS.values(), ids=COUPLINGS)
def test_couplings_of_joints(changed, coupling):
    """Refused where one of the chain's joints is in it, noted where not."""
    change = ("</mujoco>", coupling.format("elbow") + "</mujoco>")
    message = changed.refused("spatial.xml", change, tool="tip")
    assert "ties the chain" in message
    notes = changed.read("spatial.xml", ("</mujoco>", coupling.format("flap") + "</mujoco>"), tool="tip").notes
    assert any("ties only what is locked" in note for note in notes)


@pytest.mark.parametrize(
    ("coupling", "felt"),
    [
        ('<equality><weld body1="vane" body2="ballast"/></equality>', False),
        ('<equality><weld body1="vane" body2="lower"/></equality>', True),
        ('<equality><connect body1="vane" anchor="0 0 0"/></equality>', True),
        ('<equality><connect body1="post" anchor="0 0 0"/></equality>', False),
        ('<equality><weld site1="tip" site2="tip"/></equality>', False),
        ('<equality><joint joint1="elbow" active="false"/></equality>', False),
        ('<tendon><spatial><site site="tip"/><geom geom="floor"/></spatial></tendon>', True),
        ('<tendon><spatial><site site="tip"/><pulley divisor="2"/><site site="tip"/></spatial></tendon>', False),
        (
            '<tendon><fixed name="t"><joint joint="flap" coef="1"/></fixed></tendon>'
            '<equality><tendon tendon1="t"/></equality>',
            False,
        ),
    ],
)
def test_couplings_of_bodies(changed, coupling, felt):
    """Refused between parts that the chain's joints move against each other."""
    change = ("</mujoco>", coupling + "</mujoco>")
    if felt:
        assert "ties the chain" in changed.refused("spatial.xml", change, tool="tip")
    else:
        assert changed.read("spatial.xml", change, tool="tip").mechanism.N == 5


@pytest.mark.parametrize(
    "coupling",
    [
        '<equality><joint joint1="nope"/></equality>',
        '<equality><tendon tendon1="nope"/></equality>',
        '<equality><connect body1="nope"/></equality>',
        '<tendon><fixed><joint joint="nope" coef="1"/></fixed></tendon>',
        '<tendon><spatial><site site="nope"/></spatial></tendon>',
    ],
)
def test_couplings_of_nothing_are_refused(changed, coupling):
    assert '"nope" does not exist' in changed.refused("plain.xml", ("</mujoco>", coupling + "</mujoco>"))


@pytest.mark.parametrize(
    ("changes", "words"),
    {
        "dry friction": ([('armature="0.1"', 'frictionloss="0.1"')], 'joint "swing": dry friction'),
        "gravity compensation": ([('pos="0 0 1"', 'gravcomp="1"')], 'body "arm": gravcomp'),
        "motor": (
            [("</mujoco>", '<actuator><motor name="drive" joint="swing" gear="50"/></actuator></mujoco>')],
            'actuator "drive": gear and limits not used',
        ),
        "servos": (
            [
                (
                    "</mujoco>",
                    '<actuator><position name="p" joint="swing" kp="100"/><general name="g" joint="turn" '
                    'biastype="affine" gainprm="9" biasprm="0 -9 -1"/></actuator></mujoco>',
                )
            ],
            'actuators "p", "g": servo gains (kp, kv, gainprm, biasprm) not used',
        ),
        "plugin of an extension": (
            [
                (
                    "</mujoco>",
                    '<extension><plugin plugin="mujoco.pid"><instance name="i"/></plugin></extension></mujoco>',
                )
            ],
            'plugin "mujoco.pid": of an extension, ignored',
        ),
        "water": (
            [("</mujoco>", '<option density="1000" viscosity="1" wind="0 0 0"/></mujoco>')],
            'options "density", "viscosity": ignored',
        ),
        "rounded inertia": (
            [("0.1 0.1 0.1", "0.1 0.1 0.21")],
            'body "tool": principal moments of inertia that violate',
        ),
        "slightly indefinite": (
            [("0.1 0.1 0.1", "0.1 0.1 -1e-6")],
            'body "tool": a slightly negative principal moment',
        ),
        "placeholder": ([("0.1 0.1 0.1", "0 0 0"), OFF_AXIS], 'body "tool": a mass without inertia'),
        "no inertia": ([(' diaginertia="0.1 0.1 0.1"', ""), OFF_AXIS], 'body "tool": a mass without inertia'),
        "inertia without mass": ([('mass="1"', 'mass="0"')], 'body "tool": an inertia without mass'),
        "balanced": (
            [("0.1 0.1 0.1", "0.1 0.1 0.7"), (COMPILER, '<compiler angle="radian" balanceinertia="true"/>')],
            'body "tool": principal moments of inertia averaged',
        ),
        "a joint that moves nothing": ([(INERTIAL, "")], 'joint "turn": no inertia to move'),
        "a body and a site": ([(INERTIAL, INERTIAL + '<site name="tool"/>')], '"tool" is both'),
    }.values(),
)
def test_what_is_odd_is_noted_by_name(changed, changes, words):
    robot = changed.read("plain.xml", *changes)
    assert len(robot.notes) == 1
    assert words in robot.notes[0]


def test_the_armature_of_an_actuator_is_noted_by_name(changed):
    notes = changed.read(
        "plain.xml", ("</mujoco>", '<actuator><motor name="m" joint="swing" armature="2"/></actuator></mujoco>')
    ).notes
    assert notes[1] == 'actuator "m": armature of the actuator ignored: give it as [robot] rotor_inertia'
    assert len(notes) == 2


def test_odd_inertias_are_the_files_own_numbers(changed):
    """What MuJoCo's compiler would refuse, to the last digit, in the frame of the inertial and of frames around it."""
    odd = '<inertial pos="1 2 3" mass="2" diaginertia="0.1 0.21 0.1" euler="0 0 90"/>'
    in_frame = f'<frame pos="0 0 1" euler="90 0 0">{odd}</frame>'
    degrees = (COMPILER, "<compiler/>")
    plain, framed = (changed.read("plain.xml", degrees, (INERTIAL, text)).mechanism for text in (odd, in_frame))
    assert plain.mass[1] == 2.0
    assert plain.com[1] == pytest.approx([1.0, 2.0, 3.0])
    assert plain.inertia[1] == pytest.approx(np.diag([0.21, 0.1, 0.1]), abs=1e-15)
    assert framed.com[1] == pytest.approx([1.0, -3.0, 3.0])
    assert framed.inertia[1] == pytest.approx(np.diag([0.21, 0.1, 0.1]), abs=1e-15)
    full = changed.read("plain.xml", (INERTIAL, '<inertial pos="0 0 0" mass="2" fullinertia="1 2 2.9 0.1 0.2 0.3"/>'))
    assert np.array_equal(full.mechanism.inertia[1], [[1.0, 0.1, 0.2], [0.1, 2.0, 0.3], [0.2, 0.3, 2.9]])


@pytest.mark.parametrize("bounds", ['boundmass="3" boundinertia="0.15"', 'balanceinertia="true" boundmass="0"'])
@pytest.mark.parametrize(
    "inertia", ['diaginertia="0.1 0.1 0.19" euler="1 2 3"', 'fullinertia="0.3 0.3 0.4 0 0.05 0.05"']
)
def test_bounds_of_the_compiler_are_mujocos(changed, bounds, inertia):
    """boundmass, boundinertia and balanceinertia do what MuJoCo does with the same file."""
    mujoco = pytest.importorskip("mujoco")
    changes = ((COMPILER, f'<compiler angle="radian" {bounds}/>'), ('diaginertia="0.1 0.1 0.1"', inertia))
    ours = changed.read("plain.xml", *changes).mechanism
    model = mujoco.MjModel.from_xml_path(str(changed.folder / "plain.xml"))
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[2])
    turn = turn.reshape(3, 3)
    assert ours.mass.tolist() == model.body_mass[1:].tolist()
    assert ours.inertia[1] == pytest.approx(turn @ np.diag(model.body_inertia[2]) @ turn.T, abs=1e-12)


def test_bodies_without_mass_between_joints_are_normal(changed):
    """The same arm with a bare body, or one whose geoms weigh nothing, between its joints."""
    bare = '<body name="cross"><joint name="other" axis="0 1 0"/>{}{}</body>'
    whole = (
        '<body name="tool" pos="1 0 0">'
        + (DATA / "plain.xml").read_text().partition('<body name="tool" pos="1 0 0">')[2]
    )
    inner = whole[: whole.index("</body>") + len("</body>")]
    for geom in ("", '<geom type="box" size="1 1 1" mass="0"/>'):
        robot = changed.read("plain.xml", (inner, bare.format(geom, inner)))
        assert robot.mechanism.joint_names == ("swing", "other", "turn")
        assert robot.mechanism.mass[1] == 0.0
        assert not robot.mechanism.inertia[1].any()
        assert robot.notes == ()


@pytest.mark.parametrize(
    "changes",
    [
        [("</mujoco>", "<keyframe/><visual/><sensor/><custom/></mujoco>")],
        [("</mujoco>", '<asset><mesh name="m" file="/outside/m.stl"/></asset></mujoco>')],
        [(INERTIAL, INERTIAL + '<geom type="mesh" mesh="m"/><camera/><light/>')],
        [(GEOM, GEOM + '<geom type="mesh" mesh="m" mass="0"/>')],
        [("<worldbody>", '<worldbody><geom type="plane" size="1 1 1"/><body name="table"><geom type="mesh"/></body>')],
        [(COMPILER, '<compiler angle="radian" meshdir="/outside" discardvisual="true" usethread="true"/>')],
    ],
)
def test_what_neither_moves_nor_weighs_is_left_out(changed, changes):
    """The same numbers with and without it, and no notes."""
    plain, other = (changed.read("plain.xml", *some, tool=None) for some in ([], changes))
    assert other.notes == plain.notes == ()
    for name, value in vars(plain.mechanism).items():
        assert np.array_equal(value, getattr(other.mechanism, name))


def test_names_are_made_up_where_the_file_has_none(changed):
    robot = changed.read("plain.xml", ('name="swing" ', ""), ('name="turn" ', ""), ('name="arm" ', ""))
    assert robot.mechanism.joint_names == ("(joint 1)", "(joint 2)")


def test_the_tool_is_a_body_or_a_site(changed):
    site = changed.read("spatial.xml", tool="tip").mechanism
    body = changed.read("spatial.xml", tool="hand").mechanism
    assert site.tool_position == pytest.approx([0.01, 0.02, 0.1])
    assert body.tool_position.tolist() == [0.0, 0.0, 0.0]
    for_none = changed.refused("spatial.xml", tool=None)
    assert all(leaf in for_none for leaf in ('"vane"', '"ballast"', '"hand"', "3 frames"))
    assert 'Did you mean "tip"?' in changed.refused("spatial.xml", tool="tipp")
    assert "moving joint" in changed.refused("spatial.xml", tool="post")
    assert "moving joint" in changed.refused("spatial.xml", tool="world")


def test_the_users_warning_handler_survives():
    import mujoco

    def handler(message: str) -> None: ...

    mujoco.set_mju_user_warning(handler)
    try:
        read_robot_file(DATA / "plain.xml", None, folder=DATA)
        assert mujoco.get_mju_user_warning() is handler
    finally:
        mujoco.set_mju_user_warning(None)

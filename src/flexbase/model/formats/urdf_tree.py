"""A sound URDF -> the tree of its moving bodies, by Pinocchio, which only ever sees text that is written here."""

from __future__ import annotations

from typing import Any

import numpy as np

from flexbase.errors import import_extra
from flexbase.model.formats.chain import Foot, Moving, Place, RobotFile, chain_to, choose_tool
from flexbase.model.formats.fields import Numbers
from flexbase.model.formats.guard import Element
from flexbase.model.formats.notes import Notes
from flexbase.model.formats.urdf import MOVING, Urdf, UrdfJoint, UrdfLink, check_mimics, check_urdf
from flexbase.model.mechanism import Body

WIDE = 1e9  # limits that Pinocchio asks for and that nothing here uses


def read_urdf(robot: Element, tool: str | None) -> RobotFile:
    """The chain from the root link to a link. Raises InputError."""
    urdf = check_urdf(robot)
    name = choose_tool(tool, list(urdf.links), urdf.leaves)
    following = check_mimics(urdf, name)
    moved = {joint.name for joint in urdf.path(name)}
    tree, last, place, foot = _tree(urdf, name)
    notes = urdf.notes.lines(lambda what, name: name in moved if what == "joint" else name != urdf.root)
    mimics = Notes()
    for joint in following:
        mimics.add("joint", joint.name, "mimic ignored, because its branch is locked")
    below = tuple(urdf.notes.lines(lambda what, name: what == "link" and name == urdf.root))
    return chain_to(tree, last, place, {0: Foot(foot, below)}, [*notes, *mimics.lines()])


def _tree(urdf: Urdf, tool: str) -> tuple[list[Moving], int, Place, Body]:
    """Moving bodies, the number of the one that carries the tool, where it carries it, and what is fixed to the root.

    Pinocchio welds what fixed joints connect.
    """
    pinocchio = import_extra("pinocchio", "robots")
    model = pinocchio.buildModelFromXML(clean_urdf(urdf))
    joints = list(urdf.joints.values())
    tree = []
    for index in range(1, model.njoints):
        joint, at, inertia = joints[int(model.names[index][1:])], model.jointPlacements[index], model.inertias[index]
        tree.append(
            Moving(
                name=joint.name,
                parent=int(model.parents[index]) - 1,
                revolute=joint.kind != "prismatic",
                axis=np.array(joint.axis),
                place=Place(np.array(at.rotation), np.array(at.translation)),
                body=_body(inertia),
                friction=joint.damping,
                limits=joint.limits,
            )
        )
    frame = model.frames[model.getFrameId(f"l{list(urdf.links).index(tool)}")]
    last = frame.parentJoint if hasattr(frame, "parentJoint") else frame.parent
    place = Place(np.array(frame.placement.rotation), np.array(frame.placement.translation))
    return tree, int(last) - 1, place, _body(model.inertias[0])


def _body(inertia: Any) -> Body:
    return Body(float(inertia.mass), np.array(inertia.lever), np.array(inertia.inertia))


def clean_urdf(urdf: Urdf) -> str:
    """The same robot in our own words: numbered names, checked numbers, unlimited joints, nothing to look at."""
    number = {name: f"l{index}" for index, name in enumerate(urdf.links)}
    links = [_link_text(number[link.name], link) for link in urdf.links.values()]
    joints = [_joint_text(f"j{index}", joint, number) for index, joint in enumerate(urdf.joints.values())]
    return "\n".join(['<robot name="robot">', *links, *joints, "</robot>"])


def _link_text(name: str, link: UrdfLink) -> str:
    xx, yy, zz, xy, xz, yz = map(repr, link.inertia)
    return (
        f'<link name="{name}"><inertial><origin xyz="{_text(link.xyz)}" rpy="{_text(link.rpy)}"/>'
        f'<mass value="{link.mass!r}"/>'
        f'<inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="{xy}" ixz="{xz}" iyz="{yz}"/></inertial></link>'
    )


def _joint_text(name: str, joint: UrdfJoint, number: dict[str, str]) -> str:
    kind = "revolute" if joint.kind == "continuous" else joint.kind  # a continuous one would become cosine and sine
    limit = f'<limit lower="{-WIDE!r}" upper="{WIDE!r}" effort="{WIDE!r}" velocity="{WIDE!r}"/>'
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{number[joint.parent]}"/>'
        f'<child link="{number[joint.child]}"/><origin xyz="{_text(joint.xyz)}" rpy="{_text(joint.rpy)}"/>'
        f'<axis xyz="{_text(joint.axis)}"/>{limit if joint.kind in MOVING else ""}</joint>'
    )


def _text(values: Numbers) -> str:
    return " ".join(map(repr, values))

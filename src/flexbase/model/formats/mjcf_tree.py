"""A sound MJCF -> the tree of its moving bodies, by MuJoCo's compiler, which only ever sees what is written here."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.model.formats.chain import (
    AT_ORIGIN,
    NOTHING,
    WORLD,
    Foot,
    Moving,
    Place,
    RobotFile,
    chain_to,
    choose_tool,
    turned,
    welded,
)
from flexbase.model.formats.guard import Element, shown
from flexbase.model.formats.mjcf import LEAST, Mjcf, check_mjcf
from flexbase.model.formats.mjcf_couplings import check_couplings
from flexbase.model.formats.mjcf_drives import drive_notes
from flexbase.model.formats.notes import Notes
from flexbase.model.formats.quiet_mujoco import quiet_mujoco
from flexbase.model.mechanism import Body

HINGE = 3  # mjtJoint
OWN_NAME = re.compile(r"(?:\b(?:body|joint|site|geom) )?'([bjsg])([0-9]+)'")


def read_mjcf(root: Element, tool: str | None) -> RobotFile:
    """The chain from the world to a body or site. Raises InputError."""
    mjcf = check_mjcf(root)
    names = {body.name: number for number, body in enumerate(mjcf.bodies)}
    name = choose_tool(tool, [*names, *mjcf.sites], mjcf.leaves)
    body = names[name] if name in names else mjcf.sites[name]
    notes = [*mjcf.notes.lines(), *check_couplings(mjcf, root, body)]
    if name in names and name in mjcf.sites:
        notes.append(f"{shown(name)} is both a body and a site: the body is taken")
    notes += drive_notes(root)
    model = _compiled(mjcf)
    tree, frames, feet = _tree(mjcf, model)
    last, place = frames[int(model.body(f"b{body}").id)] if body else (WORLD, AT_ORIGIN)
    if name not in names:
        site = model.site(f"s{list(mjcf.sites).index(name)}")
        place = place.then(Place(_rotation(site.quat), np.array(site.pos)))
    chain = {mjcf.joints[joint] for above in mjcf.ancestors(body) for joint in mjcf.bodies[above].joints}
    notes += _joint_notes(tree, model).lines(lambda what, name: name in chain)
    return chain_to(tree, last, place, feet, notes)


def _compiled(mjcf: Mjcf) -> Any:
    try:
        with quiet_mujoco("robots") as mujoco:
            return mujoco.MjModel.from_xml_string("\n".join(mjcf.text))
    except ValueError as fault:
        raise InputError(f"MuJoCo refuses the robot: {_reason(mjcf, str(fault))}") from fault


def _reason(mjcf: Mjcf, message: str) -> str:
    """MuJoCo's words, which quote nothing but what is written here, with our names turned back into the file's."""
    first, _, rest = message.strip().partition("\n")
    reason = first.removeprefix("XML ").removeprefix("Error: ").removeprefix("error ")[:200].rstrip(".")
    where = [f", at {_meant(mjcf, found)}" for found in OWN_NAME.finditer(rest)]
    return f"{OWN_NAME.sub(lambda found: _meant(mjcf, found), reason)}{''.join(where[:1])}."


def _meant(mjcf: Mjcf, found: re.Match[str]) -> str:
    """What one of our names stands for."""
    number = int(found[2])
    match found[1]:
        case "b":
            return f"body {shown(mjcf.bodies[number].name)}"
        case "j":
            return f"joint {shown(mjcf.joints[number])}"
        case "s":
            return f"site {shown(list(mjcf.sites)[number])}"
        case _:
            return f"a geom of body {shown(mjcf.bodies[mjcf.weighed[number]].name)}"


def _tree(mjcf: Mjcf, model: Any) -> tuple[list[Moving], dict[int, tuple[int, Place]], dict[int, Foot]]:
    """Moving bodies, a joint each; where every MuJoCo body sits: the moving body that carries it, and where; and what
    stands still, by the body in the world that it is fixed to.

    Several joints of a body become bodies without mass, except for the last one. A joint frame lies at the joint's
    anchor; it is turned back by `ref`, so that joint positions are MuJoCo's qpos.
    """
    tree: list[Moving] = []
    frames: dict[int, tuple[int, Place]] = {0: (WORLD, AT_ORIGIN)}
    feet: dict[int, Foot] = {}
    for index in range(1, model.nbody):
        parent, at = frames[int(model.body_parentid[index])]
        at = at.then(Place(_rotation(model.body_quat[index]), np.array(model.body_pos[index])))
        number = int(model.body(index).name[1:])
        body, piece = _body(mjcf, model, index), mjcf.ancestors(number)[0]
        first = int(model.body_jntadr[index])
        for joint in range(first, first + int(model.body_jntnum[index])):
            anchor = np.array(model.jnt_pos[joint]) * (model.jnt_type[joint] == HINGE)
            node = _moving(mjcf, model, joint, parent, at.then(Place(np.eye(3), anchor)))
            tree.append(replace(node, piece=piece))
            parent, at = len(tree) - 1, Place(np.eye(3), -anchor)
        frames[index] = (parent, at)
        if parent != WORLD:
            tree[parent] = replace(tree[parent], body=welded(tree[parent].body, at.carry(body)))
        else:
            feet[piece] = Foot(welded(feet.get(piece, Foot(NOTHING)).body, at.carry(body)))
    return tree, frames, {piece: Foot(foot.body, _below(mjcf, piece)) for piece, foot in feet.items()}


def _below(mjcf: Mjcf, piece: int) -> tuple[str, ...]:
    """Remarks on the bodies that stand still in a piece of the file."""
    names = {body.name for number, body in enumerate(mjcf.bodies) if number and mjcf.ancestors(number)[0] == piece}
    return tuple(mjcf.foot_notes.lines(lambda what, name: name in names))


def _moving(mjcf: Mjcf, model: Any, joint: int, parent: int, place: Place) -> Moving:
    """A joint whose frame is `place` at its reference."""
    axis, reference = np.array(model.jnt_axis[joint]), float(model.qpos0[model.jnt_qposadr[joint]])
    revolute = bool(model.jnt_type[joint] == HINGE)
    back = turned(axis, -reference) if revolute else Place(np.eye(3), -reference * axis)
    dof = int(model.jnt_dofadr[joint])
    numbers = [float(model.dof_damping[dof]), float(model.dof_armature[dof]), float(model.jnt_stiffness[joint])]
    name = mjcf.joints[int(model.joint(joint).name[1:])]
    for what, value in zip(("damping", "armature", "stiffness"), numbers, strict=True):
        if value < 0.0:
            raise InputError(f"joint {shown(name)}: its {what} is negative. Give zero or a positive number.")
    low, high = model.jnt_range[joint] if model.jnt_limited[joint] else (-np.inf, np.inf)
    friction, armature, stiffness = numbers
    return Moving(
        name=name,
        parent=parent,
        revolute=revolute,
        axis=axis,
        place=place.then(back),
        body=NOTHING,
        friction=friction,
        armature=armature,
        stiffness=stiffness,
        reference=reference,
        limits=(float(low), float(high)),
    )


def _joint_notes(tree: list[Moving], model: Any) -> Notes:
    """What the joints have that the chain does not use."""
    notes = Notes()
    for node, loss in zip(tree, model.dof_frictionloss.tolist(), strict=True):
        if node.friction > 0.0:
            notes.add("joint", node.name, "damping, often the servo's, not used unless [robot] file_friction = true")
        if node.stiffness > 0.0:
            notes.add("joint", node.name, "stiffness in the file, reported but not used")
        if loss > 0.0:
            notes.add("joint", node.name, "dry friction ignored, because the model is linear")
    return notes


def _rotation(quaternion: Any) -> Array:
    """Rotation matrix of w x y z, of length 1 or nearly so."""
    w, x, y, z = (np.array(quaternion, dtype=float) / np.linalg.norm(quaternion)).tolist()
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def _body(mjcf: Mjcf, model: Any, index: int) -> Body:
    """What a body weighs: the file's own numbers, or what MuJoCo makes of its geoms."""
    own, turn = mjcf.bodies[int(model.body(index).name[1:])].own, _rotation(model.body_iquat[index])
    mass, inertia = own or (float(model.body_mass[index]), np.diag(model.body_inertia[index]))
    if own is None and mass <= LEAST:
        return NOTHING
    return Body(mass, np.array(model.body_ipos[index]), np.array(turn @ inertia @ turn.T))

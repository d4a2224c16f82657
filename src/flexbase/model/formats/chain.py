"""A tree of moving bodies, whatever file it comes from -> the serial chain to the tool frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from flexbase.checks import Array
from flexbase.errors import InputError, nearest_name
from flexbase.model.formats.guard import SHOWN, listed, shown
from flexbase.model.formats.notes import Notes
from flexbase.model.mechanism import Body, Mechanism, merged, steiner

MOST_JOINTS = 64  # moving ones in the chain
WORLD = -1


class Foot(NamedTuple):
    """What stands still while the file stands alone, and moves where base joints are added below it.

    body : the root link (URDF) or the body in the world that the arm stands on (MJCF), with all that is fixed to it and
        the side branches that hang from it, in the frame of the file's root
    notes : what the user should know if it moves
    """

    body: Body
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class RobotFile:
    """What a robot file says, as frozen arrays. N moving joints, in chain order, SI units.

    mechanism : the serial chain from the file's root to the tool frame
    friction : viscous joint friction found in the file (URDF damping, MJCF damping), shape (N,): reported, not used
    armature : reflected rotor inertia (MJCF armature), shape (N,): belongs on the diagonal of M
    stiffness : joint stiffness (MJCF stiffness), shape (N,): reported, so that it is never counted twice
    reference : joint positions at the pose that the file draws (MJCF ref; zero in URDF), shape (N,)
    limits : lowest and highest joint positions, infinite where there are none, shape (N, 2)
    foot : what the chain stands on; it counts where base joints are added below it
    notes : one line for everything that was accepted, but that the user should know
    """

    mechanism: Mechanism
    friction: Array
    armature: Array
    stiffness: Array
    reference: Array
    limits: Array
    foot: Foot
    notes: tuple[str, ...]


class Place(NamedTuple):
    """A frame as seen from another: rotation (3, 3) and position (3,)."""

    rotation: Array
    position: Array

    def then(self, other: Place) -> Place:
        """A frame that `other` places in this one."""
        return Place(self.rotation @ other.rotation, self.position + self.rotation @ other.position)

    def carry(self, body: Body) -> Body:
        """A body given in this frame, as seen from outside."""
        return Body(body.mass, self.position + self.rotation @ body.com, self.rotation @ body.inertia @ self.rotation.T)


AT_ORIGIN = Place(np.eye(3), np.zeros(3))
NOTHING = Body(0.0, np.zeros(3), np.zeros((3, 3)))


def turned(axis: Array, angle: float) -> Place:
    """Rotation about a unit axis."""
    x, y, z = axis.tolist()
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return Place(rotation, np.zeros(3))


@dataclass(frozen=True, eq=False)
class Moving:
    """A joint and the body that it carries, in the joint frame at joint position 0.

    parent : number of the body before it, or WORLD; parents come first in a tree
    place : the joint frame at position 0, in the parent's frame
    piece : number of the piece of the file that it belongs to; MJCF bodies in the world are not fixed to each other
    """

    name: str
    parent: int
    revolute: bool
    axis: Array
    place: Place
    body: Body
    friction: float = 0.0
    armature: float = 0.0
    stiffness: float = 0.0
    reference: float = 0.0
    limits: tuple[float, float] = (-np.inf, np.inf)
    piece: int = 0

    @property
    def locked(self) -> Place:
        """Where its frame is in the parent's while the joint stays at its reference."""
        if self.revolute:
            return self.place.then(turned(self.axis, self.reference))
        return self.place.then(Place(np.eye(3), self.reference * self.axis))


def chain_to(
    tree: Sequence[Moving], last: int, tool: Place, feet: Mapping[int, Foot], notes: Sequence[str] = ()
) -> RobotFile:
    """The chain to a tool frame given in the frame of body `last`; side branches are welded on at their reference.

    feet : what is fixed to the root, by the number of its piece
    Raises InputError if nothing moves the tool frame, or too much.
    """
    path = path_to(tree, last)
    if not path:
        raise InputError("no moving joint between the root and the tool frame. Name a tool frame that moves.")
    if len(path) > MOST_JOINTS:
        raise InputError(f"{len(path)} moving joints lead to the tool frame, at most {MOST_JOINTS} can be handled.")
    side = [node.name for number, node in enumerate(tree) if number not in path]
    bodies = [node.body for node in tree]
    foot = feet.get(tree[path[0]].piece, Foot(NOTHING))
    for number in reversed(range(len(tree))):
        node = tree[number]
        if number not in path and node.parent != WORLD:
            bodies[node.parent] = welded(bodies[node.parent], node.locked.carry(bodies[number]))
        elif number not in path and node.piece == tree[path[0]].piece:
            foot = foot._replace(body=welded(foot.body, node.locked.carry(bodies[number])))
    chain = [tree[number] for number in path]
    carried = [bodies[number] for number in path]
    own = Notes()
    for name in side:
        own.add("joint", name, "of a side branch, locked where the file draws it")
    for name in _weightless(chain, carried):
        own.add("joint", name, "no inertia to move, so give a payload or a rotor inertia")
    return RobotFile(
        mechanism=_mechanism(chain, carried, tool),
        friction=_frozen([node.friction for node in chain]),
        armature=_frozen([node.armature for node in chain]),
        stiffness=_frozen([node.stiffness for node in chain]),
        reference=_frozen([node.reference for node in chain]),
        limits=_frozen([node.limits for node in chain]),
        foot=foot._replace(body=Body(foot.body.mass, _frozen(foot.body.com), _frozen(foot.body.inertia))),
        notes=(*notes, *own.lines()),
    )


def path_to(tree: Sequence[Moving], last: int) -> list[int]:
    """Numbers of the bodies from the world to `last`."""
    path = []
    while last != WORLD:
        path.append(last)
        last = tree[last].parent
    return path[::-1]


def choose_tool(tool: str | None, frames: Sequence[str], leaves: Sequence[str]) -> str:
    """The frame that was asked for, or the only one in which the tree ends. Raises InputError naming them."""
    if not leaves:
        raise InputError("nothing in it moves. Give a robot with revolute or prismatic joints.")
    ends = f"The tree ends in {listed(list(leaves))}."
    if tool is None:
        if len(leaves) != 1:
            raise InputError(f"{len(leaves)} frames could be the tool. {ends} Name one as tool.")
        return leaves[0]
    if tool not in frames:
        hint = nearest_name(tool[:SHOWN], {name[:SHOWN] for name in frames})
        raise InputError(f"no frame {shown(tool)}. {hint if hint.startswith('Did') else ends}")
    return tool


def welded(one: Body, other: Body) -> Body:
    """Two bodies as one, also where both have no mass and only inertia."""
    if one.mass + other.mass == 0.0:
        return Body(0.0, one.com, one.inertia + other.inertia)
    return merged(one, other)


def _weightless(chain: Sequence[Moving], carried: Sequence[Body]) -> list[str]:
    """The joints that move no inertia at all: M is singular unless the project adds some."""
    found = []
    beyond = NOTHING
    for node, body in zip(reversed(chain), reversed(carried), strict=True):
        beyond = welded(body, beyond)
        about_axis = beyond.inertia + steiner(beyond.mass, beyond.com)
        moved = float(node.axis @ about_axis @ node.axis) if node.revolute else beyond.mass
        if moved + node.armature <= 0.0:
            found.append(node.name)
        beyond = node.locked.carry(beyond)
    return found[::-1]


def _mechanism(chain: Sequence[Moving], carried: Sequence[Body], tool: Place) -> Mechanism:
    return Mechanism(
        joint_names=tuple(node.name for node in chain),
        joint_types=tuple("revolute" if node.revolute else "prismatic" for node in chain),
        axes=_frozen([node.axis for node in chain]),
        placement_rotation=_frozen([node.place.rotation for node in chain]),
        placement_position=_frozen([node.place.position for node in chain]),
        mass=_frozen([body.mass for body in carried]),
        com=_frozen([body.com for body in carried]),
        inertia=_frozen([0.5 * (body.inertia + body.inertia.T) for body in carried]),
        tool_rotation=_frozen(tool.rotation),
        tool_position=_frozen(tool.position),
    )


def _frozen(values: object) -> Array:
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array

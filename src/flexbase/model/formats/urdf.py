"""URDF: an XML tree -> links and joints that are known to be sound. Visual and collision are never read."""

from __future__ import annotations

import math
from dataclasses import dataclass

from flexbase.errors import InputError
from flexbase.model.formats.fields import Numbers, direction, name_of, number, numbers, refuse_repeated, vector, word
from flexbase.model.formats.guard import Element, listed, shown
from flexbase.model.formats.inertias import judge_inertia, refuse_negative, tensor
from flexbase.model.formats.notes import Notes

MOST_LINKS = 500
MOVING = ("revolute", "continuous", "prismatic")
SUPPORTED = (*MOVING, "fixed")
UNSUPPORTED = ("floating", "planar", "spherical", "ball", "screw", "cylindrical")
MOMENTS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
ORIGIN = (0.0, 0.0, 0.0)
ANY = math.inf


@dataclass(frozen=True)
class UrdfLink:
    """A link's mass properties: `inertia` is ixx iyy izz ixy ixz iyz about the centre of mass, in the inertial axes."""

    name: str
    mass: float = 0.0
    xyz: Numbers = ORIGIN
    rpy: Numbers = ORIGIN
    inertia: Numbers = (0.0,) * 6


@dataclass(frozen=True)
class UrdfJoint:
    """A joint: `mimics` names the joint that it follows; the axis has length 1."""

    name: str
    kind: str
    parent: str
    child: str
    xyz: Numbers
    rpy: Numbers
    axis: Numbers
    limits: tuple[float, float]
    damping: float
    mimics: str | None


@dataclass(frozen=True)
class Urdf:
    """A sound tree of links. parent_joint : the joint above each link but the root."""

    links: dict[str, UrdfLink]
    joints: dict[str, UrdfJoint]
    parent_joint: dict[str, UrdfJoint]
    root: str
    notes: Notes

    def path(self, link: str) -> list[UrdfJoint]:
        """All joints from the root to a link."""
        path: list[UrdfJoint] = []
        while link != self.root:
            path.append(self.parent_joint[link])
            link = path[-1].parent
        return path[::-1]

    @property
    def leaves(self) -> list[str]:
        """The moving links without children."""
        parents = {joint.parent for joint in self.joints.values()}
        ends = [name for name in self.links if name not in parents]
        return [name for name in ends if any(joint.kind in MOVING for joint in self.path(name))]


def check_urdf(robot: Element) -> Urdf:
    """Links and joints of a <robot>. Raises InputError on the first thing that is not sound."""
    link_elements, joint_elements = robot.all("link"), robot.all("joint")
    if not link_elements:
        raise InputError("no <link> in it. Give a robot description.")
    for what, found in (("links", link_elements), ("joints", joint_elements)):
        if len(found) > MOST_LINKS:
            raise InputError(f"more than {MOST_LINKS} {what}, which is beyond what flexbase reads. Cut the file down.")
    notes = Notes()
    links = [_link(element, notes) for element in link_elements]
    joints = [_joint(element, notes) for element in joint_elements]
    refuse_repeated("link", [link.name for link in links])
    refuse_repeated("joint", [joint.name for joint in joints])
    by_name = {link.name: link for link in links}
    parent_joint = {}
    for joint in joints:
        for role, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in by_name:
                raise InputError(f"joint {shown(joint.name)}: its {role} link {shown(name)} does not exist. Add it.")
        if joint.child in parent_joint:
            raise InputError(f"link {shown(joint.child)}: it is the child of two joints. A robot is a tree of links.")
        parent_joint[joint.child] = joint
    root = _root([link.name for link in links], parent_joint)
    return Urdf(by_name, {joint.name: joint for joint in joints}, parent_joint, root, notes)


def check_mimics(urdf: Urdf, tool: str) -> list[UrdfJoint]:
    """Joints of side branches that follow another one. Raises InputError where the chain to the tool is involved."""
    chain = {joint.name for joint in urdf.path(tool)}
    following = []
    for joint in urdf.joints.values():
        if joint.mimics is None:
            continue
        if joint.mimics not in urdf.joints:
            raise InputError(f"joint {shown(joint.name)}: it mimics {shown(joint.mimics)}, which does not exist.")
        if joint.name in chain or joint.mimics in chain:
            raise InputError(
                f"joint {shown(joint.name)}: it mimics {shown(joint.mimics)}, and coupled joints in the chain to the "
                "tool are not supported. Remove <mimic>, or choose another tool."
            )
        following.append(joint)
    return following


def _link(element: Element, notes: Notes) -> UrdfLink:
    name = name_of(element)
    inertial = element.one("inertial")
    if inertial is None:
        return UrdfLink(name)
    origin, mass, inertia = inertial.one("origin"), inertial.one("mass"), inertial.one("inertia")
    where = f"link {shown(name)}"
    if mass is None:
        raise InputError(f"{where}: its <inertial> has no <mass>. Give it.")
    kilograms = number(mass, "value")
    moments = (0.0,) * 6 if inertia is None else tuple(number(inertia, key) for key in MOMENTS)
    refuse_negative(where, kilograms, tensor(*moments))
    if remark := judge_inertia(where, kilograms, tensor(*moments)):
        notes.add("link", name, remark)
    return UrdfLink(name, kilograms, vector(origin, "xyz", ORIGIN), vector(origin, "rpy", ORIGIN), moments)


def _joint(element: Element, notes: Notes) -> UrdfJoint:
    name = name_of(element)
    where = f"joint {shown(name)}"
    kind = element.attributes.get("type", "")
    if kind in UNSUPPORTED:
        raise InputError(f"{where}: {kind} joints are not supported. Use {', '.join(SUPPORTED)}.")
    word(element, "type", SUPPORTED)
    parent, child = element.one("parent"), element.one("child")
    if parent is None or child is None:
        raise InputError(f"{where}: <parent> or <child> is missing. Give both.")
    origin, axis = element.one("origin"), element.one("axis")
    dynamics, mimic = element.one("dynamics"), element.one("mimic")
    damping = 0.0
    if dynamics is not None and kind in MOVING:
        damping = vector(dynamics, "damping", (0.0,))[0]
        if damping < 0.0:
            raise InputError(f"{where}: its damping is negative. Give zero or a positive number.")
        if damping > 0.0:
            notes.add("joint", name, "damping in the file, not used unless [robot] file_friction = true")
        if vector(dynamics, "friction", (0.0,))[0] != 0.0:
            notes.add("joint", name, "dry friction ignored, because the model is linear")
    return UrdfJoint(
        name=name,
        kind=kind,
        parent=name_of(parent, "link"),
        child=name_of(child, "link"),
        xyz=vector(origin, "xyz", ORIGIN),
        rpy=vector(origin, "rpy", ORIGIN),
        axis=direction(axis, "xyz", (1.0, 0.0, 0.0)) if kind in MOVING else (1.0, 0.0, 0.0),
        limits=_limits(element, kind, name, notes),
        damping=damping,
        mimics=name_of(mimic, "joint") if mimic is not None and kind in MOVING else None,
    )


def _limits(element: Element, kind: str, name: str, notes: Notes) -> tuple[float, float]:
    limit = element.one("limit")
    if kind not in ("revolute", "prismatic"):
        return -ANY, ANY
    if limit is None:
        notes.add("joint", name, "no limits given, taken as unlimited")
        return -ANY, ANY
    ends = (numbers(limit, key, 1, largest=ANY)[0] if key in limit.attributes else 0.0 for key in ("lower", "upper"))
    lower, upper = ends
    if lower >= upper:
        notes.add("joint", name, "limits that leave no room, taken as unlimited")
        return -ANY, ANY
    return lower, upper


def _root(names: list[str], parent_joint: dict[str, UrdfJoint]) -> str:
    """The one link without a parent, from which all others hang. Raises InputError on several, and on cycles."""
    roots = [name for name in names if name not in parent_joint]
    if len(roots) > 1:
        raise InputError(f"{len(roots)} root links: {listed(roots)}. Connect them by joints: one link has no parent.")
    children: dict[str, list[str]] = {}
    for child, joint in parent_joint.items():
        children.setdefault(joint.parent, []).append(child)
    reached, waiting = set(roots), list(roots)
    while waiting:
        found = children.get(waiting.pop(), [])
        reached.update(found)
        waiting += found
    lost = [name for name in names if name not in reached]
    if lost:
        raise InputError(f"links {listed(lost)} hang in a closed loop. A robot is a tree of links.")
    return roots[0]

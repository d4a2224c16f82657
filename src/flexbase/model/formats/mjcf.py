"""MJCF: an XML tree -> the same robot in our own words, with numbered names and checked numbers, for MuJoCo to compile.

Defaults, angle units, Euler sequences and inertia from geoms stay MuJoCo's work. Assets, meshes and looks are left out,
so that there is no path that it could open.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.model.formats.fields import Numbers, name_of, number, numbers, refuse_repeated
from flexbase.model.formats.guard import LONGEST_NAME, Element, place, shown
from flexbase.model.formats.inertias import as_compiled, judge_inertia, refuse_negative, tensor
from flexbase.model.formats.mjcf_attributes import clean_attributes
from flexbase.model.formats.mjcf_words import (
    IN_BODY,
    IN_BODY_IGNORED,
    SECTIONS_IGNORED,
    SECTIONS_READ,
    SOLIDS,
)
from flexbase.model.formats.notes import Notes

MOST = 500  # bodies, joints, named sites, frames, default classes: MuJoCo takes longer than in proportion
MOST_GEOMS = 2000  # that weigh something
WORLD_BODY = 0
MAIN = "main"
ZERO = {"0", "0.0", "0."}
LEAST = 1e-14  # kg, kg m^2: MuJoCo wants more than 1e-15 of whatever moves; what has no more weighs nothing here
STAND_IN = {"mass": "1", "diaginertia": "1 1 1", "fullinertia": "3 2.5 2 0 0 0"}  # it may not judge the file's own


@dataclass(eq=False)
class MjcfBody:
    """A body as written: `name` may be made up.

    moves : whether a joint is above or in it
    weighs : whether it moves, or the arm stands on it; scenery weighs nothing here
    from_geoms : whether its geoms are what it weighs
    own : otherwise its mass and its inertia in the axes of its inertial frame, None where it has neither
    """

    name: str
    parent: int
    moves: bool
    weighs: bool
    from_geoms: bool
    own: tuple[float, Array] | None = None
    joints: list[int] = field(default_factory=list)


@dataclass(eq=False)
class Mjcf:
    """A robot in our own words, and what its numbered names stand for. bodies[0] is the world."""

    text: list[str] = field(default_factory=list)
    bodies: list[MjcfBody] = field(default_factory=lambda: [MjcfBody("world", -1, False, False, False)])
    joints: list[str] = field(default_factory=list)
    sites: dict[str, int] = field(default_factory=dict)  # in the order of their numbers; -> body
    geoms: dict[str, int] = field(default_factory=dict)
    weighed: list[int] = field(default_factory=list)  # the body of each geom that is kept
    classes: dict[str, str] = field(default_factory=lambda: {MAIN: MAIN})
    geom_defaults: dict[str, dict[str, str]] = field(default_factory=lambda: {MAIN: {}})
    from_geoms: str = "auto"
    least_mass: float = 0.0
    least_moment: float = 0.0
    balance: bool = False
    frames: int = 0
    notes: Notes = field(default_factory=Notes)
    foot_notes: Notes = field(default_factory=Notes)  # on bodies that stand still in the file

    def remark(self, body: int, text: str) -> None:
        """Remark on what a body weighs."""
        whose = self.bodies[body]
        if whose.weighs:
            (self.notes if whose.moves else self.foot_notes).add("body", whose.name, text)

    def ancestors(self, body: int) -> list[int]:
        """The body and all above it but the world, from the world outwards."""
        path = []
        while body != WORLD_BODY:
            path.append(body)
            body = self.bodies[body].parent
        return path[::-1]

    @property
    def leaves(self) -> list[str]:
        """The moving bodies without children."""
        parents = {body.parent for body in self.bodies}
        return [body.name for number, body in enumerate(self.bodies) if body.moves and number not in parents]


def check_mjcf(root: Element) -> Mjcf:
    """The robot of a <mujoco> element. Raises InputError on the first thing that is not sound."""
    mjcf = Mjcf()
    for section in root.children:
        if section.tag not in SECTIONS_READ | SECTIONS_IGNORED:
            raise InputError(f"{place(section)}: not supported, because it could move or weigh something. Remove it.")
    mjcf.text.append(f'<mujoco><compiler boundmass="{LEAST}" boundinertia="{LEAST}"/>')
    for compiler in root.all("compiler"):
        _compiler(mjcf, compiler)
    for default in root.all("default"):
        _default(mjcf, default, None)
    mjcf.text.append("<worldbody>")
    for world in root.all("worldbody"):
        if world.attributes:
            raise InputError(f"{place(world)}: the world takes no attributes. Put them on a body in it.")
        _children(mjcf, world, WORLD_BODY, MAIN)
    mjcf.text += ["</worldbody>", "</mujoco>"]
    refuse_repeated("body", [body.name for body in mjcf.bodies])
    refuse_repeated("joint", mjcf.joints)
    return mjcf


def _compiler(mjcf: Mjcf, element: Element) -> None:
    given = dict(element.attributes)
    if given.pop("coordinate", "local") != "local":
        raise InputError(f"{place(element)}: only local coordinates are supported. Convert the file.")
    if "settotalmass" in given and numbers(element, "settotalmass", 1)[0] > 0.0:
        raise InputError(
            f"{place(element)}: settotalmass rescales what the file says. Scale the masses, and remove it."
        )
    given.pop("settotalmass", None)
    mjcf.from_geoms = given.get("inertiafromgeom", mjcf.from_geoms)
    mjcf.least_mass = number(element, "boundmass") if "boundmass" in given else mjcf.least_mass
    mjcf.least_moment = number(element, "boundinertia") if "boundinertia" in given else mjcf.least_moment
    mjcf.balance = given.get("balanceinertia", str(mjcf.balance).lower()) == "true"
    for key in ("boundmass", "boundinertia"):
        if key in given and number(element, key) <= LEAST:
            given[key] = repr(LEAST)
    mjcf.text.append(f"<compiler{clean_attributes(replace(element, attributes=given))}/>")


def _default(mjcf: Mjcf, element: Element, inherited: str | None) -> None:
    """A default class and those inside it: joints, geoms and sites only. inherited : None for the outermost."""
    name = name_of(element, "class") if inherited or "class" in element.attributes else MAIN
    if not inherited and name != MAIN:
        raise InputError(f"{place(element)}: the outermost default class is called main. Leave its class out.")
    if inherited and name in mjcf.classes:
        raise InputError(f"{place(element)}: class {shown(name)} is defined twice. Rename one.")
    _refuse_more("default classes", len(mjcf.classes))
    mjcf.classes.setdefault(name, f"c{len(mjcf.classes)}")
    mjcf.text.append(f'<default class="{mjcf.classes[name]}">')
    looks = dict(mjcf.geom_defaults[inherited or name])
    for child in element.children:
        if child.tag in ("joint", "geom", "site"):
            if child.tag == "geom":
                looks |= child.attributes
            mjcf.text.append(f"<{child.tag}{clean_attributes(child)}/>")
    mjcf.geom_defaults[name] = looks
    for child in element.all("default"):
        _default(mjcf, child, name)
    mjcf.text.append("</default>")


def _children(mjcf: Mjcf, element: Element, body: int, childclass: str) -> None:
    """Everything inside a body, a frame or the world."""
    for child in element.children:
        if child.tag in IN_BODY_IGNORED:
            continue
        if child.tag == "freejoint":
            raise InputError(f"{place(child)}: free joints are not supported. Use hinge and slide joints.")
        if child.tag not in IN_BODY:
            raise InputError(f"{place(child)}: not supported in a body. Remove it.")
        if child.tag in ("body", "frame"):
            _nested(mjcf, child, body, childclass)
        elif child.tag == "joint":
            _joint(mjcf, child, body)
        elif child.tag == "site":
            _site(mjcf, child, body)
        elif child.tag == "geom":
            _remember(mjcf.geoms, child, body)
            if mjcf.bodies[body].from_geoms:
                _geom(mjcf, child, body, childclass)
        else:
            _inertial(mjcf, child, body)


def _nested(mjcf: Mjcf, element: Element, parent: int, childclass: str) -> None:
    inner, name = parent, ""
    if element.tag == "frame":
        _refuse_more("frames", mjcf.frames)
        mjcf.frames += 1
    if element.tag == "body":
        _refuse_more("bodies", len(mjcf.bodies) - 1)
        inner = len(mjcf.bodies)
        mjcf.bodies.append(_body(mjcf, element, parent, _own_name(element, f"(body {inner})")))
        name = f' name="b{inner}"'
        if element.attributes.get("mocap", "false") == "true":
            raise InputError(f"{place(element)}: mocap bodies are not supported. Remove it.")
        if "gravcomp" in element.attributes:
            mjcf.notes.add("body", mjcf.bodies[inner].name, "gravcomp ignored, gravity acts on all of it")
    if "childclass" in element.attributes:
        childclass = _class(mjcf, element, "childclass")
        name += f' childclass="{mjcf.classes[childclass]}"'
    mjcf.text.append(f"<{element.tag}{name}{clean_attributes(element)}>")
    _children(mjcf, element, inner, childclass)
    mjcf.text.append(f"</{element.tag}>")


def _body(mjcf: Mjcf, element: Element, parent: int, name: str) -> MjcfBody:
    above, inside = mjcf.bodies[parent], _inside(element, {"frame"})
    moves = above.moves or any(child.tag in ("joint", "freejoint") for child in inside)
    weighs = moves or above.weighs
    if parent == WORLD_BODY:
        weighs = weighs or any(child.tag == "joint" for child in _inside(element, {"frame", "body"}))
    inertials = [child for child in inside if child.tag == "inertial"]
    if len(inertials) > 1:
        raise InputError(f"{place(element)}: <inertial> is given {len(inertials)} times. Keep one.")
    from_geoms = mjcf.from_geoms == "true" or (mjcf.from_geoms == "auto" and not inertials)
    return MjcfBody(name, parent, moves, weighs, weighs and from_geoms)


def _inside(element: Element, through: set[str]) -> list[Element]:
    """The elements in a body; MuJoCo allows most of them inside frames too."""
    inside = list(element.children)
    for child in inside:  # grows while it is walked
        inside += child.children if child.tag in through else []
    return inside


def _joint(mjcf: Mjcf, element: Element, body: int) -> None:
    if body == WORLD_BODY:
        raise InputError(f"{place(element)}: the world has no joints. Put it into a body.")
    number = len(mjcf.joints)
    _refuse_more("joints", number)
    mjcf.joints.append(_own_name(element, f"(joint {number + 1})"))
    mjcf.bodies[body].joints.append(number)
    mjcf.text.append(f'<joint name="j{number}"{_class_text(mjcf, element)}{clean_attributes(element)}/>')


def _site(mjcf: Mjcf, element: Element, body: int) -> None:
    if "name" in element.attributes:
        number = len(mjcf.sites)
        _refuse_more("named sites", number)
        _remember(mjcf.sites, element, body)
        mjcf.text.append(f'<site name="s{number}"{_class_text(mjcf, element)}{clean_attributes(element)}/>')


def _geom(mjcf: Mjcf, element: Element, body: int, childclass: str) -> None:
    """A geom that gives its body mass: a solid, or nothing that weighs."""
    own = _class(mjcf, element, "class") if "class" in element.attributes else childclass
    looks = mjcf.geom_defaults[own] | element.attributes
    if looks.get("type", "sphere") not in SOLIDS or "mesh" in looks:
        if looks.get("mass", looks.get("density", "")).strip() in ZERO:  # a mass overrides a density
            return
        if not mjcf.bodies[body].moves:
            mjcf.remark(body, "takes mass from a mesh, which is not read: not counted, so give it in [base.body]")
            return
        raise InputError(
            f"{place(element)}: body {shown(mjcf.bodies[body].name)} takes its mass from a mesh, and meshes are not "
            "read. Give the body an <inertial>."
        )
    number = len(mjcf.weighed)
    _refuse_more("geoms that weigh something", number, MOST_GEOMS)
    mjcf.weighed.append(body)
    mjcf.text.append(f'<geom name="g{number}"{_class_text(mjcf, element)}{clean_attributes(element)}/>')


def _inertial(mjcf: Mjcf, element: Element, body: int) -> None:
    """The body's own numbers, and a stand-in from which MuJoCo finds the inertial frame: it refuses what is odd."""
    if body == WORLD_BODY:
        raise InputError(f"{place(element)}: the world has no inertial. Put it into a body.")
    whose = mjcf.bodies[body]
    where = f"body {shown(whose.name)}"
    mass = number(element, "mass")
    moments: Numbers = (0.0,) * 6
    full, diagonal = (key in element.attributes for key in ("fullinertia", "diaginertia"))
    if full:
        moments = numbers(element, "fullinertia", 6)
    elif diagonal:
        moments = (*numbers(element, "diaginertia", 3), 0.0, 0.0, 0.0)
    inertia = tensor(*moments)
    refuse_negative(where, mass, inertia)
    mass, inertia, balanced = as_compiled(
        mass, inertia, least_mass=mjcf.least_mass, least_moment=mjcf.least_moment, balance=mjcf.balance
    )
    remark = judge_inertia(where, mass, inertia)
    if balanced:
        remark = "principal moments of inertia averaged, as the file's balanceinertia asks"
    if remark and not whose.from_geoms:
        mjcf.remark(body, remark)
    if whose.weighs:
        clean_attributes(element)
        given = element.attributes if full else {"diaginertia": "", **element.attributes}
        stand_in = {key: STAND_IN.get(key, value) for key, value in given.items()}
        mjcf.text.append(f"<inertial{clean_attributes(replace(element, attributes=stand_in))}/>")
        whose.own = None if whose.from_geoms else (mass, inertia)


def _refuse_more(what: str, count: int, most: int = MOST) -> None:
    if count >= most:
        raise InputError(f"more than {most} {what}, which is beyond what flexbase reads. Cut the file down.")


def _own_name(element: Element, made_up: str) -> str:
    return name_of(element) if "name" in element.attributes else made_up


def _remember(names: dict[str, int], element: Element, body: int) -> None:
    if "name" not in element.attributes:
        return
    name = name_of(element)
    if name in names:
        raise InputError(f"{place(element)}: the name is given twice. Rename one.")
    names[name] = body


def _class(mjcf: Mjcf, element: Element, key: str) -> str:
    name = element.attributes[key]
    if name not in mjcf.geom_defaults:
        raise InputError(f"{place(element)}: {key} {shown(name[:LONGEST_NAME])} does not exist. Correct it.")
    return name


def _class_text(mjcf: Mjcf, element: Element) -> str:
    return f' class="{mjcf.classes[_class(mjcf, element, "class")]}"' if "class" in element.attributes else ""

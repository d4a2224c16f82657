"""The words of MJCF that say where bodies are, how they move and what they weigh; and those that say nothing of it.

What is in neither list is refused by name: a word that a newer MuJoCo adds could matter.
"""

from __future__ import annotations

from typing import NamedTuple


class Count(NamedTuple):
    """How many numbers an attribute holds."""

    least: int
    most: int


Words = frozenset[str]
Kind = Count | Words

ONE, TWO, THREE, FOUR, SIX = (Count(size, size) for size in (1, 2, 3, 4, 6))
BOOLEAN = frozenset({"true", "false"})
ONE_TO_THREE = Count(1, 3)
SOLIDS = frozenset({"sphere", "capsule", "ellipsoid", "cylinder", "box"})
SHAPES = frozenset({"mesh", "plane", "hfield", "sdf"})  # what they weigh is not in the file
EULER_SEQUENCES = frozenset(a + b + c for a in "xyzXYZ" for b in "xyzXYZ" for c in "xyzXYZ")

PLACED: dict[str, Kind] = {
    "pos": THREE,
    "quat": FOUR,
    "axisangle": FOUR,
    "xyaxes": SIX,
    "zaxis": THREE,
    "euler": THREE,
}

KEPT: dict[str, dict[str, Kind]] = {
    "compiler": {
        "angle": frozenset({"degree", "radian"}),
        "eulerseq": EULER_SEQUENCES,
        "autolimits": BOOLEAN,
        "inertiafromgeom": BOOLEAN | {"auto"},
        "inertiagrouprange": TWO,
        "boundmass": ONE,
        "boundinertia": ONE,
        "balanceinertia": BOOLEAN,
    },
    "body": PLACED,
    "frame": PLACED,
    "inertial": {**PLACED, "mass": ONE, "diaginertia": THREE, "fullinertia": SIX},
    "joint": {
        "type": frozenset({"hinge", "slide"}),
        "pos": THREE,
        "axis": THREE,
        "range": TWO,
        "limited": BOOLEAN | {"auto"},
        "ref": ONE,
        "springref": ONE,
        "springdamper": TWO,
        "stiffness": ONE,
        "damping": ONE,
        "armature": ONE,
        "frictionloss": ONE,
    },
    "geom": {
        **PLACED,
        "type": SOLIDS,
        "size": ONE_TO_THREE,
        "fromto": SIX,
        "mass": ONE,
        "density": ONE,
        "shellinertia": BOOLEAN,
        "group": ONE,
    },
    "site": {**PLACED, "type": SOLIDS, "size": ONE_TO_THREE, "fromto": SIX},
}
DIRECTIONS = {"quat", "axisangle", "xyaxes", "zaxis", "axis"}  # zero means nothing
INTEGERS = {"group", "inertiagrouprange"}


def _words(text: str) -> Words:
    return frozenset(text.split())


IGNORED: dict[str, Words] = {
    "compiler": _words(
        "alignfree assetdir meshdir texturedir strippath discardvisual fitaabb fusestatic usethread convexhull "
        "exactmeshinertia saveinertial savecompiled savecanonical conflict passthrough"
    ),
    "body": _words("name childclass gravcomp sleep user simple fuse"),
    "frame": _words("name childclass"),
    "inertial": frozenset(),
    "joint": _words(
        "name class group margin user actuatorfrclimited actuatorfrcrange actuatorgravcomp "
        "solimpfriction solimplimit solreffriction solreflimit springyield"
    ),
    "geom": _words(
        "name class mesh hfield material rgba contype conaffinity condim priority friction solmix solref solimp margin "
        "gap fitscale fluidshape fluidcoef user castshadow adhesion surfacevel"
    ),
    "site": _words("name class group material rgba user mesh"),
}

SECTIONS_READ = _words("compiler default worldbody tendon equality actuator")
SECTIONS_IGNORED = _words("option size statistic visual asset contact sensor keyframe custom extension")
IN_BODY = _words("body frame inertial joint geom site")
IN_BODY_IGNORED = _words("camera light")

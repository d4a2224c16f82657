"""Hostile robot files: sound ones with bytes or elements changed, and documents grown from the grammar's own words."""

from __future__ import annotations

import random
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

from hypothesis import strategies as st

DATA = Path(__file__).parent / "data"
SEEDS = [path.read_bytes() for path in sorted(DATA.iterdir()) if path.suffix in (".urdf", ".xml")]


def words(text: str) -> list[str]:
    """The words of a text."""
    return text.split()


NUMBERS = words("0 1 -1 0.5 nan NaN inf -inf 1e400 -1e400 1e308 1e9 1e-320 0x10 7kg 1_0 1,5 ${pi} ١ 1e 1e99999999999")
WORDS = [
    *words("revolute continuous prismatic fixed floating planar hinge slide ball free mesh box sphere capsule plane"),
    *words("true false auto radian degree xyz world tool tip elbow main big"),
    "",
    " ",
    "a" * 5000,
    "\u202e\u009b[31m",
    "[bold]<&>",
    "%s%n{}",
    "../../outside",
    "7 kg",
    "0 0 0",
    "1 2 3",
    "1 0 0 0",
    "1 1 1 2 2 2",
    "0 0 0 0",
]
KEYS = words(
    "name class childclass type value xyz rpy link joint joint1 joint2 body1 body2 site1 mass diaginertia fullinertia "
    "pos quat euler axisangle zaxis xyaxes axis ref range limited armature damping stiffness springref springdamper "
    "size fromto density group file mesh ixx iyy izz ixy lower upper angle eulerseq inertiafromgeom balanceinertia "
    "boundmass boundinertia settotalmass multiplier offset mocap active coef user kp gainprm plugin viscosity wind"
)
TAGS = words(
    "robot link joint inertial mass inertia origin axis parent child limit dynamics mimic visual mujoco worldbody body "
    "frame geom site freejoint default compiler equality weld connect tendon fixed spatial include plugin composite "
    "flexcomp replicate attach asset extension actuator option position general instance"
)
SNIPPETS = [
    b"<!DOCTYPE r [<!ENTITY a 'x'><!ENTITY b '&a;&a;&a;'>]>",
    b"<!DOCTYPE r SYSTEM 'file:///outside'>",
    b"&a;",
    b"&#0;",
    b"&#x9b;",
    b"<![CDATA[",
    b"]]>",
    b"<!--",
    b"-->",
    b"<?xml version='1.0' encoding='latin-1'?>",
    b"<?xml version='1.0' encoding='utf-7'?>",
    b"<xi:include href='/outside'/>",
    b"<xacro:macro/>",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\x00",
    b"\xe9",
    b"<body>" * 200,
    b"<link name='x'/>" * 600,
    b'"',
    b">",
    b"/>",
]


def mutated_bytes(chance: random.Random) -> bytes:
    """A sound file after one to four accidents with its bytes."""
    text = bytearray(chance.choice(SEEDS))
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(text) + 1)
        end = min(len(text), at + chance.choice([1, 1, 2, 10, 100, 1000]))
        match chance.randrange(6):
            case 0:
                text[at:at] = chance.choice(SNIPPETS)
            case 1:
                del text[at:end]
            case 2:
                text[at:at] = text[at:end]
            case 3 if at < len(text):
                text[at] = chance.randrange(256)
            case 4:
                text[at:end] = chance.choice(NUMBERS).encode()
            case _:
                other = chance.choice(SEEDS)
                start = chance.randrange(len(other))
                text[at:end] = other[start : start + chance.choice([5, 50, 500])]
    encoding = chance.choice(["keep"] * 20 + ["utf-16", "latin-1"])
    return bytes(text) if encoding == "keep" else text.decode("utf-8", "ignore").encode(encoding, "ignore")


def mutated_tree(chance: random.Random) -> bytes:
    """A sound file after one to three changes that keep it well-formed."""
    root = ET.fromstring(chance.choice(SEEDS))
    for _ in range(chance.randint(1, 3)):
        parents = [element for element in root.iter() if len(element)]
        parent = chance.choice(parents) if parents else root
        element = chance.choice(list(root.iter()))
        match chance.randrange(9):
            case 0 | 1 | 2 if element.attrib:
                key = chance.choice(sorted(element.attrib))
                element.set(key, _value(chance, element.get(key, "")))
            case 3 if element.attrib:
                del element.attrib[chance.choice(sorted(element.attrib))]
            case 4:
                element.set(chance.choice(KEYS), _value(chance, "1"))
            case 5 if len(parent):
                parent.remove(chance.choice(list(parent)))
            case 6 if len(parent):
                parent.append(ET.fromstring(ET.tostring(chance.choice(list(parent)))))
            case 7:
                child = ET.SubElement(element, chance.choice(TAGS))
                child.set(chance.choice(KEYS), _value(chance, "1"))
            case _:
                element.tag = chance.choice(TAGS)
    return ET.tostring(root)


def _value(chance: random.Random, old: str) -> str:
    parts = old.split() or ["1"]
    match chance.randrange(4):
        case 0:
            return chance.choice(WORDS)
        case 1:
            parts[chance.randrange(len(parts))] = chance.choice(NUMBERS)
        case 2:
            parts = [repr(chance.choice([-1.0, 1.0]) * 10.0 ** chance.uniform(-12.0, 10.0)) for _ in parts]
        case _:
            parts.append(chance.choice(NUMBERS))
    return " ".join(parts)


def hostile_files(seed: int) -> Iterator[bytes]:
    """An endless mixture of both, the same for the same seed."""
    chance = random.Random(seed)
    while True:
        yield (mutated_bytes if chance.random() < 0.4 else mutated_tree)(chance)


def documents() -> st.SearchStrategy[bytes]:
    """Small robots grown by hypothesis: mostly near a sound one, with any tree of links and any numbers."""
    sane = st.one_of(st.floats(-10.0, 10.0).map(repr), st.integers(-3, 3).map(str))
    odd = st.one_of(st.floats().map(repr), st.sampled_from(NUMBERS))
    number = st.integers(0, 19).flatmap(lambda dice: odd if dice == 7 else sane)
    triple = st.lists(number, min_size=3, max_size=3).map(" ".join)
    link_name = st.sampled_from("abcdef")
    link = st.builds(
        '<link name="{}"><inertial><origin xyz="{}" rpy="{}"/><mass value="{}"/>'
        '<inertia ixx="{}" iyy="{}" izz="{}" ixy="0" ixz="0" iyz="{}"/></inertial></link>'.format,
        *(link_name, triple, triple, number, number, number, number, number),
    )
    kind = st.sampled_from(["revolute", "continuous", "prismatic", "fixed", "floating"])
    joint = st.builds(
        '<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/><axis xyz="{}"/></joint>'.format,
        *(st.sampled_from("uvwxyz"), kind, link_name, link_name, triple),
    )
    urdf = st.builds(
        lambda links, joints: f"<robot>{''.join(links)}{''.join(joints)}</robot>",
        st.lists(link, max_size=6),
        st.lists(joint, max_size=5),
    )
    hinge = st.builds(
        '<joint type="{}" axis="{}" pos="{}" ref="{}" armature="{}"/>'.format,
        *(st.sampled_from(["hinge", "slide", "ball"]), triple, triple, number, number),
    )
    solid = st.builds(
        '<geom type="{}" size="{}" mass="{}"/>'.format, st.sampled_from(["box", "sphere", "mesh"]), triple, number
    )
    inertial = st.builds('<inertial pos="{}" mass="{}" diaginertia="{}"/>'.format, triple, number, triple)
    leaf = st.one_of(hinge, solid, inertial)
    body = st.recursive(
        leaf,
        lambda inner: st.lists(inner, max_size=4).map(lambda parts: f"<body>{''.join(parts)}</body>"),
        max_leaves=9,
    )
    mjcf = body.map(lambda inside: f"<mujoco><worldbody><body>{inside}</body></worldbody></mujoco>")
    return st.one_of(urdf, mjcf).map(str.encode)

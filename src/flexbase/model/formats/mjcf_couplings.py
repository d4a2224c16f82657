"""Equalities and tendons of an MJCF: refused where they tie the chain to the tool, noted where they tie the rest."""

from __future__ import annotations

from collections.abc import Iterable

from flexbase.errors import InputError
from flexbase.model.formats.fields import name_of
from flexbase.model.formats.guard import Element, place, shown
from flexbase.model.formats.mjcf import WORLD_BODY, Mjcf
from flexbase.model.formats.notes import Notes

ENDS = {
    "connect": ("body1", "body2", "site1", "site2"),
    "weld": ("body1", "body2", "site1", "site2"),
    "joint": ("joint1", "joint2"),
    "tendon": ("tendon1", "tendon2"),
}
Known = dict[str, dict[str, int]]
WRAPS = {"site": "site", "geom": "geom", "joint": "joint", "pulley": ""}


def check_couplings(mjcf: Mjcf, root: Element, tool_body: int) -> list[str]:
    """Notes on couplings that the chain to the tool does not feel. Raises InputError on those that it does."""
    chain = set(mjcf.ancestors(tool_body))
    known = _known(mjcf)
    ties: dict[str, set[int]] = {}
    notes = Notes()
    for tendon in _each(root, "tendon"):
        if tendon.tag not in ("spatial", "fixed"):
            raise InputError(f"{place(tendon)}: not a tendon that flexbase knows. Remove it.")
        tied = _tied(mjcf, known, chain, ((wrap, WRAPS.get(wrap.tag, wrap.tag)) for wrap in tendon.children))
        if "name" in tendon.attributes:
            ties[name_of(tendon)] = tied
        _judge(tendon, tied, notes)
    for equality in _each(root, "equality"):
        if equality.tag not in ENDS:
            raise InputError(f"{place(equality)}: not an equality that flexbase knows. Remove it.")
        if equality.attributes.get("active") == "false":
            continue
        given = [key for key in ENDS[equality.tag] if key in equality.attributes]
        if equality.tag == "tendon":
            tied = set().union(*(_tendon(ties, equality, key) for key in given))
        else:
            tied = _tied(mjcf, known, chain, ((equality, key) for key in given))
            if given == ["body1"]:
                tied.add(WORLD_BODY)
        _judge(equality, tied, notes)
    return notes.lines()


def _each(root: Element, section: str) -> list[Element]:
    return [child for found in root.all(section) for child in found.children]


def _judge(element: Element, tied: set[int], notes: Notes) -> None:
    """A note, or InputError where the tie runs between parts that the chain's joints move against each other."""
    if len(tied) > 1:
        raise InputError(
            f"{place(element)}: it ties the chain to the tool, and coupled joints are not supported. Remove it, or "
            "choose another tool."
        )
    name = name_of(element) if "name" in element.attributes else f"<{element.tag}>"
    notes.add("coupling", name, "ignored, because it ties only what is locked")


def _tied(mjcf: Mjcf, known: Known, chain: set[int], ends: Iterable[tuple[Element, str]]) -> set[int]:
    """The bodies of the chain (or the world) with which each end moves. A joint of the chain moves two of them."""
    tied = set()
    for element, key in ends:
        if key == "":
            continue
        name, names = name_of(element, key), known.get(key.rstrip("12"), {})
        if name not in names:
            raise InputError(f"{place(element)}: {shown(key)[1:-1]} {shown(name)} does not exist. Correct it.")
        body = names[name]
        if not key.startswith("joint"):
            tied.add(_carrier(mjcf, chain, body))
        elif body in chain:
            tied |= {_carrier(mjcf, chain, body), _carrier(mjcf, chain, mjcf.bodies[body].parent)}
    return tied


def _known(mjcf: Mjcf) -> Known:
    """Body numbers by what can be tied and its name."""
    numbered = list(enumerate(mjcf.bodies))
    return {
        "body": {body.name: number for number, body in numbered},
        "joint": {mjcf.joints[joint]: number for number, body in numbered for joint in body.joints},
        "site": mjcf.sites,
        "geom": mjcf.geoms,
    }


def _carrier(mjcf: Mjcf, chain: set[int], body: int) -> int:
    """The last body of the chain, at or above this one, that a joint moves."""
    while body != WORLD_BODY and not (body in chain and mjcf.bodies[body].joints):
        body = mjcf.bodies[body].parent
    return body


def _tendon(ties: dict[str, set[int]], equality: Element, key: str) -> set[int]:
    name = name_of(equality, key)
    if name not in ties:
        raise InputError(f"{place(equality)}: {key} {shown(name)} does not exist. Correct it.")
    return ties[name]

"""The attributes of an MJCF element that matter, checked, as text."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

from flexbase.errors import InputError
from flexbase.model.formats.fields import numbers, word
from flexbase.model.formats.guard import Element, listed, place
from flexbase.model.formats.mjcf_words import DIRECTIONS, IGNORED, INTEGERS, KEPT, SHAPES, Count


def clean_attributes(element: Element) -> str:
    """The attributes that matter, checked, as text. Raises InputError on one that is not known."""
    kept = KEPT[element.tag]
    if element.tag == "joint" and element.attributes.get("type") in ("ball", "free"):
        raise InputError(f"{place(element)}: ball and free joints are not supported. Use hinge and slide joints.")
    unknown = [key for key in element.attributes if key not in kept and key not in IGNORED[element.tag]]
    if unknown:
        raise InputError(f"{place(element)}: attribute {listed(unknown[:1])} is not known. Remove it.")
    return "".join(f" {key}={quoteattr(_value(element, key))}" for key in element.attributes if key in kept)


def _value(element: Element, key: str) -> str:
    kind = KEPT[element.tag][key]
    if not isinstance(kind, Count):
        if element.tag == "geom" and key == "type" and element.attributes[key] in SHAPES:
            return "sphere"  # a default class of geoms that are left out
        return word(element, key, kind)
    values = numbers(element, key, *kind)
    if key in DIRECTIONS and not any(abs(value) > 1e-6 for value in (values[:3] if key == "axisangle" else values)):
        raise InputError(f"{place(element)}: {key} is zero, so it has no direction. Give a nonzero one.")
    if key in INTEGERS:
        if any(value != int(value) for value in values):
            raise InputError(f"{place(element)}: {key} must be whole numbers. Correct it.")
        return " ".join(str(int(value)) for value in values)
    return " ".join(map(repr, values))

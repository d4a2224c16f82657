"""Bytes that nobody has vouched for -> a small tree of XML elements, in bounded time and memory.

The standard library's expat is driven directly, because nothing above it can do all of this: refuse a DOCTYPE (and with
it every entity and external inclusion) and count elements, depth and attributes while reading rather than afterwards;
leave prefixes alone, so that the public UR5e file with its undeclared `drake:` is read like any other. defusedxml
covers the first half only. Text between the tags means nothing in a robot file and is never stored.
"""

from __future__ import annotations

import os
import stat
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from flexbase.errors import InputError

LARGEST_FILE = 2_000_000  # bytes; the largest of 400 public robots has 0.2 MB
MOST_ELEMENTS = 20_000
MOST_ATTRIBUTES = 64  # of one element
DEEPEST = 100  # levels; bodies nest in MJCF
LONGEST_NAME = 200  # characters
SHOWN = 40  # characters of a name that a message repeats

ENCODINGS = {"utf-8", "utf8", "utf-16", "us-ascii", "ascii", "iso-8859-1", "latin-1", "latin1", "windows-1252"}


@dataclass(frozen=True, eq=False)
class Element:
    """A tag, its attributes, its children, the line it starts on, and the name of the nearest named one around it."""

    tag: str
    attributes: dict[str, str]
    line: int
    owner: str = ""
    children: list[Element] = field(default_factory=list)

    def all(self, tag: str) -> list[Element]:
        """The children with a tag."""
        return [child for child in self.children if child.tag == tag]

    def one(self, tag: str) -> Element | None:
        """The child with a tag, or None. Raises InputError where there are several."""
        found = self.all(tag)
        if len(found) > 1:
            raise InputError(f"{place(self)}: <{tag}> is given {len(found)} times. Keep one.")
        return found[0] if found else None


def shown(name: str) -> str:
    """A name from a file as a message may repeat it: printable, cut, in quotes."""
    cut = name if len(name) <= SHOWN else name[: SHOWN - 3] + "..."
    return '"' + "".join(letter if letter.isprintable() else "?" for letter in cut) + '"'


def listed(names: list[str], most: int = 8) -> str:
    """Some names for a message, the rest counted."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(map(shown, names[:most])) + more


def place(element: Element) -> str:
    """'line 12, <joint> "elbow"' or 'line 14, <mass> of "arm"', for messages."""
    name = element.attributes.get("name", "")
    whose = f" {shown(name)}" if name else f" of {shown(element.owner)}" if element.owner else ""
    return f"line {element.line}, <{shown(element.tag)[1:-1]}>{whose}"


def read_bytes(path: Path, folder: Path) -> bytes:
    """The content of a regular file inside a folder. Raises InputError; says nothing about files outside it."""
    try:
        home = folder.resolve(strict=True)
        inside = path if path.is_absolute() else home / path
        target = inside.resolve()
    except (OSError, RuntimeError, ValueError) as fault:
        raise InputError("the path leads nowhere. Give a file in the folder of the project.") from fault
    if not target.is_relative_to(home):
        raise InputError("the path leaves the folder of the project. Copy the file into it.")
    flags = os.O_RDONLY | sum(getattr(os, flag, 0) for flag in ("O_NOFOLLOW", "O_NONBLOCK", "O_CLOEXEC", "O_BINARY"))
    try:
        descriptor = os.open(target, flags)
        with open(descriptor, "rb") as stream:
            if not stat.S_ISREG(os.fstat(descriptor).st_mode):
                raise InputError("is not a file. Give a robot file (.urdf, or .xml for MJCF).")
            content = stream.read(LARGEST_FILE + 1)
    except FileNotFoundError as fault:
        raise InputError("no such file. Give a robot file in the folder of the project.") from fault
    except (OSError, ValueError) as fault:
        raise InputError("cannot be read. Give a readable robot file (.urdf, or .xml for MJCF).") from fault
    if len(content) > LARGEST_FILE:
        raise InputError(f"larger than {LARGEST_FILE} bytes, which no robot file is. Take the meshes out of it.")
    return content


def parse(content: bytes) -> Element:
    """The root element of an XML document. Raises InputError without repeating any of the document."""
    reader = _Reader()
    try:
        reader.parser.Parse(content, True)
    except expat.ExpatError as fault:
        reason = expat.ErrorString(fault.code) or "not well-formed"
        raise InputError(f"not valid XML: {reason}, line {fault.lineno}.") from fault
    except (UnicodeError, LookupError, ValueError) as fault:
        raise InputError("not readable as text in the encoding it declares. Save it as UTF-8.") from fault
    if reader.root is None:
        raise InputError("not valid XML: no element in it.")
    return reader.root


class _Reader:
    """Expat's events, counted, as elements."""

    def __init__(self) -> None:
        self.root: Element | None = None
        self.open: list[Element] = []
        self.count = 0
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.XmlDeclHandler = self._declaration
        self.parser.StartDoctypeDeclHandler = self._doctype
        self.parser.EntityDeclHandler = self._doctype
        self.parser.ExternalEntityRefHandler = self._doctype

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self.count += 1
        line = self.parser.CurrentLineNumber
        if self.count > MOST_ELEMENTS:
            raise InputError(f"more than {MOST_ELEMENTS} elements, which no robot needs. Cut the file down.")
        if len(self.open) >= DEEPEST:
            raise InputError(f"line {line}: more than {DEEPEST} elements inside each other. Flatten the file.")
        if len(attributes) > MOST_ATTRIBUTES:
            raise InputError(f"line {line}: an element with more than {MOST_ATTRIBUTES} attributes. Remove some.")
        around = self.open[-1] if self.open else None
        owner = (around.attributes.get("name") or around.owner) if around else ""
        element = Element(tag, attributes, line, owner)
        prefix, _, local = tag.rpartition(":")
        if prefix == "xacro":
            raise InputError(f"line {line}: an unexpanded xacro element. Run the file through xacro first.")
        if local == "include":
            raise InputError(f"line {line}: the file includes another file. Merge them into one.")
        if around:
            around.children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def _end(self, tag: str) -> None:
        self.open.pop()

    def _declaration(self, version: str, encoding: str | None, standalone: int) -> None:
        if encoding is not None and encoding.lower() not in ENCODINGS:
            raise InputError("line 1: a declared encoding that is not supported. Save the file as UTF-8.")

    def _doctype(self, *_: object) -> int:
        line = self.parser.CurrentLineNumber
        raise InputError(f"line {line}: a DOCTYPE or an entity, which robot files do not need. Remove it.")

"""Files that nobody vouches for: where they may lie, how large they may be, what XML they may hold."""

from __future__ import annotations

import os
import sys
import time

import pytest

from flexbase.errors import InputError, MissingExtra
from flexbase.model.formats.guard import DEEPEST, LARGEST_FILE, MOST_ELEMENTS, parse
from flexbase.model.formats.robot import read_robot_file

from .conftest import DATA

PLAIN = (DATA / "plain.urdf").read_bytes()
SECRET = "the-secret-of-another-folder"


def refusal(folder, content: bytes, tool: str | None = "tool") -> str:
    """The message with which a file is refused: a line, without anything of this machine."""
    (folder / "robot.urdf").write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_robot_file(folder / "robot.urdf", tool, folder=folder)
    message = str(caught.value)
    assert message.startswith("robot.urdf: ")
    assert message.isprintable()
    assert len(message) < 400
    assert str(folder) not in message
    return message


@pytest.fixture
def project(tmp_path):
    """A project's folder, and beside it one that is none of its business."""
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside" / "robot.urdf").write_bytes(PLAIN.replace(b"plain", SECRET.encode()))
    (tmp_path / "project").mkdir()
    return tmp_path / "project"


@pytest.mark.parametrize("way", ["dots", "absolute", "link", "linked folder"])
def test_a_path_that_leaves_the_folder_is_refused(project, way):
    outside = project.parent / "outside"
    (project / "link.urdf").symlink_to(outside / "robot.urdf")
    (project / "linked").symlink_to(outside)
    path = {
        "dots": project / ".." / "outside" / "robot.urdf",
        "absolute": outside / "robot.urdf",
        "link": project / "link.urdf",
        "linked folder": project / "linked" / "robot.urdf",
    }[way]
    with pytest.raises(InputError, match="leaves the folder") as caught:
        read_robot_file(path, None, folder=project)
    assert SECRET not in str(caught.value)
    assert str(project.parent) not in str(caught.value)


def test_a_link_inside_the_folder_is_followed(project):
    (project / "robot.urdf").write_bytes(PLAIN)
    (project / "link.urdf").symlink_to("robot.urdf")
    assert read_robot_file(project / "link.urdf", None, folder=project).mechanism.N == 1


@pytest.mark.parametrize("what", ["missing", "folder", "pipe", "loop", "nul", "too large"])
def test_what_is_not_a_readable_file_is_refused_at_once(project, what):
    path = project / ("a\0b" if what == "nul" else "robot.urdf")
    if what == "folder":
        path.mkdir()
    elif what == "pipe":
        os.mkfifo(path)
    elif what == "loop":
        path.symlink_to(path)
    elif what == "too large":
        path.write_bytes(PLAIN + b" " * LARGEST_FILE)
    start = time.monotonic()
    with pytest.raises(InputError) as caught:
        read_robot_file(path, None, folder=project)
    assert time.monotonic() - start < 2.0
    assert str(project) not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "words"),
    {
        "empty": (b"", "not valid XML"),
        "no XML": (SECRET.encode(), "not valid XML"),
        "cut off": (PLAIN[:300], "not valid XML"),
        "binary": (bytes(range(256)) * 40, "not valid XML"),
        "DOCTYPE": (b"<!DOCTYPE robot>" + PLAIN, "DOCTYPE"),
        "entities": (b"<!DOCTYPE r [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;&a;'>]><robot>&b;</robot>", "DOCTYPE"),
        "external": (b"<!DOCTYPE r [<!ENTITY a SYSTEM '../outside/robot.urdf'>]><robot>&a;</robot>", "DOCTYPE"),
        "undefined entity": (b"<robot>&a;</robot>", "not valid XML"),
        "inclusion": (b"<robot><xi:include href='../outside/robot.urdf'/></robot>", "includes another file"),
        "MJCF inclusion": (b"<mujoco><include file='../outside/robot.xml'/></mujoco>", "includes another file"),
        "xacro": (b"<robot><xacro:macro name='m'/></robot>", "xacro"),
        "deep": (b"<robot>" * (DEEPEST + 1) + b"</robot>" * (DEEPEST + 1), "inside each other"),
        "many": (b"<robot>" + b"<a/>" * MOST_ELEMENTS + b"</robot>", "elements"),
        "attributes": (
            b"<robot " + b" ".join(b'a%d="1"' % number for number in range(100)) + b"/>",
            "attributes",
        ),
        "encoding": (b'<?xml version="1.0" encoding="utf-7"?><robot/>', "encoding"),
        "unknown encoding": (b'<?xml version="1.0" encoding="x-y-z"?><robot/>', "encoding"),
        "not in its encoding": (b"<robot name='\xe9'/>", "not valid XML"),
        "another format": (b"<sdf version='1.9'/>", "neither URDF"),
    }.values(),
)
def test_dangerous_or_broken_xml_is_refused(project, content, words):
    message = refusal(project, content)
    assert words in message
    assert SECRET not in message


def test_the_largest_nesting_takes_a_moment_only():
    """Bounded time and memory: as many elements as a file may hold."""
    start = time.monotonic()
    with pytest.raises(InputError):
        parse(b"<a>" + b"<b/>" * (LARGEST_FILE // 4) + b"</a>")
    assert time.monotonic() - start < 2.0


@pytest.mark.parametrize(
    "content",
    {
        "byte order mark": b"\xef\xbb\xbf" + PLAIN,
        "CRLF": PLAIN.replace(b"\n", b"\r\n"),
        "Latin-1": b'<?xml version="1.0" encoding="ISO-8859-1"?>' + PLAIN.replace(b"swing", b"schl\xe4gt"),
        "UTF-16": PLAIN.decode().encode("utf-16"),
        "markup in names": PLAIN.replace(b"swing", b"[red]&lt;b&gt;&amp;swing"),
        "unbound prefix": PLAIN.replace(b"<limit ", b'<limit drake:acceleration="2.5" '),
        "unbound element": PLAIN.replace(b'<link name="base"/>', b'<link name="base"/><drake:joint/>'),
        "comments": PLAIN.replace(b'<link name="base"/>', b'<!-- <include/> --><link name="base"/>'),
    }.values(),
)
def test_harmless_oddities_are_fine(project, content):
    (project / "robot.urdf").write_bytes(content)
    robot = read_robot_file(project / "robot.urdf", None, folder=project)
    assert robot.mechanism.N == 1
    assert robot.mechanism.mass.tolist() == [2.0]


@pytest.mark.parametrize(("name", "package"), [("plain.urdf", "pinocchio"), ("plain.xml", "mujoco")])
def test_a_missing_package_is_named_with_its_extra(monkeypatch, name, package):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(MissingExtra, match=rf'{package}.*"flexbase\[robots\]"'):
        read_robot_file(DATA / name, None, folder=DATA)


@pytest.mark.parametrize("fault", [RecursionError, MemoryError, RuntimeError, UnicodeError, OSError])
def test_whatever_a_parser_throws_becomes_a_message(monkeypatch, fault):
    """Also faults whose text repeats the file."""

    def broken(*_: object) -> None:
        raise fault(SECRET)

    monkeypatch.setattr("pinocchio.buildModelFromXML", broken)
    with pytest.raises(InputError, match=rf"plain\.urdf: .*{fault.__name__}") as caught:
        read_robot_file(DATA / "plain.urdf", None, folder=DATA)
    assert SECRET not in str(caught.value)


def test_names_arrive_whole(project):
    (project / "robot.urdf").write_bytes(PLAIN.replace(b"swing", b"[red]&lt;b&gt;&amp;swing"))
    robot = read_robot_file(project / "robot.urdf", None, folder=project)
    assert robot.mechanism.joint_names == ("[red]<b>&swing",)

"""Project files: what is read, and one plain InputError for everything else.  [issue 2, point 10]"""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import flexbase
from flexbase import FlexbaseWarning, InputError
from flexbase.model.files.bundled import robots
from flexbase.model.files.project import LARGEST_FILE, parse_project
from systems.planar import PAPER, planar_text

TWO_JOINT_BASE = planar_text([0.2, 0.1, 0.3, 0.25], m=2)
NUMBERS = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:e[+-]?\d+)?(?![\w.])")


def swap(old: str, new: str, text: str = PAPER) -> str:
    """The text with one thing changed; a change that changes nothing would test nothing."""
    assert old in text
    return text.replace(old, new, 1)


def refusal(text: str) -> str:
    """The message of the InputError that a text must raise; any other error or a warning fails the test."""
    with pytest.raises(InputError) as fault:
        parse_project(text, "arm.toml")
    message = str(fault.value)
    assert message.startswith("arm.toml"), message
    assert message.count("\n") <= 1, message
    assert "Traceback" not in message
    return message


STIFF, DAMP = "stiffness = [3.0e4]      # N m/rad", "damping = [10.0]         # N m s/rad"
FAULTS = {
    "unknown key": (swap('name = "ueda2003"', 'name = "u"\ncolour = 3'), ["colour", "unknown key"]),
    "misspelt key": (swap(STIFF, "stifness = [3e4]"), ["[base] stifness", 'Did you mean "stiffness"?']),
    "misspelt key in a link": (swap("mass = 20.0", "mas = 20.0"), ["[[robot.links]] number 1", "mas", '"mass"']),
    "unknown table": (swap("[control]", "[contrl]"), ["contrl", "unknown table", 'Did you mean "control"?']),
    "syntax": (swap("mass = 7.0", "mass = = 7.0"), ["not valid TOML", "line 17"]),
    "key given twice": (swap("mass = 7.0", "mass = 7.0\nmass = 7.0"), ["not valid TOML", "line 18"]),
    "string for a list": (swap(STIFF, 'stiffness = "30 kN"'), ["[base] stiffness", "30 kN", "a string"]),
    "string in a list": (swap(STIFF, 'stiffness = ["30 kN"]'), ["[base] stiffness", "30 kN", "not a number"]),
    "string for a number": (swap("mass = 20.0", 'mass = "20 kg"'), ["mass", "20 kg", "a string", "without quotes"]),
    "boolean for a number": (swap("mass = 20.0", "mass = true"), ["mass", "true", "a boolean"]),
    "boolean in a list": (swap(STIFF, "stiffness = [true]"), ["[base] stiffness", "true", "a boolean"]),
    "number for a list": (swap(STIFF, "stiffness = 3e4"), ["[base] stiffness", "30000", "list"]),
    "number for a name": (swap('name = "ueda2003"', "name = 5"), ["name", "5", "string"]),
    "table for a number": (swap("mass = 20.0", "mass = {kg = 20.0}"), ["mass", "a table"]),
    "number for a table": (swap('[task]\nrows = ["x", "y"]\nbranch = "+"', "#"), ["task", "missing"]),
    "nan in a number": (swap("mass = 20.0", "mass = nan"), ["mass", "nan", "not finite"]),
    "nan in a list": (swap(STIFF, "stiffness = [nan]"), ["[base] stiffness", "nan", "not finite"]),
    "inf in a number": (swap("inertia = 0.066", "inertia = inf"), ["inertia", "inf", "not finite"]),
    "inf in a list": (swap(DAMP, "damping = [-inf]"), ["[base] damping", "inf", "not finite"]),
    "zero mass": (swap("mass = 20.0", "mass = 0.0"), ["number 1", "mass", "0 must be above 0"]),
    "negative mass": (swap("mass = 7.0", "mass = -7"), ["number 2", "mass", "-7 must be above 0"]),
    "negative inertia": (swap("inertia = 0.026", "inertia = -0.026"), ["number 3", "inertia", "-0.026"]),
    "negative length": (swap("length = 0.3", "length = -0.3"), ["number 2", "length", "-0.3"]),
    "zero stiffness": (swap(STIFF, "stiffness = [0.0]"), ["[base] stiffness", "0 N/m", "positive number"]),
    "negative stiffness": (swap(STIFF, "stiffness = [-3e4]"), ["[base] stiffness", "-30000", "no equilibrium"]),
    "negative damping": (swap(DAMP, "damping = [-10.0]"), ["[base] damping", "-10", "feed energy", "zero or more"]),
    "asymmetric stiffness": (
        swap("stiffness = [30000.0, 39000.0]", "stiffness = [[3e4, 1e3], [0.0, 3e4]]", TWO_JOINT_BASE),
        ["[base] stiffness", "not symmetric", "(1,2)", "1000"],
    ),
    "indefinite stiffness": (
        swap("stiffness = [30000.0, 39000.0]", "stiffness = [[1e4, 3e4], [3e4, 1e4]]", TWO_JOINT_BASE),
        ["[base] stiffness", "smallest eigenvalue -20000", "positive definite"],
    ),
    "indefinite damping": (
        swap("damping = [10.0, 10.0]", "damping = [[1.0, 3.0], [3.0, 1.0]]", TWO_JOINT_BASE),
        ["[base] damping", "smallest eigenvalue -2", "semidefinite"],
    ),
    "ragged stiffness": (
        swap("stiffness = [30000.0, 39000.0]", "stiffness = [[1e4, 0.0], [3e4]]", TWO_JOINT_BASE),
        ["[base] stiffness", "rows differ in length"],
    ),
    "two stiffnesses for one joint": (
        swap(STIFF, "stiffness = [3e4, 3e4]"),
        ["[base] stiffness", "2 values", "1 need"],
    ),
    "no damping": (swap(DAMP, ""), ["[base] damping", "is missing. Add it"]),
    "two equilibria": (swap("equilibrium = [0.0]", "equilibrium = [0.0, 0.1]"), ["[base] equilibrium", "2 values"]),
    "three gains for two rows": (
        swap("stiffness = [1.0e5, 1.0e5]", "stiffness = [1e5, 1e5, 1e5]"),
        ["[control] stiffness", "3 values", "2 needed"],
    ),
    "negative gain": (swap("[1.5e3, 1.5e3]", "[-1.5e3, 1.5e3]"), ["[control] damping", "-1500"]),
    "three rows for two joints": (
        swap('rows = ["x", "y"]', 'rows = ["x", "y", "rz"]'),
        ["[task] rows", "3 rows but only 2 arm joints"],
    ),
    "a row twice": (swap('rows = ["x", "y"]', 'rows = ["x", "x"]'), ["[task] rows", "twice"]),
    "a row out of the plane": (swap('rows = ["x", "y"]', 'rows = ["x", "z"]'), ["[task] rows", '"z"', "x, y, rz"]),
    "an unknown row": (swap('rows = ["x", "y"]', 'rows = ["x", "w"]'), ["[task] rows", '"w"', "'rz'"]),
    "no rows": (swap('rows = ["x", "y"]', "rows = []"), ["[task] rows"]),
    "unknown branch": (swap('branch = "+"', 'branch = "up"'), ["[task] branch", '"up"']),
    "base joint not first": (swap('joints = ["q1"]', 'joints = ["q2"]'), ["[base] joints", "q2", "first"]),
    "unknown base joint": (swap('joints = ["q1"]', 'joints = ["p1"]'), ["[base] joints", '"p1"', "q1"]),
    "all joints passive": (
        swap('joints = ["q1"]', 'joints = ["q1", "q2", "q3"]'),
        ["[base] joints", "no arm is left"],
    ),
    "duplicate joint names": (swap('joint = "q3"', 'joint = "q2"'), ["joint", '"q2"', "twice", "Rename"]),
    "empty joint name": (swap('joint = "q3"', 'joint = ""'), ["number 3", "joint"]),
    "axis of a revolute joint": (swap("mass = 7.0", "mass = 7.0\naxis = [1.0, 0.0]"), ["number 2", "axis", "Remove"]),
    "axis without direction": (
        swap("mass = 7.0", 'mass = 7.0\ntype = "prismatic"\naxis = [0.0, 0.0]'),
        ["number 2", "axis", "no direction"],
    ),
    "axis of three numbers": (
        swap("mass = 7.0", 'mass = 7.0\ntype = "prismatic"\naxis = [0.0, 0.0, 1.0]'),
        ["number 2", "axis", "2 numbers needed"],
    ),
    "unknown joint type": (swap("mass = 7.0", 'mass = 7.0\ntype = "helical"'), ["number 2", "type", '"helical"']),
    "gravity of two numbers": (swap("[robot]", "gravity = [0.0, -9.81]\n[robot]"), ["gravity", "2 values", "3 needed"]),
    "payload of negative mass": (
        swap("[base]", "[robot.payload]\nmass = -1.0\n[base]"),
        ["[robot.payload] mass", "-1"],
    ),
    "payload of negative inertia": (
        swap("[base]", "[robot.payload]\nmass = 1.0\ninertia = [1.0, -1.0, 1.0]\n[base]"),
        ["[robot.payload] inertia", "-1"],
    ),
    "later schema": (swap("schema_version = 1", "schema_version = 2"), ["schema_version", "2"]),
    "integer beyond doubles": (swap(STIFF, f"stiffness = [{10**400}]"), ["stiffness"]),
    "mass beyond doubles": (swap("mass = 20.0", f"mass = {10**400}"), ["mass"]),
    "integer of 5000 digits": (swap("mass = 20.0", f"mass = {'9' * 5000}"), []),
    "nested a thousand deep": (swap(STIFF, f"stiffness = {'[' * 3000}{']' * 3000}"), []),
    "no links": ('name = "x"\n[robot]\nlinks = []\n[task]\nrows = ["x"]\n', ["[robot] links"]),
    "empty file": ("", ["missing"]),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_answered_in_a_line(fault):
    """The message names the file, the field, the value and the mend, in one or two lines."""
    text, words = FAULTS[fault]
    message = refusal(text)
    for word in words:
        assert word in message, message


def test_the_first_of_several_faults_is_named_and_the_others_counted():
    """Two wrong masses: one is explained, one counted. An unknown key comes first: it explains a missing one."""
    text = swap("mass = 5.0", "mass = -2.0", swap("mass = 20.0", "mass = -1.0"))
    assert "(1 more after this one)" in refusal(text)
    assert "massa" in refusal(swap("mass = 5.0", "massa = 5.0"))


@pytest.mark.parametrize("name", sorted(robots().descriptions))
def test_bundled_robots_load(name):
    """Every bundled project loads without a warning, under its own name, with a description."""
    assert flexbase.load(name).name == name
    assert robots().descriptions[name]


def same(one, other):
    """Two arms hold the same numbers."""
    pairs = [
        (getattr(one.mechanism, field), getattr(other.mechanism, field))
        for field in ("axes", "placement_position", "mass", "com", "inertia", "tool_position")
    ]
    pairs += [(one.base.stiffness, other.base.stiffness), (one.base.damping, other.base.damping)]
    return all(np.array_equal(a, b) for a, b in pairs)


@pytest.mark.parametrize(
    "encode",
    [
        lambda text: b"\xef\xbb\xbf" + text.encode(),
        lambda text: text.replace("\n", "\r\n").encode(),
        lambda text: ("# Müller, 机器人\n" + text).encode(),
    ],
    ids=["byte-order mark", "CRLF", "other alphabets"],
)
def test_a_file_of_any_editor_is_read(tmp_path, paper, encode):
    """A byte-order mark, DOS line ends and comments in any language change nothing."""
    path = tmp_path / "arm.toml"
    path.write_bytes(encode(PAPER))
    assert same(flexbase.load(path).arm, paper.arm)
    assert same(flexbase.load(str(path)).arm, paper.arm)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"\x00\xff\xfe\x01binary", "not UTF-8 text"),
        (b"\x00\x01\x02", "not valid TOML"),
        (b"# " + b"x" * LARGEST_FILE, "larger than"),
        (PAPER.encode("utf-16"), "not UTF-8 text"),
    ],
    ids=["binary", "control characters", "huge", "UTF-16"],
)
def test_a_file_that_is_no_text_is_refused(tmp_path, content, message):
    """Binary, too large, another encoding: refused with the file's name."""
    path = tmp_path / "arm.toml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message) as fault:
        flexbase.load(path)
    assert "arm.toml" in str(fault.value)


def test_a_directory_and_a_missing_file_are_refused(tmp_path):
    """A folder is not a project; a name that is neither bundled nor a file gets the nearest bundled name."""
    with pytest.raises(InputError, match="is not a file"):
        flexbase.load(tmp_path)
    with pytest.raises(InputError, match="neither a bundled robot nor a file"):
        flexbase.load(tmp_path / "nothing.toml")
    with pytest.raises(InputError, match='Did you mean "ueda2003"'):
        flexbase.load("ueda203")


@pytest.mark.parametrize("name", ["", "a\0b", "x" * 5000, "ueda2003/", "~"])
def test_a_name_that_no_system_accepts_is_refused(name):
    """Empty, with a zero byte, too long: names that the operating system itself refuses are still plain InputErrors."""
    with pytest.raises(InputError):
        flexbase.load(name)


def test_a_rigid_base_is_accepted_with_a_warning():
    """No [base]: m = 0, loaded, with one warning that says so."""
    with pytest.warns(FlexbaseWarning, match=r"arm.toml: no \[base\] joints") as caught:
        arm = parse_project(planar_text([0.3, 0.25], m=0), "arm.toml")
    assert arm.m == 0
    assert len(caught) == 1


def test_zero_damping_and_full_matrices_are_legal():
    """Zero damping, and a full symmetric stiffness, load without a warning and arrive as they are."""
    text = swap("stiffness = [30000.0, 39000.0]", "stiffness = [[3e4, 1e3], [1e3, 2e4]]", TWO_JOINT_BASE)
    text = swap("damping = [10.0, 10.0]", "damping = [0.0, 0.0]", text)
    base = parse_project(text, "arm.toml").base
    assert base.stiffness.tolist() == [[3e4, 1e3], [1e3, 2e4]]
    assert not base.damping.any()


def test_optional_fields_take_their_defaults():
    """Without schema_version, equilibrium, branch and gravity: version 1, zero rest, elbow +, no gravity, no gains."""
    text = PAPER
    for line in ("schema_version = 1\n", "equilibrium = [0.0]\n", 'branch = "+"             # 0 < q3 < pi\n'):
        text = swap(line, "", text)
    arm = parse_project(text[: text.index("[control]")], "arm.toml")
    assert arm.base.equilibrium.tolist() == [0.0]
    assert arm.task.branch == "+"
    assert not arm.has_gravity
    assert arm.gains is None


def test_payload_of_six_numbers_is_read_in_order():
    """inertia = xx yy zz xy xz yz about the payload's centre of mass, at the tool, moved to the last link's frame."""
    text = swap(
        "[base]", "[robot.payload]\nmass = 2.0\ncom = [0.0, 0.0, 0.0]\ninertia = [4, 5, 6, 0.1, 0.2, 0.3]\n[base]"
    )
    loaded, bare = parse_project(text, "arm.toml").mechanism, parse_project(PAPER, "arm.toml").mechanism
    at_tool = np.array([[4, 0.1, 0.2], [0.1, 5, 0.3], [0.2, 0.3, 6]])

    def about_the_joint(mechanism):
        c, mass = mechanism.com[2], mechanism.mass[2]
        return mechanism.inertia[2] + mass * (c @ c * np.eye(3) - np.outer(c, c))

    added = about_the_joint(loaded) - about_the_joint(bare)
    shift = 2.0 * 0.25**2 * np.diag([0.0, 1.0, 1.0])
    assert loaded.mass[2] == 7.0
    assert added == pytest.approx(at_tool + shift, abs=1e-12)


def examine(text: str) -> None:
    """Load a text and use it; only InputError and FlexbaseWarning may come out."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", FlexbaseWarning)
        try:
            plant = flexbase.Plant(parse_project(text, "arm.toml"))
            flexbase.modes(plant.at(np.linspace(0.4, 0.9, plant.arm.n)))
            if plant.arm.k == 2:
                plant.at_tip([0.33, -0.25])
        except InputError as fault:
            assert str(fault).count("\n") <= 1  # noqa: PT017


EDITS = st.lists(
    st.tuples(
        st.sampled_from(["delete", "insert", "replace", "cut", "double"]),
        st.integers(0, 10**6),
        st.text(st.characters(min_codepoint=9, max_codepoint=0x2FF), min_size=1, max_size=4)
        | st.sampled_from(
            ["[", "]", "[[", '"', "=", "\n", ".", "-", "e9", "nan", "inf", "true", "{", "}", ",", "0x", "#"]
        ),
    ),
    min_size=1,
    max_size=4,
)


@settings(max_examples=400, suppress_health_check=[HealthCheck.too_slow])
@given(EDITS)
def test_any_slip_of_the_keyboard_gives_an_input_error(edits):
    """Random edits of the bundled text, characters deleted, inserted, replaced, lines cut and doubled.

    Whatever they make of it, loading and using it raises InputError or nothing.
    """
    text = PAPER
    for kind, at, piece in edits:
        place = at % (len(text) + 1)
        lines = text.split("\n")
        if kind == "delete":
            text = text[:place] + text[place + 1 :]
        elif kind == "insert":
            text = text[:place] + piece + text[place:]
        elif kind == "replace":
            text = text[:place] + piece + text[place + 1 :]
        elif kind == "cut":
            del lines[at % len(lines)]
            text = "\n".join(lines)
        else:
            lines.insert(at % len(lines), lines[at % len(lines)])
            text = "\n".join(lines)
    examine(text)


VALUES = st.one_of(
    st.floats(width=64).map(lambda x: repr(x)),
    st.integers(-(10**6), 10**6).map(str),
    st.sampled_from(
        [
            *[
                "0",
                "-1",
                "1e400",
                "-0.0",
                "nan",
                "+inf",
                "true",
                '"30kN"',
                "[]",
                "[[]]",
                "[1,2]",
                "[[1,2],[3]]",
                "{}",
                "{a=1}",
                "1979-05-27",
                "07:32:00",
                "0xff",
                "1_000",
                "''",
                '["x"]',
                "[nan]",
                "[{}]",
                "[[[1]]]",
                "5e-324",
                "1.7e308",
            ],
            str(10**310),
        ]
    ),
)


@settings(max_examples=400, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(st.tuples(st.integers(0, 10**6), VALUES), min_size=1, max_size=3))
@example([(5, "1e308")])
@example([(3, str(10**400))])
def test_any_value_in_any_place_gives_an_input_error(swaps):
    """Numbers of the bundled text swapped for other values of every TOML type and size."""
    text = PAPER
    for at, value in swaps:
        found = list(NUMBERS.finditer(text))
        if not found:
            break
        match = found[at % len(found)]
        text = text[: match.start()] + value + text[match.end() :]
    examine(text)

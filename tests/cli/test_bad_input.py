"""Bad input: one or two lines on stderr, nothing on stdout, exit 2, no traceback."""

from __future__ import annotations

from pathlib import Path

import pytest

from flexbase.model.files.start import template

from .conftest import TIP, Call

AT = ("--tip", TIP)
COMMAND_LINES = {
    "unknown command": (("mods",), ("mods", '"modes"')),
    "unknown option, none near": (("modes", "ueda2003", *AT, "--zzzzzz"), ("--zzzzzz", "flexbase modes --help")),
    "unknown option, one near": (("modes", "ueda2003", "--tpi", TIP), ("--tpi", "--tip")),
    "option before a command": (("--json",), ("--json", "check")),
    "no robot": (("modes",), ("ROBOT", "flexbase modes --help")),
    "no pose": (("modes", "ueda2003"), ("--tip", "--joints")),
    "no pose for design": (("design", "ueda2003"), ("--tip", "--joints")),
    "no pose for ellipsoid": (("manipulability", "ueda2003"), ("--tip", "--joints")),
    "no goal": (("simulate", "ueda2003", "--from", TIP), ("--to",)),
    "no value": (("modes", "ueda2003", "--tip"), ("--tip",)),
    "an option where a value should be": (("modes", "ueda2003", "--tip", "--json"), ("--tip", "--json")),
    "two poses": (("modes", "ueda2003", *AT, "--joints", "1,2"), ("--tip", "--joints")),
    "twice": (("modes", "ueda2003", *AT, *AT), ("--tip",)),
    "a space in the list": (("modes", "ueda2003", "--tip", "0.33", "-0.25"), ("-0.25", "commas")),
    "a word too many": (("modes", "ueda2003", "ueda2003", *AT), ("ueda2003",)),
    "NaN": (("modes", "ueda2003", "--tip", "0.33,nan"), ("--tip", "nan")),
    "infinite": (("modes", "ueda2003", "--joints", "inf,0"), ("--joints", "inf")),
    "no number": (("modes", "ueda2003", "--tip", "0.33,abc"), ("--tip", "abc")),
    "empty entry": (("modes", "ueda2003", "--tip", "0.33,"), ("--tip", "0.33,")),
    "wrong count of tip": (("modes", "ueda2003", "--tip", "0.33"), ("--tip", "1", "2", "x y")),
    "wrong count of joints": (("modes", "ueda2003", "--joints", "1"), ("joints", "2", "3")),
    "elbow": (("modes", "ueda2003", *AT, "--elbow", "up"), ("--elbow", "up")),
    "elbow of joints": (("modes", "ueda2003", "--joints", "1,1", "--elbow", "+"), ("--elbow",)),
    "out of reach": (("check", "ueda2003", "--tip", "3,3"), ("[3.0, 3.0]", "out of reach", "3.554")),
    "singular": (("check", "ueda2003", "--joints", "0,0"), ("singular",)),
    "unknown robot": (("check", "ueda203"), ("ueda203", '"ueda2003"')),
    "a folder": (("check", "."), ("not a file",)),
    "method": (("design", "ueda2003", *AT, "--method", "exakt"), ("exakt", '"exact"')),
    "foreign option": (("design", "ueda2003", *AT, "--method", "exact", "--step", "0.1"), ("exact", '"step"')),
    "objective": (("design", "ueda2003", *AT, "--objective", "best"), ("least-gain", "least-radius")),
    "frequency": (("design", "ueda2003", *AT, "--natural-frequency", "-5"), ("-5",)),
    "iterations": (("design", "ueda2003", *AT, "--iterations", "1.5"), ("--iterations", "1.5")),
    "seed": (("design", "ueda2003", *AT, "--method", "recursive", "--seed", "-1"), ("--seed", "-1")),
    "gain count": (("design", "ueda2003", *AT, "--stiffness", "1e5"), ("--stiffness", "1", "2")),
    "negative gain": (("design", "ueda2003", *AT, "--damping", "-1,1"), ("--damping", "-1")),
    "times": (("simulate", "ueda2003", "--from", TIP, "--to", TIP, "--switch", "0.5"), ("0.5", "0.4")),
    "NaN time": (("simulate", "ueda2003", "--from", TIP, "--to", TIP, "--end", "nan"), ("--end", "nan")),
    "trajectory": (("simulate", "ueda2003", "--from", TIP, "--to", TIP, "--trajectory", "quntic"), ("quintic",)),
    "convention": (("manipulability", "ueda2003", *AT, "--convention", "forc"), ("--convention", '"force"')),
    "measure": (("sweep", "ueda2003", "--measure", "robust"), ("robust", '"robustness"')),
    "shape": (("sweep", "ueda2003", "--shape", "4,x"), ("--shape", "x")),
    "over": (("sweep", "ueda2003", "--over", "nowhere"), ("nowhere", "tip", "joints")),
    "missing compensator": (
        ("modes", "ueda2003", *AT, "--compensator", "nope.json"),
        ("--compensator", "nope.json", "design --out"),
    ),
    "joints far away": (("modes", "ueda2003", "--joints", "1e300,1"), ("joints: 1e+300", "1e+06 rad or m")),
    "tip far away": (("modes", "ueda2003", "--tip", "1,1e300"), ("--tip: 1e+300", "1e+06 rad or m")),
    "engine": (("simulate", "ueda2003", "--from", TIP, "--to", TIP, "--plant", "mujco"), ("--plant:", '"mujoco"')),
    "suffix": (("modes", "ueda2003", *AT, "-o", "x.bmp"), ("--out", "x.bmp", ".png")),
    "picture of a compensator": (("design", "ueda2003", *AT, "-o", "x.png"), ("--out", "x.png", ".json")),
    "no such folder": (("sweep", "ueda2003", "-o", "no/such/x.png"), ("--out", "no/such")),
}


@pytest.mark.parametrize(("words", "expected"), COMMAND_LINES.values(), ids=COMMAND_LINES)
def test_command_lines(call: Call, words: tuple[str, ...], expected: tuple[str, ...]) -> None:
    outcome = call(*words)
    _is_plain(outcome.status, outcome.out, outcome.err)
    assert all(word in outcome.err for word in expected), outcome.err
    assert call(*words, "--json").out == ""


TWO_DRIVEN = 'joints = ["bridge"]'
FILES = {
    "unknown key": ("mass = 9.0", "mas = 9.0", ("[[robot.links]] number 2", "mas", '"mass"')),
    "unknown table": ("[control]", "[contrl]", ("contrl", '"control"')),
    "TOML": ("mass = 9.0", "mass = = 9.0", ("not valid TOML", "line")),
    "a string": ("[2.0e6]", '["30 kN"]', ("[base] stiffness", "30 kN")),
    "a boolean": ("mass = 9.0", "mass = true", ("mass", "true")),
    "NaN": ("mass = 9.0", "mass = nan", ("mass", "nan", "finite")),
    "no mass": ("mass = 9.0", "mass = 0.0", ("mass", "0")),
    "unsymmetric": ("stiffness = [1.0e5, 1.0e5]", "stiffness = [[1e5, 2.0], [3.0, 1e5]]", ("[control] stiffness",)),
    "indefinite": ("[2.0e6]", "[-2.0e6]", ("[base] stiffness", "-2e+06")),
    "negative damping": ("[400.0]", "[-400.0]", ("[base] damping", "-400")),
    "a wrong count": ("[400.0]", "[400.0, 1.0]", ("[base] damping", "2", "1")),
    "k > n": ('rows = ["x", "y"]', 'rows = ["x", "y", "rz"]', ("[task] rows", "3", "2")),
    "unknown joint": (TWO_DRIVEN, 'joints = ["brigde"]', ("[base] joints", "brigde", '"bridge"')),
    "no rows": ('rows = ["x", "y"]', "rows = []", ("[task] rows: 0 entries given, 1 or more needed",)),
    "no name": ('name = "my machine"', 'name = ""', ("name: is empty. Give",)),
    "springs without joints": (TWO_DRIVEN, "joints = []", ("[base] stiffness: there are no base joints. Remove",)),
    "a thousand digits": ("mass = 9.0", f"mass = {'9' * 1000}", ("mass: a huge number, beyond 1e+12. Give",)),
    "5000 digits": ("mass = 9.0", f"mass = {'9' * 5000}", ("an integer with thousands of digits",)),
    "deep": ("mass = 9.0", f"mass = {'[' * 5000}", ("nested too deeply",)),
    "far equilibrium": ("[0.0]", "[1e300]", ("[base] equilibrium", "1e+12")),
    "farther than a joint": ("[0.0]", "[1e7]", ("[base] equilibrium: 1e+07", "1e+06 rad or m")),
    "one gain of two": (
        "stiffness = [1.0e5, 1.0e5]",
        "stiffness = [1.0e5]",
        ("1 value given, 2 needed: one for each",),
    ),
    "two springs of one": ("[2.0e6]", "[2.0e6, 1.0]", ("2 values given, 1 needed: one for each joint or task row",)),
    "schema version": ("schema_version = 1 ", "schema_version = 2 ", ("schema_version", "2", "1")),
}


@pytest.mark.parametrize(("old", "new", "expected"), FILES.values(), ids=FILES)
def test_files(call: Call, tmp_path: Path, old: str, new: str, expected: tuple[str, ...]) -> None:
    assert old in template()
    project = tmp_path / "gantry.toml"
    project.write_text(template().replace(old, new, 1))
    outcome = call("check", project)
    _is_plain(outcome.status, outcome.out, outcome.err)
    assert all(word in outcome.err for word in ("gantry.toml", *expected)), outcome.err


COMPENSATORS = ["", "[]", "{}", "[" * 100_000, '{"format": "flexbase compensator 1"}', "\0", "NaN"]


@pytest.mark.parametrize("text", COMPENSATORS, ids=repr)
def test_compensator_files(call: Call, tmp_path: Path, text: str) -> None:
    path = tmp_path / "bad.json"
    path.write_text(text)
    outcome = call("modes", "ueda2003", *AT, "--compensator", path)
    _is_plain(outcome.status, outcome.out, outcome.err)
    assert "--compensator: " in outcome.err
    assert "bad.json" in outcome.err
    assert "design --out" in outcome.err


def _is_plain(status: int, out: str, err: str) -> None:
    assert (status, out) == (2, "")
    assert err.startswith("error: ")
    assert len(err.splitlines()) <= 2
    assert "Traceback" not in err
    assert "np.float64" not in err
    assert "validation" not in err
    assert "sys." not in err
    assert err.endswith("\n")


ACCEPTED = {
    "rigid base": (TWO_DRIVEN, "joints = []", "rigid base"),
    "overdamped": ("[400.0]", "[1.0e6]", "overdamped"),
}


@pytest.mark.parametrize(("old", "new", "said"), ACCEPTED.values(), ids=ACCEPTED)
def test_accepted_with_one_warning_on_stderr(call: Call, tmp_path: Path, old: str, new: str, said: str) -> None:
    text = template().replace(old, new, 1)
    if said == "rigid base":
        for field in ("stiffness = [2.0e6]", "damping = [400.0]", "equilibrium = [0.0]"):
            text = text.replace(field, f"{field.partition('=')[0]}= []", 1)
    project = tmp_path / "gantry.toml"
    project.write_text(text)
    outcome = call("modes", project, "--joints", "0.3,0.4,0.8" if said == "rigid base" else "0.3,0.8", "--json")
    assert outcome.status == 0
    outcome.document("modes")
    (line,) = outcome.err.splitlines()
    assert line.startswith("warning: ")
    assert said in line


def test_compensator_of_another_robot_is_pointed_out(call: Call, tmp_path: Path, compensator_file: Path) -> None:
    project = tmp_path / "gantry.toml"
    project.write_text(template())
    outcome = call("modes", project, "--joints", "0.3,0.8", "--compensator", compensator_file, "--json")
    assert outcome.status == 0
    assert outcome.err.startswith("warning: ")
    assert "ueda2003" in outcome.err

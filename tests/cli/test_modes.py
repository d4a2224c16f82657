"""`modes` and the ways to name a pose."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import flexbase as fb

from .conftest import TIP, Call

KEYS = {"frequency_rad_s", "damping_ratio", "residue", "residue_s", "robustness", "alignment", "label"}


def test_reference_numbers_and_keys(call: Call) -> None:
    found = call("modes", "ueda2003", "--tip", TIP, "--json").document("modes")
    (mode,) = found["modes"]
    assert set(mode) >= KEYS
    assert set(found) >= {"q", "modes", "rigid_mode", "positive_real"}
    assert mode["robustness"] == pytest.approx(-0.0708320860, rel=1e-9)
    assert mode["frequency_rad_s"] == pytest.approx(277.1029065, rel=1e-9)
    np.testing.assert_allclose(mode["residue"], [[-0.03250938, -0.07462994], [0.03716396, 0.08531520]], rtol=1e-6)
    assert mode["residue_s"] == [[0.0, 0.0], [0.0, 0.0]]
    assert found["positive_real"] is False


def test_tables_say_the_same(call: Call) -> None:
    shown = call("modes", "ueda2003", "--tip", TIP)
    assert (shown.status, shown.err) == (0, "")
    for number in ("-0.070832086", "277.102906", "0.427100588", "Not positive real"):
        assert number in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80
    assert "\x1b" not in shown.out


@pytest.mark.parametrize("words", [("--tip", "-0.3,0.2"), ("--tip=-0.3,0.2",), ("--tip", "-0.3, 0.2")])
def test_tip_may_begin_with_a_minus(call: Call, words: tuple[str, ...], paper: fb.Plant) -> None:
    found = call("modes", "ueda2003", *words, "--json").document("modes")
    np.testing.assert_allclose(found["tip"], [-0.3, 0.2], atol=1e-12)
    assert found == fb.modes(paper.at_tip([-0.3, 0.2])).to_dict()


@pytest.mark.parametrize(
    ("words", "sign"), [((), 1), (("--elbow", "+"), 1), (("--elbow", "-"), -1), (("--elbow=-",), -1)]
)
def test_elbow_chooses_the_branch(call: Call, words: tuple[str, ...], sign: int) -> None:
    q = call("modes", "ueda2003", "--tip", TIP, *words, "--json").document("modes")["q"]
    assert np.sign(q[2]) == sign


@pytest.mark.parametrize(("words", "q"), [("-1.5,1.2", [0.0, -1.5, 1.2]), ("0.1,-1.5,1.2", [0.1, -1.5, 1.2])])
def test_joints_of_the_arm_or_all(call: Call, words: str, q: list[float]) -> None:
    assert call("modes", "ueda2003", "--joints", words, "--json").document("modes")["q"] == q


def test_undefined_is_null(call: Call, tmp_path: Path) -> None:
    """A base whose motion the tip's row does not see has a vanishing residue, so no alignment."""
    project = tmp_path / "unseen.toml"
    project.write_text(UNSEEN)
    found = call("modes", project, "--joints", "0.1", "--json").document("modes")
    assert found["modes"][0]["alignment"] is None
    assert "undefined" in call("modes", project, "--joints", "0.1").out


UNSEEN = """
name = "unseen"
[robot]
[[robot.links]]
joint = "up"
type = "prismatic"
axis = [0.0, 1.0]
length = 0.0
mass = 2.0
com = 0.0
inertia = 0.1
[[robot.links]]
joint = "along"
type = "prismatic"
length = 0.0
mass = 1.0
com = 0.0
inertia = 0.1
[base]
joints = ["up"]
stiffness = [1e4]
damping = [1.0]
[task]
rows = ["x"]
"""


def test_picture_and_document(call: Call, tmp_path: Path) -> None:
    picture, document = tmp_path / "modes.svg", tmp_path / "modes.json"
    shown = call("modes", "ueda2003", "--tip", TIP, "-o", picture)
    assert shown.status == 0
    assert "Written" in shown.out
    assert picture.read_text().lstrip().startswith("<?xml")
    printed = call("modes", "ueda2003", "--tip", TIP, "--out", document, "--json").out
    assert document.read_text() == printed

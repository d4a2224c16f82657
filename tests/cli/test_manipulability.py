"""`ellipsoid`: both conventions."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import flexbase as fb

from .conftest import TIP, Call


def test_both_conventions_are_the_librarys(call: Call, compensator_file: Path, paper_pose: fb.Pose) -> None:
    words = ("manipulability", "ueda2003", "--tip", TIP, "--compensator", compensator_file, "--json")
    found = call(*words).document("manipulability")
    used = fb.load_compensator(compensator_file)
    for convention in ("force", "torque"):
        assert found[convention] == fb.manipulability(paper_pose, used, convention).to_dict()
    limited = call(*words, "--convention", "torque").document("manipulability")
    assert set(limited) == set(found)


def test_force_semi_axes_are_those_of_the_rigid_mode(call: Call) -> None:
    rigid = call("modes", "ueda2003", "--tip", TIP, "--json").document("modes")["rigid_mode"]
    found = call("manipulability", "ueda2003", "--tip", TIP, "--json").document("manipulability")
    np.testing.assert_allclose(sorted(found["force"]["original"]["semi_axes"]), np.linalg.eigvalsh(rigid), rtol=1e-12)


def test_convention_limits_what_is_shown(call: Call) -> None:
    both = call("manipulability", "ueda2003", "--tip", TIP).out
    one = call("manipulability", "ueda2003", "--tip", TIP, "--convention", "force").out
    assert "Convention force" in both
    assert "Convention torque" in both
    assert "Convention force" in one
    assert "Convention torque" not in one


def test_picture(call: Call, tmp_path: Path) -> None:
    path = tmp_path / "e.png"
    assert call("manipulability", "ueda2003", "--tip", TIP, "-o", path).status == 0
    assert path.read_bytes().startswith(b"\x89PNG")

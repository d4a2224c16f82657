"""`flexbase compare`, `safe-gain` and `region`: controllers as they run at a pose."""

from __future__ import annotations

from pathlib import Path

import pytest

import flexbase as fb
from flexbase.model.sensing import Sensing
from flexbase.sampled.verdict import hardware_verdict
from flexbase.synthesis import controller_for

from .conftest import TIP, Call

AT = ("ueda2003", "--tip", TIP, "--rate", "4000")
SOFT = ("--stiffness", "2e4,2e4", "--damping", "600,600")


def test_table(call: Call) -> None:
    shown = call("compare", *AT, "--method", "none,exact")
    assert (shown.status, shown.err) == (0, "")
    for words in ("4000 Hz", "none", "exact", "algebraic loop of E", "takes positions only"):
        assert words in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80


def test_document_is_the_librarys(call: Call, paper_pose: fb.Pose) -> None:
    found = call("compare", *AT, "--method", "exact", "--json").document("compare")
    expected = hardware_verdict(controller_for(paper_pose, "exact", Sensing(rate=4000.0))).to_dict()
    assert found["methods"][0]["spectral_radius"] == pytest.approx(expected["spectral_radius"], rel=1e-9)
    assert found["declared"] is True
    assert found["sensing"]["rate"] == 4000.0


def test_files_and_wrong_words(call: Call, tmp_path: Path) -> None:
    assert call("compare", *AT, "--method", "none", "--out", tmp_path / "table.json").status == 0
    assert call("compare", *AT, "--method", "none", "--out", tmp_path / "table.png").status == 2
    for command in ("compare", "safe-gain", "region"):
        assert call(command, *AT, "--method", "nose").status == 2


@pytest.mark.slow
def test_safe_gain(call: Call, paper_pose: fb.Pose) -> None:
    shown = call("safe-gain", *AT, *SOFT, "--method", "none,viscous")
    assert "times the gains" in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80
    found = call("safe-gain", *AT, *SOFT, "--json").document("safe-gain")["safe_gain"]
    soft = fb.Loop(gains=fb.Gains([2e4, 2e4], [600.0, 600.0]), sensing=Sensing(rate=4000.0))
    assert found == [fb.safe_gain(paper_pose, "none", soft).to_dict()]


@pytest.mark.slow
def test_region(call: Call, tmp_path: Path, compensator_file: Path) -> None:
    picture, near = tmp_path / "region.png", ("--half-width", "0.05")
    found = call("region", *AT, *SOFT, *near, "--out", picture, "--json").document("region")
    assert picture.stat().st_size > 5000
    assert found["what"] == "E"
    assert len(found["grade"]) == 25
    designed = call("region", *AT, *near, "--compensator", compensator_file, "--json").document("region")
    assert designed["grade"] != found["grade"]

"""`flexbase hardware`: a table of methods, safe gains, a region."""

from __future__ import annotations

from pathlib import Path

import pytest

import flexbase as fb
from flexbase.model.sensing import Sensing
from flexbase.sampled.verdict import hardware_verdict
from flexbase.synthesis import controller_for

from .conftest import TIP, Call

AT = ("hardware", "ueda2003", "--tip", TIP, "--rate", "4000")


def test_table(call: Call) -> None:
    shown = call(*AT, "--method", "none,exact")
    assert (shown.status, shown.err) == (0, "")
    for words in ("4000 Hz", "none", "exact", "algebraic loop of E", "takes positions only"):
        assert words in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80


def test_document_is_the_librarys(call: Call, paper_pose: fb.Pose) -> None:
    found = call(*AT, "--method", "exact", "--json").document("hardware")
    expected = hardware_verdict(controller_for(paper_pose, "exact", Sensing(rate=4000.0))).to_dict()
    assert found["methods"][0]["spectral_radius"] == pytest.approx(expected["spectral_radius"], rel=1e-9)
    assert found["declared"] is True
    assert found["sensing"]["rate"] == 4000.0


@pytest.mark.slow
def test_safe_gain_and_region(call: Call, tmp_path: Path) -> None:
    out = tmp_path / "region.json"
    words = ("--method", "none", "--stiffness", "2e4,2e4", "--damping", "600,600")
    shown = call(*AT, *words, "--safe-gain")
    assert "times the gains" in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80
    picture = tmp_path / "region.png"
    found = call(*AT, *words, "--region", "--half-width", "0.05", "--out", picture, "--json").document("hardware")
    assert picture.stat().st_size > 5000
    assert found["region"]["what"] == "E"
    assert len(found["region"]["grade"]) == 25
    assert call(*AT, "--region").status == 2
    assert call(*AT, "--method", "none", "--out", out).status == 0
    assert call(*AT, "--method", "none", "--out", picture).status == 2
    assert call(*AT, "--method", "nose").status == 2

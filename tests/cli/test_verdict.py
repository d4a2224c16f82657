"""`flexbase verdict`: the exact answer, its numbers and words."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import flexbase as fb

from .conftest import TIP, Call


def test_reference_numbers_and_keys(call: Call, paper_pose: fb.Pose) -> None:
    """The document's numbers stand at its top, and are the library's.  [theory §5]"""
    shown = call("verdict", "ueda2003", "--tip", TIP, "--json")
    assert (shown.status, shown.err) == (0, "")
    plain = json.loads(shown.out)
    assert plain["shortage"] == pytest.approx(-0.001383691, abs=5e-10)
    assert plain["relative_shortage"] == pytest.approx(-0.28645, abs=5e-6)
    assert plain["positive_real"] is False
    assert plain["negative_imaginary"] is False
    ((low, high),) = plain["fails_at_rad_s"]
    assert 0.0 < low < 277.0 < high
    found = shown.document("verdict")
    wanted = fb.verdict(paper_pose).to_dict()
    wanted["output_index"] = None  # minus infinity
    assert found == wanted


def test_the_exact_design_is_positive_real(call: Call, compensator_file: Path) -> None:
    found = call("verdict", "ueda2003", "--tip", TIP, "--compensator", compensator_file, "--json").document("verdict")
    assert found["positive_real"] is True
    assert found["negative_imaginary"] is True
    assert found["fails_at_rad_s"] == []
    assert found["shortage"] == pytest.approx(0.0, abs=1e-12)
    assert found["worst_at_rad_s"] is None
    words = call("verdict", "ueda2003", "--tip", TIP, "--compensator", compensator_file).out
    assert "  Positive real" in words
    assert "with compensator" in words


def test_tables_say_the_same(call: Call) -> None:
    shown = call("verdict", "ueda2003", "--tip", TIP)
    assert (shown.status, shown.err) == (0, "")
    for words in (
        "-0.00138369104 m/(N s), -28.645 % of the largest",
        "277.103 rad/s",
        "at all frequencies",
        "Not positive real",
    ):
        assert words in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80


def test_bandwidth(call: Call) -> None:
    found = call("verdict", "ueda2003", "--tip", TIP, "--bandwidth", "200", "--json").document("verdict")
    assert found["bandwidth_rad_s"] == 200.0
    assert found["worst_at_rad_s"] == 200.0
    assert -0.001383691 < found["shortage"] < 0.0
    assert "up to 200 rad/s" in call("verdict", "ueda2003", "--tip", TIP, "--bandwidth", "200").out
    wrong = call("verdict", "ueda2003", "--tip", TIP, "--bandwidth", "-3")
    assert wrong.status == 2
    assert "bandwidth" in wrong.err


def test_a_shortage_without_bound_is_null(call: Call, tmp_path: Path) -> None:
    """An undamped base: strict JSON, and words that say so."""
    project = tmp_path / "undamped.toml"
    project.write_text(
        (Path(fb.__file__).parent / "model/library/ueda2003.toml").read_text().replace("[10.0]", "[0.0]")
    )
    found = call("verdict", project, "--tip", TIP, "--json").document("verdict")
    assert found["shortage"] is None
    assert found["positive_real"] is False
    assert found["fails_at_rad_s"] == [[pytest.approx(277.40, abs=0.3)] * 2]
    assert "no bound" in " ".join(call("verdict", project, "--tip", TIP).out.split())


def test_picture(call: Call, tmp_path: Path) -> None:
    shown = call("verdict", "ueda2003", "--tip", TIP, "-o", tmp_path / "a.svg")
    assert shown.status == 0
    assert "Written" in shown.out
    assert (tmp_path / "a.svg").read_text().lstrip().startswith("<?xml")

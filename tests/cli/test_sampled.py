"""`simulate-sampled` and `agreement` on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from .conftest import Call

pytest.importorskip("mujoco")
MOVE = ("simulate-sampled", "ueda2003", "--from", "0.33,0.25", "--to", "0.33,-0.25")
LATE = ("--switch", "0.15", "--end", "0.6")


@pytest.mark.parametrize("plant", ["builtin", "mujoco"])
def test_ours_settles_and_the_papers_law_does_not(call: Call, plant: str) -> None:
    shown = call(*MOVE, *LATE, "--method", "lqg", "--plant", plant, "--json")
    found = json.loads(shown.out)
    assert shown.status == 0
    assert found["settled"]
    assert found["predicted_stable"]
    assert found["engine"] == plant
    paper = call(*MOVE, *LATE, "--plant", plant, "--json")
    assert paper.status == 1
    assert json.loads(paper.out)["diverged"]


def test_a_compensator_a_push_and_a_picture(call: Call, tmp_path: Path) -> None:
    E = tmp_path / "E.json"
    assert call("design", "ueda2003", "--tip", "0.33,-0.25", "--out", str(E)).status == 0
    shown = call(
        *MOVE, *LATE, "--compensator", str(E), "--rate", "8e3", "--disturb", "30,0", "-o", str(tmp_path / "a.png")
    )
    assert "exact at 8000 Hz" in shown.out
    assert "spectral radius" in shown.out
    assert (tmp_path / "a.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("words", "match"),
    [
        (("simulate", *MOVE[1:], "--rate", "4e3"), "--rate"),
        (("simulate", *MOVE[1:], "--method", "none"), "--method"),
        ((*MOVE, "--method", "magic"), "magic"),
        ((*MOVE, "--interval", "1e-3"), "--interval"),
        ((*MOVE, "--disturb", "1"), "push"),
        ((*MOVE, "--rate", "0"), "rate"),
        (("agreement", "ueda2003", "--workers", "-1"), "workers"),
        (("agreement", "ueda2003", "--methods", "magic"), "magic"),
        (("study", "hardware", "ueda2003"), "now called hardware-study or agreement"),
    ],
)
def test_wrong_words(call: Call, words: tuple[str, ...], match: str) -> None:
    shown = call(*words)
    assert shown.status == 2
    assert match in shown.err
    assert shown.out == ""


@pytest.mark.slow
def test_agreement_in_json_and_in_words(call: Call, tmp_path: Path) -> None:
    words = ("agreement", "ueda2003", "--poses", "8", "--methods", "none,lqg", "--workers", "1")
    shown = call(*words, "--json")
    found = json.loads(shown.out)
    assert (shown.status, found["poses"], found["agreement"]) == (0, 8, 1.0)
    assert {"false_stable_rate", "false_unstable_rate", "confusion", "share_stable", "disagreements"} <= set(found)
    assert found["constant_predictor"]["agreement"] < 0.8
    kept = call(*words, "--out", str(tmp_path / "cases.json"))
    assert "100.0 % come true" in kept.out
    assert len(json.loads((tmp_path / "cases.json").read_text())["cases"]) == 8

"""`montecarlo`: tables, files, documents and refusals."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

import flexbase as fb

from .conftest import TIP, Call

POSE = ("montecarlo", "ueda2003", "--tip", TIP, "--samples", "60")
MAP = ("montecarlo", "ueda2003", "--shape", "8,7", "--samples", "60", "--redesign", "--vary", "payload=uniform:0:3")


def test_document_is_the_librarys(call: Call, paper: fb.Plant) -> None:
    outcome = call(*MAP, "--criteria", "robust=0.02,frequency=280:", "--elbow", "-", "--seed", "3", "--json")
    found = fb.montecarlo(
        paper,
        fb.Draws({"payload": "uniform(0,3)"}, samples=60, seed=3),
        redesign=True,
        criteria=["robust=0.02", "frequency=280:"],
        cells=fb.Cells(shape=(8, 7), branch="-"),
    )
    assert (outcome.status, outcome.err) == (0, "")
    assert outcome.document("montecarlo") == found.to_dict()


def test_a_pose_with_a_compensator(call: Call, compensator_file: Path) -> None:
    words = ("--vary", "stiffness=normal(1,0.15),payload=uniform(0,6)", "--compensator", compensator_file)
    document = call(*POSE, *words, "--json").document("montecarlo")
    assert document["vary"] == ["stiffness normal(1, 0.15)", "payload uniform(0, 6)"]
    assert 0.2 < document["probability"] < 0.8
    shown = call(*POSE, *words)
    assert max(map(len, shown.out.splitlines())) <= 80
    assert f"{document['probability']:.4f}" in shown.out
    assert "unvaried  holds" in shown.out
    bare = call(*POSE, "--vary", "payload=0")
    assert "unvaried  does not hold" in bare.out
    assert "bare plant" in bare.out


def test_files(call: Call, tmp_path: Path) -> None:
    paths = {kind: tmp_path / f"m.{kind}" for kind in ("png", "csv", "json", "nc")}
    for path in paths.values():
        shown = call(*MAP, "--out", path)
        assert shown.status == 0, shown.err
        assert max(map(len, shown.out.replace(str(path), "").splitlines())) <= 80
    assert len(list(csv.DictReader(paths["csv"].read_text().splitlines()))) == 56
    assert paths["json"].read_text() == call(*MAP, "--json").out
    assert paths["png"].read_bytes().startswith(b"\x89PNG")
    draws = tmp_path / "draws.csv"
    assert call(*POSE, "--vary", "payload=uniform:0:3", "--out", draws).status == 0
    assert len(list(csv.DictReader(draws.read_text().splitlines()))) == 60


def test_nothing_in_reach_is_no_fault(call: Call) -> None:
    shown = call(*MAP, "--bounds", "5,6,5,6")
    assert shown.status == 0
    assert "none" in shown.out
    assert call(*MAP, "--bounds", "5,6,5,6", "--json").document("montecarlo")["cells"] == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "vary: nothing varies"),
        (("--vary", "payload"), '--vary: "payload" is not NAME=KIND:A:B'),
        (("--vary", "payload=1,payload=2"), "--vary: payload is given twice"),
        (("--vary", "payload=uniform(0,3"), "--vary:"),
        (("--vary", "paylaod=1"), 'Did you mean "payload"'),
        (("--vary", "payload=1", "--over", "joints"), "over: belongs to a map"),
        (("--vary", "payload=1", "--seed", "x"), '--seed: "x" is not a whole number'),
        (("--vary", "payload=1", "--out", "m.zarr"), '--out: m.zarr ends in ".zarr"'),
    ],
)
def test_wrong_words_are_named(call: Call, words: tuple[str, ...], said: str) -> None:
    outcome = call(*POSE, *words)
    assert (outcome.status, outcome.out) == (2, "")
    assert outcome.err.startswith("error: ")
    assert said in outcome.err


def test_draw_reads_what_was_kept(call: Call, tmp_path: Path) -> None:
    assert call(*MAP, "--out", tmp_path / "m.nc").status == 0
    shown = call("draw", tmp_path / "m.nc", "--out", tmp_path / "m.png")
    assert (shown.status, shown.err) == (0, "")
    assert "probability that it holds" in shown.out
    assert (tmp_path / "m.png").read_bytes().startswith(b"\x89PNG")
    refused = call("draw", tmp_path / "m.nc", "--before", tmp_path / "m.nc", "--out", tmp_path / "d.png")
    assert refused.status == 2

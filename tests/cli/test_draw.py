"""`draw`, and `map` with a page or a difference."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from .conftest import Call

SMALL = ("sweep", "ueda2003", "--shape", "9,7")


@pytest.fixture
def store(call: Call, tmp_path: Path) -> Path:
    place = tmp_path / "a.zarr"
    assert call(*SMALL, "--vary", "payload=0:5:6", "--out", place).status == 0
    return place


@pytest.mark.parametrize(
    ("name", "start"), [("a.png", b"\x89PNG"), ("a.svg", b"<?xml"), ("a.html", b"<!doctype html>")]
)
def test_a_store_is_drawn(call: Call, store: Path, tmp_path: Path, name: str, start: bytes) -> None:
    shown = call("draw", store, "--out", tmp_path / name)
    assert (shown.status, shown.err) == (0, "")
    assert "ueda2003  robustness over x, y, payload" in shown.out
    assert (tmp_path / name).read_bytes().startswith(start)


def test_an_axis_is_held_at_the_nearest_value(call: Call, store: Path, tmp_path: Path) -> None:
    shown = call("draw", store, "--at", "payload=2.2", "--out", tmp_path / "a.png")
    assert "ueda2003, payload = 2 kg  robustness over x, y" in shown.out


def test_a_file_is_drawn_against_another(call: Call, compensator_file: Path, tmp_path: Path) -> None:
    before, after = tmp_path / "before.nc", tmp_path / "after.nc"
    call(*SMALL, "--out", before)
    call(*SMALL, "--compensator", compensator_file, "--out", after)
    shown = call("draw", after, "--before", before, "--out", tmp_path / "a.png")
    assert "with compensator minus without compensator" in shown.out
    direct = call(*SMALL, "--compensator", compensator_file, "--difference", "--out", tmp_path / "b.png")
    assert "ok before only" in direct.out
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_a_difference_is_a_document(call: Call, compensator_file: Path) -> None:
    found = call(*SMALL, "--compensator", compensator_file, "--difference", "--json").document("sweep")
    assert found["difference"] == "with compensator minus without compensator"
    assert found["status_codes"]["5"] == "ok before only"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "--out is missing"),
        (("--out", "a.txt"), 'ends in ".txt"'),
        (("--out", "a.png", "--at", "payload"), '"payload" has no value. Give NAME=VALUE'),
        (("--out", "a.png", "--at", "paylod=1"), 'no axis "paylod". Did you mean "payload"?'),
        (("--out", "a.png", "--at", "payload=1,x=0,y=0"), "single cell"),
        (("--out", "a.png", "--before", "none.nc"), "none.nc: is no sweep"),
    ],
)
def test_faults_are_named(call: Call, store: Path, words: tuple[str, ...], said: str) -> None:
    outcome = call("draw", store, *words)
    assert (outcome.status, outcome.out) == (2, "")
    assert said in outcome.err


def test_an_unfinished_store_is_drawn_with_a_warning(call: Call, store: Path, tmp_path: Path) -> None:
    shutil.rmtree(store / "finished_blocks" / "c")
    outcome = call("draw", store, "--out", tmp_path / "a.png")
    assert outcome.status == 0
    assert "blocks are missing" in outcome.err


def test_a_difference_needs_two_and_a_place(call: Call, compensator_file: Path, tmp_path: Path) -> None:
    lonely = call(*SMALL, "--difference")
    assert lonely.err == "error: --difference: without and with what? Give --compensator FILE.\n"
    words = ("--compensator", compensator_file, "--difference", "--out", tmp_path / "a.zarr")
    assert "flexbase draw AFTER --before BEFORE" in call(*SMALL, *words).err

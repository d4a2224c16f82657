"""`map`: tables, files and documents."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

import flexbase as fb
from flexbase.sweeps import document

from .conftest import Call

SMALL = ("sweep", "ueda2003", "--shape", "9,7")


def test_document_is_the_librarys(call: Call, paper: fb.Plant) -> None:
    words = ("--measures", "robustness,alignment", "--bounds", "-0.4,0.8,-0.6,0.6", "--elbow", "-", "--json")
    outcome = call(*SMALL, *words)
    chart = fb.sweep(
        paper, ["robustness", "alignment"], fb.Cells(shape=(9, 7), bounds=[-0.4, 0.8, -0.6, 0.6], branch="-")
    )
    assert outcome.err == ""  # stderr is no terminal: no bar
    assert outcome.document("sweep") == document(chart)


@pytest.mark.parametrize("option", ["--measure", "--measures"])
def test_over_joints(call: Call, option: str) -> None:
    words = ("--over", "joints", "--axes", "q3,q2", option, "compensability", "--json")
    found = call(*SMALL, *words).document("sweep")
    assert [axis["name"] for axis in found["axes"]] == ["q3", "q2"]
    assert list(found["measures"]) == ["compensability"]


def test_csv_json_and_picture(call: Call, tmp_path: Path) -> None:
    table, document, picture = (tmp_path / name for name in ("m.csv", "m.json", "m.png"))
    for path in (table, document, picture):
        assert call(*SMALL, "--out", path).status == 0
    rows = list(csv.DictReader(table.read_text().splitlines()))
    assert len(rows) == 63
    assert document.read_text() == call(*SMALL, "--json").out
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_compensator_is_used(call: Call, compensator_file: Path) -> None:
    here = ("--bounds", "0.33,0.34,-0.25,-0.24", "--shape", "2,2", "--compensator", compensator_file, "--json")
    found = call("sweep", "ueda2003", *here).document("sweep")
    assert found["compensated"] is True
    assert np.abs(found["measures"]["robustness"]["values"][0][0][0]) < 1e-12


def test_tables(call: Call) -> None:
    shown = call(*SMALL, "--measures", ",".join(fb.MEASURES))
    assert max(map(len, shown.out.splitlines())) <= 80
    for name, measure in fb.MEASURES.items():
        assert name in shown.out
        assert measure.unit in shown.out


def test_nothing_in_reach_is_no_fault(call: Call) -> None:
    shown = call(*SMALL, "--bounds", "5,6,5,6")
    assert shown.status == 0
    assert "none" in shown.out


@pytest.mark.parametrize(("over", "option"), [("joints", ("--elbow", "-")), ("samples", ("--elbow", "+"))])
def test_options_of_the_other_plane_are_refused(call: Call, over: str, option: tuple[str, str]) -> None:
    outcome = call(*SMALL, "--over", over, *option)
    assert (outcome.status, outcome.out) == (2, "")
    assert outcome.err.startswith("error: branch (--elbow): ")

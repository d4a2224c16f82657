"""`posture`, `rac` and `layout`: documents are the library's, tables fit, faults name the option."""

from __future__ import annotations

from pathlib import Path

import pytest

import flexbase as fb

from .conftest import Call

JOB = "name,x,y\nhole 1,0.33,-0.25\nhole 2,0.33,-0.1\n"


@pytest.fixture
def job(tmp_path: Path) -> Path:
    path = tmp_path / "job.csv"
    path.write_text(JOB)
    return path


def test_posture_document_is_the_librarys(call: Call, paper: fb.Plant) -> None:
    found = call("postures", "ueda2003", "--tip", "0.33,-0.25", "--json")
    assert (found.status, found.err) == (0, "")
    assert found.document("postures") == fb.postures(paper, [0.33, -0.25]).to_dict()
    one = call("postures", "ueda2003", "--tip", "0.33,-0.25", "--elbow", "+", "--measure", "alignment", "--json")
    assert [each["branch"] for each in one.document("postures")["postures"]] == ["+"]


def test_compensator_is_used(call: Call, compensator_file: Path) -> None:
    found = call("postures", "ueda2003", "--tip", "0.33,-0.25", "--compensator", compensator_file, "--json")
    content = found.document("postures")
    assert content["compensated"] is True
    assert abs(content["postures"][0]["value"]) < 1e-12


def test_robust_documents_are_the_librarys(call: Call, paper: fb.Plant) -> None:
    assert call("robust-curves", "ueda2003", "--json").document("robust-curves") == fb.robust_curves(paper).to_dict()
    points = call("robust-points", "ueda2003", "--count", "20", "--json").document("robust-points")
    assert points == fb.robust_points(paper, count=20).to_dict()


def test_layout_document_is_the_librarys(call: Call, paper: fb.Plant, job: Path) -> None:
    found = call("layout", "ueda2003", "--targets", job, "--within", "0.05", "--along", "x", "--json")
    assert found.status == 0
    targets = fb.read_targets(paper.arm.task, job)
    assert found.document("layout") == fb.layout(paper, targets, within=0.05, along=["x"]).to_dict()


def test_tables_fit_and_name_what_counts(call: Call, job: Path) -> None:
    posture = call("postures", "ur5e-pedestal", "--tip", "0.4,0.2,1.0")
    curves = call("robust-curves", "ueda2003")
    points = call("robust-points", "ur5e-pedestal", "--modes", "1", "--count", "30")
    layout = call("layout", "ueda2003", "--targets", job, "--turn")
    for shown, words in (
        (posture, ("unasked", "mode 2", "best joints")),
        (curves, ("q2, q3", "points")),
        (points, ("of 30 samples", "z of the tip")),
        (layout, ("hole 2", "turned about", "All in reach")),
    ):
        assert shown.status == 0
        assert max(map(len, shown.out.splitlines())) <= 80
        for word in words:
            assert word in shown.out


@pytest.mark.slow
def test_files(call: Call, tmp_path: Path, job: Path) -> None:
    for words in (
        ("postures", "ueda2003", "--tip", "0.33,-0.25"),
        ("postures", "ur5e-pedestal", "--tip", "0.4,0.2,1.0"),
        ("robust-curves", "ueda2003"),
        ("robust-points", "ur5e-pedestal", "--modes", "1", "--count", "30"),
        ("layout", "ueda2003", "--targets", job),
    ):
        picture, document = tmp_path / "p.png", tmp_path / "p.json"
        assert call(*words, "--out", picture).status == 0
        assert picture.read_bytes().startswith(b"\x89PNG")
        assert call(*words, "--out", document).status == 0
        assert document.read_text() == call(*words, "--json").out
    table = tmp_path / "t.csv"
    assert call("robust-curves", "ueda2003", "--out", table).status == 0
    assert table.read_text().startswith("curve,mode,q2,q3,x,y\n")


def test_targets_out_of_reach_are_the_answer_no(call: Call, tmp_path: Path) -> None:
    path = tmp_path / "far.csv"
    path.write_text("x,y\n0.3,0.1\n5,0\n")
    found = call("layout", "ueda2003", "--targets", path)
    assert found.status == 1
    assert "Out of reach: 2" in found.out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("postures", "ueda2003"), "--tip is missing"),
        (("postures", "ueda2003", "--tip", "3,0"), "--tip: "),
        (("postures", "ueda2003", "--tip", "0.3,0", "--measure", "turn"), "alignment is its cosine"),
        (("robust-points", "ur5e-pedestal", "--modes", "7"), "no mode 7"),
        (("layout", "ueda2003", "--targets", "nowhere.csv"), "nowhere.csv"),
        (("layout", "ueda2003"), "targets"),
    ],
)
def test_faults_name_the_option(call: Call, words: tuple[str, ...], said: str) -> None:
    found = call(*words)
    assert (found.status, found.out) == (2, "")
    assert said in found.err

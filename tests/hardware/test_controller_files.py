"""Sampled controllers on disk: what is read back is what was written, and nothing else is read."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import flexbase as fb


@pytest.mark.parametrize("method", ["none", "exact", "coprime", "viscous"])
def test_round_trip(paper: fb.Plant, paper_pose: fb.Pose, tmp_path: Path, method: str) -> None:
    """Every digit of the state space, and with it every figure of the verdict."""
    controller = fb.make_controller(paper_pose, method)
    fb.save_controller(controller, tmp_path / "c.json")
    again = fb.load_controller(tmp_path / "c.json", paper)
    for part in "ABCD":
        assert np.array_equal(getattr(again.system, part), getattr(controller.system, part))
    assert (again.name, again.sensing, again.system.step) == (method, controller.sensing, controller.system.step)
    assert fb.hardware_verdict(again).to_dict() == fb.hardware_verdict(controller).to_dict()


def broken(document: dict[str, object], key: str, value: object) -> dict[str, object]:
    return {**document, key: value}


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("format", "flexbase compensator 1", "not a controller"),
        ("robot", "ur5e-pedestal", 'made for "ur5e-pedestal"'),
        ("step", 0.5, "the sensing samples every"),
        ("step", "soon", "not a positive number"),
        ("A", [[float("nan")]], "not finite|entries, but its shape"),
        ("B", [], "entries, but its shape"),
        ("E", [[1.0]], "E has shape"),
        ("q", [0.0], "1 joints"),
        ("sensing", {"rate": -1.0}, "rate"),
        ("notes", 5, "missing or unknown"),
        ("shapes", {}, "missing or unknown"),
    ],
)
def test_wrong_files_are_refused(
    paper: fb.Plant, paper_pose: fb.Pose, tmp_path: Path, key: str, value: object, message: str
) -> None:
    path = tmp_path / "c.json"
    fb.save_controller(fb.make_controller(paper_pose, "viscous"), path)
    path.write_text(json.dumps(broken(json.loads(path.read_text()), key, value)))
    with pytest.raises(fb.InputError, match=message):
        fb.load_controller(path, paper)


def test_a_changed_robot_is_named(paper: fb.Plant, paper_pose: fb.Pose, tmp_path: Path) -> None:
    path = tmp_path / "c.json"
    fb.save_controller(fb.make_controller(paper_pose, "none"), path)
    path.write_text(json.dumps(broken(json.loads(path.read_text()), "model", "another")))
    with pytest.warns(fb.FlexbaseWarning, match="has other numbers"):
        fb.load_controller(path, paper)


def test_files_that_cannot_be(paper: fb.Plant, paper_pose: fb.Pose, tmp_path: Path) -> None:
    with pytest.raises(fb.InputError, match="cannot be written"):
        fb.save_controller(fb.make_controller(paper_pose, "none"), tmp_path / "no" / "c.json")
    with pytest.raises(fb.InputError, match="cannot be read"):
        fb.load_controller(tmp_path / "none.json", paper)
    (tmp_path / "text").write_text("{")
    with pytest.raises(fb.InputError, match="not valid JSON, line 1, column 2"):
        fb.load_controller(tmp_path / "text", paper)
    with pytest.raises(fb.InputError, match="plant: str given"):
        fb.load_controller(tmp_path / "text", "ueda2003")  # type: ignore[arg-type]

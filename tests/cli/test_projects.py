"""`check`, `robots`, `init`, the template and the schema."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import flexbase as fb
from flexbase.model.files.bundled import robots
from flexbase.model.files.project import parse_project
from flexbase.model.files.start import schema_text, template
from flexbase.study.check import check

from .conftest import TIP, Call

SCHEMA = Path(__file__).parents[2] / "docs" / "flexbase.schema.json"
BUNDLED = Path(fb.__file__).parent / "model" / "library"
HEAVY = template().replace("# gravity", "gravity")


def test_check_says_what_the_project_says(call: Call) -> None:
    found = call("check", "ueda2003", "--json").document("check")
    assert [found[key] for key in ("name", "m", "n", "k")] == ["ueda2003", 1, 2, 2]
    assert [(joint["name"], joint["part"], joint["type"]) for joint in found["joints"]] == [
        ("q1", "base", "revolute"),
        ("q2", "arm", "revolute"),
        ("q3", "arm", "revolute"),
    ]
    assert found["base"] == {"stiffness": [[3e4]], "damping": [[10.0]], "equilibrium": [0.0]}
    assert found["task"] == {"rows": ["x", "y"], "units": ["m", "m"], "branch": "+"}
    assert found["gains"]["stiffness"] == [[1e5, 0.0], [0.0, 1e5]]
    assert found["pose"] is None


def test_check_at_a_pose(call: Call, paper_pose: fb.Pose) -> None:
    pose = call("check", "ueda2003", "--tip", TIP, "--json").document("check")["pose"]
    assert pose["q"] == paper_pose.q.tolist()
    np.testing.assert_allclose(pose["tip"], [0.33, -0.25], atol=1e-12)
    assert pose["condition_number_M"] == pytest.approx(np.linalg.cond(paper_pose.M), rel=1e-10)
    assert pose["sag"] == [0.0]
    assert pose["holding_torque"] == [0.0, 0.0]


def test_check_under_gravity(call: Call, tmp_path: Path) -> None:
    """The spring along y carries the whole machine: sag = -g m / K."""
    project = tmp_path / "heavy.toml"
    project.write_text(HEAVY)
    found = call("check", project, "--joints", "0.3,0.8", "--json").document("check")
    weight = 9.81 * (40.0 + 9.0 + 5.0 + 1.5)
    assert found["pose"]["sag"] == pytest.approx([-weight / 2e6], rel=1e-12)
    assert found["gravity"] == [0.0, -9.81, 0.0]
    shown = call("check", project, "--joints", "0.3,0.8")
    for words in ("-9.81", "holding torque", "N m", "base sag", "bridge"):
        assert words in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80


def test_describe_has_a_summary(paper: fb.Plant, paper_pose: fb.Pose) -> None:
    assert "1 base and 2 arm joints" in check(paper).summary()
    assert re.search(r"condition number of M +19.9682", check(paper, paper_pose).summary())
    assert "condition number of M" not in check(paper).summary()


def test_robots_lists_what_is_bundled(call: Call) -> None:
    shown, found = call("robots"), call("robots", "--json").document("robots")
    assert {robot["name"]: robot["description"] for robot in found["robots"]} == robots().descriptions
    assert all(name in shown.out for name in robots().descriptions)


def test_init_writes_a_project_that_loads_and_never_overwrites(call: Call, tmp_path: Path) -> None:
    project = tmp_path / "gantry.toml"
    assert call("init", project).status == 0
    checked = call("check", project)
    assert (checked.status, checked.err) == (0, "")
    project.write_text("mine")
    again = call("init", project)
    assert (again.status, again.out) == (2, "")
    assert again.err.startswith(f"error: {project}: already exists")
    assert project.read_text() == "mine"


def test_init_without_a_name(call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert call("init").status == 0
    assert (tmp_path / "project.toml").read_text() == template()


def test_template_is_a_rich_example() -> None:
    arm = parse_project(template(), "template")
    assert (arm.m, arm.n, arm.k) == (1, 2, 2)
    assert fb.Plant(arm).at_tip([0.6, 0.2]).tip == pytest.approx([0.6, 0.2])
    schema = json.loads(schema_text())
    tables = ["robot", "base", "task", "control", *schema["$defs"]["BaseTable"]["properties"]]
    assert all(word in template() for word in [*schema["properties"], *tables])


def test_schema_in_the_docs_is_the_codes(call: Call, tmp_path: Path) -> None:
    written = tmp_path / "schema.json"
    assert call("init", "--schema", written).status == 0
    assert written.read_text() == SCHEMA.read_text(), "renew it: flexbase init --schema docs/flexbase.schema.json"
    assert list(tmp_path.iterdir()) == [written]
    assert call("init", "--schema", tmp_path / "schema.toml").status == 2


def test_schema_accepts_what_loads_and_refuses_what_does_not() -> None:
    schema = json.loads(schema_text())
    for text in (template(), *(path.read_text() for path in BUNDLED.glob("*.toml"))):
        jsonschema.validate(tomllib.loads(text), schema)
    for wrong in (template().replace("mass = 9.0", 'mass = "9 kg"'), template().replace("[task]", "[taks]")):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(tomllib.loads(wrong), schema)

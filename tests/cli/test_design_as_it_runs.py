"""`design` prints the hardware verdict beside the ideal one, declared or assumed."""

from __future__ import annotations

from pathlib import Path

import pytest

import flexbase as fb
from flexbase.model.sensing import Sensing
from flexbase.sampled.verdict import hardware_verdict
from flexbase.study.running.as_it_runs import as_it_runs
from flexbase.synthesis import controller_for
from systems.planar import PAPER

from .conftest import TIP, Call

AT = ("--tip", TIP, "--natural-frequency", "377.1029065")  # 100 rad/s up: the hardware method "exact"


@pytest.fixture
def declared(tmp_path: Path) -> Path:
    project = tmp_path / "arm.toml"
    project.write_text(PAPER + "\n[sensing]\nrate = 4000.0\n")
    return project


def test_assumed_where_nothing_is_declared(call: Call) -> None:
    """Stderr stays clean, the status 0; the verdict says that its loop is assumed."""
    shown = call("design", "ueda2003", *AT)
    assert (shown.status, shown.err) == (0, "")
    for words in ("stable here", "Unstable as it runs", "1000 Hz", "(assumed:", "flexbase compare compares"):
        assert words in shown.out
    assert max(map(len, shown.out.splitlines())) <= 80
    found = call("design", "ueda2003", *AT, "--json").document("design")["as_it_runs"]
    assert found["declared"] is False
    assert found["stable"] is False
    assert found["sensing"]["rate"] == 1000.0


def test_declared_loop_is_the_projects(call: Call, declared: Path, paper_pose: fb.Pose) -> None:
    found = call("design", declared, *AT, "--json").document("design")["as_it_runs"]
    assert found["declared"] is True
    expected = hardware_verdict(controller_for(paper_pose, "exact", Sensing(rate=4000.0)))
    assert found["spectral_radius"] == pytest.approx(expected.spectral_radius, rel=1e-6)
    assert found["disk_margin_torque"] == pytest.approx(expected.disk_margin_torque, rel=1e-3)
    assert "(assumed" not in call("design", declared, *AT).out


def test_options_stand_in_for_the_project(call: Call, declared: Path) -> None:
    slow = call("design", declared, *AT, "--rate", "1000", "--json").document("design")["as_it_runs"]
    assert (slow["sensing"]["rate"], slow["stable"]) == (1000.0, False)
    two = call("design", declared, *AT, "--task-rate", "2000", "--compute-delay", "0", "--json").document("design")
    assert (two["as_it_runs"]["sensing"]["task_every"], two["as_it_runs"]["sensing"]["compute_delay"]) == (2, 0)
    for words, said in (
        (("--rate", "-5"), "--rate: -5.0 must be above 0"),
        (("--task-rate", "300"), "--task-rate: 300 Hz does not divide the rate, 4000 Hz"),
        (("--task-rate", "2000", "--task-every", "2"), "Give one of them"),
        (("--acceleration", "gyro"), '--acceleration: "gyro" is unknown'),
        (("--torque-limit", "5"), "--torque_limit: 1 value given, 2 needed"),
    ):
        wrong = call("design", declared, *AT, *words)
        assert (wrong.status, wrong.out) == (2, "")
        assert said.replace("--torque_limit", "--torque-limit") in wrong.err


def test_without_gains_there_is_no_loop(paper_pose: fb.Pose) -> None:
    from dataclasses import replace

    bare = fb.Plant(replace(paper_pose.arm, gains=None)).at(paper_pose.q)
    assert as_it_runs(bare, fb.design(bare)) is None
    found = as_it_runs(paper_pose, fb.design(paper_pose))
    assert found is not None
    assert "assumed" in found.summary()

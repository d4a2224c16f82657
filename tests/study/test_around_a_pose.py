"""What a safe gain and a region make of judgements that are given."""

from __future__ import annotations

import inspect
from collections.abc import Callable

import numpy as np
import pytest

import flexbase as fb
from flexbase.errors import Infeasible
from flexbase.sampled.judged import robots_at
from flexbase.study.running import region as regions
from flexbase.study.running import safe_gain as gains
from flexbase.study.running.region import OUT_OF_REACH, SAFE, STABLE, UNSTABLE, Region, region


class Found:
    """A judged loop, as far as a search for gains looks."""

    def __init__(self, stable: bool, safe: bool) -> None:
        self.stable, self.safe = stable, safe

    def accepted(self) -> bool:
        return self.safe

    def figure(self, name: str) -> float:
        return {"tip_stiffness": 1234.0}[name]


def highest(pose: fb.Pose, monkeypatch: pytest.MonkeyPatch, judge: Callable[[float], Found | None]) -> fb.SafeGain:
    own = pose.arm.gains
    assert own is not None

    def judged(robots: object, method: str, scaled: fb.Gains) -> Found | None:
        scale = float(scaled.stiffness[0, 0] / own.stiffness[0, 0])
        assert scaled.damping[0, 0] == pytest.approx(np.sqrt(scale) * own.damping[0, 0])
        return judge(scale)

    monkeypatch.setattr(gains, "_judged", judged)
    return fb.safe_gain(pose, "none")


@pytest.mark.parametrize(("stable", "safe"), [(20.0, 5.0), (0.7, 0.7), (90.0, 0.002)])
def test_the_borders_are_found_to_four_percent(
    paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch, stable: float, safe: float
) -> None:
    found = highest(paper_pose, monkeypatch, lambda scale: Found(scale <= stable, scale <= safe))
    for value, border in ((found.stable, stable), (found.safe, safe)):
        assert value is not None
        assert border / 1.04 < value <= border
    assert (found.safe_stiffness, found.unsafe_below) == (1234.0, False)


def test_where_no_gain_is_safe_the_stable_one_is_told(paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch) -> None:
    found = highest(paper_pose, monkeypatch, lambda scale: Found(scale <= 5.0, False))
    assert found.stable == pytest.approx(5.0, rel=0.04)
    assert (found.safe, found.safe_stiffness, found.unsafe_below) == (None, None, False)
    found = highest(paper_pose, monkeypatch, lambda scale: None)
    assert (found.safe, found.stable) == (None, None)


def test_a_method_without_a_controller_has_no_gain_and_a_wrong_word_is_refused(
    paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch
) -> None:
    robots, own = robots_at(paper_pose, fb.Sensing()), paper_pose.arm.gains
    assert own is not None

    def refuse(*_: object, **__: object) -> None:
        raise Infeasible("none there")

    monkeypatch.setattr(gains, "controller_for", refuse)
    assert gains._judged(robots, "exact", own) is None
    with pytest.raises(fb.InputError, match='method: "nose" is unknown'):
        gains._judged(robots, "nose", own)


def test_a_window_has_two_rows_and_cells_on_both(paper_pose: fb.Pose) -> None:
    for shape in ((1, 5), (5, 1), (3,), (3, 3, 3)):
        with pytest.raises(fb.InputError, match="two rows and 2 cells or more are needed"):
            region(paper_pose, "none", shape=shape)
    usual = inspect.signature(region).parameters
    assert (usual["half_width"].default, usual["shape"].default) == (0.15, (25, 25))


def test_a_pose_is_found_again_on_its_own_branch(paper: fb.Plant) -> None:
    """Near the stretched arm both branches are 5 mrad apart, and still two."""
    for elbow, branch in ((0.0025, "+"), (-0.0025, "-"), (1.0, "+"), (-1.0, "-")):
        assert regions._branch(paper.at([0.3, elbow])) == branch


def test_the_radius_is_the_nearest_worse_cell() -> None:
    """Cells out of reach do not count; without a worse one it is the half-width, and never more."""
    distance = np.array([0.0, 0.1, 0.2, 0.3])
    for grades, code, radius in (
        ([SAFE, OUT_OF_REACH, STABLE, UNSTABLE], SAFE, 0.2),
        ([SAFE, OUT_OF_REACH, STABLE, UNSTABLE], STABLE, 0.25),
        ([SAFE, UNSTABLE, SAFE, SAFE], STABLE, 0.1),
        ([SAFE, SAFE, SAFE, OUT_OF_REACH], SAFE, 0.25),
    ):
        assert regions._radius(distance, np.array(grades, dtype=np.int8), code, 0.25) == radius


def test_shares_are_of_the_reached_cells() -> None:
    grade = np.array([[0, 1, 2], [3, 3, 2]], dtype=np.int8)
    found = Region(
        "robot", "exact", "E", ("x", "y"), ("m", "m"), np.arange(3.0), np.arange(2.0), grade, (0, 0), None, 0.1
    )
    assert "in 40 % of the reached cells, not at the design tip" in found.summary()
    assert "in 80 % of the reached cells, in all of them within 0.100 m of the design tip" in found.summary()
    assert "Not safe at the design tip" in found.summary()


def test_a_design_that_is_not_safe_has_no_radius(paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch) -> None:
    """The window's grades as given: here stable only, and so is every cell."""
    monkeypatch.setattr(regions.Grade, "__call__", lambda *_: (0, (STABLE,)))
    found = region(paper_pose, "none", half_width=0.01, shape=(2, 3))
    assert found.grade.tolist() == [[STABLE] * 2] * 3
    assert (found.safe_radius, found.stable_radius) == (None, 0.01)
    monkeypatch.setattr(regions.Grade, "__call__", lambda *_: (0, (SAFE,)))
    found = region(paper_pose, "none", half_width=0.01, shape=(2, 3))
    assert (found.safe_radius, found.stable_radius) == (0.01, 0.01)
    assert found.x.tolist() == pytest.approx([paper_pose.tip[0] - 0.01, paper_pose.tip[0] + 0.01])
    assert found.y.tolist() == pytest.approx([paper_pose.tip[1] - 0.01, paper_pose.tip[1], paper_pose.tip[1] + 0.01])
    assert found.what == "E"


@pytest.mark.parametrize(("method", "what"), [(None, "E"), ("exact", "E"), ("lqg", "controller")])
def test_what_stays_constant(
    paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch, method: str | None, what: str
) -> None:
    monkeypatch.setattr(regions.Grade, "__call__", lambda *_: (0, (STABLE,)))
    assert region(paper_pose, method, half_width=0.01, shape=(2, 2)).what == what

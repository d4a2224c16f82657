"""E designed through the sampled loop: its slopes, its descent, and what it reaches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize

import flexbase as fb
from flexbase.errors import InputError
from flexbase.linear.discrete.affine_loop import AffineLoop
from flexbase.linear.discrete.disk_margin import disk_margin
from flexbase.linear.discrete.system import series, static
from flexbase.model.sensing import Sensing
from flexbase.sampled.closed import close_loop, sensitivities
from flexbase.sampled.controller import SampledController
from flexbase.sampled.verdict import hardware_verdict
from flexbase.study.random_poses import random_poses
from flexbase.synthesis import controller_for
from flexbase.synthesis.methods.sampled import SCALES, SampledProblem, signals
from flexbase.synthesis.search.minimax import Landscape, descend

FAST = Sensing(rate=4000.0)
ALL_BUT_MATRICES = ("E", *SCALES)
CASES = {
    "accelerometer": FAST,
    "encoders": replace(FAST, acceleration="encoders"),
    "kalman": replace(FAST, acceleration="kalman"),
    "slower task sensor": replace(FAST, rate=8000.0, task_every=4),
    "no delays": replace(FAST, compute_delay=0, task_delay=0),
}
X = np.array([-0.03, -0.22, -0.08, 0.1, -0.1, 0.2])


def problem(pose: fb.Pose, sensing: Sensing) -> SampledProblem:
    assert pose.arm.gains is not None
    return SampledProblem(pose, sensing, pose.arm.gains, ALL_BUT_MATRICES)


@pytest.mark.parametrize("case", CASES)
def test_the_problems_loop_is_the_loop(case: str, paper_pose: fb.Pose) -> None:
    """Poles and margins of the affine form are those of the controller that it stands for."""
    here, sensing = problem(paper_pose, CASES[case]), CASES[case]
    theta = here.theta(X)
    plain = SampledController(
        "", paper_pose, sensing, series(signals(paper_pose, sensing), static(theta, sensing.step))
    )
    made = here.controller(descend(here.look, X, most=1), 1)
    radius = here.loop.poles(theta)[0].value
    assert close_loop(paper_pose, plain).radius == pytest.approx(radius, rel=1e-9)
    assert close_loop(paper_pose, made).radius == pytest.approx(radius, rel=1e-9)
    if radius < 1.0:
        margins = [piece.value for piece in here.loop.margins(theta)]
        expected = min(disk_margin(one).alpha for one in sensitivities(paper_pose, made))
        assert min(margins) == pytest.approx(expected, rel=2e-2)  # two grids: at, and between, the peaks


@pytest.mark.parametrize("case", CASES)
def test_slopes_of_poles_are_their_differences(case: str, paper_pose: fb.Pose) -> None:
    """Central differences to 1e-5: eigenvalues are simple."""
    here = problem(paper_pose, CASES[case])
    slopes = [np.tensordot(here.units, piece.slope, 2) for piece in here.loop.poles(here.theta(X))]
    for i, step in enumerate(1e-6 * np.eye(len(X))):
        ahead, back = (here.loop.poles(here.theta(X + sign * step)) for sign in (1.0, -1.0))
        assert (ahead[0].value - back[0].value) / 2e-6 == pytest.approx(slopes[0][i], rel=1e-4, abs=1e-7)


def test_slopes_of_margins(paper_pose: fb.Pose, monkeypatch: pytest.MonkeyPatch) -> None:
    """Against differences at the same frequencies, to 2e-3 of the largest: what is left of the scalings' own slope."""
    here = SampledProblem(paper_pose, FAST, paper_pose.arm.gains)  # type: ignore[arg-type]
    x = descend(here.look, here.starts()[0]).x + 0.01
    turning = here.loop._frequencies(here.theta(x))
    monkeypatch.setattr(AffineLoop, "_frequencies", lambda loop, theta: turning)
    values, slopes = here.look(x).groups[0]
    top = int(np.argmax(values))
    found = []
    for step in 1e-6 * np.eye(len(x)):
        ahead, back = (here.look(x + sign * step).groups[0][0].max() for sign in (1.0, -1.0))
        found.append((ahead - back) / 2e-6)
    np.testing.assert_allclose(found, slopes[top], rtol=0.0, atol=2e-3 * np.abs(slopes[top]).max())


def test_descent_on_a_known_minimax() -> None:
    """max(|x - a|) + max(|y|, y^2...) : the minimum of a polyhedral function is reached to 1e-6, and never rises."""
    a = np.array([0.7, -1.9, 3.1])
    values = []

    def look(x: np.ndarray) -> Landscape:
        gap = x - a
        group = np.concatenate([gap, -gap]), np.vstack([np.eye(3), -np.eye(3)])
        bowl = np.array([gap @ gap]), 2.0 * gap[None]
        values.append(float(np.abs(gap).max() + gap @ gap))
        return Landscape(values[-1], (group, bowl))

    found = descend(look, np.zeros(3), most=200)
    assert found.value < 1e-3
    assert found.looks == len(values) < 200


def test_as_good_as_nelder_mead_with_half_the_looks(paper: fb.Plant) -> None:
    """[theory §10]'s way: from no E and 0.4 times the ideal design, at most 160 looks a start; means of 4 poses."""
    ours, theirs, looks, others = [], [], 0, 0
    for pose in random_poses(paper, 4, seed=1):
        here = SampledProblem(pose, FAST, paper.arm.gains)  # type: ignore[arg-type]
        found = [descend(here.look, start) for start in here.starts()]
        other = [
            minimize(lambda x: here.look(x).value, start, method="Nelder-Mead", options={"maxfev": 160})  # noqa: B023
            for start in here.starts()[:2]
        ]
        ours.append(min(one.value for one in found))
        theirs.append(min(float(one.fun) for one in other))
        looks += sum(one.looks for one in found)
        others += sum(one.nfev for one in other)
    assert np.mean(ours) <= np.mean(theirs) + 5e-3
    assert looks < 0.6 * others


@pytest.mark.parametrize("acceleration", ["accelerometer", "encoders"])
def test_runs_where_the_ideal_designs_do_not(acceleration: str, paper_pose: fb.Pose) -> None:
    """At 4 kHz and the paper's gains, in its pose: no E is unstable, the ideal E has no margin."""
    sensing = replace(FAST, acceleration=acceleration)
    verdict = hardware_verdict(controller_for(paper_pose, "sampled", sensing))
    assert verdict.stable
    assert verdict.survives
    assert min(verdict.disk_margin_torque, verdict.disk_margin_sensor) > 0.25
    assert verdict.tip_stiffness == pytest.approx(1e5, rel=1e-6)
    for name in ("none", "exact"):
        other = hardware_verdict(controller_for(paper_pose, name, sensing))
        assert min(other.disk_margin_torque, other.disk_margin_sensor) < 0.1


def test_free_gains_keep_their_bounds(paper_pose: fb.Pose) -> None:
    controller = controller_for(paper_pose, "sampled", Sensing(), free=ALL_BUT_MATRICES, softest=0.5)
    verdict = hardware_verdict(controller, changes=())
    assert verdict.stable
    assert controller.notes["stiffness_scale"] >= 0.5
    assert verdict.tip_stiffness is not None
    assert verdict.tip_stiffness >= 0.5e5 * (1.0 - 1e-9)
    with pytest.raises(InputError, match=r'free: "gain" is unknown'):
        controller_for(paper_pose, "sampled", free=("gain",))


def test_several_base_joints() -> None:
    """Three base joints, six arm joints, three rows: starts from the bounded design; task PD alone is unstable."""
    pose = fb.load("ur5e-platform").at([0.3, -1.2, 1.5, -0.8, 0.4, 0.2])
    sensing = Sensing(rate=2000.0)
    gains = fb.Gains(3e4 * np.eye(pose.arm.k), 600.0 * np.eye(pose.arm.k))
    here = SampledProblem(pose, sensing, gains)
    alone = controller_for(pose, "none", sensing, gains)
    made = here.controller(descend(here.look, here.starts()[0], most=25), 1)
    assert here.loop.poles(here.theta(np.zeros(21)))[0].value == pytest.approx(close_loop(pose, alone).radius, rel=1e-9)
    assert close_loop(pose, alone).radius > 1.1
    assert close_loop(pose, made).radius < 1.0
    assert min(disk_margin(side).alpha for side in sensitivities(pose, made)) > 0.03


def test_constant_gains_hold_the_arm_at_one_kilohertz(paper_pose: fb.Pose) -> None:
    """Encoders alone, one sample of delay: no E is unstable, and constant matrices have margin on both sides."""
    sensing = Sensing(acceleration="encoders")
    controller = controller_for(paper_pose, "constant", sensing)
    verdict = hardware_verdict(controller)
    assert verdict.stable
    assert verdict.survives
    assert verdict.has_margin
    assert controller.notes["accepted"]
    assert verdict.tip_stiffness == pytest.approx(1e5 * controller.notes["scale"], rel=1e-6)
    assert controller.notes["scale"] >= 0.25
    assert not hardware_verdict(controller_for(paper_pose, "none", sensing), changes=()).stable


def test_slopes_by_single_entries(paper_pose: fb.Pose) -> None:
    """Radius by every unknown of the full problem, to 1e-4."""
    here = SampledProblem(paper_pose, Sensing(), paper_pose.arm.gains, ("E", *SCALES, "matrices"))  # type: ignore[arg-type]
    x = 0.1 * np.random.default_rng(2).standard_normal(len(here.units))
    slopes = np.tensordot(here.units, here.loop.poles(here.theta(x))[0].slope, 2)
    for i, step in enumerate(1e-6 * np.eye(len(x))):
        ahead, back = (here.loop.poles(here.theta(x + sign * step))[0].value for sign in (1.0, -1.0))
        assert (ahead - back) / 2e-6 == pytest.approx(slopes[i], rel=1e-3, abs=1e-6)

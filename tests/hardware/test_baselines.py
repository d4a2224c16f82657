"""Baselines and the base-deflection form, each against what defines it."""

from __future__ import annotations

import control
import numpy as np
import pytest

import flexbase as fb
from flexbase.errors import Infeasible, InputError
from flexbase.linear.discrete.disk_margin import disk_margin
from flexbase.linear.discrete.system import feedback
from flexbase.model.sensing import Sensing
from flexbase.sampled.closed import close_loop, sensitivities
from flexbase.synthesis import controller_for
from flexbase.synthesis.methods.deflection import base_deflection, search, with_deflection
from flexbase.synthesis.methods.lqg import observer, regulator
from flexbase.synthesis.methods.notch import DEPTH, notch_filter
from flexbase.synthesis.methods.sampled import UNSTABLE
from flexbase.synthesis.search.shaping import design_plant, task_shape
from systems.random_plants import random_pose


def test_lqg_gains_are_python_controls(paper_pose: fb.Pose) -> None:
    """K of dlqr and L of dlqe (its L is for the prediction: A L here), rel 1e-7: two Riccati solvers."""
    assert paper_pose.arm.gains is not None
    plant = task_shape(paper_pose, paper_pose.arm.gains, 1.0, 0.5).around(design_plant(paper_pose, Sensing()))
    Q, R, V = plant.C.T @ plant.C, np.eye(2), 0.01 * np.eye(len(plant.C))
    found = regulator(plant, Q, R, V)
    theirs_K = np.asarray(control.dlqr(plant.A, plant.B, Q, R)[0])
    theirs_L = np.asarray(control.dlqe(plant.A, plant.B, plant.C, np.eye(2), V)[0])
    for ours, theirs in ((found.K, theirs_K), (plant.A @ found.L, theirs_L)):
        assert ours == pytest.approx(theirs, rel=1e-7, abs=1e-9 * np.abs(theirs).max())


def test_lqg_poles_separate(paper_pose: fb.Pose) -> None:
    """The closed loop has the poles of A - B K and of (I - L C) A, and no others (1e-6: poles meet in pairs)."""
    assert paper_pose.arm.gains is not None
    plant = task_shape(paper_pose, paper_pose.arm.gains, 1.0, 0.5).around(design_plant(paper_pose, Sensing()))
    found = regulator(plant, plant.C.T @ plant.C, np.eye(2), np.eye(len(plant.C)))
    closed = np.poly(np.linalg.eigvals(feedback(plant, observer(plant, found)).A))
    eye = np.eye(plant.order)
    apart = np.concatenate(
        [
            np.linalg.eigvals(plant.A - plant.B @ found.K),
            np.linalg.eigvals((eye - found.L @ plant.C) @ plant.A),
        ]
    )
    assert closed == pytest.approx(np.poly(apart), abs=1e-6 * np.abs(closed).max())


def test_notch_leaves_a_tenth_at_its_frequency() -> None:
    """Gain DEPTH at the mode, 1 at rest and at Nyquist's frequency, all exact by prewarping."""
    one = notch_filter(277.1, 0.7, 1e-3)
    gain = np.abs(one.transfer_function(np.array([1e-6, 277.1, np.pi / 1e-3]))[:, 0, 0])
    assert gain == pytest.approx([1.0, DEPTH, 1.0], abs=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_deflection_identity(seed: int) -> None:
    """tau of the acceleration-free form equals tau~ + E q_a'' at random states: the equation of motion, solved."""
    m = 1 + seed % 2
    pose = random_pose(seed, m, 3, 3)
    rng = np.random.default_rng(seed)
    E = rng.normal(size=(3, 3))
    E = 0.3 * np.linalg.eigvalsh(pose.M[m:, m:])[0] * (E + E.T) / np.linalg.norm(E + E.T, 2)
    q, rates, law = rng.normal(size=m + 3), rng.normal(size=m + 3), rng.normal(size=3)
    changed = pose.M.copy()
    changed[m:, m:] -= E
    pull = -(pose.K @ q + pose.D @ rates)
    pull[m:] = 0.0  # springs and dampers of the base alone
    acceleration = np.linalg.solve(changed, pull + np.concatenate([np.zeros(m), law]))
    expected = law + E @ acceleration[m:]
    felt = E @ np.linalg.inv(pose.Ms)
    Kp, Dp = pose.K[:m, :m], pose.D[:m, :m]
    base = felt @ pose.M[m:, :m] @ np.linalg.solve(pose.M[:m, :m], Kp @ q[:m] + Dp @ rates[:m])
    assert np.linalg.solve(np.eye(3) - felt, law + base) == pytest.approx(expected, rel=1e-9)
    controller = with_deflection(pose, Sensing(), unit_gains(3), E)
    still = controller.system.static_gain()[:, :6] @ np.concatenate([pose.J @ q, q[m:]])  # at rest, rates are 0
    law = -pose.J[:, m:].T @ (pose.J @ q)
    base = felt @ pose.M[m:, :m] @ np.linalg.solve(pose.M[:m, :m], Kp @ q[:m])
    assert still == pytest.approx(np.linalg.solve(np.eye(3) - felt, law + base), rel=1e-8)


def unit_gains(k: int) -> fb.model.task.Gains:
    return fb.model.task.Gains(np.eye(k), np.eye(k))


def test_base_deflection_is_seen_in_time(paper_pose: fb.Pose) -> None:
    """A base that moves at a constant rate: q_p as it was one sample ago (the tip's delay), and its rate exactly."""
    sensing = Sensing()
    seen, rate, h = base_deflection(paper_pose, sensing), 0.3, sensing.step
    x, arm_rate = np.zeros(seen.order), np.array([0.2, -0.1])
    for sample in range(30):
        t = sample * h
        base = rate * (t - h)  # the tip error is one sample late
        e = paper_pose.J @ np.concatenate([[base], arm_rate * (t - h)])
        y = np.concatenate([e, arm_rate * t, np.zeros(2)])
        out, x = seen.C @ x + seen.D @ y, seen.A @ x + seen.B @ y
    assert out == pytest.approx([base, rate], rel=1e-9)


def test_the_search_looks_at_the_loop_itself(paper_pose: fb.Pose) -> None:
    """Radius and slopes by E's entries, at an unstable E: those of the loop closed by the controller, to 1e-4."""
    sensing, gains = Sensing(), paper_pose.arm.gains
    assert gains is not None
    look, basis = search(paper_pose, sensing, gains)
    x = np.array([-0.4, 0.1, -0.3])

    def radius(at: np.ndarray) -> float:
        E = np.tensordot(at, basis, 1)
        return close_loop(paper_pose, with_deflection(paper_pose, sensing, gains, E)).radius

    here = look(x)
    values, slopes = here.groups[0]
    assert radius(x) > 1.0
    assert values[0] == pytest.approx(radius(x), rel=1e-9)
    assert here.value == pytest.approx(UNSTABLE + radius(x), rel=1e-9)
    differences = [(radius(x + step) - radius(x - step)) / 2e-6 for step in 1e-6 * np.eye(len(x))]
    assert slopes[0] == pytest.approx(differences, rel=1e-4, abs=1e-6)


def test_the_search_ends_better_than_it_starts(paper_pose: fb.Pose) -> None:
    """At 4 kHz: a disk margin above that of no E, which is stable there."""
    sensing, gains = Sensing(rate=4000.0), paper_pose.arm.gains
    assert gains is not None
    plain = with_deflection(paper_pose, sensing, gains, np.zeros((2, 2)))
    found = controller_for(paper_pose, "deflection", sensing)
    before, after = (min(disk_margin(one).alpha for one in sensitivities(paper_pose, by)) for by in (plain, found))
    assert after > 1.2 * before


def test_deflection_refuses_what_the_tip_does_not_show() -> None:
    """Three base joints and two task rows: says so. A gain of the wrong shape, too."""
    with pytest.raises(Infeasible, match="do not show"):
        controller_for(random_pose(0, 3, 3, 2), "deflection", Sensing(), unit_gains(2))
    with pytest.raises(InputError, match="shape"):
        controller_for(random_pose(0, 1, 2, 2), "deflection", Sensing(), unit_gains(2), E=np.eye(3))


def test_viscous_never_does_worse_than_none(paper_pose: fb.Pose) -> None:
    """At 4 kHz: no damping is among those tried, so the smaller margin does not shrink where neither is accepted."""
    from flexbase.sampled.verdict import hardware_verdict

    fast = Sensing(rate=4000.0)
    plain, damped = (hardware_verdict(controller_for(paper_pose, name, fast)) for name in ("none", "viscous"))
    assert damped.stable
    if not (plain.survives and plain.has_margin):
        before = min(plain.disk_margin_torque, plain.disk_margin_sensor)
        assert damped.survives or min(damped.disk_margin_torque, damped.disk_margin_sensor) >= before - 1e-9

"""Margins of the loop as it runs, each against the disturbed loop itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.linear.discrete.disk_margin import disk_margin, structured_norm
from flexbase.linear.discrete.loop_margins import delay_margin
from flexbase.linear.discrete.system import Discrete, delay, parallel, series, static
from flexbase.model.sensing import Sensing
from flexbase.sampled.changes import Changed, changed_pose
from flexbase.sampled.closed import (
    close_loop,
    dynamic_stiffness,
    loop_gain,
    sensitivities,
    tip_correction,
    tip_stiffness,
)
from flexbase.sampled.controller import SampledController, joint_damping, pd_with_gain
from flexbase.sampled.plant import sampled_plant
from flexbase.sampled.verdict import hardware_verdict
from flexbase.synthesis import controller_for

FAST = Sensing(rate=4000.0)


@pytest.fixture(scope="module")
def loop(paper_pose: fb.Pose) -> SampledController:
    """The exact compensator at 4 kHz: stable, with little margin."""
    E = fb.design(paper_pose, method="exact", natural_frequency=346.8).E
    assert paper_pose.arm.gains is not None
    return pd_with_gain(paper_pose, FAST, paper_pose.arm.gains, E, "exact")


def radius_with(controller: SampledController, at_torque: Discrete) -> float:
    changed = replace(controller, system=series(controller.system, at_torque))
    return close_loop(controller.pose, changed).radius


def test_rigid_arm_at_one_kilohertz(paper: fb.Plant) -> None:
    """The paper's gains on a rigid base: spectral radius 1.166 with one sample of delay on both sides.  [theory §10]"""
    stiff = replace(paper.arm, base=replace(paper.arm.base, stiffness=1e9 * paper.arm.base.stiffness))
    pose = fb.Plant(stiff).at(paper.at_tip([0.33, -0.25]).q[1:])
    assert paper.arm.gains is not None
    controller = pd_with_gain(pose, Sensing(), paper.arm.gains, None, "none")
    assert close_loop(pose, controller).radius == pytest.approx(1.166, abs=5e-4)


def test_delay_margin_is_where_the_delayed_loop_turns(loop: SampledController) -> None:
    """Stable with 0.99 of it, unstable with 1.01: the loop resampled so finely that the delay is whole samples."""
    margin = delay_margin(loop_gain(loop.pose, loop))
    samples = margin / FAST.step
    assert 1.0 < samples < 4.0
    for whole in range(5):
        assert (radius_with(loop, delay(2, whole, FAST.step)) < 1.0) == (whole < samples)


def test_disk_margin_is_a_promise_and_nearly_tight(loop: SampledController) -> None:
    """Gains inside the disk never destabilise; at its border some gains and phases put a pole on the circle."""
    alpha, omega = disk_margin(sensitivities(loop.pose, loop)[0])
    low, high = (2.0 - alpha) / (2.0 + alpha), (2.0 + alpha) / (2.0 - alpha)
    for gains in np.random.default_rng(0).uniform(low, high, (200, 2)):
        assert radius_with(loop, static(np.diag(gains), FAST.step)) < 1.0
    L = loop_gain(loop.pose, loop)
    delta = np.linspace(-np.pi, np.pi, 181)
    one, other = np.meshgrid(np.exp(1j * delta), np.exp(1j * delta))
    Lw = L.transfer_function(np.array([omega]))[0]

    def smallest_gap(size: float) -> float:
        g = [(1.0 + size * z / 2.0) / (1.0 - size * z / 2.0) for z in (one, other)]
        det = (1.0 - Lw[0, 0] * g[0]) * (1.0 - Lw[1, 1] * g[1]) - Lw[0, 1] * g[1] * Lw[1, 0] * g[0]
        return float(np.abs(det).min())

    assert smallest_gap(alpha) < 0.1 * smallest_gap(0.7 * alpha)


def test_structured_norm_bounds() -> None:
    """Between the spectral radius and the norm; nearly unchanged by scaled channels; equal to it when diagonal."""
    rng = np.random.default_rng(1)
    T = rng.normal(size=(30, 3, 3)) + 1j * rng.normal(size=(30, 3, 3))
    size = structured_norm(T)
    assert np.all(size <= np.linalg.norm(T, 2, axis=(1, 2)) + 1e-12)
    assert np.all(size >= np.abs(np.linalg.eigvals(T)).max(axis=1) - 1e-12)
    scaling = np.diag([1.0, 1e3, 1e-2])
    assert structured_norm(scaling @ T @ np.linalg.inv(scaling)) == pytest.approx(size, rel=5e-2)
    diagonal = np.diag([1.0, -3.0, 2.0])[None].astype(complex)
    assert structured_norm(diagonal) == pytest.approx([3.0])


def test_tip_stiffness_is_what_a_push_shows(loop: SampledController) -> None:
    """A constant force at the tip, the sampled loop run until it rests: displacement over force, to 1e-6."""
    pose, n, k = loop.pose, 2, 2
    plant, force = sampled_plant(pose, FAST), np.array([3.0, -1.0])
    x, c, tau = np.zeros(plant.order), np.zeros(loop.system.order), np.zeros(n)
    for _ in range(8000):
        u = np.concatenate([tau, force])
        y = plant.C @ x + plant.D @ u
        seen = y[: k + 2 * n]
        tau = loop.system.C @ c + loop.system.D @ seen
        u = np.concatenate([tau, force])
        c = loop.system.A @ c + loop.system.B @ seen
        x = plant.A @ x + plant.B @ u
    moved = (plant.C @ x + plant.D @ u)[k + 2 * n :]
    assert np.linalg.norm(force) / np.linalg.norm(moved) >= tip_stiffness(pose, loop) * (1.0 - 1e-6)
    assert tip_stiffness(pose, loop) == pytest.approx(1e5, rel=1e-6)  # Kp: the task error is what the law stiffens


def test_changes_change_the_robot(paper_pose: fb.Pose) -> None:
    softer = changed_pose(paper_pose, Changed("", base_stiffness=0.8))
    assert fb.modes(softer)[0].frequency == pytest.approx(np.sqrt(0.8) * fb.modes(paper_pose)[0].frequency, rel=1e-12)
    heavier = changed_pose(paper_pose, Changed("", last_link=1.1))
    assert heavier.M[2, 2] == pytest.approx(1.1 * paper_pose.M[2, 2], rel=1e-12)
    turned = changed_pose(paper_pose, Changed("", joints=((1, 0.1),)))
    assert turned.q == pytest.approx(paper_pose.q + np.array([0.0, 0.0, 0.1]))


def test_verdict(loop: SampledController, paper_pose: fb.Pose) -> None:
    verdict = hardware_verdict(loop)
    assert verdict.stable
    assert verdict.algebraic_loop_radius == pytest.approx(0.72298, abs=1e-5)
    assert verdict.algebraic_loop_radius_per_joint == pytest.approx(0.93188, abs=1e-5)
    assert not verdict.has_margin
    assert len(verdict.to_dict()) == 17
    slow = replace(
        loop, sensing=Sensing(), system=Discrete(loop.system.A, loop.system.B, loop.system.C, loop.system.D, 1e-3)
    )
    assert hardware_verdict(slow, changes=()).to_dict()["spectral_radius"] > 1.0


def test_correction_is_what_a_late_run_shows(paper_pose: fb.Pose) -> None:
    """A task sensor that is off by a constant: where the tip comes to rest, by 20,000 samples of the linear loop."""
    controller = controller_for(paper_pose, "coprime", Sensing())
    plant, law = sampled_plant(paper_pose, controller.sensing), controller.system
    drive, offset = plant.select(list(range(8)), [0, 1]), np.array([1e-3, 0.0, 0.0, 0.0, 0.0, 0.0])
    shares = []
    for direction in (offset, np.roll(offset, 1)):
        x, c = np.zeros(drive.order), np.zeros(law.order)
        for _ in range(20_000):
            seen = drive.C[:6] @ x + direction
            tau = law.C @ c + law.D @ seen
            c, x = law.A @ c + law.B @ seen, drive.A @ x + drive.B @ tau
        shares.append(-drive.C[6:] @ x / 1e-3)
    left = np.eye(2) - np.array(shares).T
    assert tip_correction(paper_pose, controller) == pytest.approx(1.0 - np.linalg.norm(left, 2), rel=1e-6)


def test_task_pd_corrects_all_of_a_tip_error(loop: SampledController) -> None:
    """And a controller that hears the joints alone, nothing."""
    assert tip_correction(loop.pose, loop) == pytest.approx(1.0, abs=1e-9)
    deaf = loop.system.B.copy(), loop.system.D.copy()
    for part in deaf:
        part[:, :2] = 0.0
    joints = replace(loop, system=replace(loop.system, B=deaf[0], D=deaf[1]))
    held = replace(joints, system=parallel(joints.system, joint_damping(loop.pose, FAST, np.eye(2), 100.0 * np.eye(2))))
    assert tip_correction(loop.pose, held) == 0.0


def test_dynamic_stiffness_is_where_a_force_moves_the_tip_most(paper_pose: fb.Pose) -> None:
    """Forces of 40 frequencies and 7 directions, 2,000 samples: none moves it more than promised, some within 10 %."""
    controller = controller_for(paper_pose, "robust", Sensing())
    promised = dynamic_stiffness(paper_pose, controller)
    assert promised < 0.5 * tip_stiffness(paper_pose, controller)
    plant, law = sampled_plant(paper_pose, controller.sensing), controller.system
    omega, angle = (grid.ravel() for grid in np.meshgrid(np.geomspace(20.0, 500.0, 40), np.linspace(0.0, np.pi, 7)))
    x, c = np.zeros((plant.order, omega.size), dtype=complex), np.zeros((law.order, omega.size), dtype=complex)
    for sample in range(2_000):
        seen = plant.C @ x
        force = np.exp(1j * omega * 1e-3 * sample) * np.stack([np.cos(angle), np.sin(angle)])
        tau = law.C @ c + law.D @ seen[:6]
        x, c = plant.A @ x + plant.B @ np.vstack([tau, force]), law.A @ c + law.B @ seen[:6]
    largest = float(np.linalg.norm(seen[6:], axis=0).max())
    assert 0.9 / promised < largest <= 1.001 / promised


def test_dynamic_stiffness_with_a_slow_task_sensor(paper_pose: fb.Pose) -> None:
    """The same in root mean squares, a value held for 12 samples: no sinusoid moves the tip more, one within 35 %.

    The loop scatters a frequency into twelve, and the worst force is a mixture of them; the mean delay of the hold
    would promise three times this stiffness.
    """
    slow = replace(controller_for(paper_pose, "constant", Sensing()), sensing=Sensing(task_every=12))
    assert close_loop(paper_pose, slow).radius < 1.0
    promised = dynamic_stiffness(paper_pose, slow)
    plant, law = sampled_plant(paper_pose, slow.sensing), slow.system
    omega = np.repeat(np.geomspace(5.0, 500.0, 200), 4)
    angle = np.tile(np.linspace(0.0, 0.75 * np.pi, 4), 200)
    x, c = np.zeros((plant.order, omega.size), dtype=complex), np.zeros((law.order, omega.size), dtype=complex)
    held, power = np.zeros((2, omega.size), dtype=complex), np.zeros(omega.size)
    for sample in range(6_000):
        seen = plant.C @ x
        held = seen[:2] if sample % 12 == 0 else held
        force = np.exp(1j * omega * 1e-3 * sample) * np.stack([np.cos(angle), np.sin(angle)])
        read = np.vstack([held, seen[2:6]])
        tau = law.C @ c + law.D @ read
        x, c = plant.A @ x + plant.B @ np.vstack([tau, force]), law.A @ c + law.B @ read
        power += (sample >= 4_800) * (np.abs(seen[6:]) ** 2).sum(axis=0) / 1_200
    largest = float(np.sqrt(power.max()))
    assert 0.65 / promised < largest <= 1.01 / promised


def test_an_error_that_grows_counts_below_zero(loop: SampledController) -> None:
    """Joint springs that push away with 0.6 of the task stiffness: an error is answered 2.5 times, 1.5 is left."""
    n, Jv, gains = loop.pose.arm.n, loop.pose.J[:, loop.pose.arm.m :], loop.pose.arm.gains
    assert gains is not None
    away = joint_damping(loop.pose, FAST, np.zeros((n, n)), -0.6 * Jv.T @ gains.stiffness @ Jv)
    both = replace(loop, system=parallel(loop.system, away))
    assert tip_correction(loop.pose, both) == pytest.approx(-0.5, abs=1e-9)

"""Loop shaping by normalised coprime factors: the bound, the frequency sweep, theory §10's figures, reduction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import cont2discrete

import flexbase as fb
from flexbase.errors import Infeasible
from flexbase.linear.discrete.coprime import coprime_controller
from flexbase.linear.discrete.disk_margin import grid_of
from flexbase.linear.discrete.system import Discrete, feedback, spectral_radius
from flexbase.linear.discrete.tustin import balanced_truncation, to_continuous, to_discrete
from flexbase.model.sensing import Sensing
from flexbase.sampled.closed import close_loop
from flexbase.sampled.verdict import hardware_verdict
from flexbase.synthesis import controller_for
from flexbase.synthesis.methods.coprime import coprime_at
from flexbase.synthesis.search.shaping import design_plant, task_shape


def coprime_margin(plant: Discrete, controller: Discrete) -> float:
    """b = 1 / max over frequency of |[K; I] (I - P K)^-1 [I, P]|, by a sweep of the closed loop; 0 if it is unstable.

    Assumes u = K y. Taken on the grid of `disk_margin`: an upper bound, short of the truth by the grid alone.
    """
    loop = feedback(plant, controller)
    if float(np.abs(np.linalg.eigvals(loop.A)).max(initial=0.0)) >= 1.0:
        return 0.0
    frequencies = grid_of(loop)
    P, K = plant.transfer_function(frequencies), controller.transfer_function(frequencies)
    return float(1.0 / _four_blocks(P, K).max())


def _four_blocks(P: np.ndarray, K: np.ndarray) -> np.ndarray:
    eye = np.eye(P.shape[1])
    loop = np.linalg.inv(eye - P @ K)  # regular: a stable loop has no pole on the unit circle
    left = np.concatenate([K, np.broadcast_to(eye, (len(P), *eye.shape))], axis=1)
    right = np.concatenate([np.broadcast_to(eye, (len(P), *eye.shape)), P], axis=2)
    return np.asarray(np.linalg.norm(left @ loop @ right, 2, axis=(1, 2)))


def random_plant(seed: int, states: int = 5, inputs: int = 2, outputs: int = 3) -> Discrete:
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(states, states))
    A *= 1.05 / np.abs(np.linalg.eigvals(A)).max()  # slightly unstable
    return Discrete(
        A, rng.normal(size=(states, inputs)), rng.normal(size=(outputs, states)), np.zeros((outputs, inputs)), 0.01
    )


@pytest.mark.parametrize("seed", range(12))
def test_bilinear_map_is_scipys_and_returns(seed: int) -> None:
    """Against scipy's bilinear discretisation at h = 2, and back to the bit but rounding (1e-11, poles not near -1)."""
    plant = random_plant(seed)
    continuous = to_continuous(plant)
    theirs = cont2discrete(tuple(continuous), 2.0, method="bilinear")
    omega = np.array([0.01, 1.0, 30.0, 200.0])
    mine = plant.transfer_function(omega)
    assert Discrete(*theirs[:4], 0.01).transfer_function(omega) == pytest.approx(mine, rel=1e-8, abs=1e-8)
    back = to_discrete(continuous, plant.step)
    for name in "ABCD":
        assert getattr(back, name) == pytest.approx(getattr(plant, name), abs=1e-9)


@pytest.mark.parametrize("seed", range(12))
def test_margin_is_between_its_bounds(seed: int) -> None:
    """b_opt / 1.1 <= b <= b_opt for the central controller, b by a sweep of all four blocks over frequency."""
    plant = random_plant(seed)
    controller, b_opt = coprime_controller(plant, 1.1)
    assert b_opt / 1.1 * (1.0 - 1e-6) <= coprime_margin(plant, controller) <= b_opt * (1.0 + 1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_no_other_controller_does_better(seed: int) -> None:
    """b_opt bounds every stabilising controller: disturbed central controllers never exceed it."""
    plant = random_plant(seed)
    controller, b_opt = coprime_controller(plant, 1.01)
    rng = np.random.default_rng(seed)
    for size in np.geomspace(1e-4, 0.3, 40):
        other = replace(
            controller,
            C=controller.C * (1.0 + size * rng.normal(size=controller.C.shape)),
            D=controller.D + size * rng.normal(size=controller.D.shape) * np.abs(controller.D).max(),
        )
        assert coprime_margin(plant, other) <= b_opt * (1.0 + 1e-6)


def test_b_opt_of_an_integrator() -> None:
    """1/s with unit weight: X = Z = 1, so b_opt = 1/sqrt 2; its sampled image keeps it."""
    plant = to_discrete(fb.linear.second_order.StateSpace(*(np.array([[x]]) for x in (0.0, 1.0, 1.0, 0.0))), 0.1)
    assert coprime_controller(plant)[1] == pytest.approx(0.5**0.5, rel=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_coprime_errors_up_to_b_are_borne(seed: int) -> None:
    """(N + dN)(M + dM)^-1 with |[dN; dM]| = 0.99 b, constant errors of random direction: always stable."""
    plant = random_plant(seed)
    controller, _ = coprime_controller(plant)
    b = coprime_margin(plant, controller)
    A, B, C, D = to_continuous(plant)
    from scipy.linalg import solve_continuous_are

    S = np.eye(2) + D.T @ D
    X = solve_continuous_are(A - B @ np.linalg.solve(S, D.T @ C), B, C.T @ np.linalg.solve(np.eye(3) + D @ D.T, C), S)
    F = -np.linalg.solve(S, D.T @ C + B.T @ X)
    root = np.linalg.inv(np.linalg.cholesky(S)).T
    factors = (A + B @ F, B @ root, np.vstack([C + D @ F, F]), np.vstack([D @ root, root]))
    rng = np.random.default_rng(seed)
    for _ in range(50):
        error = rng.normal(size=(5, 2))
        error *= 0.99 * b / np.linalg.norm(error, 2)
        grown = factors[3] + error
        M_inverse = np.linalg.inv(grown[3:])
        # y = (C_N x + D_N r), u = C_M x + D_M r with r solved for u
        changed = (
            factors[0] - factors[1] @ M_inverse @ factors[2][3:],
            factors[1] @ M_inverse,
            factors[2][:3] - grown[:3] @ M_inverse @ factors[2][3:],
            grown[:3] @ M_inverse,
        )
        disturbed = to_discrete(fb.linear.second_order.StateSpace(*changed), plant.step)
        assert spectral_radius(feedback(disturbed, controller).A) < 1.0


def test_figures_of_theory(paper_pose: fb.Pose) -> None:
    """Order 10, achieved b = 0.2545 against the bound 0.2523, at c = 0 and the paper's stiffness.  [theory §10]"""
    shape = task_shape(paper_pose, paper_pose.arm.gains, 1.0, 0.0)
    plant = shape.around(design_plant(paper_pose, Sensing()))
    controller, b_opt = coprime_controller(plant, 1.1)
    assert controller.order == 10
    assert b_opt / 1.1 == pytest.approx(0.2523, abs=5e-5)
    assert coprime_margin(plant, controller) == pytest.approx(0.2545, abs=5e-5)


def test_stiffest_accepted_is_accepted(paper_pose: fb.Pose) -> None:
    """The verdict, which shares no search with the design, confirms what the notes say."""
    controller = controller_for(paper_pose, "coprime")
    verdict = hardware_verdict(controller)
    assert controller.notes["accepted"]
    assert verdict.survives
    assert verdict.has_margin
    assert 2.8e4 <= (verdict.tip_stiffness or 0.0) <= 7e4


def test_redundant_arm_holds_its_self_motion() -> None:
    """Six joints, three task rows, two base joints: all of it stable, though three joints are free."""
    pose = fb.load("ur5e-platform").at([0.3, -1.2, 1.4, -0.5, 0.8, 0.2])
    controller = controller_for(pose, "coprime", Sensing())
    verdict = hardware_verdict(controller)
    assert verdict.survives
    assert verdict.has_margin


def test_slower_task_sensor(paper_pose: fb.Pose) -> None:
    """A task sensor at 250 Hz on a 1 kHz loop: the exact periodic loop is stable."""
    controller = controller_for(paper_pose, "coprime", Sensing(task_every=4))
    assert close_loop(paper_pose, controller).radius < 1.0


@pytest.mark.parametrize("order", [9, 8, 7])
def test_reduced_controllers_are_verified(paper_pose: fb.Pose, order: int) -> None:
    """The asked order, still accepted; the error of truncation within twice the sum of what was left out."""
    full = coprime_at(paper_pose, Sensing(), paper_pose.arm.gains, 1.0, 0.5).system
    reduced, values = balanced_truncation(full, order)
    omega = np.geomspace(0.1, np.pi / full.step, 400)
    error = np.linalg.norm(full.transfer_function(omega) - reduced.transfer_function(omega), 2, axis=(1, 2)).max()
    assert 0.0 < error <= 2.0 * values[order:].sum() * (1.0 + 1e-6)
    controller = controller_for(paper_pose, "coprime", order=order)
    assert controller.system.order == order
    assert controller.notes["accepted"]
    assert hardware_verdict(controller).has_margin


def test_impossible_orders_are_refused(paper_pose: fb.Pose) -> None:
    """0 and more states than there are, by the count."""
    for order in (0, 11):
        with pytest.raises(Infeasible, match="has 10"):
            controller_for(paper_pose, "coprime", order=order)

"""Every registered controller for real hardware: what its verdict says is what the disturbed loop does.

Adding a method to `HARDWARE_METHODS` puts it under these tests. The witnesses step the loop sample by sample, or
disturb it and look at its eigenvalues.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
import pytest

import flexbase as fb
from flexbase.errors import FlexbaseError
from flexbase.linear.discrete.system import Discrete, delay, series
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.sampled.closed import close_loop
from flexbase.sampled.controller import SampledController
from flexbase.sampled.plant import sampled_plant
from flexbase.sampled.verdict import HardwareVerdict, hardware_verdict
from flexbase.synthesis import HARDWARE_METHODS, controller_for
from systems.planar import PAPER_TIP, planar

SYSTEMS = {
    "paper, 1 kHz": lambda: (fb.load("ueda2003").at_tip(PAPER_TIP), Sensing()),
    "paper, 4 kHz": lambda: (fb.load("ueda2003").at_tip(PAPER_TIP), Sensing(rate=4000.0)),
    "paper, slow camera": lambda: (fb.load("ueda2003").at_tip(PAPER_TIP), Sensing(rate=4000.0, task_every=4)),
    "UR5e": lambda: (fb.load("ur5e-platform").at([0.3, -1.2, 1.4, -0.5, 0.8, 0.2]), Sensing()),
}
REFUSED = {("recursive", "UR5e"), ("exact", "UR5e")}  # they shape one base joint
CASES = [pair for pair in product(HARDWARE_METHODS, SYSTEMS) if pair not in REFUSED]
SLOW = {("sampled", "UR5e"), ("constant", "UR5e")}  # searches over 21 gains
EXACT_DELAYS = [pair for pair in CASES if pair[1] != "paper, slow camera"]  # there the delay margin is approximate


@cache
def made(method: str, system: str) -> tuple[SampledController, HardwareVerdict]:
    pose, sensing = SYSTEMS[system]()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fb.FlexbaseWarning)  # cautions of ideal designs: the verdict is looked at here
        controller = controller_for(pose, method, sensing)
    return controller, hardware_verdict(controller)


def marked(pairs: list[tuple[str, str]]) -> list[object]:
    return [pytest.param(one, id=", ".join(one), marks=[pytest.mark.slow] * (one in SLOW)) for one in pairs]


@pytest.fixture(params=marked(CASES))
def case(request: pytest.FixtureRequest) -> tuple[SampledController, HardwareVerdict]:
    return made(*request.param)


@pytest.mark.parametrize("pair", sorted(REFUSED), ids=", ".join)
def test_what_does_not_apply_is_refused_with_its_reason(pair: tuple[str, str]) -> None:
    with pytest.raises(fb.InputError, match="3 base joints, but this method shapes one"):
        made(*pair)


def stepped(controller: SampledController, samples: int) -> np.ndarray:
    """Largest plant and controller state, sample by sample from a kick: plain recursion with the sensor's hold."""
    pose, sensing = controller.pose, controller.sensing
    n, k = pose.arm.n, pose.arm.k
    plant, system = sampled_plant(pose, sensing), controller.system
    rng = np.random.default_rng(0)
    x, c, held = rng.normal(size=plant.order), np.zeros(system.order), np.zeros(k)
    x *= 1e-6
    size = []
    for sample in range(samples):
        # measurements have no throughput from torques: compute_delay is 1
        y = (plant.C @ x)[: k + 2 * n]
        held = y[:k] if sample % sensing.task_every == 0 else held
        y = np.concatenate([held, y[k:]])
        u = system.C @ c + system.D @ y
        c = system.A @ c + system.B @ y
        x = plant.A @ x + plant.B[:, :n] @ u
        size.append(max(np.abs(x).max(), np.abs(c).max(initial=0.0)))
        if size[-1] > 1e6:
            break
    return np.array(size)


def test_shapes_and_numbers(case: tuple[SampledController, HardwareVerdict]) -> None:
    """Torques of n joints from k + 2n measurements, all finite, the name of the method on it."""
    controller, verdict = case
    n, k = controller.pose.arm.n, controller.pose.arm.k
    assert controller.system.D.shape == (n, k + 2 * n)
    for name in "ABCD":
        assert np.all(np.isfinite(getattr(controller.system, name)))
    assert controller.system.step == controller.sensing.step
    assert controller.name in HARDWARE_METHODS
    assert verdict.method == controller.name


def test_stability_is_what_stepping_shows(case: tuple[SampledController, HardwareVerdict]) -> None:
    """Stable: a kick has died to less than exp(-3) of its peak after 6 slowest time constants; else it grows."""
    controller, verdict = case
    constant = abs(1.0 / np.log(verdict.spectral_radius))
    size = stepped(controller, int(6.0 * constant) + 200)
    if verdict.stable:
        assert size[-1] < np.exp(-3.0) * size.max()
    else:
        assert size[-1] > 10.0 * size[0]


def disturbed_radius(controller: SampledController, plant: Discrete, factors: np.ndarray) -> np.ndarray:
    """Spectral radius with every torque channel times a complex number, for many sets of them."""
    system = controller.system
    radii = []
    for one in factors:
        C, D = one[:, None] * system.C, one[:, None] * system.D
        top = np.hstack([plant.A + plant.B @ D @ plant.C, plant.B @ C])
        A = np.vstack([top, np.hstack([system.B @ plant.C, system.A])])
        radii.append(np.abs(np.linalg.eigvals(A)).max())
    return np.array(radii)


@pytest.mark.parametrize("method", [name for name in HARDWARE_METHODS if name != "none"])
def test_torque_disk_margin_is_tight(method: str) -> None:
    """On the disk's border of 0.97 alpha no pair of gains and phases destabilises; of 1.05 alpha some pair does."""
    controller, verdict = made(method, "paper, 4 kHz")
    n, k = 2, 2
    plant = sampled_plant(controller.pose, controller.sensing).select(list(range(k + 2 * n)), list(range(n)))
    turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 36, endpoint=False))
    pairs = np.array([(a, b) for a in turn for b in turn])

    def at(alpha: float) -> np.ndarray:
        delta = 0.5 * alpha * pairs
        return disturbed_radius(controller, plant, (1.0 + delta) / (1.0 - delta))

    assert at(0.97 * verdict.disk_margin_torque).max() < 1.0
    assert at(1.05 * verdict.disk_margin_torque).max() > 1.0


@pytest.mark.parametrize("pair", marked(EXACT_DELAYS))
def test_delay_margin_is_the_delayed_loop(pair: tuple[str, str]) -> None:
    """Stable with every whole number of samples below the margin, unstable with the next; none where none is stable."""
    controller, verdict = made(*pair)
    if not verdict.stable:
        assert verdict.delay_margin_s is None
        return
    assert verdict.delay_margin_s is not None  # no loop here bears any delay
    step, n = controller.sensing.step, controller.pose.arm.n
    most = int(verdict.delay_margin_s / step)

    def radius(samples: int) -> float:
        late = series(controller.system, delay(n, samples, step))
        return close_loop(controller.pose, replace(controller, system=late)).radius

    assert all(radius(samples) < 1.0 for samples in range(min(most, 12) + 1))
    if most < 12:
        assert radius(most + 1) > 1.0


@pytest.mark.parametrize("method", ["coprime", "robust", "lqg"])
def test_rigid_base_is_held(method: str, paper: fb.Plant) -> None:
    """Made and run on a base 10 000 times stiffer, at 1 kHz, where the paper's gains are unstable."""
    stiff = replace(paper.arm, base=replace(paper.arm.base, stiffness=1e4 * paper.arm.base.stiffness))
    pose = fb.Plant(stiff).at(paper.at_tip(PAPER_TIP).q[1:])
    assert close_loop(pose, controller_for(pose, "none")).radius > 1.0
    assert close_loop(pose, controller_for(pose, method)).radius < 1.0


@pytest.fixture(scope="module")
def bolted() -> fb.Pose:
    """An arm without base joints."""
    with pytest.warns(fb.FlexbaseWarning, match="rigid"):
        arm = planar([0.3, 0.25], m=0).arm
    return fb.Plant(replace(arm, gains=Gains(1e4 * np.eye(2), 200.0 * np.eye(2)))).at([0.4, 0.9])


SHAPE_THE_BASE = ("recursive", "exact", "convex", "deflection", "notch")


@pytest.mark.parametrize("method", SHAPE_THE_BASE)
def test_methods_that_shape_the_base_refuse_an_arm_without_one(method: str, bolted: fb.Pose) -> None:
    with pytest.raises(FlexbaseError, match=r"rigid|no base mode"):
        controller_for(bolted, method)


@pytest.mark.parametrize("method", [name for name in HARDWARE_METHODS if name not in SHAPE_THE_BASE])
def test_other_methods_hold_an_arm_without_a_base(method: str, bolted: fb.Pose) -> None:
    assert hardware_verdict(controller_for(bolted, method), brief=True).stable


def test_every_method_is_stable_somewhere() -> None:
    """Only plain PD is not: here the base undoes it without delay, too."""
    assert {method for method in HARDWARE_METHODS if not made(method, "paper, 4 kHz")[1].stable} == {"none"}

"""The loop as it runs: sampled plant and controller closed, at one rate or with a slower task sensor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from flexbase.checks import Array
from flexbase.linear.discrete.disk_margin import grid_of, highest, spectral_norm
from flexbase.linear.discrete.harmonic import periodic
from flexbase.linear.discrete.system import Discrete, feedback, series, spectral_radius
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose
from flexbase.sampled.controller import SampledController
from flexbase.sampled.plant import sampled_plant

LIFTED = 100  # channels of a whole period up to which a slow task sensor is taken exactly: a second or two


@dataclass(frozen=True, eq=False)
class SampledLoop:
    """A closed loop over one period of its slowest sensor.

    transition : state to state over the period, shape (states, states)
    samples : of the controller, in a period
    """

    transition: Array
    samples: int

    @property
    def radius(self) -> float:
        """Spectral radius of a sample: below 1, the loop settles."""
        return float(spectral_radius(self.transition) ** (1.0 / self.samples))


def close_loop(pose: Pose, controller: SampledController) -> SampledLoop:
    """The controller on the plant of a pose, which need not be the one that it was made for."""
    return _around(plants_in_a_period(pose, controller.sensing), controller, pose.arm.k)


def period_radius(plants: Sequence[Discrete], controller: SampledController, k: int) -> float:
    """Spectral radius of a sample on plants that `plants_in_a_period` made, with k tip forces each."""
    return _around(plants, controller, k).radius


def _around(plants: Sequence[Discrete], controller: SampledController, k: int) -> SampledLoop:
    first, *held = (feedback(plant, controller.system, external=k).A for plant in plants[:2])
    if not held:
        return SampledLoop(first, 1)
    with np.errstate(over="ignore", invalid="ignore"):  # an unstable loop may grow without bound; its radius says so
        return SampledLoop(np.linalg.matrix_power(held[0], len(plants) - 1) @ first, len(plants))


def _held(plant: Discrete, k: int, hold: bool = False) -> Discrete:
    """The plant with a memory of the last tip error delivered; with `hold` it is what the controller gets."""
    states, outputs = plant.order, len(plant.C)
    A = np.zeros((states + k, states + k))
    A[:states, :states] = plant.A
    B = np.vstack([plant.B, np.zeros((k, plant.B.shape[1]))])
    C = np.hstack([plant.C, np.zeros((outputs, k))])
    D = plant.D.copy()
    if hold:
        A[states:, states:] = np.eye(k)
        C[:k] = np.hstack([np.zeros((k, states)), np.eye(k)])
        D[:k] = 0.0
    else:
        A[states:, :states] = plant.C[:k]
        B[states:] = plant.D[:k]
    return Discrete(A, B, C, D, plant.step)


def sensitivities(pose: Pose, controller: SampledController) -> tuple[Discrete, Discrete]:
    """S = (I + L)^-1 at the torque commands, and at the sensors that the controller uses.

    With a slower task sensor both are periodic, and the sensor's value counts as the controller gets it, held; beyond
    `LIFTED` channels, where that takes too long, its hold counts as its mean delay.
    """
    n, k = pose.arm.n, pose.arm.k
    used = [i for i in range(k + 2 * n) if _uses(controller.system, i)]
    system = controller.system.select(inputs=used)
    period = _whole_period(pose, _affordable(controller.sensing, max(n, len(used))))
    plants = [one.select(used, list(range(n))) for one in period]
    return (
        periodic([_sensitivity(one, system) for one in plants]),
        periodic([_sensitivity(system, one) for one in plants]),
    )


def _sensitivity(plant: Discrete, controller: Discrete) -> Discrete:
    """From d to u in u = K P u + d: the sensitivity where d enters the plant."""
    loop = feedback(plant, controller)
    seen = np.hstack([controller.D @ loop.C[:, : plant.order], controller.D @ loop.C[:, plant.order :] + controller.C])
    return Discrete(loop.A, loop.B, seen, np.eye(plant.B.shape[1]) + controller.D @ loop.D, plant.step)


def loop_gain(pose: Pose, controller: SampledController) -> Discrete:
    """What a torque command becomes once around the loop, n x n: the loop is u = L u.

    A slower task sensor counts as the mean delay of its hold.
    """
    return series(plant_at_one_rate(pose, controller.sensing), controller.system)


def plant_at_one_rate(pose: Pose, sensing: Sensing) -> Discrete:
    """From torque commands (n) to measurements (k + 2n); a slower task sensor is late by its hold's mean delay."""
    n, k = pose.arm.n, pose.arm.k
    return sampled_plant(pose, _at_one_rate(sensing)).select(list(range(k + 2 * n)), list(range(n)))


def plants_in_a_period(pose: Pose, sensing: Sensing) -> list[Discrete]:
    """The plant sample by sample over a period of the task sensor: a fresh value first, then held ones.

    Inputs are torque commands (n) and tip forces (k), outputs measurements (k + 2n).
    """
    measured = list(range(pose.arm.k + 2 * pose.arm.n))
    return [one.select(measured) for one in _whole_period(pose, sensing)]


def _whole_period(pose: Pose, sensing: Sensing) -> list[Discrete]:
    """The same with the true displacement of the tip as further outputs (k)."""
    plant = sampled_plant(pose, sensing)
    if sensing.task_every == 1:
        return [plant]
    k = pose.arm.k
    return [_held(plant, k), *[_held(plant, k, hold=True)] * (sensing.task_every - 1)]


def _at_one_rate(sensing: Sensing) -> Sensing:
    return replace(sensing, task_every=1, task_delay=sensing.mean_task_delay)


def _affordable(sensing: Sensing, channels: int) -> Sensing:
    """The sensing, or that of its mean delay where a whole period has too many channels."""
    return sensing if sensing.task_every * channels <= LIFTED else _at_one_rate(sensing)


def tip_stiffness(pose: Pose, controller: SampledController) -> float:
    """Smallest static stiffness of the tip, the loop closed [N/m or N m/rad]. Assumes a stable loop."""
    return float(1.0 / np.linalg.norm(_at_rest(pose, controller)[:, : pose.arm.k], 2))


def tip_correction(pose: Pose, controller: SampledController) -> float:
    """Share of a constant tip error that the loop takes away at rest, though the joints do not show it.

    1 for a task-space PD, 0 for a controller that only holds the joints, negative where some error grows. That of the
    direction in which least is taken away; task rows count alike, so rows of different units mix. Assumes a stable
    loop.
    """
    k = pose.arm.k
    return 1.0 - float(np.linalg.norm(np.eye(k) + _at_rest(pose, controller)[:, k:], 2))


def dynamic_stiffness(pose: Pose, controller: SampledController) -> float:
    """Smallest stiffness of the tip at any frequency: a force there moves it by no more. Assumes a stable loop.

    A slower task sensor scatters a frequency into others; by root mean squares then.
    """
    k = pose.arm.k
    loops = _tip_loops(pose, controller, _affordable(controller.sensing, k))
    loop = periodic([one.select(inputs=list(range(k))) for one in loops])
    return 1.0 / highest(lambda w: spectral_norm(loop.transfer_function(w)), np.r_[0.0, grid_of(loop)])[0]


def _at_rest(pose: Pose, controller: SampledController) -> Array:
    """Where the tip comes to rest by a constant force on it, and by a constant error of the task sensor, (k, 2k)."""
    return _tip_loops(pose, controller, _at_one_rate(controller.sensing))[0].static_gain()


def _tip_loops(pose: Pose, controller: SampledController, sensing: Sensing) -> list[Discrete]:
    """Sample by sample of a period, the closed loop from tip forces (k) and sensor errors (k) to the true tip (k)."""
    n, k = pose.arm.n, pose.arm.k
    measured, loops = k + 2 * n, []
    for plant in _whole_period(pose, sensing):
        seen = plant.select(list(range(measured)))
        error = np.hstack([seen.D, np.eye(measured, k)])
        loop = feedback(
            replace(seen, B=np.hstack([seen.B, np.zeros((seen.order, k))]), D=error), controller.system, external=2 * k
        )
        true = np.hstack([plant.C[measured:], np.zeros((k, controller.system.order))])
        loops.append(Discrete(loop.A, loop.B[:, n:], true, np.zeros((k, 2 * k)), plant.step))
    return loops


def _uses(system: Discrete, channel: int) -> bool:
    return bool(np.any(system.B[:, channel]) or np.any(system.D[:, channel]))

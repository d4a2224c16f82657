"""One case of the agreement study: a controller drawn at a pose, and its linear verdict."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from flexbase.cautions import collected
from flexbase.errors import FlexbaseError
from flexbase.model.loop import loop_on
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose
from flexbase.sampled.changes import Changed, changed_pose, eight_changes
from flexbase.sampled.controller import SampledController
from flexbase.sampled.judged import dies_out, judged
from flexbase.sheets.plain import Plain
from flexbase.synthesis import HARDWARE_METHODS

RATES = (1e3, 2e3, 4e3)
SCALES = (1.0 / 16.0, 0.25, 1.0, 4.0)  # of the project's task gains: (s Kp, sqrt(s) Kv)
ACCELERATIONS = ("accelerometer", "accelerometer", "encoders", "kalman")
DRAWN = (
    *("task_every", "compute_delay", "task_delay", "acceleration", "encoder_counts", "task_noise"),
    *("acceleration_noise", "torque_limit"),
)  # of the sensing
DRIVE = (0.5, 4.0)  # torque given over torque asked, in half of the cases


@dataclass(frozen=True, eq=False)
class Case(Plain):
    """A controller on a robot that may differ from its model, and the verdict of the linear loop.

    pose : where and on which robot it runs; change : how that differs, in words
    drive : torque that the drives give over what the design asks for
    complete : stable there with good disk margins, and on all robots that are changed from it
    """

    number: int
    method: str
    scale: float
    change: str
    drive: float
    controller: SampledController
    pose: Pose
    radius: float
    complete: bool

    document: ClassVar = (
        *("number", "method", "gain_scale=scale", "rate_hz=controller.sensing.rate"),
        *(f"{name}=controller.sensing.{name}" for name in DRAWN),
        *("change", "drive", "joints=pose.joints", "spectral_radius=radius", "predicted_stable=stable", "complete"),
        "predicted_growth_per_s=rate",
    )

    @property
    def stable(self) -> bool:
        """The linear verdict."""
        return dies_out(self.radius)

    @property
    def rate(self) -> float:
        """Growth of the slowest motion that the linear loop promises [1/s]; negative where it dies out."""
        return float(np.log(max(self.radius, 1e-300))) * self.controller.sensing.rate


@dataclass(frozen=True)
class Outcome(Plain):
    """What happened: settled or not, how it was seen, after how long [s].

    growth : as measured at the end [1/s]; NaN where it was not
    """

    settled: bool
    seen: str
    seconds: float
    growth: float

    document: ClassVar = ("settled", "seen", "seconds", "measured_growth_per_s=growth")


def draw_case(pose: Pose, number: int, attempt: int, seed: int, methods: tuple[str, ...]) -> Case | None:
    """A controller for a pose, drawn by number, attempt and seed alone; None where its method has no design there."""
    rng = np.random.default_rng([seed, number, attempt])
    method, scale = str(rng.choice(methods)), float(rng.choice(SCALES))
    sensing = Sensing(
        rate=float(rng.choice(RATES)),
        task_every=int(rng.choice((1, 1, 2))),
        compute_delay=int(rng.choice((1, 1, 2))),
        task_delay=int(rng.choice((0, 1, 2))),
        acceleration=str(rng.choice(ACCELERATIONS)),
    )
    changes = eight_changes(pose.arm.n)
    change = changes[rng.integers(len(changes))] if rng.random() < 0.5 else Changed("none")
    drive = float(np.exp(rng.uniform(*np.log(DRIVE)))) if rng.random() < 0.5 else 1.0
    scaled = loop_on(pose.arm).scaled(scale)
    with collected(quietly=True):  # cautions of designs: the outcome is what counts here
        try:
            controller = _driven(HARDWARE_METHODS[method].make(pose, sensing, scaled), drive)
            real = changed_pose(pose, change)
        except FlexbaseError:
            return None
    found = judged(controller, real)
    return Case(number, method, scale, change.label, drive, controller, real, found.radius, found.accepted())


def _driven(controller: SampledController, drive: float) -> SampledController:
    """The controller on drives whose torque is wrong by a factor."""
    system = controller.system
    return replace(controller, system=replace(system, C=drive * system.C, D=drive * system.D))

"""One case of the agreement study: a controller drawn at a pose, its linear verdict, and what MuJoCo makes of it."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.control.sampled_controller import SampledController
from flexbase.control.sampled_loop import close_loop
from flexbase.control.sampled_plant import Changed, changed_pose, eight_changes
from flexbase.design.hardware import HARDWARE_METHODS
from flexbase.errors import FlexbaseError
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.simulate.loop import Loop
from flexbase.simulate.mujoco_held import MujocoHeld

RATES = (1e3, 2e3, 4e3)
SCALES = (1.0 / 16.0, 0.25, 1.0, 4.0)  # of the project's task gains: (s Kp, sqrt(s) Kv)
ACCELERATIONS = ("accelerometer", "accelerometer", "encoders", "kalman")
DRIVE = (0.5, 4.0)  # torque given over torque asked, in half of the cases
NUDGE = 1e-6  # rad or m of all joints together: the start
GROWN = 1e3  # times the nudge: has left
DECAYED = 1e-4  # of the largest deviation so far: has come to rest, if it stays so for as long again
WINDOW = 0.05  # s, over which the largest deviation is taken
LONGEST = 8.0  # s: after it, the last quarter is compared with the one before


@dataclass(frozen=True, eq=False)
class Case:
    """A controller on a robot that may differ from its model, and the verdict of the linear loop.

    pose : where and on which robot it runs; change : how that differs, in words
    drive : torque that the drives give over what the design asks for
    """

    number: int
    method: str
    scale: float
    change: str
    drive: float
    controller: SampledController
    pose: Pose
    radius: float

    @property
    def stable(self) -> bool:
        """The linear verdict."""
        return self.radius < 1.0

    @property
    def rate(self) -> float:
        """Growth of the slowest motion that the linear loop promises [1/s]; negative where it dies out."""
        return float(np.log(max(self.radius, 1e-300))) * self.controller.sensing.rate

    def to_dict(self) -> dict[str, Any]:
        """What was drawn, and the verdict."""
        sensing = self.controller.sensing
        return {
            "number": self.number,
            "method": self.method,
            "gain_scale": self.scale,
            "rate_hz": sensing.rate,
            "task_every": sensing.task_every,
            "compute_delay": sensing.compute_delay,
            "task_delay": sensing.task_delay,
            "acceleration": sensing.acceleration,
            "change": self.change,
            "drive": self.drive,
            "joints": self.pose.q[self.pose.arm.m :].tolist(),
            "spectral_radius": self.radius,
            "predicted_stable": self.stable,
            "predicted_growth_per_s": self.rate,
        }


@dataclass(frozen=True)
class Outcome:
    """What happened: settled or not, how it was seen ("decayed", "grown", "slope"), after how long [s].

    growth : as measured at the end [1/s]
    """

    settled: bool
    seen: str
    seconds: float
    growth: float


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
    gains = pose.arm.gains
    assert gains is not None  # checked by the study
    scaled = Gains(scale * gains.stiffness, np.sqrt(scale) * gains.damping)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # cautions of designs: the outcome is what counts here
        try:
            controller = _driven(HARDWARE_METHODS[method].make(pose, sensing, scaled), drive)
            real = changed_pose(pose, change)
        except (FlexbaseError, np.linalg.LinAlgError):
            return None
    return Case(number, method, scale, change.label, drive, controller, real, close_loop(real, controller).radius)


def _driven(controller: SampledController, drive: float) -> SampledController:
    """The controller on drives whose torque is wrong by a factor."""
    system = controller.system
    return replace(controller, system=replace(system, C=drive * system.C, D=drive * system.D))


def watch(case: Case, nudge: float = NUDGE, longest: float = LONGEST) -> Outcome:
    """Nudge all joints, base and arm, at rest in MuJoCo, and wait until the motion has grown or died out.

    The linear verdict is not looked at: neither the horizon nor the rule depends on it. Grown: a thousand times the
    nudge. Died out: below 1e-4 of the largest deviation, and still so after as long again. Neither within `longest`
    seconds: the larger of the last quarter and the one before it decides.
    """
    sensing, goal = case.controller.sensing, case.pose
    direction = np.random.default_rng([case.number, 7]).standard_normal(goal.arm.N)
    start = (goal.q + nudge * direction / np.linalg.norm(direction))[None]
    loop = Loop([case.controller], [goal], MujocoHeld([goal], start, sensing), start=start)
    samples = max(16, round(WINDOW * sensing.rate))
    still = np.zeros((samples, goal.arm.k))
    sizes: list[float] = []
    rested: int | None = None  # number of the first window at rest
    while len(sizes) * samples * sensing.step < longest:
        sizes.append(float(np.linalg.norm(loop.go(still).q[:, 0] - goal.q, axis=1).max()))
        if not loop.alive[0] or not sizes[-1] <= GROWN * nudge:
            return _outcome(False, "grown", sizes, samples * sensing.step)
        if sizes[-1] >= DECAYED * max(sizes):
            rested = None
        elif rested is None:
            rested = len(sizes)
        elif len(sizes) >= 2 * rested:
            return _outcome(True, "decayed", sizes[:rested], samples * sensing.step)
    quarter = len(sizes) // 4
    settled = max(sizes[-quarter:]) < max(sizes[-2 * quarter : -quarter])
    return _outcome(settled, "slope", sizes, samples * sensing.step)


def _outcome(settled: bool, seen: str, sizes: list[float], window: float) -> Outcome:
    return Outcome(settled, seen, len(sizes) * window, growth_of(np.array(sizes), window))


def growth_of(sizes: Array, window: float) -> float:
    """Slope of the logarithm of the largest deviations, over their last half [1/s]; NaN of one window."""
    late = np.log(np.maximum(sizes[np.isfinite(sizes)], 1e-300))[-max(2, len(sizes) // 2) :]
    if len(late) < 2:
        return float("nan")
    return float(np.polyfit(window * np.arange(len(late)), late, 1)[0])

"""Which controllers run? Shares of the workspace, at several rates and gains, with their intervals.  [theory §10]"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from flexbase.checks import choose
from flexbase.errors import FlexbaseError, FlexbaseWarning, InputError
from flexbase.linear.discrete.disk_margin import disk_margin
from flexbase.model.sensing import TYPICAL, Sensing
from flexbase.model.task import Gains
from flexbase.plant import Plant, Pose
from flexbase.sampled.closed import close_loop, dynamic_stiffness, sensitivities, tip_correction, tip_stiffness
from flexbase.sampled.controller import SampledController
from flexbase.sampled.plant import changed_pose, eight_changes
from flexbase.sampled.verdict import GOOD_MARGIN
from flexbase.study.montecarlo.interval import probability_interval
from flexbase.study.workspace import random_poses
from flexbase.sweeps.engine.pool import in_processes
from flexbase.synthesis import HARDWARE_METHODS


class Setting(NamedTuple):
    """A sampling rate [Hz], and gains (s Kp, sqrt(s) Kv) of the project's own."""

    rate: float
    scale: float


SETTINGS = tuple(Setting(*pair) for pair in ((1e3, 0.25), (1e3, 1.0), (1e3, 4.0), (4e3, 1.0), (4e3, 4.0)))


class Outcome(NamedTuple):
    """One method at one pose: whether there is a design, what it bears, and what it does to the tip; NaN if unstable.

    stiffness, dynamic, correction : `tip_stiffness`, `dynamic_stiffness`, `tip_correction`
    time : constant of the slowest motion [s]
    """

    designed: bool
    stable: bool
    margin: bool
    perturbed: bool
    stiffness: float = float("nan")
    dynamic: float = float("nan")
    correction: float = float("nan")
    time: float = float("nan")


@dataclass(frozen=True)
class Row:
    """Shares of the poses at which a method is stable, has disk margins of 0.3, and survives all changes, in [0, 1].

    margin_share : stable with both margins; perturbed_share : stable for the nominal and every changed robot
    complete_share : all three at once; no_design_share : poses where the method finds no controller
    tip_stiffness : median of the smallest static stiffness where stable [N/m]; None where it never is
    dynamic_stiffness, tip_correction, time_constant_s : medians too: smallest stiffness at any frequency; share of a
        tip error, unseen by the joints, that is taken away at rest; of the slowest motion
    *_interval : 95 % intervals, exact
    """

    method: str
    rate_hz: float
    gain_scale: float
    poses: int
    stable_share: float
    margin_share: float
    perturbed_share: float
    complete_share: float
    no_design_share: float
    tip_stiffness: float | None
    dynamic_stiffness: float | None
    tip_correction: float | None
    time_constant_s: float | None
    stable_interval: tuple[float, float]
    margin_interval: tuple[float, float]
    perturbed_interval: tuple[float, float]
    complete_interval: tuple[float, float]


@dataclass(frozen=True)
class HardwareStudy:
    """The table of a study."""

    robot: str
    seed: int
    rows: tuple[Row, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return {"robot": self.robot, "seed": self.seed, "rows": [dict(vars(row)) for row in self.rows]}

    def summary(self) -> str:
        """A line a row: stable / margin / perturbed / all three in percent."""
        lines = [
            f"{self.robot}: stable / disk margin {GOOD_MARGIN} / survives all changes / all three [%], stiffness [N/m]"
        ]
        for row in self.rows:
            shares = (row.stable_share, row.margin_share, row.perturbed_share, row.complete_share)
            shown = " / ".join(f"{100.0 * share:3.0f}" for share in shares)
            stiff = "none" if row.tip_stiffness is None else f"{row.tip_stiffness:.2e}"
            lines.append(f"  {row.method:12s} {row.rate_hz:6.0f} Hz x{row.gain_scale:<5g} {shown}  {stiff}")
        return "\n".join(lines)


def hardware_study(
    plant: Plant,
    *,
    poses: int = 400,
    seed: int = 0,
    methods: Sequence[str] | None = None,
    settings: Sequence[Setting] = SETTINGS,
    sensing: Sensing = TYPICAL,
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> HardwareStudy:
    """Every method at every setting on the same random poses, on `workers` processes (one a core if left out).

    The poses are the tips that `random_poses` draws uniformly over the workspace. A method without a design at a pose
    counts as unstable there.

    sensing : delays and sensors; its rate is replaced by the setting's
    Raises InputError.
    """
    chosen = list(HARDWARE_METHODS) if methods is None else list(methods)
    for name in chosen:
        choose("method", name, HARDWARE_METHODS)
    if plant.arm.gains is None:
        raise InputError(f"{plant.name}: no task gains. Add a [control] table to the project.")
    drawn = random_poses(plant, poses, seed)
    tasks = [(pose, name, settings, sensing) for pose in drawn for name in chosen]
    found: dict[tuple[str, Setting], list[Outcome]] = {(name, one): [] for name in chosen for one in settings}
    for done, (_, (name, outcomes)) in enumerate(in_processes(outcomes_of, tasks, workers), start=1):
        for setting, outcome in zip(settings, outcomes, strict=True):
            found[name, setting].append(outcome)
        progress(done, len(tasks))
    return HardwareStudy(
        plant.name, seed, tuple(_row(name, one, found[name, one]) for name in chosen for one in settings)
    )


Task = tuple[Pose, str, Sequence[Setting], Sensing]


def outcomes_of(task: Task) -> tuple[str, list[Outcome]]:
    """One method at one pose, at every setting."""
    pose, name, settings, sensing = task
    return name, [_outcome(pose, name, setting, sensing) for setting in settings]


def _outcome(pose: Pose, name: str, setting: Setting, sensing: Sensing) -> Outcome:
    gains = pose.arm.gains
    assert gains is not None  # checked by the study
    scaled = Gains(setting.scale * gains.stiffness, np.sqrt(setting.scale) * gains.damping)
    at_rate = Sensing(**{**vars(sensing), "rate": setting.rate})
    try:
        controller = HARDWARE_METHODS[name].make(pose, at_rate, scaled)
    except (FlexbaseError, FlexbaseWarning, np.linalg.LinAlgError):
        return Outcome(False, False, False, False)
    return judge(pose, controller)


def judge(pose: Pose, controller: SampledController) -> Outcome:
    """Stability, disk margins, changed robots, the tip: the verdict without its slower parts."""
    radius = close_loop(pose, controller).radius
    if radius >= 1.0:
        return Outcome(True, False, False, False)
    margin = min(disk_margin(one).alpha for one in sensitivities(pose, controller))
    perturbed = all(
        close_loop(changed_pose(pose, change), controller).radius < 1.0 for change in eight_changes(pose.arm.n)
    )
    return Outcome(
        designed=True,
        stable=True,
        margin=margin >= GOOD_MARGIN,
        perturbed=perturbed,
        stiffness=tip_stiffness(pose, controller),
        dynamic=dynamic_stiffness(pose, controller),
        correction=tip_correction(pose, controller),
        time=-controller.sensing.step / float(np.log(radius)),
    )


def _row(name: str, setting: Setting, outcomes: Sequence[Outcome]) -> Row:
    count = len(outcomes)
    stable = [one.stable for one in outcomes]
    margin = [one.margin for one in outcomes]
    perturbed = [one.perturbed for one in outcomes]
    complete = [one.margin and one.perturbed for one in outcomes]
    settling = [one for one in outcomes if one.stable]
    return Row(
        name,
        setting.rate,
        setting.scale,
        count,
        float(np.mean(stable)),
        float(np.mean(margin)),
        float(np.mean(perturbed)),
        float(np.mean(complete)),
        float(np.mean([not one.designed for one in outcomes])),
        _median([one.stiffness for one in settling]),
        _median([one.dynamic for one in settling]),
        _median([one.correction for one in settling]),
        _median([one.time for one in settling]),
        share_interval(sum(stable), count),
        share_interval(sum(margin), count),
        share_interval(sum(perturbed), count),
        share_interval(sum(complete), count),
    )


def _median(values: Sequence[float]) -> float | None:
    return float(np.median(values)) if values else None


def share_interval(hits: int, trials: int) -> tuple[float, float]:
    """Clopper and Pearson's 95 % interval of a share."""
    lower, upper = probability_interval(np.array(hits), trials)
    return float(lower), float(upper)

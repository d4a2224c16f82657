"""Which controllers run? Shares of the workspace, at several rates and gains, with their intervals.  [theory §10]"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import choose
from flexbase.errors import FlexbaseError
from flexbase.model.loop import Asked, LoopSpec, loop_on
from flexbase.plant import Plant, Pose, check_plant
from flexbase.sampled.figures import FIGURES
from flexbase.sampled.judged import GOOD_MARGIN, judged
from flexbase.study.montecarlo.interval import probability_interval
from flexbase.study.workspace import random_poses
from flexbase.sweeps.engine.pool import in_processes
from flexbase.synthesis import HARDWARE_METHODS

TOLD = tuple(name for name, one in FIGURES.items() if one.of_the_tip)


class Setting(NamedTuple):
    """A sampling rate [Hz], and gains (s Kp, sqrt(s) Kv) of the project's own."""

    rate: float
    scale: float


SETTINGS = tuple(Setting(*pair) for pair in ((1e3, 0.25), (1e3, 1.0), (1e3, 4.0), (4e3, 1.0), (4e3, 4.0)))


class Outcome(NamedTuple):
    """One method at one pose: whether there is a design, what it bears, and what it does to the tip.

    tip : figures that are tabulated, by name; empty if unstable
    """

    designed: bool
    stable: bool
    margin: bool
    perturbed: bool
    tip: dict[str, float | None]


NO_DESIGN = Outcome(False, False, False, False, {})


@dataclass(frozen=True)
class Row:
    """Shares of the poses at which a method is stable, has disk margins of 0.3, and survives all changes, in [0, 1].

    margin_share : stable with both margins; perturbed_share : stable for the nominal and every changed robot
    complete_share : all three at once; no_design_share : poses where the method finds no controller
    medians : of the figures that tell what the loop does to the tip, over the poses where it is stable; None where it
        never is
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
    medians: dict[str, float | None]
    stable_interval: tuple[float, float]
    margin_interval: tuple[float, float]
    perturbed_interval: tuple[float, float]
    complete_interval: tuple[float, float]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, the medians under the figures' names."""
        said = {name: value for name, value in vars(self).items() if name != "medians"}
        return {**said, **self.medians}


@dataclass(frozen=True)
class HardwareStudy:
    """The table of a study."""

    robot: str
    seed: int
    rows: tuple[Row, ...]

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return {"robot": self.robot, "seed": self.seed, "rows": [row.to_dict() for row in self.rows]}

    def summary(self) -> str:
        """A line a row: stable / margin / perturbed / all three in percent."""
        lines = [
            f"{self.robot}: stable / disk margin {GOOD_MARGIN} / survives all changes / all three [%], stiffness [N/m]"
        ]
        for row in self.rows:
            shares = (row.stable_share, row.margin_share, row.perturbed_share, row.complete_share)
            shown = " / ".join(f"{100.0 * share:3.0f}" for share in shares)
            stiffness = row.medians["tip_stiffness"]
            stiff = "none" if stiffness is None else f"{stiffness:.2e}"
            lines.append(f"  {row.method:12s} {row.rate_hz:6.0f} Hz x{row.gain_scale:<5g} {shown}  {stiff}")
        return "\n".join(lines)


def hardware_study(
    plant: Plant,
    *,
    poses: int = 400,
    seed: int = 0,
    methods: Sequence[str] | None = None,
    settings: Sequence[Setting] = SETTINGS,
    loop: Asked = None,
    workers: int | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> HardwareStudy:
    """Every method at every setting on the same random poses, on `workers` processes (one a core if left out).

    The poses are the tips that `random_poses` draws uniformly over the workspace. A method without a design at a pose
    counts as unstable there.

    loop : task gains, delays and sensors, the project's own if left out; rate and gains are those of the setting
    Raises InputError.
    """
    chosen = list(HARDWARE_METHODS) if methods is None else list(methods)
    for name in chosen:
        choose("method", name, HARDWARE_METHODS)
    check_plant(plant)
    meant = loop_on(plant.arm, loop)
    _ = meant.gains  # raises where there are none
    drawn = random_poses(plant, poses, seed)
    tasks = [(pose, name, settings, meant) for pose in drawn for name in chosen]
    found: dict[tuple[str, Setting], list[Outcome]] = {(name, one): [] for name in chosen for one in settings}
    for done, (_, (name, outcomes)) in enumerate(in_processes(outcomes_of, tasks, workers), start=1):
        for setting, outcome in zip(settings, outcomes, strict=True):
            found[name, setting].append(outcome)
        progress(done, len(tasks))
    return HardwareStudy(
        plant.name, seed, tuple(_row(name, one, found[name, one]) for name in chosen for one in settings)
    )


Task = tuple[Pose, str, Sequence[Setting], LoopSpec]


def outcomes_of(task: Task) -> tuple[str, list[Outcome]]:
    """One method at one pose, at every setting."""
    pose, name, settings, loop = task
    return name, [_outcome(pose, name, setting, loop) for setting in settings]


def _outcome(pose: Pose, name: str, setting: Setting, loop: LoopSpec) -> Outcome:
    gains = loop.scaled(setting.scale)
    try:
        with collected(quietly=True):  # cautions of ideal designs: the outcome is what counts here
            controller = HARDWARE_METHODS[name].make(pose, replace(loop.sensing, rate=setting.rate), gains)
    except (FlexbaseError, np.linalg.LinAlgError):
        return NO_DESIGN
    found = judged(controller, pose)
    tip = {one: found.figure(one) for one in TOLD} if found.stable else {}
    return Outcome(True, found.stable, found.stable and found.has_margin(), found.survives, tip)


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
        {told: _median([one.tip[told] for one in settling]) for told in TOLD},
        share_interval(sum(stable), count),
        share_interval(sum(margin), count),
        share_interval(sum(perturbed), count),
        share_interval(sum(complete), count),
    )


def _median(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return float(np.median(known)) if known else None


def share_interval(hits: int, trials: int) -> tuple[float, float]:
    """Clopper and Pearson's 95 % interval of a share."""
    lower, upper = probability_interval(np.array(hits), trials)
    return float(lower), float(upper)

"""Which controllers run? Shares of the workspace, at several rates and gains, with their intervals.  [theory §10]"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import choose
from flexbase.errors import FlexbaseError
from flexbase.model.loop import Asked, LoopSpec, loop_on
from flexbase.plant import Plant, Pose, check_plant
from flexbase.requests import Progress, no_progress
from flexbase.sampled.columns import below, cells, columns, legend
from flexbase.sampled.figures import FIGURES
from flexbase.sampled.judged import GOOD_MARGIN, judged
from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Column, Note, Sheet, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.study.montecarlo.interval import probability_interval
from flexbase.study.random_poses import random_poses
from flexbase.sweeps.engine.pool import in_processes
from flexbase.synthesis import HARDWARE_METHODS

SHARES = {
    "stable": "stable_share",
    "margin": "margin_share",
    "changed": "perturbed_share",
    "all": "complete_share",
}
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
class Row(Plain):
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

    document: ClassVar = (
        *("method", "rate_hz", "gain_scale", "poses"),
        *("stable_share", "margin_share", "perturbed_share", "complete_share", "no_design_share"),
        *("stable_interval", "margin_interval", "perturbed_interval", "complete_interval", "*medians"),
    )


@dataclass(frozen=True)
class HardwareStudy(Told):
    """The table of a study."""

    robot: str
    seed: int
    rows: tuple[Row, ...]

    def sheet(self) -> Sheet:
        """A row a method and setting, what the columns mean, and how far the shares may be trusted."""
        heads = [words("method"), words("rate\ngains"), *(Column(head, "%") for head in SHARES)]
        rows = [
            (
                row.method,
                f"{row.rate_hz / 1e3:g}k x{row.gain_scale:g}",
                *(f"{100.0 * getattr(row, share):.0f}" for share in SHARES.values()),
                *cells(row.medians, TOLD),
            )
            for row in self.rows
        ]
        ends = [pair for row in self.rows for pair in (row.stable_interval, row.complete_interval)]
        wide = f"{50.0 * max(high - low for low, high in ends):.0f} %"
        medians = {f"{row.method} {row.rate_hz / 1e3:g}k x{row.gain_scale:g}": row.medians for row in self.rows}
        return make_sheet(
            self.robot,
            "which controllers run",
            table([*heads, *columns(TOLD)], rows),
            below(medians, TOLD),
            Note(
                f"Shares of {self.rows[0].poses} poses; half-width of the 95 % intervals up to {wide}. margin: disk "
                f"margins of {GOOD_MARGIN:g}; changed: on all changed robots; medians where stable, {legend(TOLD)}."
            ),
        )


def hardware_study(
    plant: Plant,
    *,
    poses: int = 400,
    seed: int = 0,
    methods: Sequence[str] | None = None,
    settings: Sequence[Setting] = SETTINGS,
    loop: Asked = None,
    workers: int | None = None,
    progress: Progress = no_progress,
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
        progress("poses times methods", done, len(tasks))
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
    except FlexbaseError:
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

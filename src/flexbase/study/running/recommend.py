"""Which controller to use at a pose, why, at what cost, and when the answer would change."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from flexbase.errors import FlexbaseError
from flexbase.linear.modal import modes
from flexbase.model.loop import Asked, loop_on
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose, check_pose
from flexbase.requests import Progress, no_progress
from flexbase.sampled.changes import Changed
from flexbase.sampled.controller import SampledController
from flexbase.sampled.judged import GOOD_MARGIN, SAFE, STABLE, UNSTABLE, Judged, robots_at
from flexbase.sampled.noise import torque_noise
from flexbase.sampled.verdict import HardwareVerdict, hardware_verdict
from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Sheet, facts, make_sheet
from flexbase.sheets.told import Told
from flexbase.sweeps.engine.pool import in_processes
from flexbase.synthesis import HARDWARE_METHODS, controller_for

RATES = (250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0)  # Hz: where a change of the answer is looked for
HEARS = 0.1  # of a constant tip error taken away: less is no task-space control
CLOSE = 0.8  # of the best stiffness: a simpler method that reaches it is preferred
Task = tuple[Pose, str, Sensing, Gains | None, bool]  # the last: in brief
ERRORS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)  # of the base stiffness: how wrong the model may be


@dataclass(frozen=True)
class Candidate(Plain):
    """A method at the pose: its verdict and what it costs.

    refusal : why there is no controller; the rest is None then
    torque_noise : largest standard deviation of an arm torque [N m or N], None if unstable
    stiffness_error : relative error of the base stiffness, either way, that the loop survives, of those tried
    sensors : what the law reads, in words
    """

    method: str
    purpose: str
    verdict: HardwareVerdict | None
    refusal: str | None = None
    torque_noise: float | None = None
    stiffness_error: float | None = None
    sensors: tuple[str, ...] = ()

    document: ClassVar = (
        *("method", "purpose", "verdict", "refusal", "torque_noise", "stiffness_error", "sensors", "grade"),
    )

    @property
    def grade(self) -> int:
        """3: stable, with margins, for all changed robots; 2: with margins or for all of them; 1: stable; 0: not."""
        return UNSTABLE if self.verdict is None else self.verdict.grade


@dataclass(frozen=True)
class Recommendation(Told):
    """The answer at one pose.

    best : the recommended candidate, or None where nothing is stable
    changes : rate [Hz] or sensor -> which of the best few here would be recommended there, None for none
    """

    robot: str
    tip: tuple[float, ...]
    sensing: Sensing
    declared: bool
    positive_real: bool
    best: Candidate | None
    candidates: tuple[Candidate, ...]
    changes: dict[str, str | None]

    document: ClassVar = (
        *("robot", "tip", "sensing", "sensing_declared=declared", "positive_real", "recommended=best.method", "grade"),
        *("candidates", "changes", "lines"),
    )

    @property
    def grade(self) -> int:
        """Of the recommended candidate."""
        return UNSTABLE if self.best is None else self.best.grade

    def sheet(self) -> Sheet:
        """The six lines."""
        said = [line.partition(": ") for line in self.lines()]
        return make_sheet(self.robot, "recommended", facts(*((name, text) for name, _, text in said)))

    def lines(self) -> list[str]:
        """Six lines that a person can act on."""
        clock = f"{self.sensing.rate:g} Hz, {self.sensing.compute_delay} + {self.sensing.task_delay} samples late"
        said = "as declared" if self.declared else "assumed: the project declares no [sensing]"
        ideal = f"Ideal loop: the plant is {'' if self.positive_real else 'not '}positive real here"
        if self.best is None or self.best.verdict is None:
            return [
                f"Use: none of the methods is stable at this pose ({clock}, {said}).",
                "Why: " + "; ".join(f"{one.method}: {_flaw(one)}" for one in self.candidates) + ".",
                "Cost: nothing runs, so nothing is lost by lower gains: halve the task stiffness and ask again.",
                "Needs: less delay, a faster rate, or a stiffer base.",
                f"{ideal}.",
                "Change: " + self._turns(),
            ]
        verdict, best = self.best.verdict, self.best
        others = [one for one in self.candidates if one is not best]
        return [
            f"{'Use' if best.grade == SAFE else 'Use with care'}: {best.method}, {best.purpose} ({clock}, {said}).",
            f"Why: {_merit(best)}; disk margins {verdict.disk_margin_torque:.2f} at torques, "
            f"{verdict.disk_margin_sensor:.2f} at sensors. " + _comparison(best, others),
            f"Cost: tip stiffness {verdict.tip_stiffness:.3g} N/m at rest, {verdict.dynamic_stiffness:.2g} N/m at its"
            f" worst frequency; time constant {1e3 * (verdict.time_constant_s or 0.0):.0f} ms; torque noise "
            f"{best.torque_noise:.3g} N m. It corrects {100.0 * _correction(best):.0f} % of what only the tip shows.",
            f"Needs: {', '.join(best.sensors)}; base stiffness known to "
            + (f"{100.0 * best.stiffness_error:.0f} %." if best.stiffness_error else "better than 5 %."),
            "; ".join([ideal, *(f"{one.method}: {_flaw(one)}" for one in others[:4])]) + ".",
            "Change: " + self._turns(),
        ]

    def _turns(self) -> str:
        here = None if self.best is None else self.best.method
        turns = [f"{where}: {name or 'nothing stable'}" for where, name in self.changes.items() if name != here]
        return ("with " + "; ".join(turns) + ".") if turns else "the same answer at every rate and sensor tried."


def recommend(
    pose: Pose,
    *,
    loop: Asked = None,
    methods: Sequence[str] | None = None,
    workers: int | None = 1,
    progress: Progress = no_progress,
) -> Recommendation:
    """Judge every method at a pose as its loop would run, and choose.

    First the grade (stable, with disk margins of 0.3, for all changed robots), then whether it corrects the tip at all,
    then the stiffness at its worst frequency; a method that comes earlier in the registry is preferred where it reaches
    80 % of it.

    loop : task gains and sensing: the project's own if left out, else 1 kHz with one sample of delay
    workers : processes, None for one a core; a script that asks for several needs its `__main__` guard
    Raises InputError without task gains.
    """
    check_pose(pose)
    meant = loop_on(pose.arm, loop)
    used, gains = meant.sensing, meant.gains
    chosen = list(HARDWARE_METHODS) if methods is None else list(methods)
    others = [(f"{rate:g} Hz", replace(used, rate=rate)) for rate in RATES if rate != used.rate]
    sensors = [("accelerometer", "joint accelerometers"), ("encoders", "differenced encoders")]
    others += [(said, replace(used, acceleration=kind)) for kind, said in sensors if kind != used.acceleration]
    settings = [("here", used), *others]
    tasks = [(pose, name, one, gains, label != "here") for label, one in settings for name in chosen]
    found: dict[int, Candidate] = {}
    for number, candidate in in_processes(_candidate, tasks, workers):
        found[number] = candidate
        progress(candidate.method, len(found), len(tasks))
    count = len(chosen)
    tables = [[found[row * count + i] for i in range(count)] for row in range(len(settings))]
    best = choose_best(tables[0])
    answers = [choose_best(row) for row in tables[1:]]
    changes = {
        label: None if answer is None else answer.method for (label, _), answer in zip(others, answers, strict=True)
    }
    ideal = modes(pose).positive_real
    tip = tuple(map(float, pose.tip))
    return Recommendation(pose.plant.name, tip, used, meant.declared, ideal, best, tuple(tables[0]), changes)


def choose_best(candidates: Sequence[Candidate]) -> Candidate | None:
    """The highest grade; among those the first that reaches 80 % of the best stiffness. None where all are unstable.

    A controller that takes away less than a tenth of a tip error has hardly a task-space loop: it is an answer only
    where no other has its grade.
    """
    grade = max((one.grade for one in candidates), default=0)
    if grade == UNSTABLE:
        return None
    first = [one for one in candidates if one.grade == grade]
    first = [one for one in first if _correction(one) >= HEARS] or first
    if grade == STABLE:
        return max(first, key=lambda one: _smaller_margin(one))
    stiffest = max(_stiffness(one) for one in first)
    return next(one for one in first if _stiffness(one) >= CLOSE * stiffest)


def _stiffness(one: Candidate) -> float:
    return 0.0 if one.verdict is None else one.verdict.dynamic_stiffness or 0.0


def _correction(one: Candidate) -> float:
    return 0.0 if one.verdict is None else one.verdict.tip_correction or 0.0


def _smaller_margin(one: Candidate) -> float:
    return 0.0 if one.verdict is None else one.verdict.smaller_margin


def _candidate(task: Task) -> Candidate:
    pose, name, sensing, gains, brief = task
    purpose = HARDWARE_METHODS[name].purpose
    try:
        controller = controller_for(pose, name, sensing, gains)
        verdict = hardware_verdict(controller, brief=brief)
    except FlexbaseError as fault:
        return Candidate(name, purpose, None, refusal=str(fault).split(". ")[0])
    if brief or not verdict.stable:
        return Candidate(name, purpose, verdict, sensors=_sensors(controller))
    noise = float(torque_noise(pose, controller).max())
    return Candidate(name, purpose, verdict, None, noise, _stiffness_error(pose, controller), _sensors(controller))


def _stiffness_error(pose: Pose, controller: SampledController) -> float | None:
    """The largest of `ERRORS` up to which the loop is stable with the base that much softer or stiffer."""
    survived = None
    for error in ERRORS:
        changes = [Changed("", base_stiffness=1.0 + sign * error) for sign in (-1.0, 1.0)]
        if not Judged(controller, robots_at(pose, controller.sensing, changes)).survives:
            break
        survived = error
    return survived


def _sensors(controller: SampledController) -> tuple[str, ...]:
    n, k = controller.pose.arm.n, controller.pose.arm.k
    system, found = controller.system, []
    for said, columns in (
        ("a task sensor", slice(0, k)),
        ("joint encoders", slice(k, k + n)),
        ("joint accelerometers", slice(k + n, k + 2 * n)),
    ):
        if np.any(system.B[:, columns]) or np.any(system.D[:, columns]):
            found.append(said)
    return (*found, f"{controller.sensing.rate:g} Hz")


def _flaw(one: Candidate) -> str:
    if one.verdict is None:
        return f"no design ({one.refusal})"
    if not one.verdict.stable:
        return "unstable"
    if one.grade == SAFE:
        return f"runs too, at {one.verdict.dynamic_stiffness:.2g} N/m"
    if not one.verdict.survives:
        return f"fails with {one.verdict.worst_change}"
    return f"margin {_smaller_margin(one):.2f}"


def _merit(best: Candidate) -> str:
    assert best.verdict is not None  # only candidates with a verdict are recommended
    parts = ["stable as it runs"]
    parts += (
        ["survives all changed robots"] if best.verdict.survives else [f"but fails with {best.verdict.worst_change}"]
    )
    parts += [] if best.verdict.has_margin else [f"but below the margin of {GOOD_MARGIN}"]
    return ", ".join(parts)


def _comparison(best: Candidate, others: Sequence[Candidate]) -> str:
    rivals = [one for one in others if one.grade == best.grade]
    if not rivals:
        return "No other method does as much."
    second = max(rivals, key=_stiffness)
    return f"Next is {second.method}, at {_stiffness(second):.2g} N/m."

"""Do linear verdicts come true? Each against its outcome in MuJoCo, over random poses and controllers. [theory §10]"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple

import numpy as np

from flexbase.checks import choose
from flexbase.errors import InputError, import_extra
from flexbase.model.loop import loop_on
from flexbase.plant import Plant, Pose, check_plant
from flexbase.requests import Progress, no_progress
from flexbase.sheets.sheet import Column, Sheet, answer, facts, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.study.agreement import move as agreement_move
from flexbase.study.agreement import nudge as agreement_nudge
from flexbase.study.agreement.case import Case, Outcome, draw_case
from flexbase.study.agreement.nudge import NEAR
from flexbase.study.random_poses import random_poses
from flexbase.sweeps.engine.pool import Mapper, mapping
from flexbase.synthesis import HARDWARE_METHODS

FULL = 0.55  # of the poses: a class with so many takes no more, and its poses draw again
ENOUGH, ERROR = 0.98, 0.02  # of the verdicts that come true, and of either error: good
ATTEMPTS = 40  # draws a pose


class Trial(NamedTuple):
    """How a verdict is put to the test: what is added to a drawn case, how it ends, what explains a verdict that fails.

    prepared : case and seed to case
    """

    prepared: Callable[[Case, int], Case]
    watch: Callable[[Case], Outcome]
    explain: Callable[[Case], dict[str, Any]]


def _as_drawn(case: Case, seed: int) -> Case:
    return case


TRIALS = {
    "nudge": Trial(_as_drawn, agreement_nudge.watch, agreement_nudge.explain),
    "move": Trial(agreement_move.prepared, agreement_move.watch, agreement_move.explain),
}


@dataclass(frozen=True, eq=False)
class Agreement(Told):
    """Verdicts and outcomes, case by case.

    trial : of TRIALS; redrawn : draws whose class was full; undesigned : draws whose method had no design
    explained : number of a case that disagrees -> why
    """

    robot: str
    trial: str
    seed: int
    cases: tuple[Case, ...]
    outcomes: tuple[Outcome, ...]
    redrawn: int
    undesigned: int
    explained: dict[int, dict[str, Any]] = field(default_factory=dict)

    engine: ClassVar[str] = "mujoco"
    document: ClassVar = (
        *("robot", "trial", "seed", "engine", "poses=cases.__len__", "agreement", "false_stable_rate"),
        *("false_unstable_rate", "confusion", "share_stable", "complete", "disagreements", "constant_predictor"),
        *("method_predictor", "borderline", "growth_error", "mix", "seen_by", "redrawn", "undesigned", "cases=told"),
    )

    @property
    def pairs(self) -> list[tuple[Case, Outcome]]:
        """Each case with its outcome."""
        return list(zip(self.cases, self.outcomes, strict=True))

    def confusion(self) -> dict[str, int]:
        """Counts of the four combinations."""
        words = Counter(
            f"predicted_{'stable' if case.stable else 'unstable'}_{'settled' if found.settled else 'not_settled'}"
            for case, found in self.pairs
        )
        return {f"predicted_{a}_{b}": words[f"predicted_{a}_{b}"] for a in CLASSES for b in ("settled", "not_settled")}

    @property
    def agreement(self) -> float:
        """Share of verdicts that come true."""
        return float(np.mean([a.stable == b.settled for a, b in self.pairs]))

    @property
    def false_stable_rate(self) -> float:
        """Of the loops that do not settle, the share that was called stable."""
        table = self.confusion()
        return _share(table["predicted_stable_not_settled"], table["predicted_unstable_not_settled"])

    @property
    def false_unstable_rate(self) -> float:
        """Of the loops that settle, the share that was called unstable."""
        table = self.confusion()
        return _share(table["predicted_unstable_settled"], table["predicted_stable_settled"])

    @property
    def share_stable(self) -> float:
        """Of the cases, by their verdict."""
        return float(np.mean([case.stable for case in self.cases]))

    @property
    def growth_error(self) -> float:
        """Median difference of measured and promised growth, over the promised one; NaN of moves."""
        pairs = [(a.rate, b.growth) for a, b in self.pairs if np.isfinite(b.growth)]
        return float(np.median([abs(b - a) / abs(a) for a, b in pairs])) if pairs else float("nan")

    def borderline(self) -> dict[str, Any]:
        """Cases with a spectral radius within 1e-3 of 1, in the count like all others."""
        near = [(a.stable, b.settled) for a, b in self.pairs if abs(a.radius - 1.0) < NEAR]
        return {"within": NEAR, "cases": len(near), "agreeing": sum(a == b for a, b in near)}

    def complete(self) -> dict[str, int]:
        """Cases that are stable with good disk margins on all changed robots too, and how many of them settle."""
        outcomes = [found.settled for case, found in self.pairs if case.complete]
        return {"cases": len(outcomes), "settled": sum(outcomes)}

    def constant_predictor(self) -> dict[str, Any]:
        """What always giving the commoner answer would score: the control of this experiment."""
        settled = float(np.mean([found.settled for found in self.outcomes]))
        says = settled >= 0.5
        return {
            "says": "stable" if says else "unstable",
            "agreement": max(settled, 1.0 - settled),
            "false_stable_rate": 1.0 if says else 0.0,
            "false_unstable_rate": 0.0 if says else 1.0,
        }

    def method_predictor(self) -> dict[str, float]:
        """What always giving a method's commoner answer would score: how much of the mix its name gives away."""
        told: dict[str, list[bool]] = {}
        for case, found in self.pairs:
            told.setdefault(case.method, []).append(found.settled)
        return {"agreement": sum(max(sum(one), len(one) - sum(one)) for one in told.values()) / len(self.cases)}

    def told(self) -> list[dict[str, Any]]:
        """What was drawn, the verdict and the outcome of each case."""
        return [{**case.to_dict(), **found.to_dict()} for case, found in self.pairs]

    def disagreements(self) -> list[dict[str, Any]]:
        """The cases that disagree, with what explains them."""
        wrong = [one for one in self.told() if one["predicted_stable"] != one["settled"]]
        return [{**one, "explanation": self.explained.get(one["number"])} for one in wrong]

    def seen_by(self) -> dict[str, int]:
        """How many outcomes were seen in each way."""
        return dict(Counter(found.seen for found in self.outcomes))

    def mix(self) -> dict[str, dict[str, int]]:
        """How many cases of each method were called stable and unstable."""
        counts = Counter((case.method, case.stable) for case in self.cases)
        methods = sorted({case.method for case in self.cases})
        return {name: {"stable": counts[name, True], "unstable": counts[name, False]} for name in methods}

    @property
    def good(self) -> bool:
        """Whether enough of the verdicts come true, and neither error is large."""
        return self.agreement >= ENOUGH and max(self.false_stable_rate, self.false_unstable_rate) <= ERROR

    def sheet(self) -> Sheet:
        """The counts, the errors, and each case that disagrees with what explains it."""
        counts, control, near, whole = self.confusion(), self.constant_predictor(), self.borderline(), self.complete()
        rows = [
            [f"called {a}", *(str(counts[f"predicted_{a}_{b}"]) for b in ("settled", "not_settled"))] for a in CLASSES
        ]
        growth = f"{100.0 * self.growth_error:.2g} % apart (median)"
        said = facts(
            ("unstable, called stable", f"{100.0 * self.false_stable_rate:.1f} %"),
            ("stable, called unstable", f"{100.0 * self.false_unstable_rate:.1f} %"),
            ("stable with margins, also changed", f"{whole['settled']} of {whole['cases']} settle"),
            (f"within {NEAR:g} of the border", f"{near['agreeing']} of {near['cases']} come true"),
            ("growth, measured to promised", growth) if self.trial == "nudge" else None,
            (f"always saying {control['says']}", f"{100.0 * control['agreement']:.1f} %"),
            *(("disagrees", f"case {one['number']}: {one['explanation']['why']}") for one in self.disagreements()),
        )
        share = f"{100.0 * self.agreement:.1f} % come true"
        return make_sheet(
            self.robot,
            f"linear verdicts against a {self.trial} in MuJoCo, {len(self.cases)} poses",
            table([words(""), Column("settled"), Column("not settled")], rows),
            said,
            answer(self.good, share, share),
        )


CLASSES = ("stable", "unstable")


def agreement(
    plant: Plant,
    *,
    poses: int = 500,
    seed: int = 0,
    trial: str = "nudge",
    methods: Sequence[str] | None = None,
    workers: int | None = None,
    progress: Progress = no_progress,
) -> Agreement:
    """Linear verdicts (spectral radius below 1) against outcomes in MuJoCo, one controller at each of `poses` poses.

    Drawn at each pose: method, task gains, rate, delays, rate of the task sensor, source of the acceleration; in half
    of the cases a robot that differs from the controller's model, and in half drives that are wrong by a factor. Where
    one class has 55 % of the poses, further ones draw again until the other class comes up; no draw is left out for
    being near the border. The outcome is watched without regard to the verdict.

    trial : "nudge", so small that only the linear loop matters, until it has grown or died out; or "move", the same
        controllers with encoder counts, noise, torque and slew limits, driving there from elsewhere, with a push
    methods : names of HARDWARE_METHODS, all if left out; workers : processes, one a core if left out
    The result depends on `poses`, `seed`, `trial` and `methods`, not on `workers`. Raises InputError, MissingExtra.
    """
    tried = choose("trial", trial, TRIALS)
    import_extra("mujoco", "mujoco")
    chosen = tuple(HARDWARE_METHODS) if methods is None else tuple(methods)
    for name in chosen:
        choose("method", name, HARDWARE_METHODS)
    check_plant(plant)
    _ = loop_on(plant.arm).gains  # raises where there are none
    drawn = random_poses(plant, poses, seed)
    with mapping(workers) as each:
        cases, redrawn, undesigned = _balanced(drawn, seed, chosen, each, progress)
        cases = [tried.prepared(case, seed) for case in cases]
        outcomes = []
        for found in each(tried.watch, cases):
            outcomes.append(found)
            progress("watched in MuJoCo", len(cases) + len(outcomes), 2 * len(cases))
        wrong = [case for case, found in zip(cases, outcomes, strict=True) if case.stable != found.settled]
        explained = {case.number: why for case, why in zip(wrong, each(tried.explain, wrong), strict=True)}
    return Agreement(plant.name, trial, seed, tuple(cases), tuple(outcomes), redrawn, undesigned, explained)


def _balanced(
    drawn: list[Pose], seed: int, methods: tuple[str, ...], each: Mapper, progress: Progress
) -> tuple[list[Case], int, int]:
    """One case a pose, neither class above its share; in rounds, so that the result does not depend on timing."""
    kept: dict[int, Case] = {}
    counts = {True: 0, False: 0}
    room = max(1, round(FULL * len(drawn)))
    redrawn = undesigned = 0
    waiting = list(range(len(drawn)))
    for attempt in range(ATTEMPTS):
        tasks = [(drawn[number], number, attempt, seed, methods) for number in waiting]
        left = []
        for number, case in zip(waiting, each(_draw, tasks), strict=True):
            if case is None:
                undesigned += 1
                left.append(number)
            elif counts[case.stable] >= room:
                redrawn += 1
                left.append(number)
            else:
                kept[number] = case
                counts[case.stable] += 1
                progress("controllers designed", len(kept), 2 * len(drawn))
        waiting = left
        if not waiting:
            return [kept[number] for number in range(len(drawn))], redrawn, undesigned
    raise InputError(
        f"agreement: {counts[True]} stable and {counts[False]} unstable loops found of {len(drawn)}; "
        f"{ATTEMPTS} draws a pose do not balance them. Give methods that are stable in some settings and not in others."
    )


def _draw(task: tuple[Pose, int, int, int, tuple[str, ...]]) -> Case | None:
    return draw_case(*task)


def _share(part: int, rest: int) -> float:
    return part / (part + rest) if part else 0.0

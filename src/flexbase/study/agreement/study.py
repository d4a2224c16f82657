"""Do linear verdicts come true? Each against its outcome in MuJoCo, over random poses and controllers. [theory §10]"""

from __future__ import annotations

import multiprocessing
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from flexbase.checks import choose
from flexbase.errors import InputError, import_extra
from flexbase.model.loop import loop_on
from flexbase.plant import Plant, Pose, check_plant
from flexbase.study.agreement import move as agreement_move
from flexbase.study.agreement import nudge as agreement_nudge
from flexbase.study.agreement.case import Case, Outcome, draw_case
from flexbase.study.agreement.nudge import NEAR
from flexbase.study.workspace import random_poses
from flexbase.sweeps.engine.pool import check_workers, one_blas_thread
from flexbase.synthesis import HARDWARE_METHODS
from flexbase.trace.kernel import cores

FULL = 0.55  # of the poses: a class with so many takes no more, and its poses draw again
ATTEMPTS = 40  # draws a pose
Progress = Callable[[str, int, int], None]
Mapper = Callable[[Callable[[Any], Any], Sequence[Any]], Iterator[Any]]


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
class Agreement:
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

    def confusion(self) -> dict[str, int]:
        """Counts of the four combinations."""
        words = Counter(
            f"predicted_{'stable' if case.stable else 'unstable'}_{'settled' if found.settled else 'not_settled'}"
            for case, found in zip(self.cases, self.outcomes, strict=True)
        )
        return {f"predicted_{a}_{b}": words[f"predicted_{a}_{b}"] for a in CLASSES for b in ("settled", "not_settled")}

    @property
    def agreement(self) -> float:
        """Share of verdicts that come true."""
        return float(np.mean([a.stable == b.settled for a, b in zip(self.cases, self.outcomes, strict=True)]))

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
        pairs = [(a.rate, b.growth) for a, b in zip(self.cases, self.outcomes, strict=True) if np.isfinite(b.growth)]
        return float(np.median([abs(b - a) / abs(a) for a, b in pairs])) if pairs else float("nan")

    def borderline(self) -> dict[str, Any]:
        """Cases with a spectral radius within 1e-3 of 1, in the count like all others."""
        near = [
            (a.stable, b.settled) for a, b in zip(self.cases, self.outcomes, strict=True) if abs(a.radius - 1.0) < NEAR
        ]
        return {"within": NEAR, "cases": len(near), "agreeing": sum(a == b for a, b in near)}

    def complete(self) -> dict[str, int]:
        """Cases that are stable with good disk margins on all changed robots too, and how many of them settle."""
        outcomes = [found.settled for case, found in zip(self.cases, self.outcomes, strict=True) if case.complete]
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

    def method_predictor(self) -> float:
        """What always giving a method's commoner answer would score: how much of the mix its name gives away."""
        told: dict[str, list[bool]] = {}
        for case, found in zip(self.cases, self.outcomes, strict=True):
            told.setdefault(case.method, []).append(found.settled)
        return sum(max(sum(one), len(one) - sum(one)) for one in told.values()) / len(self.cases)

    def disagreements(self) -> list[dict[str, Any]]:
        """The cases that disagree, with what explains them."""
        return [
            {**case.to_dict(), **_words(found), "explanation": self.explained.get(case.number)}
            for case, found in zip(self.cases, self.outcomes, strict=True)
            if case.stable != found.settled
        ]

    def mix(self) -> dict[str, dict[str, int]]:
        """How many cases of each method were called stable and unstable."""
        table: dict[str, dict[str, int]] = {}
        for case in self.cases:
            row = table.setdefault(case.method, {"stable": 0, "unstable": 0})
            row["stable" if case.stable else "unstable"] += 1
        return dict(sorted(table.items()))

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return {
            "robot": self.robot,
            "trial": self.trial,
            "seed": self.seed,
            "engine": "mujoco",
            "poses": len(self.cases),
            "agreement": self.agreement,
            "false_stable_rate": self.false_stable_rate,
            "false_unstable_rate": self.false_unstable_rate,
            "confusion": self.confusion(),
            "share_stable": self.share_stable,
            "complete": self.complete(),
            "disagreements": self.disagreements(),
            "constant_predictor": self.constant_predictor(),
            "method_predictor": {"agreement": self.method_predictor()},
            "borderline": self.borderline(),
            "growth_error": self.growth_error,
            "mix": self.mix(),
            "seen_by": dict(Counter(found.seen for found in self.outcomes)),
            "redrawn": self.redrawn,
            "undesigned": self.undesigned,
            "cases": [
                {**case.to_dict(), **_words(found)} for case, found in zip(self.cases, self.outcomes, strict=True)
            ],
        }

    def summary(self) -> str:
        """A few lines in plain text."""
        control = self.constant_predictor()
        return (
            f"{self.robot}: {len(self.cases)} poses, {100 * self.agreement:.1f} % of the linear verdicts come true\n"
            f"  called stable and does not settle {100 * self.false_stable_rate:.1f} %, "
            f"called unstable and settles {100 * self.false_unstable_rate:.1f} %\n"
            f"  always saying {control['says']}: {100 * control['agreement']:.1f} %"
        )


CLASSES = ("stable", "unstable")


def agreement_study(
    plant: Plant,
    *,
    poses: int = 500,
    seed: int = 0,
    trial: str = "nudge",
    methods: Sequence[str] | None = None,
    workers: int | None = None,
    progress: Progress = lambda what, done, total: None,
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
    check_workers(workers)
    drawn = random_poses(plant, poses, seed)
    with _mapper(workers or cores()) as each:
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


@contextmanager
def _mapper(workers: int) -> Iterator[Mapper]:
    """`map`, over processes: results in order."""
    if workers == 1:
        yield map
        return
    with one_blas_thread(), ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn")) as pool:
        try:
            yield pool.map
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _draw(task: tuple[Pose, int, int, int, tuple[str, ...]]) -> Case | None:
    return draw_case(*task)


def _share(part: int, rest: int) -> float:
    return part / (part + rest) if part else 0.0


def _words(found: Outcome) -> dict[str, Any]:
    return {
        "settled": found.settled,
        "seen": found.seen,
        "seconds": found.seconds,
        "measured_growth_per_s": found.growth,
    }

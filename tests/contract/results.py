"""An example of every result, or several where it has several faces: what all results keep to is tested over them."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import flexbase as fb
from flexbase.sheets.told import Told
from flexbase.study.agreement.case import Outcome, draw_case
from systems.planar import PAPER_TIP


@cache
def paper() -> fb.Plant:
    """The paper's arm."""
    return fb.load("ueda2003")


@cache
def pose() -> fb.Pose:
    """The pose of theory §9."""
    return paper().at_tip(PAPER_TIP)


@cache
def compensator() -> fb.Compensator:
    """Made for that pose."""
    return fb.design(pose(), "exact")


def controller(method: str) -> fb.SampledController:
    """For the loop that a project without [sensing] gets."""
    return fb.make_controller(pose(), method)


def as_it_runs() -> fb.AsItRuns:
    """Of that compensator."""
    found = fb.as_it_runs(pose(), compensator())
    assert found is not None
    return found


def recommendation(*methods: str) -> fb.Recommendation:
    """At a rate where some of them run."""
    return fb.recommend(pose(), loop=fb.Loop(sensing=fb.Sensing(rate=4000.0)), methods=methods)


def agreement() -> fb.Agreement:
    """Of two drawn loops, with outcomes as they might be: one verdict does not come true."""
    drawn = [draw_case(pose(), number, 0, 0, ("none", "viscous")) for number in range(2)]
    cases = tuple(case for case in drawn if case is not None)
    outcomes = (Outcome(cases[0].stable, "decayed", 1.0, -2.0), Outcome(not cases[1].stable, "slope", 8.0, math.nan))
    return fb.Agreement("ueda2003", "nudge", 0, cases, outcomes, 0, 0, {1: {"why": "unexplained"}})


EXAMPLES: dict[str, Callable[[], Told]] = {
    "modes": lambda: fb.modes(pose()),
    "modes, compensated": lambda: fb.modes(pose(), compensator()),
    "verdict": lambda: fb.verdict(pose()),
    "verdict, positive real": lambda: fb.verdict(pose(), compensator(), bandwidth=500.0),
    "verdict on a system": lambda: fb.verdict(fb.linearise(pose())),
    "manipulability": lambda: fb.manipulability(pose()),
    "manipulability, compensated": lambda: fb.manipulability(pose(), compensator(), "torque"),
    "hardware verdict": lambda: fb.hardware_verdict(controller("coprime")),
    "hardware verdict, unstable": lambda: fb.hardware_verdict(controller("exact")),
    "comparison": lambda: fb.compare(pose(), ["none", "exact", "coprime"]),
    "safe gain": lambda: fb.safe_gain(pose(), "none"),
    "controller": lambda: controller("exact"),
    "controller with notes": lambda: controller("robust"),
    "recommendation": lambda: recommendation("none", "viscous"),
    "recommendation, none": lambda: recommendation("none"),
    "hardware study": lambda: fb.hardware_study(paper(), poses=2, methods=["none", "viscous"], workers=1),
    "agreement": agreement,
    "a compensator as it runs": lambda: as_it_runs(),
}


@cache
def example(name: str) -> Told:
    """Made once."""
    return EXAMPLES[name]()

"""An example of every result, or several where it has several faces: what all results keep to is tested over them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

import flexbase as fb
from flexbase.cautions import collected
from flexbase.sheets.told import Told
from flexbase.study.agreement.case import Outcome, draw_case
from flexbase.study.paper.table import PaperRow, Reproduction
from systems.planar import PAPER_TIP

if TYPE_CHECKING:
    import xarray


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


def wide() -> fb.Pose:
    """Six joints."""
    return fb.load("ur5e-pedestal").at_tip([0.72, -0.35, 1.3], "-+-")


def wide_compensator() -> fb.Compensator:
    """Made there, without task gains and with a caution."""
    with collected(quietly=True):
        found = fb.design(wide(), "convex")
    proof = replace(found.certificate, closed_loop_abscissa=None, lag_limit_s=None, warnings=("beware of <b>",))
    return replace(found, certificate=proof)


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


VARY = {"payload": "uniform(0,2)"}
SMALL = fb.Cells(shape=(3, 2))


def map_of(loop: fb.Compensator | None = None) -> xarray.Dataset:
    """Two measures in a few cells, one of them a mode's."""
    return fb.sweep(paper(), ["robustness", "manipulability"], SMALL, loop=loop)


DATASETS: dict[str, Callable[[], xarray.Dataset]] = {
    "map": map_of,
    "difference": lambda: fb.difference(map_of(), map_of(compensator())),
    "hardware map": lambda: fb.hardware_map(paper(), "none", SMALL, execution=fb.Execution(workers=1)),
}


def run() -> fb.Run:
    """From one tip to the pose."""
    return fb.simulate(paper(), paper().at_tip([0.33, 0.25]), pose(), move=fb.Move(switch=0.05, end=0.1))


def sampled_run(method: str) -> fb.SampledRun:
    """Pushed at the pose."""
    return fb.simulate_sampled(controller(method), push=fb.Push((50.0, 0.0), 0.05, 0.01), move=fb.SampledMove(end=0.2))


def runs(*stiffness: float) -> fb.Runs:
    """The same move with other base springs."""
    here = paper().at_tip([0.33, 0.25])
    return fb.simulate_many(paper(), here, pose(), vary={"stiffness": stiffness})


def no_points() -> fb.RobustPoints:
    """As where no sample arrives."""
    some, none = fb.robust_points(paper(), count=1), np.empty(0)
    arrays = {name: none.reshape(0, getattr(some, name).shape[1]) for name in ("joints", "tip", "alignment")}
    return replace(some, **arrays, distance=none, nearest=0.98)


EXAMPLES: dict[str, Callable[[], Told]] = {
    "modes": lambda: fb.modes(pose()),
    "modes, compensated": lambda: fb.modes(pose(), compensator()),
    "verdict": lambda: fb.verdict(pose()),
    "verdict, positive real": lambda: fb.verdict(pose(), compensator(), bandwidth=500.0),
    "verdict on a system": lambda: fb.verdict(fb.linearise(pose())),
    "manipulability": lambda: fb.manipulability(pose()),
    "manipulability, compensated": lambda: fb.manipulability(pose(), compensator(), "torque"),
    "compensator": lambda: compensator(),
    "compensator of a wide arm": lambda: wide_compensator(),
    "run": lambda: run(),
    "sampled run": lambda: sampled_run("coprime"),
    "sampled run, diverging": lambda: sampled_run("exact"),
    "runs": lambda: runs(0.9, 1.0),
    "check": lambda: fb.check(paper()),
    "check at a pose": lambda: fb.check(fb.load("ur5e-pedestal"), wide()),
    "postures": lambda: fb.postures(paper(), PAPER_TIP),
    "layout": lambda: fb.layout(paper(), [PAPER_TIP, (0.2, -0.3), (9.0, 9.0)], along=["x"], within=0.1),
    "robust curves": lambda: fb.robust_curves(paper(), cells=60),
    "robust points": lambda: fb.robust_points(paper(), count=20),
    "robust points, none": lambda: no_points(),
    "robots": fb.robots,
    "paper": lambda: Reproduction((PaperRow("w_1", -0.07, -0.0708, remark="read off"),)),
    "hardware verdict": lambda: fb.hardware_verdict(controller("coprime")),
    "hardware verdict, unstable": lambda: fb.hardware_verdict(controller("exact")),
    "comparison": lambda: fb.compare(pose(), ["none", "exact", "coprime"]),
    "safe gain": lambda: fb.safe_gain(pose(), "none"),
    "region": lambda: fb.region(pose(), "none", half_width=0.01, shape=(2, 2), execution=fb.Execution(workers=1)),
    "hardware path": lambda: fb.hardware_path(paper(), [[0.2, 0.4], PAPER_TIP, [2.0, 2.0]], workers=1),
    "Monte Carlo at a pose": lambda: fb.montecarlo(pose(), fb.Draws(VARY, samples=20)),
    "Monte Carlo map": lambda: fb.montecarlo(paper(), fb.Draws(VARY, samples=20), cells=SMALL),
    "controller": lambda: controller("exact"),
    "controller with notes": lambda: controller("robust"),
    "recommendation": lambda: recommendation("none", "viscous"),
    "recommendation, none": lambda: recommendation("none"),
    "hardware study": lambda: fb.hardware_study(paper(), poses=2, methods=["none", "viscous"], workers=1),
    "agreement": agreement,
    "a compensator as it runs": lambda: as_it_runs(),
}


@cache
def example(name: str) -> Told | xarray.Dataset:
    """Made once."""
    return {**EXAMPLES, **DATASETS}[name]()

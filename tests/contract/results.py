"""An example of every result, or several where it has several faces: what all results keep to is tested over them."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import flexbase as fb
from flexbase.sheets.told import Told
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
    "a compensator as it runs": lambda: as_it_runs(),
}

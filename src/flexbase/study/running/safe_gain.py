"""How stiff may the task-space loop be? The highest gain at which a method's controller is safe, or merely stable."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from flexbase.checks import choose
from flexbase.errors import FlexbaseError, InputError
from flexbase.model.loop import Asked, loop_on
from flexbase.model.task import Gains
from flexbase.plant import Pose, check_pose
from flexbase.sampled.judged import Judged, Robots, robots_at
from flexbase.sheets.numbers import number
from flexbase.sheets.sheet import Column, Sheet, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.synthesis import HARDWARE_METHODS, controller_for

SMALLEST, LARGEST, LOOKS = 1e-3, 1e2, 11  # scales looked at first: a factor of about 3 apart
HALVINGS = 5  # of the last factor: to 4 %


@dataclass(frozen=True)
class SafeGain(Told):
    """The largest scale s of the gains (s Kp, sqrt(s) Kv) up to which a method was found to do; None: at none.

    safe : stable, both disk margins 0.3 or more, and stable on all changed robots; stable : merely stable
    safe_stiffness : smallest static stiffness of the tip at the safe scale [N/m or N m/rad]
    unsafe_below : a scale below the safe one that is not safe was seen, so the answer is no simple bound
    """

    method: str
    safe: float | None
    stable: float | None
    safe_stiffness: float | None
    unsafe_below: bool

    def sheet(self) -> Sheet:
        """A table of one row."""
        return sheet_of_gains([self])


def sheet_of_gains(found: Sequence[SafeGain]) -> Sheet:
    """The highest safe and the highest stable scale of the gains, a row a method."""
    rows = [
        (
            f"{one.method}{' (not below all of it)' if one.unsafe_below else ''}",
            *(("none", "-") if one.safe is None else (number(one.safe, 3), number(one.safe_stiffness, 3))),
            "none" if one.stable is None else number(one.stable, 3),
        )
        for one in found
    ]
    columns = (
        words("method"),
        Column("safe up to", "times the gains"),
        Column("stiffness there", "N/m"),
        Column("stable up to", "times the gains"),
    )
    asked = f"(s Kp, root of s Kv), s from {SMALLEST:g} to {LARGEST:g}"
    return make_sheet("Highest gains", asked, table(columns, rows))


def safe_gain(pose: Pose, method: str = "none", loop: Asked = None) -> SafeGain:
    """The highest safe and stable scale from 0.001 to 100, the method designing anew at each scale.

    `constant` keeps to the scale that is asked; the loop-shaping methods choose a softer one where it is too much.
    Looked for on a grid from the top down, then bisected between the first that does and its neighbour above.
    Raises InputError.
    """
    check_pose(pose)
    meant = loop_on(pose.arm, loop)
    robots = robots_at(pose, meant.sensing)
    known: dict[float, Judged | None] = {}

    def at(scale: float) -> Judged | None:
        if scale not in known:
            known[scale] = _judged(robots, method, meant.scaled(scale))
        return known[scale]

    def is_stable(scale: float) -> bool:
        return (found := at(scale)) is not None and found.stable

    def is_safe(scale: float) -> bool:
        return (found := at(scale)) is not None and found.accepted()

    scales = np.geomspace(SMALLEST, LARGEST, LOOKS).tolist()
    stable, safe = _highest(scales, is_stable), _highest(scales, is_safe)
    best = None if safe is None else at(safe)
    if safe is None or best is None:
        return SafeGain(method, None, stable, None, False)
    holes = any(not is_safe(scale) for scale in list(known) if scale < safe)
    return SafeGain(method, safe, stable, best.figure("tip_stiffness"), holes)


def _highest(scales: list[float], does: Callable[[float], bool]) -> float | None:
    above = None
    for scale in reversed(scales):
        if does(scale):
            break
        above = scale
    else:
        return None
    low, high = scale, above
    for _ in range(HALVINGS if high is not None else 0):
        middle = float(np.sqrt(low * high))  # type: ignore[operator]
        low, high = (middle, high) if does(middle) else (low, middle)
    return float(low)


def _judged(robots: Robots, method: str, gains: Gains) -> Judged | None:
    """The method's controller, judged; None where it has none."""
    try:
        as_given = choose("method", method, HARDWARE_METHODS).as_given
        return Judged(controller_for(robots.pose, method, robots.sensing, gains, **as_given), robots)
    except InputError:
        raise
    except FlexbaseError:
        return None

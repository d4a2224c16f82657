"""Robust arm configurations in numbers: what `flexbase rac` shows."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.terminal.show import facts, table
from flexbase.sheets.numbers import number
from flexbase.study.robust_configurations.curves import RobustCurves
from flexbase.study.robust_configurations.points import RobustPoints


def curves(found: RobustCurves) -> list[RenderableType]:
    """A row a curve."""
    rows = [
        [str(i), str(one.mode), "closed" if one.closed else "open", str(len(one.joints)), number(one.length, 6)]
        for i, one in enumerate(found.curves, start=1)
    ]
    said = [("over", ", ".join(found.axes)), ("largest |sin(a, b)|", number(found.residual, 2))]
    return ["", facts(said), table(["curve", "mode", "kind", "points", "length"], rows, (0, 2), blank_after=False)]


def points(found: RobustPoints) -> list[RenderableType]:
    """How many postures there are, and how far their joints and tips reach."""
    said = [
        ("modes", ", ".join(map(str, found.modes))),
        ("postures", f"{len(found.joints)} of {found.samples} samples"),
    ]
    said += [("largest |a/|a| - b/|b||", number(found.residual, 2))] if len(found.joints) else []
    said += [("nearest alignment", number(found.nearest, 6))] if found.nearest is not None else []
    arm = found.plant.arm
    names = [*arm.joint_names, *(f"{row} of the tip" for row in arm.task.rows)]
    both = [*found.joints.T, *found.tip.T] if len(found.joints) else []
    rows = [[name, number(min(v), 5), number(max(v), 5)] for name, v in zip(names, both, strict=False)]
    return ["", facts(said), *([table(["of the postures", "least", "largest"], rows)] if rows else [])]

"""What a project says and what holds at a pose, as tables."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.terminal.show import facts, table, title
from flexbase.sheets import units
from flexbase.sheets.numbers import listed, number
from flexbase.study.describe import Description


def tables(found: Description) -> list[RenderableType]:
    """Heading, the joints, and the facts; with a pose, also what holds there."""
    arm = found.plant.arm
    counts = f"{arm.m} base and {arm.n} arm joints, {arm.k} task rows"
    return [title(found.plant.name, counts), _joints(found), facts([*_project(found), *_at_pose(found)])]


def _joints(found: Description) -> RenderableType:
    columns, rows = ["joint", "part", "type"], [[joint["name"], joint["part"], joint["type"]] for joint in found.joints]
    if found.pose is not None:
        kinds = [joint["unit"] for joint in found.joints]
        arm, none = found.plant.arm, [""] * found.plant.arm.m
        torques = arm.parts.whole(none, [*map(number, found.pose.holding_torque)])
        efforts = arm.parts.whole(none, [*units.each("effort", arm.joint_units)])
        columns += ["position", "holding torque"]
        for row, q, kind, torque, effort in zip(rows, found.pose.q, kinds, torques, efforts, strict=True):
            row += [f"{number(q)} {kind}", f"{torque} {effort}".strip()]
    return table(columns, rows, words=(0, 1, 2))


def _project(found: Description) -> list[tuple[str, object]]:
    arm, gains, rows = found.plant.arm, found.plant.arm.gains, found.plant.arm.task.units
    base = [(joint["name"], joint["unit"]) for joint in found.joints if joint["part"] == "base"]
    names, kinds = [name for name, _ in base], [kind for _, kind in base]
    said: list[tuple[str, object]] = [("task rows", f"{' '.join(arm.task.rows)}, elbow {arm.task.branch}")]
    if arm.m:
        said += [
            (f"base stiffness [{units.common('stiffness', kinds)}]", arm.base.stiffness),
            (f"base damping [{units.common('damping', kinds)}]", arm.base.damping),
            ("base equilibrium", listed(arm.base.equilibrium, names, kinds)),
        ]
    if gains is not None:
        said += [
            (f"task stiffness [{units.common('stiffness', rows)}]", gains.stiffness),
            (f"task damping [{units.common('damping', rows)}]", gains.damping),
        ]
    if arm.sensing is not None:
        said += [("sensing", arm.sensing.summary())]
    return [*said, ("gravity", f"{listed(arm.gravity, 'xyz')} m/s^2" if arm.has_gravity else "none")]


def _at_pose(found: Description) -> list[tuple[str, object]]:
    if found.pose is None or found.sag is None:
        return []
    task, base = found.plant.arm.task, found.joints[: len(found.sag)]
    sag = listed(found.sag, [joint["name"] for joint in base], [joint["unit"] for joint in base])
    return [
        ("tip", listed(found.pose.tip, task.rows, task.units)),
        ("condition number of M", number(found.condition_number, 6)),
        ("base sag", sag or "none: rigid base"),
    ]

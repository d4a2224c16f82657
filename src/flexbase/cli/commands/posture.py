"""`flexbase posture`: the joints in which the arm stands best on a target."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter
from rich.console import RenderableType

from flexbase.cli.options.common import CompensatorFile, Json, blaming, option
from flexbase.cli.options.elbow import AnyElbow
from flexbase.cli.options.pose import Robot, compensator_of
from flexbase.cli.options.words import Vector, numbers
from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import Out, check_out, write_out, written
from flexbase.cli.terminal.show import facts, put, table, title
from flexbase.errors import InputError
from flexbase.plant import load
from flexbase.sheets.numbers import listed, number
from flexbase.study.postures.best_postures import Posture, Postures, postures
from flexbase.study.postures.objective import climbable

app = App(
    name="posture",
    help_epilogue=f"""Examples:
  flexbase posture ueda2003 --tip 0.33,-0.25
  flexbase posture ur5e-pedestal --tip 0.4,0.2,1.0 --out posture.png
  flexbase posture iiwa-platform --tip 0.5,0.2,1.0 --measure alignment

Of measures with a value for each mode the worst counts. Joint limits are not
looked at. Measures: {", ".join(climbable())}.""",
)
MOST = 12  # in the table


@app.default
def posture(
    robot: Robot,
    /,
    *,
    tip: Annotated[Vector | None, option(numbers, "X,Y", "where the tip rests, one number a task row")] = None,
    elbow: AnyElbow = None,
    measure: Annotated[str, Parameter(metavar="NAME", help="what is made best; robustness if left out")] = "robustness",
    compensator: CompensatorFile = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """The best arm joints for a target, over branches and, of redundant arms, the self-motion."""
    check_out(out)
    if tip is None:
        raise InputError("--tip is missing. Say where the tip rests, such as --tip 0.33,-0.25.")
    plant = load(robot)
    used = compensator_of(plant, compensator)
    with blaming("--tip"):
        found = postures(plant, tip, measure, branch=elbow, loop=used)
    content = found.to_dict()
    write_out(out, "posture", found, content)
    put(document("posture", content)) if json else put(*_tables(found), *written(out))


def _tables(found: Postures) -> list[RenderableType]:
    arm, several = found.plant.arm, len(found.best.modes) > 1
    rows = [_row(str(i), one, several) for i, one in enumerate(found.found[:MOST], start=1)]
    rows += [_row("unasked", found.usual, several)] if found.usual else []
    unit = "" if found.measure.unit == "1" else f"\n[{found.measure.unit}]"
    modes = [f"mode {i + 1}" for i in range(len(found.best.modes))] if several else []
    best = listed(found.best.joints, arm.joint_names, arm.joint_units)
    heading = f"postures by {found.measure.name} {'with' if found.compensated else 'without'} compensator"
    where = listed(found.target, arm.task.rows, arm.task.units)
    return [
        title(found.plant.name, heading),
        "",
        facts([("tip", where), ("best joints", best)]),
        table(["posture", "branch", f"{found.measure.name}{unit}", *modes], rows, words=(0, 1), blank_after=False),
    ]


def _row(name: str, one: Posture, several: bool) -> list[str]:
    return [name, one.branch, number(one.value, 6), *(number(value, 6) for value in one.modes if several)]

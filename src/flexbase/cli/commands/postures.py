"""`flexbase postures`: the joints in which the arm stands best on a target."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import CompensatorFile, Json, blaming, option
from flexbase.cli.options.pose import AnyElbow, Robot, compensator_of
from flexbase.cli.options.values import Vector, numbers
from flexbase.cli.terminal.out import Out, check_out
from flexbase.cli.terminal.show import show
from flexbase.errors import InputError
from flexbase.plant import load
from flexbase.study.postures.best_postures import postures as postures_of
from flexbase.study.postures.objective import climbable

app = App(
    name="postures",
    help_epilogue=f"""Examples:
  flexbase postures ueda2003 --tip 0.33,-0.25
  flexbase postures ur5e-pedestal --tip 0.4,0.2,1.0 --out posture.png
  flexbase postures iiwa-platform --tip 0.5,0.2,1.0 --measure alignment

Of measures with a value for each mode the worst counts. Joint limits are not
looked at. Measures: {", ".join(climbable())}.""",
)


@app.default
def postures(
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
        found = postures_of(plant, tip, measure, branch=elbow, loop=used)
    show("postures", found, json, out)

"""`flexbase ellipsoid`: dynamic manipulability in both conventions."""

from __future__ import annotations

from math import degrees
from typing import Annotated

from cyclopts import App, Parameter
from rich.console import RenderableType

from flexbase.checks import choose
from flexbase.cli.options.common import CompensatorFile, Json
from flexbase.cli.options.pose import PoseOptions, Robot, compensator_of, where
from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import Out, check_out, write_out, written
from flexbase.cli.terminal.show import facts, put, table, title
from flexbase.measures.manipulability import CONVENTIONS, Manipulability, manipulability
from flexbase.plant import load
from flexbase.sheets.numbers import number

app = App(
    name="ellipsoid",
    help_epilogue="""Examples:
  flexbase ellipsoid ueda2003 --tip 0.33,-0.25
  flexbase ellipsoid ueda2003 --tip 0.33,-0.25 --compensator E.json
  flexbase ellipsoid ueda2003 --tip 0.33,-0.25 --convention torque -o e.svg

force: tip accelerations for |f| <= 1 (the paper's); torque: for |tau| <= 1.
A picture shows the convention asked for, or force.""",
)


@app.default
def ellipsoid(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),  # noqa: B008
    compensator: CompensatorFile = None,
    convention: Annotated[
        str | None, Parameter(metavar="NAME", help="show only force or torque; JSON holds both")
    ] = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Semi-axes and directions of the tip's acceleration, the base held still."""
    check_out(out)
    shown = CONVENTIONS if convention is None else (choose("--convention", convention, {n: n for n in CONVENTIONS}),)
    plant = load(robot)
    there, used = pose.pose(plant), compensator_of(plant, compensator)
    found = {name: manipulability(there, used, name) for name in CONVENTIONS}
    content = {"q": there.q.tolist(), "tip": there.tip.tolist(), **{name: one.to_dict() for name, one in found.items()}}
    write_out(out, "ellipsoid", found[shown[0]], content)
    if json:
        put(document("ellipsoid", content))
        return
    heading = f"dynamic manipulability {'without' if used is None else 'with'} compensator"
    put(title(plant.name, heading), "", where(there))
    for name in shown:
        put("", *_tables(found[name], there.arm.task.rows, used is not None))
    put(*written(out))


def _tables(found: Manipulability, rows: tuple[str, ...], compensated: bool) -> list[RenderableType]:
    force = found.original.convention == "force"
    ball = "|f| <= 1 N" if force else "|tau| <= 1 N m (or N)"
    kinds = {"original": found.original, **({"compensated": found.compensated} if compensated else {})}
    columns = ["ellipsoid", "semi-axis\n[m/s^2]", *(f"direction\n{row}" for row in rows)]
    lines = [
        [name if i == 0 else "", number(one.semi_axes[i]), *(number(entry, 6) for entry in one.directions[:, i])]
        for name, one in kinds.items()
        for i in range(len(one.semi_axes))
    ]
    drawn: list[RenderableType] = [
        title(f"Convention {found.original.convention}", ball),
        table(columns, lines, blank_after=compensated),
    ]
    turned = ("longest axis turned by", f"{number(degrees(found.rotation), 6)} deg")
    return [*drawn, facts([turned, ("volume times", number(found.volume_ratio, 6))])] if compensated else drawn

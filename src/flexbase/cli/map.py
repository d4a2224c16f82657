"""`flexbase map`: measures over a plane of configurations."""

from __future__ import annotations

from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.chart import tables
from flexbase.cli.document import document
from flexbase.cli.options import CompensatorFile, Json, option
from flexbase.cli.out import PICTURES, OutFile, check_out, write_out, written
from flexbase.cli.plane import PlaneOptions
from flexbase.cli.pose import Robot, compensator_of
from flexbase.cli.progress import progress_bar
from flexbase.cli.show import put
from flexbase.cli.words import Names, names
from flexbase.plant import load
from flexbase.sweep import sweep

app = App(
    name="map",
    help_epilogue="""Examples:
  flexbase map ueda2003 --out robustness.png
  flexbase map ueda2003 --measures robustness,alignment --over joints
  flexbase map ueda2003 --bounds -0.4,0.8,-0.6,0.6 --shape 200,200 -o map.csv

Measures: robustness, alignment, turn, frequency, damping, compensability,
manipulability.""",
)
Out = Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf), .csv or .json")]


@app.default
def map_plane(
    robot: Robot,
    /,
    *,
    measures: Annotated[
        Names, option(names, "NAMES", "with commas; robustness if left out", ("--measures", "--measure"))
    ] = ("robustness",),
    plane: PlaneOptions = PlaneOptions(),  # noqa: B008
    compensator: CompensatorFile = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Measures in every cell, the base at its equilibrium; cells out of reach or singular have none."""
    check_out(out, (*PICTURES, ".csv", ".json"))
    plane.check()
    plant = load(robot)
    used = compensator_of(plant, compensator)
    with progress_bar() as report:
        found = sweep(
            plant,
            measures,
            plane.over,
            plane.shape,  # type: ignore[arg-type]  # the library says what is wrong with other counts
            bounds=plane.bounds,
            branch=plane.elbow,
            joints=plane.axes,
            hold=plane.hold,
            compensator=used,
            progress=lambda done, total: report("cells", done, total),
        )
    content = found.to_dict() if json or (out and out.suffix.lower() == ".json") else {}
    write_out(out, "map", found, content)
    put(document("map", content)) if json else put(*tables(found), *written(out))

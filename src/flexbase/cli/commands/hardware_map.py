"""`flexbase hardware-map`: verdicts on the loop as it runs, over the tip's plane."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.cells import TipCells, VerdictExecution
from flexbase.cli.options.common import Json
from flexbase.cli.options.loop import CompensatedLoopOptions
from flexbase.cli.options.pose import Robot
from flexbase.cli.terminal.cells_bar import cells_bar
from flexbase.cli.terminal.map_files import check_map_out, show_map, store_of
from flexbase.cli.terminal.out import OutFile
from flexbase.plant import load
from flexbase.study.running.hardware_map import hardware_map as map_of

app = App(
    name="hardware-map",
    help_epilogue="""Examples:
  flexbase hardware-map ueda2003 --method coprime --out map.png
  flexbase hardware-map ueda2003 --shape 100,100 --out map.zarr --resume
  flexbase hardware-map ueda2003 --compensator E.json --shape 40,40""",
)
Out = Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf .html), .csv, .json, .nc or .zarr")]


@app.default
def hardware_map(
    robot: Robot,
    /,
    *,
    method: Annotated[str, Parameter(metavar="NAME", help="designed anew in every cell; none if left out")] = "none",
    cells: TipCells = TipCells(),
    loop: CompensatedLoopOptions = CompensatedLoopOptions(),
    execution: VerdictExecution = VerdictExecution(),
    out: Out = None,
    json: Json = False,
) -> None:
    """Stability, margins, changed robots and stiffness, each cell with a controller of its own."""
    check_map_out(out, execution.resume)
    plant = load(robot)
    with cells_bar(store_of(out)) as progress:
        how = replace(execution, store=store_of(out))
        found = map_of(plant, method, cells, loop=loop.loop(plant), execution=how, progress=progress)
    show_map("hardware-map", found, json, out)

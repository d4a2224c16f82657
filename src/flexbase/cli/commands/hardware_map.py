"""`flexbase hardware-map`: verdicts on the loop as it runs, over the tip's plane or along a path."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

from cyclopts import App, Parameter

from flexbase.cli.options.cells import TipCells, VerdictExecution
from flexbase.cli.options.common import CompensatorFile, Json
from flexbase.cli.options.gains import GainOptions
from flexbase.cli.options.pose import Robot, compensator_of
from flexbase.cli.options.sensing import SensingOptions
from flexbase.cli.options.tips import tips_of
from flexbase.cli.terminal.cells_bar import cells_bar
from flexbase.cli.terminal.map_files import check_map_out, show_map, store_of
from flexbase.cli.terminal.out import OutFile
from flexbase.cli.terminal.show import show
from flexbase.model.loop import Loop
from flexbase.plant import load
from flexbase.study.running.hardware_map import hardware_map
from flexbase.study.running.hardware_path import hardware_path

app = App(
    name="hardware-map",
    help_epilogue="""Examples:
  flexbase hardware-map ueda2003 --method coprime --out map.png
  flexbase hardware-map ueda2003 --shape 100,100 --out map.zarr --resume
  flexbase hardware-map ueda2003 --compensator E.json --path tips.csv""",
)
Out = Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf .html), .csv, .json, .nc or .zarr")]


@app.default
def map_verdicts(
    robot: Robot,
    /,
    *,
    method: Annotated[str, Parameter(metavar="NAME", help="designed anew in every cell; none if left out")] = "none",
    compensator: CompensatorFile = None,
    cells: TipCells = TipCells(),  # noqa: B008
    path: Annotated[Path | None, Parameter(metavar="FILE", help="instead: tips, one a line (.csv)")] = None,
    loop: GainOptions = GainOptions(),  # noqa: B008
    run: SensingOptions = SensingOptions(),  # noqa: B008
    execution: VerdictExecution = VerdictExecution(),  # noqa: B008
    out: Out = None,
    json: Json = False,
) -> None:
    """Stability, margins, changed robots and stiffness, each cell with a controller of its own."""
    check_map_out(out, execution.resume)
    plant = load(robot)
    meant = Loop(compensator_of(plant, compensator), loop.gains(plant), run.sensing(plant))
    with cells_bar(store_of(out)) as progress:
        if path is not None:
            given: dict[str, Any] = {"branch": cells.branch, "workers": execution.workers, "progress": progress}
            return show("hardware-path", hardware_path(plant, tips_of(path), method, loop=meant, **given), json)
        how = replace(execution, store=store_of(out))
        found = hardware_map(plant, method, cells, loop=meant, execution=how, progress=progress)
    show_map("hardware-map", found, json, out)
    return None

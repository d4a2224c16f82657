"""`flexbase sweep`: measures over many configurations."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.cells import CellOptions, ExecutionOptions
from flexbase.cli.options.common import CompensatorFile, Json, option
from flexbase.cli.options.pose import Robot, compensator_of
from flexbase.cli.options.values import Names, names
from flexbase.cli.terminal.map_files import check_map_out, show_map, store_of
from flexbase.cli.terminal.out import OutFile
from flexbase.cli.terminal.sweeping import check_difference, compared, swept
from flexbase.measures import MEASURES
from flexbase.plant import load

app = App(
    name="sweep",
    help_epilogue=f"""Examples:
  flexbase sweep ueda2003 --out robustness.png
  flexbase sweep ueda2003 --measures robustness,alignment --over joints
  flexbase sweep ueda2003 --shape 10000,10000 --out big.zarr --resume
  flexbase sweep ueda2003 --compensator E.json --difference --out change.html
  flexbase sweep ur5e-pedestal --hold 0.4 --vary payload=0:5:6 -o map.nc

Measures: {", ".join(MEASURES)}.""",
)
Out = Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf .html), .csv, .json, .nc or .zarr")]


@app.default
def sweep(
    robot: Robot,
    /,
    *,
    measures: Annotated[
        Names, option(names, "NAMES", "with commas; robustness if left out", ("--measures", "--measure"))
    ] = ("robustness",),
    cells: CellOptions = CellOptions(),
    execution: ExecutionOptions = ExecutionOptions(),
    compensator: CompensatorFile = None,
    difference: Annotated[bool, Parameter(help="what the compensator changes: with it minus without")] = False,
    out: Out = None,
    json: Json = False,
) -> None:
    """Measures in every cell, the base at its equilibrium; cells out of reach or singular have none."""
    check_map_out(out, execution.resume)
    check_difference(difference, compensator, out)
    plant = load(robot)
    used = compensator_of(plant, compensator)
    how = replace(execution, store=store_of(out))
    ask = compared if difference else swept
    found = ask(plant, measures, cells, how, used)
    show_map("sweep", found, json, out)

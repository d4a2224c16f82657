"""`flexbase montecarlo`: how sure a design is when the plant is not known exactly."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.cells import DrawOptions, StudyCells, StudyExecution
from flexbase.cli.options.common import CompensatorFile, Json, option
from flexbase.cli.options.pose import PoseOptions, Robot, compensator_of
from flexbase.cli.options.values import Names, names
from flexbase.cli.terminal.out import PICTURES, OutFile, check_out
from flexbase.cli.terminal.progress import progress_bar
from flexbase.cli.terminal.show import show
from flexbase.plant import Pose, load
from flexbase.study.montecarlo import CRITERIA, DISTRIBUTIONS, montecarlo

app = App(
    name="montecarlo",
    help_epilogue=f"""Examples:
  flexbase montecarlo ueda2003 --redesign --vary payload=uniform:0:3 -o map.png
  flexbase montecarlo ueda2003 --tip 0.33,-0.25 --compensator E.json \\
    --vary 'stiffness=normal(1,0.15),link_mass=lognormal(1,0.05)'

Distributions: {", ".join(DISTRIBUTIONS)}.
Criteria: {", ".join(CRITERIA)}; or a measure's bounds: frequency=250:
Parameters: those of map --vary.""",
)
Out = Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf), .csv, .json or .nc")]


@app.default
def probability(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    cells: StudyCells = StudyCells(),
    draws: DrawOptions = DrawOptions(),
    criterion: Annotated[
        Names, option(names, "NAMES", "with commas, all must hold; definite,robust", ("--criterion", "--criteria"))
    ] = ("definite", "robust"),
    compensator: CompensatorFile = None,
    redesign: Annotated[bool, Parameter(help="instead: the exact design for the plant as it is, of each pose")] = False,
    execution: StudyExecution = StudyExecution(),
    out: Out = None,
    json: Json = False,
) -> None:
    """Probability that a design holds while the plant varies: at a --tip or --joints, else in every cell of a map."""
    check_out(out, (*PICTURES, ".csv", ".json", ".nc"))
    plant = load(robot)
    where = plant if pose.tip is None and pose.joints is None else pose.pose(plant)
    used = compensator_of(plant, compensator)
    with progress_bar() as report:
        found = montecarlo(
            where,
            draws,
            loop=used,
            redesign=redesign,
            criteria=criterion,
            cells=cells if isinstance(where, Pose) else replace(cells, branch=pose.elbow),
            execution=execution,
            progress=report,
        )
    show("montecarlo", found, json, out)

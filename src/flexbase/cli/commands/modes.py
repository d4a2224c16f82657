"""`flexbase modes`: vibration modes and their distance from positive realness."""

from __future__ import annotations

from cyclopts import App

from flexbase.cli.options.common import CompensatorFile, Json
from flexbase.cli.options.pose import PoseOptions, Robot, compensator_of
from flexbase.cli.terminal.out import Out, check_out
from flexbase.cli.terminal.show import show
from flexbase.linear.modal import modes as modes_of
from flexbase.plant import load

app = App(
    name="modes",
    help_epilogue="""Examples:
  flexbase modes ueda2003 --tip 0.33,-0.25
  flexbase modes ueda2003 --tip -0.3,0.2 --elbow - --json
  flexbase modes ueda2003 --joints -1.59,1.40 --compensator compensator.json

w = 0 (alignment 1) is the robust arm configuration; the farther below, the
sooner a stiff task-space loop goes unstable.""",
)


@app.default
def modes(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),
    compensator: CompensatorFile = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Frequencies, damping, residues, robustness w, alignment and the verdict at one pose."""
    check_out(out)
    plant = load(robot)
    show("modes", modes_of(pose.pose(plant), compensator_of(plant, compensator)), json, out)

"""`flexbase check`: is the project sound, and what does it say?"""

from __future__ import annotations

from cyclopts import App

from flexbase.cli.options.common import Json
from flexbase.cli.options.pose import PoseOptions, Robot
from flexbase.cli.terminal.show import show
from flexbase.plant import load
from flexbase.study.check import check as check_of

app = App(
    name="check",
    help_epilogue="""Examples:
  flexbase check ueda2003
  flexbase check ueda2003 --tip 0.33,-0.25
  flexbase check gantry.toml --json

A file that is not sound is answered with the field, the value and the mend.
Exit status: 0 sound, 2 not.""",
)


@app.default
def check(robot: Robot, /, *, pose: PoseOptions = PoseOptions(), json: Json = False) -> None:
    """Load a project and show what it says; with --tip or --joints also what holds there."""
    plant = load(robot)
    show("check", check_of(plant, pose.pose_or_none(plant)), json)

"""`flexbase robots`: what is bundled."""

from __future__ import annotations

from cyclopts import App

from flexbase.cli.options.common import Json
from flexbase.cli.terminal.show import show
from flexbase.model.files.bundled import robots as robots_of

app = App(
    name="robots",
    help_epilogue="""Examples:
  flexbase robots
  flexbase check ueda2003""",
)


@app.default
def robots(*, json: Json = False) -> None:
    """Names that stand for ROBOT, and what each is."""
    show("robots", robots_of(), json)

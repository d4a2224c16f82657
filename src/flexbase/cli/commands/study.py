"""`flexbase study`: questions over many poses, one subcommand a file."""

from __future__ import annotations

from cyclopts import App

STUDIES = {
    "hardware": "Which controllers run, over the workspace?",
    "agreement": "Do the linear verdicts come true in MuJoCo?",
}

app = App(
    name="study",
    help_epilogue="""Examples:
  flexbase study hardware ueda2003 --poses 400 --json
  flexbase study agreement ueda2003 --poses 500 --json""",
)
for _name, _purpose in STUDIES.items():
    app.command(
        f"flexbase.cli.commands.study_{_name}:app", name=_name, help=_purpose, sort_key=list(STUDIES).index(_name)
    )

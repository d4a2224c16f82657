"""`flexbase init`: a commented project file, and the schema that editors check it with."""

from __future__ import annotations

import json as json_format
from importlib import resources
from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.terminal.out import write_text
from flexbase.cli.terminal.screen import put
from flexbase.errors import InputError
from flexbase.model.files.schema import ProjectFile

app = App(
    name="init",
    usage="Usage: flexbase init [FILE] [OPTIONS]",
    help_epilogue="""Examples:
  flexbase init gantry.toml
  flexbase check gantry.toml
  flexbase init --schema flexbase.schema.json

An existing project is never overwritten. With --schema alone, only the schema
is written (an older one is replaced); editors then check the project as you
type: put   #:schema ./flexbase.schema.json   in its first line.""",
)
Schema = Annotated[Path | None, Parameter(metavar="FILE", help="write the JSON schema of project files (.json)")]
DEFAULT = Path("project.toml")


@app.default
def init(
    file: Annotated[Path | None, Parameter(help="the new project, project.toml if left out")] = None,
    /,
    *,
    schema: Schema = None,
) -> None:
    """Write a project that loads as it stands, every key explained."""
    if schema is not None:
        if schema.suffix.lower() != ".json":
            raise InputError(f'--schema: {schema} ends in "{schema.suffix}". Give a file that ends in .json.')
        write_text(schema, schema_text())
        put(f"Written: {schema}")
    if file is not None or schema is None:
        project = file or DEFAULT
        write_text(project, template(), mode="x")
        put(f"Written: {project}", f"Next: flexbase check {project}")


def template() -> str:
    """The commented project file."""
    return (resources.files("flexbase.model.files") / "template.toml").read_text("utf-8")


def schema_text() -> str:
    """The JSON schema of project files, as docs/flexbase.schema.json holds it."""
    whole = {"$schema": "https://json-schema.org/draft/2020-12/schema", **ProjectFile.model_json_schema()}
    return json_format.dumps(whole, indent=2) + "\n"

"""The commented project file to start from, and the schema that editors check it with."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path

from flexbase.errors import InputError, writing
from flexbase.model.files.schema import ProjectFile


def init(project: str | Path = "project.toml") -> Path:
    """Write a project that loads as it stands, every key explained; its path.

    Raises InputError where the place cannot be written, and where there is a file already: none is overwritten.
    """
    path = Path(project)
    with writing(path):
        try:
            with path.open("x", encoding="utf-8", newline="\n") as file:
                file.write(template())
        except FileExistsError as fault:
            raise InputError(f"{path}: already exists and is not overwritten. Give another name.") from fault
    return path


def template() -> str:
    """The commented project file."""
    return (resources.files("flexbase.model.files") / "template.toml").read_text("utf-8")


def schema_text() -> str:
    """The JSON schema of project files, as docs/flexbase.schema.json holds it."""
    whole = {"$schema": "https://json-schema.org/draft/2020-12/schema", **ProjectFile.model_json_schema()}
    return json.dumps(whole, indent=2) + "\n"

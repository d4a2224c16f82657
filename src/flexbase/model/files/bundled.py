"""The bundled robots: names that `load` takes, and what each is."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import resources
from typing import ClassVar

from flexbase.sheets.sheet import Sheet, make_sheet, table, words
from flexbase.sheets.told import Told

LIBRARY = "flexbase.model.library"


@dataclass(frozen=True)
class Robots(Told):
    """Names of the bundled robots, each with its one-line description. Made by `robots`."""

    descriptions: dict[str, str]

    document: ClassVar = ("robots=entries",)

    @property
    def entries(self) -> list[dict[str, str]]:
        """A name and its description each."""
        return [{"name": name, "description": text} for name, text in self.descriptions.items()]

    def sheet(self) -> Sheet:
        """A row a robot."""
        rows = table([words("robot"), words("what it is")], self.descriptions.items())
        return make_sheet("Bundled robots", "", rows)


def robots() -> Robots:
    """What is bundled; a description is the first comment of a project's file."""
    files = sorted(resources.files(LIBRARY).iterdir(), key=lambda item: item.name)
    first = {one.name: one.read_text("utf-8").partition("\n")[0] for one in files if one.name.endswith(".toml")}
    return Robots({name.removesuffix(".toml"): line.lstrip("# ").strip() for name, line in first.items()})

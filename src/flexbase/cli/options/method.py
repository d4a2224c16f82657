"""The design method and its options."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from cyclopts import Group, Parameter

from flexbase.cli.options.from_request import from_methods
from flexbase.compensators import METHODS

METHOD = Group("Method", sort_key=15)


@from_methods(METHOD, METHODS)
@dataclass(frozen=True)
class MethodOptions:
    """How a compensator is designed."""

    method: Annotated[
        str | None, Parameter(metavar="NAME", help=f"{', '.join(METHODS)}; if left out, exact or convex, as fits")
    ] = None

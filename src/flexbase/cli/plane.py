"""The plane of a map: which two axes, how far, how fine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from cyclopts import Group, Parameter

from flexbase.cli.options import option
from flexbase.cli.pose import Elbow
from flexbase.cli.words import Names, Vector, counts, names, numbers
from flexbase.errors import InputError

PLANE = Group("Plane", sort_key=10)


@Parameter(name="*", group=PLANE)
@dataclass(frozen=True)
class PlaneOptions:
    """Two axes and what stays put."""

    over: Annotated[str, Parameter(metavar="NAME", help="tip (if left out) or joints")] = "tip"
    shape: Annotated[tuple[int, ...], option(counts, "N,N", "cells along each axis; 400,400 if left out")] = (400, 400)
    bounds: Annotated[
        Vector | None, option(numbers, "LO,HI,LO,HI", "of the two axes; all that is reached [m, rad]")
    ] = None
    axes: Annotated[Names, option(names, "Q,Q", "over joints: which two; the last two if left out")] = ()
    hold: Annotated[Vector, option(numbers, "NUMBERS", "over tip: the other rows; over joints: all arm joints")] = ()
    elbow: Elbow = None

    def check(self) -> None:
        """Raise InputError where an option belongs to the other plane."""
        if self.over == "joints" and self.elbow is not None:
            raise InputError("--elbow: joints are given here, so there is no side to choose. Leave it out.")
        if self.over == "tip" and self.axes:
            raise InputError("--axes: names joints, but the map is over the tip. Add --over joints.")

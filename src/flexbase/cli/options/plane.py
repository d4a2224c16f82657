"""Where a map looks: which axes, how far, how fine, and what else varies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from cyclopts import Group, Parameter

from flexbase.cli.options.common import option
from flexbase.cli.options.pose import Elbow
from flexbase.cli.options.words import Names, Ranges, Vector, counts, names, numbers, ranges
from flexbase.errors import InputError

PLANE = Group("Cells", sort_key=10)


@Parameter(name="*", group=PLANE)
@dataclass(frozen=True)
class CellOptions:
    """Axes and what stays put."""

    over: Annotated[str, Parameter(metavar="NAME", help="tip (if left out) or joints; map: also samples of joints")] = (
        "tip"
    )
    shape: Annotated[
        tuple[int, ...] | None, option(counts, "N,N", "cells along each axis; map 400,400, montecarlo 100,100")
    ] = None
    bounds: Annotated[
        Vector | None, option(numbers, "LO,HI,LO,HI", "of the axes in turn; all that is reached [m, rad]")
    ] = None
    axes: Annotated[Names, option(names, "Q,Q", "which task rows or joints vary; two if left out")] = ()
    hold: Annotated[Vector, option(numbers, "NUMBERS", "over tip: the other rows; else: all arm joints")] = ()


@Parameter(name="*", group=PLANE)
@dataclass(frozen=True)
class PlaneOptions(CellOptions):
    """And what else varies."""

    elbow: Elbow = None
    vary: Annotated[
        Ranges,
        option(ranges, "NAME=LO:HI:N", "more axes: stiffness, damping, payload, link_mass, link_com, stiffness.JOINT"),
    ] = ()
    sampling: Annotated[str, Parameter(metavar="NAME", help="samples: random (if left out) or halton")] = "random"
    seed: Annotated[int, Parameter(metavar="N", help="samples: another seed, other samples")] = 0

    def check(self) -> None:
        """Raise InputError where an option belongs to another kind of map."""
        if self.over != "tip" and self.elbow is not None:
            raise InputError("--elbow: joints are given here, so there is no side to choose. Leave it out.")

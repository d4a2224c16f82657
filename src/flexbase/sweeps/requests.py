"""What is asked of a map: which cells, and how they are worked through. Python, command line and page share these."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self

from flexbase.checks import check_request
from flexbase.errors import InputError
from flexbase.requests import asked
from flexbase.sweeps.cells.domain import RANDOM, SAMPLINGS
from flexbase.sweeps.engine.evaluate import AUTO, ENGINES

TIP, JOINTS, SAMPLES = "tip", "joints", "samples"
Range = tuple[float, float, int]


@dataclass(frozen=True, kw_only=True)
class Cells:
    """Which configurations: a grid over task rows or arm joints and parameters, or samples of such a box.

    over : "tip" (task rows, by inverse kinematics), "joints" (a box of arm joints), or "samples" of such a box
    shape : cells along each axis, in the order of `axes`; for samples, how many
    bounds : low, high of each axis in turn; the arm's reach, or a full turn, if left out
    axes : task rows or arm joints that vary; the first two rows, or the elbow and the joint before, if left out
    hold : over tip, the other task rows; else all n arm joints, used where they do not vary
    branch : over tip, which of the poses; the project's if left out
    vary : a parameter's name -> (low, high, count), a further axis each; names in `PARAMETERS`, or of one joint, as
        `stiffness.q1`
    sampling, seed : of samples, how they are drawn
    """

    over: str = asked(TIP, "task rows, a box of joints, or samples of one", choices=(TIP, JOINTS, SAMPLES))
    shape: tuple[int, ...] | None = asked(
        None, "cells along each axis; map 400,400, montecarlo 100,100, hardware-map 50,50", written="N,N"
    )
    bounds: tuple[float, ...] | None = asked(
        None, "of the axes in turn; all that is reached", unit="m, rad", written="LO,HI,LO,HI"
    )
    axes: tuple[str, ...] = asked((), "which task rows or joints vary; two if left out", written="Q,Q")
    hold: tuple[float, ...] = asked((), "over tip: the other rows; else: all arm joints", written="NUMBERS")
    branch: str | None = asked(None, "elbow; or shoulder, elbow, wrist: +-+; else the project's", written="+|-")
    vary: Mapping[str, Range] | None = asked(
        None,
        "more axes: stiffness, damping, payload, link_mass, link_com, stiffness.JOINT",
        written="NAME=LO:HI:N",
    )
    sampling: str = asked(RANDOM, "of samples", choices=SAMPLINGS)
    seed: int = asked(0, "samples: another seed, other samples")

    def checked(self) -> Self:
        """The request, if it makes sense; what a robot has to say follows later. Raises InputError."""
        check_request("cells", self, Cells)
        if self.over != TIP and self.branch is not None:
            raise InputError("branch (--elbow): joints are given here, so there is no side to choose. Leave it out.")
        if self.seed < 0:
            raise InputError(f"seed: {self.seed} is below 0. Give a whole number from 0 up.")
        return self

    def shaped(self, usual: tuple[int, int]) -> Self:
        """With a shape where none is given and two axes vary."""
        return replace(self, shape=usual) if self.shape is None and len(self.axes) in (0, 2) else self


@dataclass(frozen=True, kw_only=True)
class Execution:
    """How cells are worked through.

    engine : "compiled", "rows" (NumPy, no warm-up), or "auto", by the number of cells
    store : a Zarr folder that blocks are written to as they finish; `resume` goes on with one that was interrupted
    scheduler : address of a Dask cluster that runs the blocks; workers : or so many processes of this computer; else
        formulas run on all its cores, and poses are asked in a process a core
    """

    engine: str = asked(AUTO, "by the cells", choices=ENGINES)
    store: Path | str | None = asked(None, "a .zarr folder for blocks as they finish", written="FILE")  # noqa: RUF009
    resume: bool = asked(False, "go on with an interrupted .zarr; start it if there is none")
    scheduler: str | None = asked(None, "run blocks on a Dask cluster: tcp://...", written="URL")
    workers: int | None = asked(None, "run blocks on N processes")

    def checked(self) -> Self:
        """The request, if it makes sense. Raises InputError."""
        check_request("execution", self, Execution)
        if self.resume and self.store is None:
            raise InputError("resume: there is nothing to resume without a store. Give --out NAME.zarr.")
        if self.scheduler is not None and self.workers is not None:
            raise InputError("workers: a scheduler is given too, and it has its own. Give one of them.")
        if self.workers is not None and self.workers < 1:
            raise InputError(f"workers: {self.workers} is none. Give a whole number from 1 up, or None.")
        return self

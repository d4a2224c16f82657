"""How a simulated move is made, and on which plant."""

from __future__ import annotations

from dataclasses import dataclass

from cyclopts import Group

from flexbase.cli.options.from_request import from_request
from flexbase.requests import asked
from flexbase.simulation import Move, SampledMove

RUN = Group("Run", sort_key=12)
PLANT = {"engine": "--plant"}


@from_request(RUN, names=PLANT, without=("bandwidth",))
class MoveOptions(Move):
    """Times, laws and plant of a simulation."""


@from_request(RUN, names=PLANT, without=("bandwidth",))
@dataclass(frozen=True, kw_only=True)
class SampledMoveOptions(SampledMove):
    """Times and plant of a sampled run, which comes from elsewhere: the joints track their way first."""

    switch: float = asked(0.1, "controller takes over from joint tracking", unit="s", written="S")
    end: float = asked(0.4, "end of the run", unit="s", written="S")

"""How a simulated move is made, and on which plant."""

from __future__ import annotations

from cyclopts import Group

from flexbase.cli.options.from_request import from_request
from flexbase.errors import InputError
from flexbase.requests import options_of
from flexbase.simulation import Move, SampledMove

RUN = Group("Run", sort_key=12)


@from_request(RUN, names={"engine": "--plant"}, without=("bandwidth",))
class MoveOptions(Move):
    """Times, laws and plant of a simulation."""


def as_sampled(move: Move) -> SampledMove:
    """The same move by a sampled controller. Raises InputError for what such a run has not."""
    both = {one.name for one in options_of(SampledMove)} - {"bandwidth"}
    for one in options_of(Move):
        if one.name not in both and getattr(move, one.name) != one.default:
            raise InputError(f"--{one.name.replace('_', '-')}: a sampled run has none. Leave it out.")
    return SampledMove(**{one.name: getattr(move, one.name) for one in options_of(Move) if one.name in both})

"""What became of a cell."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray

OK, UNREACHABLE, SINGULAR, INDEFINITE, INFEASIBLE, LOST, GAINED, UNSTABLE = range(8)
STATUS = {
    OK: "ok",
    UNREACHABLE: "out of reach",
    SINGULAR: "singular arm",
    INDEFINITE: "M - E not positive definite",
    INFEASIBLE: "no gain aligns the mode",
}
VERDICTS = {  # of loops as they run
    OK: "ok",
    UNREACHABLE: "out of reach",
    SINGULAR: "singular arm",
    INFEASIBLE: "no controller",
    UNSTABLE: "unstable",
}
CHANGED = {LOST: "ok before only", GAINED: "ok after only"}  # of differences, beside the others


def flags(meanings: Mapping[int, str]) -> dict[str, Any]:
    """Attributes of a status array, by the conventions of CF metadata."""
    return {"flag_values": list(meanings), "flag_meanings": "; ".join(meanings.values())}


def statuses_of(dataset: xarray.Dataset) -> dict[int, str]:
    """What the codes of a dataset's status mean."""
    said = dataset["status"].attrs
    return dict(zip(map(int, said["flag_values"]), str(said["flag_meanings"]).split("; "), strict=True))

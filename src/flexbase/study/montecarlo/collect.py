"""From counts to one dataset: probabilities of cells with their intervals, and each draw's share of the workspace."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from flexbase.study.montecarlo.interval import expected_share, probability_interval
from flexbase.study.montecarlo.trial import Trial
from flexbase.sweeps.engine.status import INFEASIBLE, OK, STATUS, flags

if TYPE_CHECKING:
    import xarray


def to_dataset(
    trial: Trial, counted: xarray.Dataset, units: Mapping[str, str], attributes: dict[str, Any]
) -> xarray.Dataset:
    """The dataset of a `MonteCarlo`, from the counts; `units` of the parameters, in the order of the draws."""
    import xarray

    draws, status = trial.draws.shape[1], counted["status"].values
    dims = counted["status"].dims
    held = np.moveaxis(counted["held"].values, -1, 0)
    judged = status == OK
    cells = int(np.count_nonzero(judged | (status == INFEASIBLE)))
    count = counted["cells"].values.reshape(-1, draws).sum(axis=0)
    shares = count / cells if cells else np.full(draws, np.nan)
    lower, upper = probability_interval(held[0], draws)

    def of_cells(values: np.ndarray, what: str) -> tuple[tuple[Hashable, ...], np.ndarray, dict[str, Any]]:
        return dims, np.where(judged, values, np.nan), {"units": "1", "long_name": what}

    share = expected_share(shares)
    attributes |= {f"expected_share{end}": value for end, value in zip(("", "_lower", "_upper"), share, strict=True)}
    names = np.array([one.name for one in trial.criteria])
    each = np.where(judged, held[1:] / draws, np.nan)
    said = {"units": "1", "long_name": "probability that each criterion is met"}
    return xarray.Dataset(
        {
            "probability": of_cells(held[0] / draws, "probability that the design holds"),
            "lower": of_cells(lower, "lower bound of its 95 % interval (Clopper-Pearson)"),
            "upper": of_cells(upper, "upper bound of its 95 % interval (Clopper-Pearson)"),
            "held": (dims, held[0], {"units": "1", "long_name": "draws that hold"}),
            "nominal": counted["nominal"],
            "status": (dims, status, flags(STATUS)),
            "criterion_probability": (("criterion", *dims), each, said),
            "share": ("draw", shares, {"units": "1", "long_name": "share of the workspace that holds in this draw"}),
        },
        {
            **{name: counted[name] for name in dims},
            "criterion": ("criterion", names),
            **{name: ("draw", row, {"units": units[name]}) for name, row in zip(units, trial.draws, strict=True)},
        },
        attributes,
    )

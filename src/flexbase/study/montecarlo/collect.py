"""From blocks to one dataset: probabilities of cells with their intervals, and each draw's share of the workspace."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from flexbase.study.montecarlo.interval import expected_share, probability_interval
from flexbase.study.montecarlo.trial import LEAST_BLOCK, TOGETHER, Trial
from flexbase.sweeps.cells.axis import block_shape, boxes
from flexbase.sweeps.engine.executors import by_threads
from flexbase.sweeps.engine.status import INFEASIBLE, OK, STATUS, flags

Progress = Callable[[int, int], None]


def run_all(trial: Trial, progress: Progress) -> dict[str, np.ndarray]:
    """The arrays of `Trial.run` over all cells, by all threads; `cells` summed over the blocks."""
    shape, draws = trial.domain.shape, trial.draws.shape[1]
    arrays: dict[str, np.ndarray] = {
        "status": np.zeros(shape, dtype=np.int8),
        "nominal": np.zeros(shape, dtype=np.int8),
        "held": np.zeros((1 + len(trial.criteria), *shape), dtype=np.int64),
        "cells": np.zeros(draws, dtype=np.int64),
    }
    block = block_shape(shape, max(LEAST_BLOCK, TOGETHER // draws))
    done, total = 0, int(np.prod(shape, dtype=np.int64)) * draws
    progress(done, total)
    for (_, box), found in by_threads(trial, list(boxes(shape, block))):
        region = tuple(slice(begin, end) for begin, end in box)
        arrays["status"][region], arrays["nominal"][region] = found["status"], found["nominal"]
        arrays["held"][(slice(None), *region)] = found["held"]
        arrays["cells"] += found["cells"]
        done += int(np.prod([end - begin for begin, end in box], dtype=np.int64)) * draws
        progress(done, total)
    return arrays


def to_dataset(
    trial: Trial, arrays: Mapping[str, np.ndarray], units: Mapping[str, str], attributes: dict[str, Any]
) -> Any:
    """The dataset of a `Probability`; `units` of the parameters, by name, in the order of the draws."""
    import xarray

    draws, status = trial.draws.shape[1], arrays["status"]
    judged = status == OK
    cells = int(np.count_nonzero(judged | (status == INFEASIBLE)))
    shares = arrays["cells"] / cells if cells else np.full(draws, np.nan)
    lower, upper = probability_interval(arrays["held"][0], draws)
    dims = tuple(axis.name for axis in trial.domain.axes)

    def of_cells(values: np.ndarray, what: str) -> tuple[tuple[str, ...], np.ndarray, dict[str, Any]]:
        return dims, np.where(judged, values, np.nan), {"units": "1", "long_name": what}

    share = expected_share(shares)
    attributes |= {f"expected_share{end}": value for end, value in zip(("", "_lower", "_upper"), share, strict=True)}
    names = np.array([one.name for one in trial.criteria])
    each = np.where(judged, arrays["held"][1:] / draws, np.nan)
    said = {"units": "1", "long_name": "probability that each criterion is met"}
    return xarray.Dataset(
        {
            "probability": of_cells(arrays["held"][0] / draws, "probability that the design holds"),
            "lower": of_cells(lower, "lower bound of its 95 % interval (Clopper-Pearson)"),
            "upper": of_cells(upper, "upper bound of its 95 % interval (Clopper-Pearson)"),
            "held": (dims, arrays["held"][0], {"units": "1", "long_name": "draws that hold"}),
            "nominal": (dims, arrays["nominal"], {"units": "1", "long_name": "whether the plant as it is holds"}),
            "status": (dims, status, flags(STATUS)),
            "criterion_probability": (("criterion", *dims), each, said),
            "share": ("draw", shares, {"units": "1", "long_name": "share of the workspace that holds in this draw"}),
        },
        {
            **{axis.name: (axis.name, axis.values, {"units": axis.unit}) for axis in trial.domain.axes},
            "criterion": ("criterion", names),
            **{name: ("draw", row, {"units": units[name]}) for name, row in zip(units, trial.draws, strict=True)},
        },
        attributes,
    )

"""One block of cells under all draws: how many draws hold in each cell, and how many cells in each draw."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.study.montecarlo.criterion import Criterion
from flexbase.sweeps.cells.axis import Box, extent
from flexbase.sweeps.cells.domain import Grid
from flexbase.sweeps.engine.evaluate import Engine
from flexbase.sweeps.engine.status import INFEASIBLE, OK, SINGULAR, UNREACHABLE

TOGETHER = 1 << 18  # configurations that a thread evaluates at once
LEAST_BLOCK = 1024  # cells: inverse kinematics takes many at a time


@dataclass(frozen=True, eq=False)
class Trial:
    """What every block does.

    domain : of cells; parameters are no part of it
    draws : of the parameters, shape (parameters, S); nominal : their values in the plant as it is
    """

    engine: Engine
    domain: Grid
    criteria: tuple[Criterion, ...]
    draws: Array
    nominal: Array

    def run(self, work: tuple[tuple[int, ...], Box]) -> Mapping[str, NDArray[Any]]:
        """Of each cell `status`, `nominal` (whether it holds undisturbed) and `held`; of each draw `cells`.

        held : draws that meet all criteria, and each of them, shape (1 + criteria, *cells)
        cells : how many cells of the block hold in each draw, shape (S,)
        """
        shape = extent(work[1])
        places, reached = self.domain.inputs(work[1])
        count = places.shape[1]
        status, nominal = np.full(count, UNREACHABLE, dtype=np.int8), np.zeros(count, dtype=bool)
        inside = np.arange(count) if reached is None else np.flatnonzero(reached)
        status[inside], nominal[inside] = self._undisturbed(places[:, inside])
        held = np.zeros((1 + len(self.criteria), count), dtype=np.int64)
        cells = np.zeros(self.draws.shape[1], dtype=np.int64)
        judged = np.flatnonzero(status == OK)
        for begin in range(0, self.draws.shape[1], TOGETHER):
            draws = self.draws[:, begin : begin + TOGETHER]
            step = max(1, TOGETHER // draws.shape[1])
            for first in range(0, judged.size, step):
                some = judged[first : first + step]
                verdicts = self._verdicts(places[:, some], draws)
                held[:, some] += verdicts.sum(axis=2)
                cells[begin : begin + TOGETHER] += verdicts[0].sum(axis=0)
        return {
            "status": status.reshape(shape),
            "nominal": nominal.reshape(shape),
            "held": held.reshape(-1, *shape),
            "cells": cells,
        }

    def _undisturbed(self, places: Array) -> tuple[NDArray[np.int8], NDArray[np.bool_]]:
        """Which cells can be judged at all, as a status, and whether the design holds with the plant as it is."""
        block = self.engine.run(self._inputs(places, self.nominal[:, None]), threads=1)
        barred = (block.status == UNREACHABLE) | (block.status == SINGULAR)
        if self.engine.question.redesigned:
            barred |= block.status == INFEASIBLE
        holds = np.array([one.holds(block) for one in self.criteria]).all(axis=0)
        return np.where(barred, block.status, OK).astype(np.int8), holds & ~barred

    def _verdicts(self, places: Array, draws: Array) -> NDArray[np.bool_]:
        """Whether all criteria hold, and each of them, shape (1 + criteria, cells, draws)."""
        block = self.engine.run(self._inputs(places, draws), threads=1)
        each = np.array([one.holds(block) for one in self.criteria])
        return np.concatenate([each.all(axis=0, keepdims=True), each]).reshape(
            len(each) + 1, places.shape[1], draws.shape[1]
        )

    @staticmethod
    def _inputs(places: Array, draws: Array) -> Array:
        """Every cell under every draw, the draws fastest, shape (inputs, cells * draws)."""
        cells, count = places.shape[1], draws.shape[1]
        inputs = np.empty((len(places) + len(draws), cells, count))
        inputs[: len(places)] = places[:, :, None]
        inputs[len(places) :] = draws[:, None, :]
        return inputs.reshape(len(inputs), cells * count)

"""The question of a Monte Carlo study: how many draws hold in each cell, and how many cells in each draw."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.study.montecarlo.criterion import Criterion
from flexbase.sweeps.engine.evaluate import engine_of
from flexbase.sweeps.engine.formula import Formula
from flexbase.sweeps.engine.question import Block, Column
from flexbase.sweeps.engine.status import INFEASIBLE, OK, SINGULAR, STATUS, UNREACHABLE

TOGETHER = 1 << 18  # configurations that a thread evaluates at once
LEAST_BLOCK = 1024  # cells: inverse kinematics takes many at a time


@dataclass(frozen=True, eq=False)
class Trial:
    """Criteria in every cell under all draws.

    formula : of the criteria's measures, on an engine, "rows" or "compiled"
    draws : of the parameters, shape (parameters, S); nominal : their values in the plant as it is
    """

    formula: Formula
    engine: str
    criteria: tuple[Criterion, ...]
    draws: Array
    nominal: Array
    recipe: Mapping[str, Any] = field(default_factory=dict)
    meanings: ClassVar[Mapping[int, str]] = STATUS
    threads: ClassVar[bool] = True

    @property
    def columns(self) -> tuple[Column, ...]:
        """Of each cell `nominal` (whether it holds undisturbed) and `held`; of each block and draw `cells`.

        held : draws that meet all criteria, and each of them; cells : how many of the block hold in a draw
        """
        return (
            Column("nominal", {"units": "1", "long_name": "whether the plant as it is holds"}, dtype="int8"),
            Column("held", {"units": "1"}, ("criterion", 1 + len(self.criteria)), "int64"),
            Column("cells", {"units": "1"}, ("draw", self.draws.shape[1]), "int64", of_block=True),
        )

    def answer(self, inputs: Array) -> Block:
        """Status and counts of cells whose places are given, shape (coordinates, cells); parameters are no part."""
        status, nominal = self._undisturbed(inputs)
        held = np.zeros((1 + len(self.criteria), inputs.shape[1]), dtype=np.int64)
        cells = np.zeros(self.draws.shape[1], dtype=np.int64)
        judged = np.flatnonzero(status == OK)
        for begin in range(0, self.draws.shape[1], TOGETHER):
            draws = self.draws[:, begin : begin + TOGETHER]
            step = max(1, TOGETHER // draws.shape[1])
            for first in range(0, judged.size, step):
                some = judged[first : first + step]
                verdicts = self._verdicts(inputs[:, some], draws)
                held[:, some] += verdicts.sum(axis=2)
                cells[begin : begin + TOGETHER] += verdicts[0].sum(axis=0)
        return Block({"nominal": nominal.astype(np.int8), "held": held.T, "cells": cells}, status)

    def _undisturbed(self, places: Array) -> tuple[NDArray[np.int8], NDArray[np.bool_]]:
        """Which cells can be judged at all, as a status, and whether the design holds with the plant as it is."""
        block = self._run(places, self.nominal[:, None])
        barred = (block.status == UNREACHABLE) | (block.status == SINGULAR)
        if self.formula.redesigned:
            barred |= block.status == INFEASIBLE
        holds = np.array([one.holds(block) for one in self.criteria]).all(axis=0)
        return np.where(barred, block.status, OK).astype(np.int8), holds & ~barred

    def _verdicts(self, places: Array, draws: Array) -> NDArray[np.bool_]:
        """Whether all criteria hold, and each of them, shape (1 + criteria, cells, draws)."""
        block = self._run(places, draws)
        each = np.array([one.holds(block) for one in self.criteria])
        return np.concatenate([each.all(axis=0, keepdims=True), each]).reshape(
            len(each) + 1, places.shape[1], draws.shape[1]
        )

    def _run(self, places: Array, draws: Array) -> Block:
        """Every cell under every draw, the draws fastest."""
        cells, count = places.shape[1], draws.shape[1]
        inputs = np.empty((len(places) + len(draws), cells, count))
        inputs[: len(places)] = places[:, :, None]
        inputs[len(places) :] = draws[:, None, :]
        return engine_of(self.formula, self.engine).run(inputs.reshape(len(inputs), cells * count), threads=1)

"""Passive (base) and active (arm) joints of a chain, by index: the one place that knows that the base comes first."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np

V = TypeVar("V", bound=np.ndarray | Sequence[Any])


class Blocks(NamedTuple):
    """A symmetric N x N matrix by its parts: passive (m x m), coupling (active rows, n x m), active (n x n)."""

    passive: Any
    coupling: Any
    active: Any


class Parts(NamedTuple):
    """Indices of the passive and of the active joints.

    Vectors are arrays, whose last axis runs over the joints, or sequences of scalars of any type; matrices likewise.
    """

    passive: tuple[int, ...]
    active: tuple[int, ...]

    def base(self, values: V) -> V:
        """What belongs to the passive joints: m of N."""
        return _chosen(values, self.passive)

    def arm(self, values: V) -> V:
        """What belongs to the active joints: n of N."""
        return _chosen(values, self.active)

    def whole(self, base: V, arm: V) -> V:
        """Both parts together, in the order of the chain."""
        arrays = isinstance(base, np.ndarray) and isinstance(arm, np.ndarray)
        joined: Any = np.concatenate([base, arm], axis=-1) if arrays else (*base, *arm)
        return cast(V, _chosen(joined, np.argsort((*self.passive, *self.active))))

    def blocks(self, matrix: Any) -> Blocks:
        """The parts of a symmetric matrix, N x N."""
        pairs = (self.passive, self.passive), (self.active, self.passive), (self.active, self.active)
        if isinstance(matrix, np.ndarray):
            return Blocks(*(matrix[np.ix_(rows, columns)] for rows, columns in pairs))
        return Blocks(*(tuple(_chosen(matrix[row], columns) for row in rows) for rows, columns in pairs))

    def on_base(self, block: Any) -> Any:
        """The N x N matrix that is this block, m x m, on the passive joints and zero elsewhere."""
        return self._spread(block, self.passive)

    def on_arm(self, block: Any) -> Any:
        """The N x N matrix that is this block, n x n, on the active joints and zero elsewhere."""
        return self._spread(block, self.active)

    def _spread(self, block: Any, joints: tuple[int, ...]) -> Any:
        N = len(self.passive) + len(self.active)
        whole = np.zeros((N, N), dtype=float if isinstance(block, np.ndarray) else object)
        whole[:] = 0.0
        whole[np.ix_(joints, joints)] = block
        return whole if isinstance(block, np.ndarray) else tuple(map(tuple, whole.tolist()))


def base_first(m: int, N: int) -> Parts:
    """The parts of a chain of N joints whose first m are the base."""
    return Parts(tuple(range(m)), tuple(range(m, N)))


def _chosen(values: V, joints: Sequence[int] | np.ndarray) -> V:
    if isinstance(values, np.ndarray):
        return cast(V, np.take(values, np.asarray(joints, dtype=int), axis=-1))
    return cast(V, tuple(values[joint] for joint in joints))

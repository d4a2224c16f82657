"""When a tip has settled, and when a motion has diverged."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from flexbase.checks import Array
from flexbase.model.task import Task
from flexbase.trace.algebra import Scalar, Vector, larger, norm

SETTLED = 1e-4  # m (and rad for rotation rows): the tip counts as settled below this
FASTEST = 1e3  # rad/s or m/s of a joint: beyond, the motion has diverged


def error_size(error: Vector, rows: Sequence[str]) -> Scalar:
    """Length of a tip error: positions in m, or rotations in rad where larger; on any number type."""
    sizes = [
        norm([entry for entry, row in zip(error, rows, strict=True) if row.startswith("r") == turns])
        for turns in (False, True)
        if any(row.startswith("r") == turns for row in rows)
    ]
    return sizes[0] if len(sizes) == 1 else larger(*sizes)


def error_sizes(errors: Array, task: Task) -> Array:
    """`error_size` of samples, shape (T,), of errors of shape (T, k)."""
    return np.asarray(error_size(tuple(errors.T), task.rows))

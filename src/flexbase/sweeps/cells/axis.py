"""Axes of a sweep and boxes of its cells."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

from flexbase.checks import Array

Box = tuple[tuple[int, int], ...]  # first and past-last cell along each dimension


@dataclass(frozen=True, eq=False)
class Axis:
    """One dimension of a sweep: a task row, an arm joint, a parameter or the number of a sample."""

    name: str
    unit: str
    values: Array


def block_shape(shape: tuple[int, ...], cells: int) -> tuple[int, ...]:
    """Blocks of about so many cells: whole rows of the last dimensions, a part of the one before."""
    sizes: list[int] = []
    for size in reversed(shape):
        part = max(1, min(size, cells))
        sizes.append(part)
        cells //= part
    return tuple(reversed(sizes))


def boxes(shape: tuple[int, ...], block: tuple[int, ...]) -> Iterator[tuple[tuple[int, ...], Box]]:
    """Every block's place in the grid of blocks and its box of cells, in the order of storage."""
    counts = [-(-size // step) for size, step in zip(shape, block, strict=True)]
    for place in itertools.product(*map(range, counts)):
        yield place, tuple((i * b, min((i + 1) * b, s)) for i, b, s in zip(place, block, shape, strict=True))


def extent(box: Box) -> tuple[int, ...]:
    """Cells along each dimension."""
    return tuple(end - begin for begin, end in box)


def region(box: Box) -> tuple[slice, ...]:
    """Where a box stands in an array of all cells."""
    return tuple(slice(begin, end) for begin, end in box)

"""Where a sweep looks: a grid over joints, tip and parameters, or samples of them. Cells become a question's inputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flexbase.checks import Array
from flexbase.sweeps.cells.axis import Axis, Box, extent

Reached = NDArray[np.bool_] | None  # None: inputs are complete in every cell
Solve = Callable[[Array], tuple[Array, NDArray[np.bool_]]]  # tip targets (T, k) -> joints (T, n) and which are reached
RANDOM, HALTON = "random", "halton"
SAMPLINGS = (RANDOM, HALTON)


def as_they_are(targets: Array) -> tuple[Array, NDArray[np.bool_]]:
    """The `solve` of those who look for joints themselves."""
    return targets, np.ones(len(targets), dtype=bool)


@dataclass(frozen=True, eq=False)
class Grid:
    """All combinations of the axes' values: parameters first, then the coordinates, the first of them fastest.

    parameters : how many of the axes are parameters
    solve, held, varied : tip targets and the inverse kinematics that they need; None where coordinates are inputs
    """

    axes: tuple[Axis, ...]
    parameters: int = 0
    solve: Solve | None = None
    held: tuple[float, ...] = ()
    varied: tuple[int, ...] = ()

    @property
    def drawn(self) -> Mapping[str, str]:
        """Inputs that are told cell by cell, with their units: none, the axes tell them."""
        return {}

    @property
    def shape(self) -> tuple[int, ...]:
        """Cells along each axis."""
        return tuple(axis.values.size for axis in self.axes)

    def inputs(self, box: Box) -> tuple[Array, Reached]:
        """A question's inputs, shape (inputs, cells): coordinates in their order, then parameters."""
        ticks = [axis.values[begin:end] for axis, (begin, end) in zip(self.axes, box, strict=True)]
        coordinates, parameters = ticks[self.parameters :], ticks[: self.parameters]
        outer = int(np.prod([len(tick) for tick in parameters], dtype=int))
        inner = int(np.prod([len(tick) for tick in coordinates], dtype=int))
        reached: Reached = None
        rows = _columns(coordinates)[::-1]
        if self.solve is not None:
            targets = np.tile(self.held, (inner, 1))
            targets[:, self.varied] = rows.T
            joints, found = self.solve(targets)
            rows, reached = joints.T, np.tile(found, outer)
        inputs = np.empty((len(rows) + len(parameters), outer * inner))
        inputs[: len(rows)].reshape(len(rows), outer, inner)[:] = rows[:, None, :]
        inputs[len(rows) :].reshape(len(parameters), outer, inner)[:] = _columns(parameters)[..., None]
        return inputs, reached


def _columns(ticks: list[Array]) -> Array:
    """Every tick's value in each of their combinations, shape (ticks, combinations), the last one fastest."""
    shape = tuple(len(tick) for tick in ticks)
    columns = np.empty((len(ticks), *shape))
    for i, tick in enumerate(ticks):
        columns[i] = tick.reshape((-1,) + (1,) * (len(ticks) - 1 - i))
    return columns.reshape(len(ticks), int(np.prod(shape, dtype=int)))


@dataclass(frozen=True, eq=False)
class Samples:
    """Points of a box, each in a row of its own; sample i is the same however the sweep is cut into blocks.

    low, high : of each input; names, units : what the inputs are
    """

    count: int
    names: tuple[str, ...]
    units: tuple[str, ...]
    low: Array
    high: Array
    sampling: str
    seed: int

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The number of the sample."""
        return (Axis("sample", "1", np.arange(self.count, dtype=float)),)

    @property
    def drawn(self) -> Mapping[str, str]:
        """Inputs that are told sample by sample, with their units."""
        return dict(zip(self.names, self.units, strict=True))

    @property
    def shape(self) -> tuple[int, ...]:
        """How many samples."""
        return (self.count,)

    def inputs(self, box: Box) -> tuple[Array, Reached]:
        """A question's inputs, shape (inputs, cells)."""
        ((begin, _),), (cells,) = box, extent(box)
        unit = self._random(begin, cells) if self.sampling == RANDOM else self._halton(begin, cells)
        return np.ascontiguousarray((self.low + (self.high - self.low) * unit).T), None

    def _random(self, begin: int, cells: int) -> Array:
        """Uniform numbers by a counter-based generator: four a step, so every sample takes whole steps."""
        size = len(self.names)
        steps = -(-size // 4)
        source = np.random.Philox(self.seed)
        source.advance(begin * steps)
        return np.random.Generator(source).random((cells, 4 * steps))[:, :size]

    def _halton(self, begin: int, cells: int) -> Array:
        from scipy.stats import qmc  # half a second to import

        return np.asarray(qmc.Halton(len(self.names), scramble=True, rng=self.seed).fast_forward(begin).random(cells))


@dataclass(frozen=True, eq=False)
class Listed:
    """Inputs one by one, such as the tips of a path. rows : shape (cells, inputs)"""

    rows: Array

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Their number."""
        return (Axis("sample", "1", np.arange(len(self.rows), dtype=float)),)

    @property
    def drawn(self) -> Mapping[str, str]:
        """None: whoever gave the list has it."""
        return {}

    @property
    def shape(self) -> tuple[int, ...]:
        """How many."""
        return (len(self.rows),)

    def inputs(self, box: Box) -> tuple[Array, Reached]:
        """A question's inputs, shape (inputs, cells)."""
        ((begin, end),) = box
        return self.rows[begin:end].T, None


Domain = Grid | Samples | Listed

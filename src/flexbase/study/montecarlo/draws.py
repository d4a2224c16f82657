"""Draws of the parameters: the same in every cell, and the same however cells are cut into blocks."""

from __future__ import annotations

import warnings
from collections.abc import Mapping

import numpy as np

from flexbase.checks import Array, choose
from flexbase.errors import InputError
from flexbase.study.montecarlo.distribution import Distribution
from flexbase.sweeps.cells.parameters import Parameter

RANDOM, SOBOL = "random", "sobol"
MOST = 10_000_000  # draws
EDGES = (2.0**-54, 1.0 - 2.0**-53)  # a quantile of 0 or 1 may be infinite


def draw(
    distributions: Mapping[str, Distribution], known: Mapping[str, Parameter], count: int, sampling: str, seed: int
) -> Array:
    """Independent parameters, shape (parameters, count).

    sampling : "random", by a counter-based generator of its own for each parameter, so that a parameter's draws depend
        on its name, its distribution and the seed alone; or "sobol", scrambled, more even
    Raises InputError.
    """
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= MOST:
        raise InputError(f"samples: {count!r} given. Give a whole number from 1 to {MOST}.")
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError(f"seed: {seed!r} given. Give a whole number from 0 up.")
    units = choose("sampling", sampling, {RANDOM: _random, SOBOL: _sobol})(list(distributions), count, seed)
    return np.array(
        [one.quantiles(np.clip(units[name], *EDGES), known[name].least) for name, one in distributions.items()]
    )


def _random(names: list[str], count: int, seed: int) -> dict[str, Array]:
    return {
        name: np.random.Generator(np.random.Philox(np.random.SeedSequence([seed, *name.encode()]))).random(count)
        for name in names
    }


def _sobol(names: list[str], count: int, seed: int) -> dict[str, Array]:
    from scipy.stats import qmc  # half a second to import

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # a count that is no power of 2 is a little less even
        points = qmc.Sobol(len(names), scramble=True, rng=seed).random(count)
    return {name: np.ascontiguousarray(column) for name, column in zip(sorted(names), points.T, strict=True)}

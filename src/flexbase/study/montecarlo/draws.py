"""Draws of the parameters: the same in every cell, and the same however cells are cut into blocks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from typing import Self

import numpy as np

from flexbase.checks import Array, check_request
from flexbase.errors import InputError, nearest_name
from flexbase.requests import asked
from flexbase.study.montecarlo.distribution import Distribution, read_distribution
from flexbase.sweeps.cells.parameters import Parameter

RANDOM, SOBOL = "random", "sobol"
MOST = 10_000_000  # draws
EDGES = (2.0**-54, 1.0 - 2.0**-53)  # a quantile of 0 or 1 may be infinite


@dataclass(frozen=True)
class Draws:
    """What varies, and how it is drawn.

    vary : a parameter's name -> its distribution, a text such as `"normal(1,0.15)"` or a number; parameters are
        independent. Names as for `sweep`, those of a single joint included: `stiffness.q1`
    sampling : "random", by a counter-based generator of its own for each parameter, so that a parameter's draws depend
        on its name, its distribution and the seed alone; or "sobol", scrambled, more even (intervals are then too wide)
    """

    vary: Mapping[str, object] | None = asked(
        None, "what varies, and how; with commas; also NAME=KIND:A:B", written="NAME=KIND(A,B)"
    )
    _: KW_ONLY
    samples: int = asked(1000, "draws of the parameters")
    seed: int = asked(0, "another seed, other draws")
    sampling: str = asked(RANDOM, "how even", choices=(RANDOM, SOBOL))

    def checked(self) -> Self:
        """The request, if it makes sense; names are the plant's to check. Raises InputError."""
        check_request("vary", self, Draws)
        if not 1 <= self.samples <= MOST:
            raise InputError(f"samples: {self.samples} given. Give a whole number from 1 to {MOST}.")
        if self.seed < 0:
            raise InputError(f"seed: {self.seed} is below 0. Give a whole number from 0 up.")
        return self

    def distributions(self, known: Mapping[str, Parameter]) -> dict[str, Distribution]:
        """The distribution of each parameter that varies, of those that there are. Raises InputError."""
        if not self.vary:
            raise InputError(f"vary: nothing varies. Give a parameter's distribution; there are {', '.join(known)}.")
        for name in self.vary:
            if name not in known:
                raise InputError(f'vary: no parameter "{name}". {nearest_name(name, known)}')
        return {name: read_distribution(name, given, known[name]) for name, given in self.vary.items()}

    def drawn(self, known: Mapping[str, Parameter]) -> Array:
        """Independent parameters, shape (parameters, samples). Raises InputError."""
        distributions = self.distributions(known)
        units = {RANDOM: _random, SOBOL: _sobol}[self.sampling](list(distributions), self.samples, self.seed)
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

    points = qmc.Sobol(len(names), scramble=True, rng=seed).random_base2((count - 1).bit_length())[:count]
    return {name: np.ascontiguousarray(column) for name, column in zip(sorted(names), points.T, strict=True)}

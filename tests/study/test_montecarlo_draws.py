"""Distributions, draws and intervals of `montecarlo`, against scipy.stats and against counting."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

import flexbase as fb
from flexbase.study.montecarlo import Fixed, Lognormal, Normal, Uniform
from flexbase.study.montecarlo.distribution import Distribution, read_distribution, written
from flexbase.study.montecarlo.draws import Draws
from flexbase.study.montecarlo.interval import expected_share, probability_interval
from flexbase.sweeps.cells.parameters import PARAMETERS

LEAST = PARAMETERS["stiffness"].least
TRUTH = [
    (Uniform(0.5, 3.0), "stiffness", stats.uniform(0.5, 2.5)),
    (Normal(1.0, 0.15), "stiffness", stats.norm(1.0, 0.15)),
    (Normal(0.5, 0.6), "payload", stats.truncnorm(-0.5 / 0.6, np.inf, 0.5, 0.6)),  # a fifth of it would be negative
    (Normal(1.0, 2.0), "stiffness", stats.truncnorm((LEAST - 1.0) / 2.0, np.inf, 1.0, 2.0)),
    (Lognormal(1.0, 0.05), "link_mass", stats.lognorm(0.05)),
    (Lognormal(2.0, 0.8), "payload", stats.lognorm(0.8, scale=2.0)),
]


def drawn(one: Distribution, name: str, count: int = 20_000, sampling: str = "random", seed: int = 1) -> np.ndarray:
    return Draws({name: one}, samples=count, seed=seed, sampling=sampling).drawn(PARAMETERS)[0]


@pytest.mark.parametrize(
    ("one", "name", "truth"), TRUTH, ids=lambda part: written(part) if hasattr(part, "quantiles") else ""
)
def test_draws_follow_their_distribution(one: Distribution, name: str, truth: object) -> None:
    """Kolmogorov and Smirnov at p > 1e-3; a normal 5 % too wide, or one that is not cut off, fails."""
    values = drawn(one, name)
    assert values.min() >= PARAMETERS[name].least
    assert stats.kstest(values, truth.cdf).pvalue > 1e-3  # type: ignore[attr-defined]
    assert stats.kstest(1.05 * values, truth.cdf).pvalue < 1e-3  # type: ignore[attr-defined]
    even = np.sort(drawn(one, name, 4096, "sobol"))
    assert np.abs(truth.cdf(even) - (np.arange(4096) + 0.5) / 4096).max() < 5e-4  # type: ignore[attr-defined]


def test_no_variation() -> None:
    for one in (Fixed(1.5), Normal(1.5, 0.0), Lognormal(1.5, 0.0), Uniform(1.5, 1.5)):
        assert np.all(drawn(one, "stiffness", 50) == 1.5)


def test_a_parameters_draws_are_its_own() -> None:
    """More samples go on with the same ones; another parameter leaves them; seeds and names change them."""

    def of(vary: dict[str, Distribution], count: int, seed: int) -> np.ndarray:
        return Draws(vary, samples=count, seed=seed).drawn(PARAMETERS)

    one = {"stiffness": Normal(1.0, 0.15)}
    two = {"payload": Uniform(0.0, 3.0), **one}
    few, many = of(one, 50, 7), of(two, 500, 7)
    assert np.array_equal(few[0], many[1, :50])
    assert np.abs(np.corrcoef(many)[0, 1]) < 0.15
    assert not np.any(of(one, 50, 8) == few)
    same = of({"stiffness": Uniform(0.5, 1.5), "damping": Uniform(0.5, 1.5)}, 50, 7)
    assert not np.any(same[0] == same[1])


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("normal(1, 0.15)", Normal(1.0, 0.15)),
        (" Uniform:0:3 ", Uniform(0.0, 3.0)),
        ("lognormal(1,5e-2)", Lognormal(1.0, 0.05)),
        ("fixed(2)", Fixed(2.0)),
        ("0.7", Fixed(0.7)),
        (1, Fixed(1.0)),
    ],
)
def test_text(text: object, found: Distribution) -> None:
    assert read_distribution("stiffness", text, PARAMETERS["payload"]) == found
    assert read_distribution("stiffness", written(found), PARAMETERS["payload"]) == found


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("normal(1)", r'stiffness: "normal\(1\)" does not give mean and deviation. Write normal\(mean,deviation\)'),
        ("normal(1,x)", "does not give mean and deviation"),
        ("normal(1,inf)", "finite"),
        ("gauss(1,1)", 'vary: stiffness: "gauss" is unknown'),
        ("normal(1,0.1", "is no distribution. Give such as normal"),
        ("", "is no distribution"),
        ("normal(-1,0.1)", r"stiffness=normal\(-1, 0.1\): a mean from 1e-06"),
        ("normal(1,-0.1)", "standard deviation of at least 0"),
        ("uniform(0,1)", "ends from 1e-06"),
        ("uniform(2,1)", "the low one first"),
        ("lognormal(0,1)", "a median above"),
        ("lognormal(1,9)", "a spread from 0 to 3"),
        ("fixed(0)", "a value from 1e-06"),
    ],
)
def test_wrong_text_is_named(text: str, said: str) -> None:
    with pytest.raises(fb.InputError, match=said):
        read_distribution("stiffness", text, PARAMETERS["stiffness"])


def test_probability_interval_is_exact() -> None:
    """At each bound the observed count is just as unlikely as 2.5 %; every probability is covered with 95 % or more."""
    draws = 40
    lower, upper = probability_interval(np.arange(draws + 1), draws)
    inner = np.arange(1, draws)
    assert stats.binom(draws, lower[inner]).sf(inner - 1) == pytest.approx(0.025, rel=1e-9)
    assert stats.binom(draws, upper[inner]).cdf(inner) == pytest.approx(0.025, rel=1e-9)
    assert (lower[0], upper[draws]) == (0.0, 1.0)
    assert lower[draws] == pytest.approx(0.025 ** (1 / draws))
    coverage = []
    for truth in np.linspace(0.001, 0.999, 500):
        inside = (lower <= truth) & (truth <= upper)
        coverage.append(stats.binom(draws, truth).pmf(np.flatnonzero(inside)).sum())
    assert 0.95 <= min(coverage) < 0.96  # and it is not simply wide


@pytest.mark.parametrize("truth", [stats.bernoulli(0.97), stats.beta(8.0, 2.0), stats.beta(0.3, 0.02), stats.uniform()])
def test_expected_share_is_covered(truth: object) -> None:
    """In 2000 studies of 200 draws: at least 94 % of the intervals hold the mean; few are twice as wide as needed."""
    shares = np.asarray(truth.rvs((2000, 200), random_state=3), dtype=float)  # type: ignore[attr-defined]
    found = np.array([expected_share(row) for row in shares])
    mean = float(truth.mean())  # type: ignore[attr-defined]
    assert np.mean((found[:, 1] <= mean) & (mean <= found[:, 2])) >= 0.94
    needed = 2.0 * 1.96 * float(truth.std()) / np.sqrt(200)  # type: ignore[attr-defined]
    assert np.median(found[:, 2] - found[:, 1]) < 2.0 * needed
    assert found[:, 0] == pytest.approx(shares.mean(axis=1))


def test_agreement_of_all_draws_is_no_certainty() -> None:
    assert expected_share(np.ones(1000)).lower == pytest.approx(0.995, abs=2e-3)
    assert expected_share(np.ones(1000)).upper == 1.0
    assert expected_share(np.zeros(10)).upper > 0.2

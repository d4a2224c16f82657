"""Sine, cosine and arc tangent of compiled kernels against the C library, over all that they may be given."""

from __future__ import annotations

import numpy as np
import pytest

from flexbase.trace.algebra import atan2, cos, sin
from flexbase.trace.kernel import Kernel, kernel_of
from flexbase.trace.targets.circular import LARGEST_ANGLE

ULPS = 2.0  # units in the last place: what the polynomials' authors promise is 1, and NumPy's own may be off by 1


@pytest.fixture(scope="module")
def turned() -> Kernel:
    return kernel_of(lambda v: (sin(v[0]), cos(v[0]), atan2(v[0], v[1])), 2, "sin cos atan2")


def ulps(found: np.ndarray, true: np.ndarray) -> float:
    return float(np.max(np.abs(found - true) / np.spacing(np.maximum(np.abs(true), 1e-300))))


def angles() -> np.ndarray:
    """Everywhere, near zero, and next to every multiple of pi/4 where quadrants change."""
    rng = np.random.default_rng(0)
    corners = np.arange(-40_000, 40_001) * (np.pi / 4.0)
    return np.concatenate(
        [
            rng.uniform(-LARGEST_ANGLE, LARGEST_ANGLE, 200_000),
            rng.uniform(-7.0, 7.0, 200_000),
            rng.uniform(-1.0, 1.0, 1000) * 10.0 ** rng.uniform(-300.0, 0.0, 1000),
            corners,
            np.nextafter(corners, np.inf),
            np.nextafter(corners, -np.inf),
            [0.0, -0.0],
        ]
    )


def test_sine_and_cosine(turned: Kernel) -> None:
    x = angles()
    found = turned(np.array([x, np.ones_like(x)]))
    assert ulps(found[0], np.sin(x)) <= ULPS
    assert ulps(found[1], np.cos(x)) <= ULPS


def test_arc_tangent(turned: Kernel) -> None:
    """Every quadrant, every octant's border, ratios from 1e-20 to 1e20, and the axes."""
    rng = np.random.default_rng(1)
    y, x = (rng.choice([-1.0, 1.0], 300_000) * 10.0 ** rng.uniform(-10.0, 10.0, 300_000) for _ in range(2))
    edge = np.array([0.0, 1.0, -1.0, 0.41421356237309503, -0.41421356237309509])
    y = np.concatenate([y, np.repeat(edge, edge.size)])
    x = np.concatenate([x, np.tile(edge, edge.size)])
    found = turned(np.array([y, x]))[2]
    assert ulps(found, np.arctan2(y, x)) <= ULPS


def test_nan_stays_nan(turned: Kernel) -> None:
    assert np.isnan(turned(np.full((2, 9), np.nan))[:2]).all()

"""A traced and compiled function gives what it gives on NumPy rows: every operation, every tail, and slopes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from flexbase.errors import import_extra
from flexbase.trace import cache
from flexbase.trace.algebra import Scalar, Vector, absolute, independence, larger, ldl, select, smaller, solve, sqrt
from flexbase.trace.kernel import GRAIN, kernel_of
from flexbase.trace.tracer import trace


def everything(v: Vector) -> list[Scalar]:
    """All operations that algebra can ask of a tracer."""
    x, y, z = v
    return [
        x + y - 2.0 * z,
        x / y,
        1.0 / z,
        -x,
        x * x + z * z,
        sqrt(absolute(x)),
        smaller(x, y),
        larger(x, z),
        select(x < y, sqrt(x - y), z),
        select(x <= y, 1.0, 2.0) + (x == y) + (x != z),
        select(absolute(x) < absolute(y), select(y < z, x, y), float("nan")),
    ]


def points(cells: int, seed: int = 0) -> np.ndarray:
    x = np.random.default_rng(seed).normal(size=(3, cells))
    x[1, ::7] = x[0, ::7]  # equal numbers too
    return x


def on_rows(x: np.ndarray) -> np.ndarray:
    with np.errstate(invalid="ignore"):  # the root of a negative number that `select` throws away
        return np.array([np.broadcast_to(value, x.shape[1]) for value in everything(tuple(x))], dtype=float)


def test_every_operation() -> None:
    """To rounding: products and sums may be contracted, which is one rounding less."""
    x = points(1003)
    found = kernel_of(everything, 3, "everything")(x)
    assert found == pytest.approx(on_rows(x), rel=1e-15, abs=1e-15, nan_ok=True)


@pytest.mark.parametrize("cells", [0, 1, 7, 8, 9, 15, 63, 64, 65, 2 * GRAIN + 13])
def test_tails_and_threads_change_no_bit(cells: int) -> None:
    kernel = kernel_of(everything, 3, "everything")
    x = points(4 * GRAIN + 1)
    whole = kernel(x, threads=1)
    assert np.array_equal(kernel(x[:, :cells]), whole[:, :cells], equal_nan=True)
    assert np.array_equal(kernel(x[:, :cells], threads=1), whole[:, :cells], equal_nan=True)


def test_results_go_where_they_are_asked_for() -> None:
    kernel = kernel_of(everything, 3, "everything")
    x = points(100)
    wide = np.full((kernel.outputs, 300), 7.0)
    kernel(x, out=wide[:, 100:200])
    assert np.array_equal(wide[:, 100:200], kernel(x), equal_nan=True)
    assert np.all(wide[:, :100] == 7.0)
    assert np.all(wide[:, 200:] == 7.0)


def test_derivatives_are_exact() -> None:
    """Slopes of a smooth function, against the complex step, whose error is rounding."""

    def smooth(v: Vector) -> list[Scalar]:
        return [v[0] * v[1] / (1.0 + v[2] * v[2]), sqrt(1.0 + v[0] * v[0]) * v[2]]

    x = points(20, 3)
    found = kernel_of(smooth, 3, "smooth", derivative=True)(x)
    assert found.shape == (2 + 6, 20)
    for i in range(3):
        step = x.astype(complex)
        step[i] += 1e-30j
        slopes = np.array(smooth(tuple(step))).imag / 1e-30
        assert found[2 + i :: 3] == pytest.approx(slopes, rel=1e-14, abs=1e-14)


@pytest.mark.parametrize("cells", [1, 8, 21, 1000])
def test_iterated_kernels_feed_their_results_back(cells: int) -> None:
    """Newton's square root of an input that stays, three and thirty steps of it, against the same steps on rows."""

    def newton(v: Vector) -> list[Scalar]:
        root, _, square = v
        return [0.5 * (root + square / root), v[0]]

    kernel = kernel_of(newton, 3, "newton", iterate=True)
    square = np.random.default_rng(7).uniform(0.5, 2.0, cells)
    x = np.array([np.ones(cells), np.zeros(cells), square])
    root, before = x[:2]
    for _ in range(3):
        root, before = newton((root, before, square))
    assert kernel(x, steps=3) == pytest.approx(np.array([root, before]), rel=1e-15)
    assert kernel(x, steps=3) != pytest.approx(kernel(x, steps=2), rel=1e-9)
    assert kernel(x, steps=30)[0] == pytest.approx(np.sqrt(square), rel=1e-15)
    assert np.array_equal(kernel(x, steps=3, threads=1), kernel(x, steps=3))


def test_common_work_is_done_once() -> None:
    """The same subexpression twice costs one operation more, not twice as many."""

    def once(v: Vector) -> list[Scalar]:
        return [solve(((v[0], v[1]), (v[1], v[2])), (v[0], v[2]))[0]]

    def twice(v: Vector) -> list[Scalar]:
        return [once(v)[0] + once(v)[0] * v[0]]

    assert len(trace(twice, 3).instructions) <= len(trace(once, 3).instructions) + 2


def test_independence_is_zero_for_dependent_rows() -> None:
    """0 for dependent rows, 1 for orthonormal ones, and never less than the ratio of the singular values."""
    assert independence(((1.0, 2.0, 3.0), (2.0, 4.0, 6.0))) == pytest.approx(0.0, abs=1e-15)
    assert independence(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))) == 1.0
    rng = np.random.default_rng(5)
    for A in rng.normal(size=(50, 3, 6)):
        values = np.linalg.svd(A, compute_uv=False)
        assert independence(A.tolist()) >= values[-1] / values[0] - 1e-15
    assert all(pivot > 0.0 for pivot in ldl(((2.0, 1.0), (1.0, 2.0)))[1])


def test_second_start_neither_traces_nor_compiles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.FOLDER, str(tmp_path))
    first = kernel_of(everything, 3, "kept")(points(50))

    def forbidden(_: Vector) -> list[Scalar]:
        raise AssertionError("traced again")

    assert np.array_equal(kernel_of(forbidden, 3, "kept")(points(50)), first, equal_nan=True)
    with pytest.raises(AssertionError, match="traced again"):
        kernel_of(forbidden, 3, "another recipe")


def test_damaged_cache_is_made_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.FOLDER, str(tmp_path))
    first = kernel_of(everything, 3, "damaged")(points(50))
    (kept,) = tmp_path.iterdir()
    for content in (b"", kept.read_bytes()[:-1], b"\0" * kept.stat().st_size):
        kept.write_bytes(content)
        assert np.array_equal(kernel_of(everything, 3, "damaged")(points(50)), first, equal_nan=True)


@pytest.mark.parametrize("folder", ["off", "/proc/nowhere"])
def test_no_cache_is_no_fault(folder: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.FOLDER, folder)
    assert kernel_of(everything, 3, "unkept")(points(9)).shape == (len(everything((3.0, 2.0, 1.0))), 9)


def test_kernels_of_two_processes_agree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What another process cached is what this one computes."""
    import_extra("casadi", "fast")
    monkeypatch.setenv(cache.FOLDER, str(tmp_path))
    code = "from tests.trace.test_kernel import *; kernel_of(everything, 3, 'shared')"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(__file__).parents[2], timeout=120)
    assert len(list(tmp_path.iterdir())) == 1
    x = points(500)
    assert kernel_of(everything, 3, "shared")(x) == pytest.approx(on_rows(x), rel=1e-15, abs=1e-15, nan_ok=True)

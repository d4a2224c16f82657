"""Jacobi's eigenvalues against LAPACK's, on floats, rows and kernels."""

from __future__ import annotations

import numpy as np
import pytest

from flexbase.trace.algebra import Scalar, Vector, stack, unstack
from flexbase.trace.eigen import generalised_eigen, symmetric_eigen
from flexbase.trace.kernel import kernel_of

SIZES = (1, 2, 3, 4, 5, 6)
EPS = 2.0**-52


def symmetric(size: int, cells: int) -> np.ndarray:
    """Ordinary ones, nearly diagonal ones, multiples of the identity, and of rank one."""
    rng = np.random.default_rng(size)
    A = rng.normal(size=(cells, size, size))
    A = A + np.swapaxes(A, 1, 2)
    A[::5] *= 1e-9
    A[::5] += np.eye(size) * rng.normal(size=(len(A[::5]), 1, size))
    A[1::50] = np.eye(size)
    v = rng.normal(size=(len(A[2::50]), size, 1))
    A[2::50] = v @ np.swapaxes(v, 1, 2)
    return A


@pytest.mark.parametrize("size", SIZES)
def test_rows_are_lapacks(size: int) -> None:
    """A V = V L, V^T V = 1 and the values themselves, within 20 roundings of |A|; ascending."""
    A = symmetric(size, 2000)
    values, vectors = symmetric_eigen(unstack(A, 2))
    found, V = stack(values), np.swapaxes(np.broadcast_to(stack(vectors), A.shape), 1, 2)
    scale = 20.0 * EPS * np.abs(A).max(axis=(1, 2)) * size
    assert np.all(np.abs(found - np.linalg.eigvalsh(A)).max(axis=1) <= scale)
    assert np.all(np.abs(A @ V - V * found[:, None, :]).max(axis=(1, 2)) <= scale)
    assert np.abs(np.swapaxes(V, 1, 2) @ V - np.eye(size)).max() <= 20.0 * EPS * size
    assert np.all(np.diff(found, axis=1) >= 0.0)


@pytest.mark.parametrize("size", SIZES)
def test_kernel_is_rows(size: int) -> None:
    places = [(i, j) for i in range(size) for j in range(i + 1)]

    def values(v: Vector) -> list[Scalar]:
        A = [[v[places.index((max(i, j), min(i, j)))] for j in range(size)] for i in range(size)]
        return list(symmetric_eigen(A).values)

    A = symmetric(size, 999)
    found = kernel_of(values, len(places), f"eigenvalues {size}")(np.array([A[:, i, j] for i, j in places]))
    assert np.abs(found.T - np.linalg.eigvalsh(A)).max() <= 20.0 * EPS * size * np.abs(A).max()


@pytest.mark.parametrize("size", SIZES)
def test_generalised(size: int) -> None:
    """K phi = l S phi with phi^T S phi = 1; S is well conditioned, so 1e-12 is generous."""
    rng = np.random.default_rng(size)
    root = rng.normal(size=(2, size, size))
    K, S = root @ np.swapaxes(root, 1, 2) + size * np.eye(size)
    values, vectors = generalised_eigen(K.tolist(), S.tolist())
    phi = np.array(vectors).T
    assert K @ phi == pytest.approx(S @ phi * np.array(values), rel=1e-12, abs=1e-12)
    assert phi.T @ S @ phi == pytest.approx(np.eye(size), rel=1e-12, abs=1e-12)

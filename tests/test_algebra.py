"""The scalar algebra that everything is written in equals NumPy's, and folds literal zeros and ones."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexbase.trace import algebra

NUMBERS = st.floats(-1e3, 1e3, allow_subnormal=False)


def matrices(rows: int, columns: int) -> st.SearchStrategy[list[list[float]]]:
    """Nested lists of ordinary numbers."""
    return st.lists(st.lists(NUMBERS, min_size=columns, max_size=columns), min_size=rows, max_size=rows)


def spd(seed: int, size: int, batch: int | None = None) -> np.ndarray:
    """Well-conditioned symmetric positive definite matrices."""
    root = np.random.default_rng(seed).normal(size=(*([] if batch is None else [batch]), size, size))
    return root @ np.swapaxes(root, -1, -2) + size * np.eye(size)


@given(matrices(3, 4), matrices(4, 2))
def test_product_of_matrices_is_numpys(A, B):
    """The entries of A B; the tolerance is a few roundings of the largest possible sum, 4e6."""
    assert np.array(algebra.matmul(A, B)) == pytest.approx(np.array(A) @ np.array(B), rel=1e-14, abs=1e-8)


@given(matrices(2, 3))
def test_cross_product_is_numpys(rows):
    """u x v; exact up to one rounding of products of size 1e6."""
    assert algebra.cross(*rows) == pytest.approx(np.cross(*np.array(rows)), rel=1e-14, abs=1e-9)


@pytest.mark.parametrize("size", [1, 2, 3, 6])
def test_ldl_reconstructs_and_solves(size):
    """L diag(d) L^T = A with L unit lower triangular, and A x = b; A is well conditioned, so 1e-12 is generous."""
    A, b = spd(size, size), np.arange(1.0, size + 1.0)
    L, d = algebra.ldl(A.tolist())
    L_array = np.array(L)
    assert np.array_equal(L_array, np.tril(L_array))
    assert np.array_equal(np.diag(L_array), np.ones(size))
    assert L_array @ np.diag(d) @ L_array.T == pytest.approx(A, rel=1e-12, abs=1e-12)
    assert A @ np.array(algebra.solve_ldl(L, d, b.tolist())) == pytest.approx(b, rel=1e-12)


def test_ldl_pivots_judge_definiteness():
    """All pivots are positive exactly where the matrix is positive definite: a batch of both kinds tells them apart."""
    rng = np.random.default_rng(3)
    A = rng.normal(size=(200, 3, 3))
    A = A + np.swapaxes(A, 1, 2) + rng.uniform(0.0, 6.0, (200, 1, 1)) * np.eye(3)
    _, pivots = algebra.ldl(algebra.unstack(A, 2))
    by_pivots = np.all(np.array(pivots) > 0.0, axis=0)
    definite = np.linalg.eigvalsh(A)[:, 0] > 0.0
    assert 20 < definite.sum() < 180  # both kinds occur
    assert np.array_equal(by_pivots, definite)


def test_batch_solve_equals_one_by_one():
    """A batch of systems gives each system's own solution, to rounding."""
    A, b = spd(5, 4, batch=7), np.random.default_rng(1).normal(size=(7, 4))
    L, d = algebra.ldl(algebra.unstack(A, 2))
    x = algebra.stack(algebra.solve_ldl(L, d, algebra.unstack(b, 1)))
    assert x == pytest.approx(np.linalg.solve(A, b[..., None])[..., 0], rel=1e-12, abs=1e-14)


@pytest.mark.parametrize(("shape", "depth"), [((3,), 1), ((2, 3), 2), ((5, 2, 3), 2), ((4, 5, 2), 1), ((2, 2), 0)])
def test_unstack_is_the_inverse_of_stack(shape, depth):
    """Taking an array apart and putting it together changes nothing, whatever its batch axes."""
    array = np.random.default_rng(0).normal(size=shape)
    assert np.array_equal(algebra.stack(algebra.unstack(array, depth)), array)


def test_stack_spreads_constants_over_a_batch():
    """A literal among batches is the same in every configuration, and the batch axis comes first."""
    batch = np.array([1.0, 2.0, 3.0])
    stacked = algebra.stack(((batch, 0.0), (1.0, -batch)))
    assert stacked.shape == (3, 2, 2)
    assert np.array_equal(stacked[1], [[2.0, 0.0], [1.0, -2.0]])


def test_literal_zeros_and_ones_fold_away():
    """Products with literal 0 and 1 and sums with literal 0 leave no operation that a tracer would record."""

    class Symbol:
        def __neg__(self) -> str:
            return "negated"

    x = Symbol()
    assert algebra.mul(0.0, x) == algebra.mul(x, 0.0) == 0.0
    assert algebra.mul(1.0, x) is x
    assert algebra.mul(x, 1.0) is x
    assert algebra.add(0.0, x) is x
    assert algebra.add(x, 0.0) is x
    assert algebra.sub(x, 0.0) is x
    assert algebra.sub(0.0, x) == "negated"
    assert algebra.dot((0.0, 1.0), (x, x)) is x


def test_a_batch_that_happens_to_be_zero_is_not_folded():
    """Only literals fold: a zero that was computed keeps its type, or a batch would lose its axis."""
    zeros = np.zeros(4)
    assert algebra.mul(zeros, 2.0).shape == (4,)
    assert algebra.add(zeros, np.ones(4)).shape == (4,)


def test_a_length_of_zero_may_be_divided_by():
    """or_one leaves lengths alone and turns zeros into ones, one by one."""
    assert algebra.or_one(np.array([0.0, 2.5])).tolist() == [1.0, 2.5]
    assert algebra.or_one(0.0) == 1.0

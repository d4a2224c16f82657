"""Passive and active joints by index: the same answers wherever in the chain the base's joints stand."""

from __future__ import annotations

import numpy as np
import pytest

from flexbase.dynamics.inertia import arm_on_free_base
from flexbase.linear.reduced import reduce_arm
from flexbase.model.parts import Parts, base_first

MIXED = Parts((1, 4), (0, 2, 3))  # base joints inside the chain
ORDER = [*MIXED.passive, *MIXED.active]


def inertia(N: int = 5) -> np.ndarray:
    root = np.random.default_rng(3).normal(size=(N, N))
    return np.asarray(root @ root.T + N * np.eye(N))


@pytest.mark.parametrize("parts", [MIXED, base_first(2, 5), base_first(0, 5)])
def test_parts_make_the_whole(parts):
    """Vectors, batches of them and matrices come apart and together; sequences of any scalar as arrays do."""
    q, M = np.arange(5.0), inertia()
    assert parts.whole(parts.base(q), parts.arm(q)).tolist() == q.tolist()
    assert parts.whole(parts.base(tuple("abcde")), parts.arm(tuple("abcde"))) == tuple("abcde")
    batch = np.stack([q, -q, 2.0 * q])
    assert parts.whole(parts.base(batch), parts.arm(batch)).tolist() == batch.tolist()
    assert [np.array(block).tolist() for block in parts.blocks(M.tolist()) if len(block)] == [
        block.tolist() for block in parts.blocks(M) if len(block)
    ]
    Mpp, Map, Mhat = parts.blocks(M)
    assert Map.tolist() == M[np.ix_(parts.active, parts.passive)].tolist()
    own = parts.on_base(Mpp) + parts.on_arm(Mhat)
    assert parts.blocks(own).passive.tolist() == Mpp.tolist()
    assert parts.blocks(own).active.tolist() == Mhat.tolist()
    assert not parts.blocks(own).coupling.any()
    assert np.array(parts.on_arm(Mhat.tolist())).tolist() == parts.on_arm(Mhat).tolist()


def test_reduced_form_and_free_arm_know_no_order():
    """The reduced form and Ms of a chain with its base inside are those of the same matrices with the base first."""
    M, J = inertia(), np.random.default_rng(4).normal(size=(2, 5))
    E = 0.1 * np.eye(3)
    sorted_M, first = M[np.ix_(ORDER, ORDER)], base_first(2, 5)
    inside = reduce_arm(M.tolist(), J.tolist(), MIXED, E.tolist())
    ahead = reduce_arm(sorted_M.tolist(), J[:, ORDER].tolist(), first, E.tolist())
    assert inside == ahead
    assert arm_on_free_base(M.tolist(), MIXED) == arm_on_free_base(sorted_M.tolist(), first)
    lone = np.linalg.inv(np.linalg.inv(M)[np.ix_(MIXED.active, MIXED.active)])
    np.testing.assert_allclose(arm_on_free_base(M.tolist(), MIXED), lone, rtol=1e-12)  # condition of M: below 10

"""The joint-space inertia matrix by the composite-rigid-body algorithm, on any number type.  [F08 ch 6]"""

from __future__ import annotations

from flexbase.dynamics.kinematics import Frames
from flexbase.dynamics.spatial import momentum, power, sum_of_inertias
from flexbase.model.parts import Parts
from flexbase.trace.algebra import Matrix, Scalar, add, ldl, matmul, matsub, solve_ldl, transpose


def mass_matrix(frames: Frames) -> Matrix:
    """M(q), N x N symmetric.  [U03 eq 1]"""
    size = len(frames.bodies)
    M: list[list[Scalar]] = [[0.0] * size for _ in range(size)]
    composite = None
    for i in reversed(range(size)):
        body = frames.bodies[i]
        composite = body if composite is None else sum_of_inertias(body, composite)
        carried = momentum(composite, frames.motions[i])
        for j in range(i + 1):
            M[i][j] = M[j][i] = power(carried, frames.motions[j])
        M[i][i] = add(M[i][i], frames.links[i].armature)
    return tuple(map(tuple, M))


def arm_on_free_base(M: Matrix, parts: Parts) -> Matrix:
    """Ms = Mhat - Map Mpp^-1 Mpa: what the arm joints weigh while the base yields, n x n.  [theory §8]

    Assumes Mpp positive definite.
    """
    blocks: tuple[Matrix, Matrix, Matrix] = parts.blocks(M)
    Mpp, Map, Mhat = blocks
    if not parts.passive:
        return Mhat
    L, pivots = ldl(Mpp)
    carried = transpose(tuple(solve_ldl(L, pivots, row) for row in Map))  # Mpp^-1 Mpa
    return matsub(Mhat, matmul(Map, carried))

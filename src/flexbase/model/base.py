"""The compliant base: what its passive joints resist with, and where they rest."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.typing import ArrayLike

from flexbase.checks import Array, check_definite, check_length, square_or_diagonal
from flexbase.model.units import DAMPING_UNIT, UNIT


@dataclass(frozen=True, eq=False)
class Base:
    """m passive visco-elastic joints: tau_p = Kp (qbar_p - q_p) - Dp q_p'.  [U03 eq 2]

    stiffness : Kp, symmetric positive definite, shape (m, m)
    damping : Dp, symmetric positive semidefinite, shape (m, m)
    equilibrium : qbar_p, where the springs rest, shape (m,)
    """

    stiffness: Array
    damping: Array
    equilibrium: Array

    @property
    def m(self) -> int:
        """Number of base joints."""
        return len(self.equilibrium)


def make_base(stiffness: ArrayLike, damping: ArrayLike, equilibrium: ArrayLike, m: int, where: str = "") -> Base:
    """Check and freeze a base of m joints; vectors become diagonal matrices.

    where : put before the field's name in messages. Raises InputError.
    """
    K = square_or_diagonal(f"{where}stiffness", stiffness, m, UNIT)
    D = square_or_diagonal(f"{where}damping", damping, m, DAMPING_UNIT)
    check_definite(f"{where}stiffness", K, UNIT, allow_zero=False, why="leaves the base no equilibrium")
    check_definite(f"{where}damping", D, DAMPING_UNIT, allow_zero=True, why="would feed energy into the base")
    return Base(K, D, check_length(f"{where}equilibrium", equilibrium, m, "one for each base joint"))

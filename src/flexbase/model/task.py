"""The task: which motions of the tool are controlled, and with which gains."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.typing import ArrayLike

from flexbase.checks import Array, check_definite, square_or_diagonal
from flexbase.errors import InputError
from flexbase.model.units import DAMPING_UNIT, UNIT

ROWS = ("x", "y", "z", "rx", "ry", "rz")
BRANCHES = ("+", "-", "+++", "++-", "+-+", "+--", "-++", "-+-", "--+", "---")


@dataclass(frozen=True)
class Task:
    """Rows of the tool's motion in world axes: positions x y z [m], rotations rx ry rz [rad].

    branch : default sign of the elbow, "+" for 0 < elbow angle < pi; or the three signs of shoulder, elbow and wrist
    """

    rows: tuple[str, ...]
    branch: str = "+"

    @property
    def k(self) -> int:
        """Number of task rows."""
        return len(self.rows)

    @property
    def indices(self) -> tuple[int, ...]:
        """Positions of the rows among x y z rx ry rz."""
        return tuple(ROWS.index(row) for row in self.rows)

    @property
    def units(self) -> tuple[str, ...]:
        """Unit of each row."""
        return tuple("rad" if row.startswith("r") else "m" for row in self.rows)


@dataclass(frozen=True, eq=False)
class Gains:
    """Task-space PD gains: f = -(stiffness y + damping y'), both symmetric, shape (k, k)."""

    stiffness: Array
    damping: Array


def make_gains(stiffness: ArrayLike, damping: ArrayLike, k: int, where: str = "") -> Gains:
    """Check and freeze task gains; vectors become diagonal matrices.

    where : put before the field's name in messages. Raises InputError.
    """
    K = square_or_diagonal(f"{where}stiffness", stiffness, k, UNIT)
    D = square_or_diagonal(f"{where}damping", damping, k, DAMPING_UNIT)
    check_definite(f"{where}stiffness", K, UNIT, allow_zero=True, why="would push the tip away from its target")
    check_definite(f"{where}damping", D, DAMPING_UNIT, allow_zero=True, why="would feed energy into the tip")
    return Gains(K, D)


def checked_gains(gains: Gains, k: int) -> Gains:
    """Gains that a user made by hand, checked and frozen. Raises InputError."""
    if not isinstance(gains, Gains):
        raise InputError(f"gains: {gains!r} is not a pair of gains. Give Gains(stiffness, damping).")
    return make_gains(gains.stiffness, gains.damping, k, where="gains, ")


def check_branch(branch: str) -> str:
    """Return a branch: the elbow's sign, or the signs of shoulder, elbow and wrist. Raises InputError.

    Whether the arm has a shoulder and a wrist to name is seen where the branch is used.
    """
    if branch not in BRANCHES:
        raise InputError(
            f'branch: "{branch}" is unknown. Give "+" (0 < elbow angle < pi) or "-"; for six joints also three signs, '
            'of shoulder, elbow and wrist, such as "+-+".'
        )
    return branch

"""Dynamic manipulability: how far a force, or a torque, accelerates the tip, in each direction.  [Y85, U03 §IV C]"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from flexbase.cautions import collected
from flexbase.checks import Array, choose
from flexbase.linear.linearise import check_definite_inertia
from flexbase.measures.registry import Configuration, measure
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Pose, check_pose
from flexbase.sheets.numbers import number
from flexbase.sheets.plain import Plain
from flexbase.sheets.sheet import Column, Sheet, facts, make_sheet, table, words
from flexbase.sheets.told import Told
from flexbase.trace.algebra import Matrix, Scalar, Vector, absolute, atan2, dot, ldl, norm, scale, select
from flexbase.trace.eigen import symmetric_eigen

CONVENTIONS = ("force", "torque")


@dataclass(frozen=True, eq=False)
class Ellipsoid(Plain):
    """Tip accelerations of the arm on a rigid base, for inputs of at most 1.

    convention : "force", |f| <= 1: semi-axes are the eigenvalues of R0 = Jv X^-1 Jv^T  [U03 eq 20];
        "torque", |tau| <= 1: semi-axes are the singular values of Jv X^-1  [Y85]
    semi_axes : longest first, shape (k,); directions : a column a semi-axis, shape (k, k)
    """

    convention: str
    semi_axes: Array
    directions: Array

    document: ClassVar = ("semi_axes", "directions=directions.T", "volume")

    @property
    def volume(self) -> float:
        """Product of the semi-axes (area over pi, for two task rows)."""
        return float(np.prod(self.semi_axes))

    def boundary(self, points: int = 181) -> Array:
        """Points on an ellipse's outline, shape (points, 2). Assumes two task rows."""
        angle = np.linspace(0.0, 2.0 * np.pi, points)
        circle = np.column_stack([np.cos(angle), np.sin(angle)])
        return np.asarray((circle * self.semi_axes) @ self.directions.T)


@dataclass(frozen=True, eq=False)
class Manipulability(Told):
    """Ellipsoids of one convention at a pose, as the arm is and under a compensator; the same where there is none.

    rotation : angle from the original to the compensated longest axis, for two task rows counted from x to y within
        (-pi/2, pi/2], otherwise without sign [rad]
    volume_ratio : compensated over original
    cautions : what should be known of the compensator
    """

    pose: Pose
    original: Ellipsoid
    compensated: Ellipsoid
    cautions: tuple[str, ...] = ()

    document: ClassVar = (
        "convention=original.convention",
        "original",
        "compensated",
        "rotation_rad=rotation",
        "volume_ratio",
    )

    @property
    def rotation(self) -> float:
        """Turn of the longest axis [rad]."""
        before, after = self.original.directions[:, 0], self.compensated.directions[:, 0]
        if len(before) == 2:
            turn = np.arctan2(before[0] * after[1] - before[1] * after[0], before @ after)
            return float(np.pi / 2.0 - np.mod(np.pi / 2.0 - turn, np.pi))
        return float(np.arccos(min(1.0, abs(float(before @ after)))))

    @property
    def volume_ratio(self) -> float:
        """Volume under the compensator over the original one."""
        return self.compensated.volume / self.original.volume

    def sheet(self) -> Sheet:
        """Semi-axes and directions of both, and what the compensator changes."""
        original, compensated = self.original, self.compensated is not self.original
        ball = "|f| <= 1 N" if original.convention == "force" else "|tau| <= 1 N m (or N)"
        kinds = {"original": original, **({"compensated": self.compensated} if compensated else {})}
        directions = (Column(f"direction\n{row}") for row in self.pose.arm.task.rows)
        rows = (
            [name if i == 0 else "", number(axis), *(number(entry, 6) for entry in one.directions[:, i])]
            for name, one in kinds.items()
            for i, axis in enumerate(one.semi_axes)
        )
        change = facts(
            ("longest axis turned by", f"{number(float(np.degrees(self.rotation)), 6)} deg"),
            ("volume times", number(self.volume_ratio, 6)),
        )
        return make_sheet(
            self.pose.plant.name,
            f"dynamic manipulability {'with' if compensated else 'without'} compensator",
            self.pose.where,
            make_sheet(
                f"Convention {original.convention}",
                ball,
                table([words("ellipsoid"), Column("semi-axis", "m/s^2"), *directions], rows),
                change if compensated else None,
            ),
            cautions=self.cautions,
        )


def manipulability(pose: Pose, loop: Asked = None, convention: str = "force") -> Manipulability:
    """Ellipsoids of the arm on its base held still, without and with a compensator.

    Raises InputError if M - E is not positive definite or the convention is unknown.
    """
    check_pose(pose)
    choose("convention", convention, dict.fromkeys(CONVENTIONS))
    with collected() as said:
        asked = loop_on(pose.arm, loop)
    check_definite_inertia(pose, asked.gain)
    original = _ellipsoid(pose, np.zeros_like(asked.gain), convention)
    compensated = original if asked.E is None else _ellipsoid(pose, asked.gain, convention)
    return Manipulability(pose, original, compensated, tuple(said))


def _ellipsoid(pose: Pose, E: Array, convention: str) -> Ellipsoid:
    Jv = pose.Jv
    response = np.linalg.solve(pose.Mhat - E, Jv.T).T  # Jv X^-1
    if convention == "force":
        axes, directions = np.linalg.eigh(response @ Jv.T)
        return Ellipsoid(convention, axes[::-1], directions[:, ::-1])
    directions, axes, _ = np.linalg.svd(response, full_matrices=False)
    return Ellipsoid(convention, axes, directions)


@measure("manipulability", unit="kg^-k", purpose="det R0: product of the force ellipsoid's semi-axes")
def volume(configuration: Configuration) -> Scalar:
    """det R0, the product of the semi-axes for |f| <= 1.  [U03 eq 20]"""
    product: Scalar = 1.0
    for pivot in ldl(configuration.reduced.R0)[1]:
        product = product * pivot
    return product


@measure(
    "axis_rotation",
    unit="rad",
    purpose="how far E turns the force ellipsoid's longest axis",
    needs=lambda m, n, k: None if k > 1 else "two task rows",
    no_search="is an angle, neither good nor bad",
    period=np.pi,
)
def axis_rotation(configuration: Configuration) -> Scalar:
    """Angle from the original to the compensated longest axis of |f| <= 1.  [U03 §IV C]

    For two task rows counted from the first to the second within (-pi/2, pi/2], otherwise without sign; 0 without a
    compensator. Undefined, and arbitrary, where the two longest axes are equal.
    """
    if configuration.E is None:
        return 0.0
    before, after = _longest(configuration.original.R0), _longest(configuration.reduced.R0)
    cosine = dot(before, after)
    if len(before) == 2:
        sine = before[0] * after[1] - before[1] * after[0]
        return atan2(select(cosine < 0.0, -sine, sine), absolute(cosine))
    across = [x - y for x, y in zip(after, scale(cosine, before), strict=True)]
    return atan2(norm(across), absolute(cosine))


def _longest(R0: Matrix) -> Vector:
    return symmetric_eigen(R0).vectors[-1]

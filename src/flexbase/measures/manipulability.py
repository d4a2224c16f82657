"""Dynamic manipulability: how far a force, or a torque, accelerates the tip, in each direction.  [Y85, U03 §IV C]"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.linear.linearise import check_definite_inertia
from flexbase.measures.registry import Configuration, measure
from flexbase.model.loop import Asked, loop_on
from flexbase.plant import Pose, check_pose
from flexbase.trace.algebra import Matrix, Scalar, Vector, absolute, atan2, dot, ldl, norm, scale, select
from flexbase.trace.eigen import symmetric_eigen

CONVENTIONS = ("force", "torque")


@dataclass(frozen=True, eq=False)
class Ellipsoid:
    """Tip accelerations of the arm on a rigid base, for inputs of at most 1.

    convention : "force", |f| <= 1: semi-axes are the eigenvalues of R0 = Jv X^-1 Jv^T  [U03 eq 20];
        "torque", |tau| <= 1: semi-axes are the singular values of Jv X^-1  [Y85]
    semi_axes : longest first, shape (k,); directions : a column a semi-axis, shape (k, k)
    """

    convention: str
    semi_axes: Array
    directions: Array

    @property
    def volume(self) -> float:
        """Product of the semi-axes (area over pi, for two task rows)."""
        return float(np.prod(self.semi_axes))

    def boundary(self, points: int = 181) -> Array:
        """Points on an ellipse's outline, shape (points, 2). Assumes two task rows."""
        angle = np.linspace(0.0, 2.0 * np.pi, points)
        circle = np.column_stack([np.cos(angle), np.sin(angle)])
        return np.asarray((circle * self.semi_axes) @ self.directions.T)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return {
            "semi_axes": self.semi_axes.tolist(),
            "directions": self.directions.T.tolist(),
            "volume": self.volume,
        }


@dataclass(frozen=True, eq=False)
class Manipulability:
    """Ellipsoids of one convention, as the arm is and under a compensator.

    rotation : angle from the original to the compensated longest axis, for two task rows counted from x to y within
        (-pi/2, pi/2], otherwise without sign [rad]
    volume_ratio : compensated over original
    """

    original: Ellipsoid
    compensated: Ellipsoid

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

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, with units in the names."""
        return {
            "convention": self.original.convention,
            "original": self.original.to_dict(),
            "compensated": self.compensated.to_dict(),
            "rotation_rad": self.rotation,
            "volume_ratio": self.volume_ratio,
        }

    def summary(self) -> str:
        """Three lines in plain text."""
        return (
            f"|{'f' if self.original.convention == 'force' else 'tau'}| <= 1\n"
            f"  original semi-axes {np.round(self.original.semi_axes, 6).tolist()}\n"
            f"  compensated semi-axes {np.round(self.compensated.semi_axes, 6).tolist()}, turned by "
            f"{np.degrees(self.rotation):.3f} deg, volume times {self.volume_ratio:.4f}"
        )


def manipulability(pose: Pose, loop: Asked = None, convention: str = "force") -> Manipulability:
    """Ellipsoids of the arm on its base held still, without and with a compensator.

    Raises InputError if M - E is not positive definite or the convention is unknown.
    """
    check_pose(pose)
    E = loop_on(pose.arm, loop).gain
    check_definite_inertia(pose, E)
    return Manipulability(_ellipsoid(pose, np.zeros_like(E), convention), _ellipsoid(pose, E, convention))


def _ellipsoid(pose: Pose, E: Array, convention: str) -> Ellipsoid:
    m = pose.arm.m
    Jv = pose.J[:, m:]
    response = np.linalg.solve(pose.M[m:, m:] - E, Jv.T).T  # Jv X^-1
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

"""Forward kinematics and the Jacobian, on any number type."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from flexbase.dynamics.spatial import (
    IDENTITY,
    ZERO_VECTOR,
    Motion,
    SpatialInertia,
    inertia_at_origin,
    point_mass,
    sum_of_inertias,
)
from flexbase.model.mechanism import Link, Mechanism
from flexbase.trace.algebra import (
    Matrix,
    Scalar,
    Vector,
    add,
    cos,
    cross,
    matmul,
    matvec,
    minus,
    mul,
    plus,
    scale,
    sin,
    sub,
)


@dataclass(frozen=True)
class Frames:
    """Where a configuration puts the bodies, in world axes: all that the dynamics need.

    motions : joint i's unit motion, at the world origin
    rotations, coms : each body's orientation and centre of mass
    tool_rotation, tool_position : the tool frame
    payload : a point mass at the tool [kg]
    """

    links: tuple[Link, ...]
    motions: tuple[Motion, ...]
    rotations: tuple[Matrix, ...]
    coms: tuple[Vector, ...]
    tool_rotation: Matrix
    tool_position: Vector
    payload: Scalar = 0.0

    @cached_property
    def bodies(self) -> tuple[SpatialInertia, ...]:
        """Each body's inertia, at the world origin, the last one's with the payload."""
        bodies = [
            inertia_at_origin(link.mass, com, link.inertia, rotation)
            for link, com, rotation in zip(self.links, self.coms, self.rotations, strict=True)
        ]
        if type(self.payload) is not float or self.payload != 0.0:
            bodies[-1] = sum_of_inertias(bodies[-1], point_mass(self.payload, self.tool_position))
        return tuple(bodies)


def rotation_about(axis: tuple[float, ...], angle: Scalar) -> Matrix:
    """Rotation matrix about a unit axis; entries that the axis makes constant stay literal."""
    c, s = cos(angle), sin(angle)
    x, y, z = axis
    turn = ((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0))
    rows = []
    for i in range(3):
        row = []
        for j in range(3):
            outer = axis[i] * axis[j]
            held = add(outer, mul(c, sub(1.0 if i == j else 0.0, outer)))
            row.append(add(held, mul(s, turn[i][j])))
        rows.append(tuple(row))
    return tuple(rows)


def forward(mechanism: Mechanism, q: Vector) -> Frames:
    """Place every body. q holds N scalars, base first; entries may be batches."""
    rotation, position = IDENTITY, ZERO_VECTOR
    motions, rotations, coms = [], [], []
    for link, qi in zip(mechanism.links, q, strict=True):
        position = plus(position, matvec(rotation, link.placement_position))
        rotation = matmul(rotation, link.placement_rotation)
        axis = matvec(rotation, link.axis)
        if link.revolute:
            motions.append(Motion(axis, cross(position, axis)))
            rotation = matmul(rotation, rotation_about(link.axis, qi))
        else:
            motions.append(Motion(ZERO_VECTOR, axis))
            position = plus(position, scale(qi, axis))
        rotations.append(rotation)
        coms.append(plus(position, matvec(rotation, link.com)))
    tool_rotation, tool_position = mechanism.tool
    return Frames(
        mechanism.links,
        tuple(motions),
        tuple(rotations),
        tuple(coms),
        matmul(rotation, tool_rotation),
        plus(position, matvec(rotation, tool_position)),
    )


def jacobian(frames: Frames) -> Matrix:
    """6 x N Jacobian of the tool in world axes: rows x y z rx ry rz."""
    columns = [
        (*minus(motion.linear, cross(frames.tool_position, motion.angular)), *motion.angular)
        for motion in frames.motions
    ]
    return tuple(tuple(column[row] for column in columns) for row in range(6))


def task_jacobian(frames: Frames, rows: tuple[int, ...]) -> Matrix:
    """k x N Jacobian of the chosen rows."""
    full = jacobian(frames)
    return tuple(full[row] for row in rows)

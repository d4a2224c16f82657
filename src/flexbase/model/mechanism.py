"""A serial chain of rigid bodies: frozen numbers, no behaviour."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from flexbase.checks import Array

ROUNDING = 1e-15  # an entry of a rotation below which it is zero


def _none() -> Array:
    return np.zeros(0)


class Link(NamedTuple):
    """One joint and the body it carries, as plain literals for the generic algorithms (constants fold away)."""

    revolute: bool
    axis: tuple[float, ...]
    placement_rotation: tuple[tuple[float, ...], ...]
    placement_position: tuple[float, ...]
    mass: float
    com: tuple[float, ...]
    inertia: tuple[tuple[float, ...], ...]
    armature: float


@dataclass(frozen=True, eq=False)
class Mechanism:
    """A serial chain, base joints first, ending in a tool frame.

    Body i moves with joint i. Its frame coincides with the joint frame at q_i = 0; `placement` is that joint frame as
    seen from the body before it. SI units.

    joint_names : N names
    joint_types : N of "revolute" or "prismatic"
    axes : unit joint axes in the joint frame, shape (N, 3)
    placement_rotation, placement_position : shapes (N, 3, 3) and (N, 3)
    mass : shape (N,) [kg]
    com : centre of mass in the body frame, shape (N, 3) [m]
    inertia : about the centre of mass, body axes, shape (N, 3, 3) [kg m^2]
    tool_rotation, tool_position : the tool frame in the last body's frame, shapes (3, 3) and (3,)
    armature : rotor inertia reflected to each joint, shape (N,) [kg m^2 or kg]; zero if left out
    friction : viscous friction of each joint, shape (N,) [N m s/rad or N s/m]; zero if left out
    """

    joint_names: tuple[str, ...]
    joint_types: tuple[str, ...]
    axes: Array
    placement_rotation: Array
    placement_position: Array
    mass: Array
    com: Array
    inertia: Array
    tool_rotation: Array
    tool_position: Array
    armature: Array = field(default_factory=_none)
    friction: Array = field(default_factory=_none)

    def __post_init__(self) -> None:
        for name in ("armature", "friction"):
            if not getattr(self, name).size:
                object.__setattr__(self, name, np.zeros(self.N))

    @property
    def joint_units(self) -> tuple[str, ...]:
        """Unit of each joint's coordinate, rad or m."""
        return tuple("rad" if kind == "revolute" else "m" for kind in self.joint_types)

    @property
    def N(self) -> int:
        """Number of joints, base and arm."""
        return len(self.joint_names)

    @cached_property
    def reach(self) -> float:
        """Sum of all link offsets, or 1 [m]: no tip is farther out while prismatic joints stand at zero."""
        offsets = np.linalg.norm(self.placement_position, axis=1).sum()
        return float(offsets + np.linalg.norm(self.tool_position)) or 1.0

    @property
    def ranges(self) -> tuple[tuple[float, float], ...]:
        """Low and high of each joint [rad or m]: a turn, or the reach to either side where it slides."""
        spans = [np.pi if kind == "revolute" else self.reach for kind in self.joint_types]
        return tuple((-span, span) for span in spans)

    @cached_property
    def links(self) -> tuple[Link, ...]:
        """The chain as plain Python numbers, one `Link` a joint."""
        return tuple(
            Link(
                self.joint_types[i] == "revolute",
                tuple(self.axes[i].tolist()),
                _literals(self.placement_rotation[i]),
                tuple(self.placement_position[i].tolist()),
                float(self.mass[i]),
                tuple(self.com[i].tolist()),
                tuple(map(tuple, self.inertia[i].tolist())),
                float(self.armature[i]),
            )
            for i in range(self.N)
        )

    @cached_property
    def tool(self) -> tuple[tuple[tuple[float, ...], ...], tuple[float, ...]]:
        """Tool rotation and position as plain Python numbers."""
        return _literals(self.tool_rotation), tuple(self.tool_position.tolist())


def _literals(rotation: Array) -> tuple[tuple[float, ...], ...]:
    """A rotation's entries; the 2e-16 of a right angle that a file gives in 16 digits is the zero that folds away."""
    return tuple(map(tuple, np.where(np.abs(rotation) <= ROUNDING, 0.0, rotation).tolist()))


class Body(NamedTuple):
    """Mass properties of a rigid body: mass [kg], centre of mass [m], inertia about it [kg m^2], in one frame."""

    mass: float
    com: Array
    inertia: Array


def steiner(mass: float, offset: Array) -> Array:
    """Inertia of a point mass at `offset`: what the parallel-axis theorem adds."""
    return mass * (float(offset @ offset) * np.eye(3) - np.outer(offset, offset))


def merged(one: Body, other: Body) -> Body:
    """Two bodies welded together, both given in the same frame."""
    mass = one.mass + other.mass
    if mass == 0.0:
        return one
    com = (one.mass * one.com + other.mass * other.com) / mass
    inertia = sum((b.inertia + steiner(b.mass, b.com - com) for b in (one, other)), np.zeros((3, 3)))
    return Body(mass, com, inertia)


def with_payload(mechanism: Mechanism, payload: Body) -> Mechanism:
    """The mechanism with a body, given in the tool frame, welded to its last link."""
    rotation = mechanism.tool_rotation
    carried = Body(
        payload.mass, mechanism.tool_position + rotation @ payload.com, rotation @ payload.inertia @ rotation.T
    )
    last = merged(Body(float(mechanism.mass[-1]), mechanism.com[-1], mechanism.inertia[-1]), carried)
    mass, com, inertia = mechanism.mass.copy(), mechanism.com.copy(), mechanism.inertia.copy()
    mass[-1], com[-1], inertia[-1] = last
    return replace(mechanism, mass=mass, com=com, inertia=inertia)

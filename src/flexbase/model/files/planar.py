"""Planar links written in the project file -> a mechanism. z is out of the plane, each link along its own x axis."""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array
from flexbase.errors import InputError
from flexbase.model.files.schema import LinkTable
from flexbase.model.mechanism import Mechanism


def planar(links: list[LinkTable], source: str) -> Mechanism:
    """The chain of links, base first. Raises InputError; `source` names the file."""
    names = [link.joint for link in links]
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        raise InputError(f'{source}, [[robot.links]] joint: the name "{repeated[0]}" is given twice. Rename one.')
    axes = np.array([_axis(link, number, source) for number, link in enumerate(links, start=1)])
    lengths = [link.length for link in links]
    return Mechanism(
        joint_names=tuple(names),
        joint_types=tuple(link.type for link in links),
        axes=axes,
        placement_rotation=np.tile(np.eye(3), (len(links), 1, 1)),
        placement_position=_along_x([0.0, *lengths[:-1]]),
        mass=np.array([link.mass for link in links]),
        com=_along_x([link.com for link in links]),
        inertia=np.array([np.diag([0.0, 0.0, link.inertia]) for link in links]),
        tool_rotation=np.eye(3),
        tool_position=_along_x([lengths[-1]])[0],
    )


def _axis(link: LinkTable, number: int, source: str) -> Array:
    if link.type == "revolute":
        if "axis" in link.model_fields_set:
            raise InputError(
                f"{source}, [[robot.links]] number {number}, axis: planar revolute joints turn about z. Remove the key."
            )
        return np.array([0.0, 0.0, 1.0])
    place = f"{source}, [[robot.links]] number {number}, axis:"
    axis = np.array(link.axis, dtype=float)
    if axis.shape != (2,):
        raise InputError(f"{place} {link.axis} given, 2 numbers needed: x and y.")
    length = float(np.hypot(*axis))
    if length == 0.0:
        raise InputError(f"{place} [0, 0] has no direction. Give a nonzero direction.")
    return np.array([axis[0] / length, axis[1] / length, 0.0])


def _along_x(distances: list[float]) -> Array:
    return np.array([[distance, 0.0, 0.0] for distance in distances])

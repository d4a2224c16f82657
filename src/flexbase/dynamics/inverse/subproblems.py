"""Angles about fixed axes that meet one geometric condition: what closed-form inverse kinematics is made of.

Vectors are arrays of shape (..., 3), axes are unit vectors; leading axes broadcast. Where a condition has two solutions
they come along a new leading axis of length 2. Paden and Kahan's subproblems in the form of [E25].
"""

from __future__ import annotations

import numpy as np

from flexbase.checks import Array


def dot(u: Array, v: Array) -> Array:
    """Inner product along the last axis."""
    return np.asarray((u * v).sum(axis=-1))


def across(axis: Array, v: Array) -> Array:
    """The part of v that is perpendicular to a unit axis."""
    return np.asarray(v - dot(axis, v)[..., None] * axis)


def turned(axis: Array, angle: Array, v: Array) -> Array:
    """Vectors turned about a unit axis by angles [rad]."""
    c, s = np.cos(angle)[..., None], np.sin(angle)[..., None]
    return np.asarray(c * v + s * np.cross(axis, v) + (1.0 - c) * dot(axis, v)[..., None] * axis)


def angle_between(axis: Array, u: Array, v: Array) -> Array:
    """The angle about `axis` that brings u nearest to v [rad]; zero where u or v lies along the axis."""
    return np.arctan2(dot(axis, np.cross(u, v)), dot(across(axis, u), v))


def angles_to_height(axis: Array, along: Array, v: Array, height: Array) -> tuple[Array, Array]:
    """Two angles about `axis` after which v has the component `height` along a vector, and by how much they miss.

    The miss is the excess over 1 of the cosine that is asked for: 0 where there are two solutions, positive where
    there are none; the angles there come nearest.
    """
    level = dot(along, axis) * dot(axis, v)
    c, s = dot(along, v) - level, dot(along, np.cross(axis, v))
    size, wanted = np.hypot(c, s), height - level
    cosine = wanted / np.where(size > 0.0, size, 1.0)
    middle, half = np.arctan2(s, c), np.arccos(np.clip(cosine, -1.0, 1.0))
    return np.stack([middle - half, middle + half]), np.maximum(np.abs(cosine) - 1.0, 0.0)


def angles_to_length(axis: Array, u: Array, v: Array, length: Array) -> tuple[Array, Array]:
    """Two angles about `axis` after which u plus the turned v has a length, and by how much they miss, as above."""
    return angles_to_height(axis, u, v, 0.5 * (length**2 - dot(u, u) - dot(v, v)))

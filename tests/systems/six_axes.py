"""Arms of six joints from axes and points at zero joint angles, and the textbook inverse kinematics of the UR5e."""

from __future__ import annotations

import itertools

import numpy as np

from flexbase.model.base import make_base
from flexbase.model.mechanism import Mechanism
from flexbase.model.mounted import MountedArm
from flexbase.model.task import ROWS, Task
from flexbase.plant import Plant
from systems.six_joint import TWIST, A, D

X, Y, Z = np.eye(3)
TOOL = np.array([0.05, 0.02, 0.1])  # from the last point

# axes and points at zero joint angles
ARMS = {
    "UR-like": (
        [Z, Y, Y, Y, -Z, Y],
        [(0, 0, 0), (0, 0.1, 0.2), (0.4, 0, 0.2), (0.8, 0, 0.2), (0.8, 0.1, 0.1), (0.8, 0.2, 0.1)],
    ),
    "UR-like, axis 3 reversed": (
        [Z, Y, -Y, Y, -Z, Y],
        [(0, 0, 0), (0, 0.1, 0.2), (0.4, 0, 0.25), (0.8, 0, 0.2), (0.8, 0.1, 0.1), (0.8, 0.2, 0.1)],
    ),
    "industrial": (
        [Z, Y, Y, X, Y, X],
        [(0, 0, 0), (0.15, 0, 0.4), (0.15, 0, 1.0), (0.2, 0, 1.1), (0.9, 0, 1.1), (0.9, 0, 1.1)],
    ),
    "offset shoulder": (
        [Z, -Y, -Y, Z, Y, Z],
        [(0, 0, 0), (0.0, 0.15, 0.3), (0.43, 0.15, 0.3), (0.45, 0, 0.3), (0.45, 0, 0.73), (0.45, 0, 0.73)],
    ),
    "axes 1 and 2 meet": (
        [Z, Y, (np.array([0.3, 1.0, 0.2])) / np.linalg.norm([0.3, 1.0, 0.2]), X, Y, X],
        [(0, 0, 0.3), (0, 0, 0.3), (0.1, 0.05, 0.8), (0.2, 0.1, 0.9), (0.7, 0.1, 0.9), (0.9, 0.1, 0.9)],
    ),
}


def six_axes(axes: list, points: list, rows: tuple[str, ...] = ROWS) -> Plant:
    """The arm on a base that slides along x, without gravity; unit masses of unit inertia."""
    corners = np.array([(0.0, 0.0, 0.0), *points], dtype=float)
    steps = np.vstack([np.zeros(3), np.diff(corners, axis=0)])
    mechanism = Mechanism(
        ("slide", *(f"q{i}" for i in range(1, 7))),
        ("prismatic", *("revolute",) * 6),
        np.array([X, *axes]),
        np.tile(np.eye(3), (7, 1, 1)),
        steps,
        np.ones(7),
        np.zeros((7, 3)),
        np.tile(np.eye(3), (7, 1, 1)),
        np.eye(3),
        TOOL,
    )
    return Plant(MountedArm("six axes", mechanism, make_base([1e5], [10.0], [0.0], 1), Task(rows), np.zeros(3)))


def crooked(axes: list, points: list, size: float) -> tuple[list, list]:
    """The same arm with axes and points off by `size` [rad, m], as calibration finds them."""
    rng = np.random.default_rng(7)
    turned = [np.array(axis) + size * rng.normal(size=3) for axis in axes]
    return [axis / np.linalg.norm(axis) for axis in turned], [np.array(p) + size * rng.normal(size=3) for p in points]


def link(i: int, angle: float) -> np.ndarray:
    """Homogeneous transformation of link i of the UR5e, standard Denavit-Hartenberg."""
    c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(TWIST[i]), np.sin(TWIST[i])
    return np.array([[c, -s * ca, s * sa, A[i] * c], [s, c * ca, -c * sa, A[i] * s], [0, sa, ca, D[i]], [0, 0, 0, 1.0]])


def chain(angles: np.ndarray) -> np.ndarray:
    """The last frame of the UR5e in its first."""
    return np.linalg.multi_dot([link(i, angle) for i, angle in enumerate(angles)])


def textbook(T: np.ndarray) -> list[np.ndarray]:
    """All joints of the UR5e that put its last frame at T, away from singular poses.

    K. P. Hawkins, "Analytic inverse kinematics for the Universal Robots UR-5/UR-10 arms" (Georgia Tech, 2013).
    """
    found, inverse = [], np.linalg.inv(T)
    wrist = T @ [0.0, 0.0, -D[5], 1.0]
    for pan, bend, flip in itertools.product((1, -1), repeat=3):
        q1 = np.arctan2(wrist[1], wrist[0]) + pan * np.arccos(D[3] / np.hypot(*wrist[:2])) + np.pi / 2
        s, c = np.sin(q1), np.cos(q1)
        q5 = flip * np.arccos((T[0, 3] * s - T[1, 3] * c - D[3]) / D[5])
        side = np.sign(np.sin(q5))
        q6 = np.arctan2(side * (-inverse[1, 0] * s + inverse[1, 1] * c), side * (inverse[0, 0] * s - inverse[0, 1] * c))
        arm = np.linalg.inv(link(0, q1)) @ T @ np.linalg.inv(link(4, q5) @ link(5, q6))
        x, y = arm[:2, 3]
        cosine = (x * x + y * y - A[1] ** 2 - A[2] ** 2) / (2.0 * A[1] * A[2])
        if abs(cosine) > 1.0:
            continue
        q3 = bend * np.arccos(cosine)
        q2 = np.arctan2(y, x) - np.arctan2(A[2] * np.sin(q3), A[1] + A[2] * np.cos(q3))
        last = np.linalg.inv(link(1, q2) @ link(2, q3)) @ arm
        found.append(np.array([q1, q2, q3, np.arctan2(last[1, 0], last[0, 0]), q5, q6]))
    return found

"""A UR5e-like arm, numbers typed in, on bases of one to three joints: no robot file needed.

Kinematics, masses and centres of mass: Universal Robots, "DH Parameters for calculations of kinematics and dynamics",
UR5e (standard Denavit-Hartenberg). Inertias: solid cylinders of the links' size, about their centres, an assumption.
"""

from __future__ import annotations

import numpy as np

from flexbase.errors import FlexbaseError
from flexbase.model.base import make_base
from flexbase.model.mechanism import Mechanism
from flexbase.model.mounted import MountedArm
from flexbase.model.task import ROWS, Task, make_gains
from flexbase.plant import Plant, Pose

A = (0.0, -0.425, -0.3922, 0.0, 0.0, 0.0)
D = (0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996)
TWIST = (np.pi / 2, 0.0, 0.0, np.pi / 2, -np.pi / 2, 0.0)
MASS = (3.761, 8.058, 2.846, 1.37, 1.3, 0.365)
COM = (
    (0.0, -0.02561, 0.00193),
    (0.2125, 0.0, 0.11336),
    (0.15, 0.0, 0.0265),
    (0.0, -0.0018, 0.01634),
    (0.0, 0.0018, 0.01634),
    (0.0, 0.0, -0.001159),
)
CYLINDER = ((0.06, 0.15, 2), (0.055, 0.425, 0), (0.045, 0.392, 0), (0.04, 0.11, 1), (0.04, 0.11, 1), (0.035, 0.05, 2))
AXES = {"p": "prismatic", "r": "revolute"}
PEDESTAL = 40.0  # kg, carried by the base, with the inertia of a 0.6 m cube


def _cylinder(mass: float, radius: float, length: float, along: int) -> np.ndarray:
    across = mass * (3.0 * radius**2 + length**2) / 12.0
    inertia = np.full(3, across)
    inertia[along] = 0.5 * mass * radius**2
    return np.diag(inertia)


def six_joint(base: tuple[str, ...], k: int, *, damping: float = 0.02, proportional: bool = True) -> Plant:
    """The arm 0.6 m above base joints such as "px" or "rz" (slide along or turn about world axes).

    damping : ratio of each base joint by itself, proportional to stiffness or (else) uneven, 1 to 3 times the ratio
    """
    m = len(base)
    eye = np.eye(3)
    placements, mass, com, inertia = [(eye, np.zeros(3))] * m, [0.0] * m, [np.zeros(3)] * m, [np.zeros((3, 3))] * m
    mass[-1], com[-1] = PEDESTAL, np.array([0.0, 0.0, 0.3])
    inertia[-1] = PEDESTAL * 0.6**2 / 6.0 * eye
    rotation, position = eye, np.array([0.0, 0.0, 0.6])
    for i in range(6):
        placements.append((rotation, position))
        c, s = np.cos(TWIST[i]), np.sin(TWIST[i])
        rotation, position = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]), np.array([A[i], 0.0, D[i]])
        mass.append(MASS[i])
        com.append(position + rotation @ np.array(COM[i]))
        inertia.append(rotation @ _cylinder(MASS[i], *CYLINDER[i]) @ rotation.T)
    axes = [eye["xyz".index(name[1])] for name in base] + [eye[2]] * 6
    mechanism = Mechanism(
        joint_names=(*base, *(f"q{i + 1}" for i in range(6))),
        joint_types=(*(AXES[name[0]] for name in base), *["revolute"] * 6),
        axes=np.array(axes),
        placement_rotation=np.array([part for part, _ in placements]),
        placement_position=np.array([part for _, part in placements]),
        mass=np.array(mass),
        com=np.array(com),
        inertia=np.array(inertia),
        tool_rotation=rotation,
        tool_position=position,
    )
    stiffness = np.array([{"p": 4.0e5, "r": 1.0e5}[name[0]] * (1.0 + 0.3 * i) for i, name in enumerate(base)])
    rates = 2.0 * damping * stiffness / 80.0 * (1.0 if proportional else np.linspace(1.0, 3.0, m))
    arm = MountedArm(
        f"six joints on {' '.join(base)}",
        mechanism,
        make_base(stiffness, rates, np.zeros(m), m),
        Task(ROWS[:k]),
        np.zeros(3),
        make_gains([2.0e4] * min(k, 3) + [1e3] * max(0, k - 3), [8e2] * min(k, 3) + [40.0] * max(0, k - 3), k),
    )
    return Plant(arm)


def random_poses(plant: Plant, count: int, seed: int = 0) -> list[Pose]:
    """Poses drawn over the whole joint range, without those within a twentieth of a singularity."""
    rng, poses = np.random.default_rng(seed), []
    while len(poses) < count:
        try:
            pose = plant.at(rng.uniform(-np.pi, np.pi, 6))
        except FlexbaseError:
            continue
        sizes = np.linalg.svd(pose.J[:, pose.arm.m :], compute_uv=False)
        if sizes[-1] > 0.02 * sizes[0]:
            poses.append(pose)
    return poses

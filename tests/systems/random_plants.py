"""Random arms on random bases, in three dimensions, reproducible from a seed."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from flexbase.errors import FlexbaseError
from flexbase.model.base import make_base
from flexbase.model.mechanism import Body, Mechanism, with_payload
from flexbase.model.mounted import MountedArm
from flexbase.model.task import ROWS, Task, make_gains
from flexbase.plant import Plant, Pose

DAMPINGS = ("zero", "proportional", "full", "overdamped")


def random_inertia(rng: np.random.Generator, size: float = 0.1) -> np.ndarray:
    """A physical inertia (triangle inequality holds): that of a random cloud of points."""
    second = (points := rng.normal(scale=size, size=(6, 3))).T @ points
    return np.trace(second) * np.eye(3) - second


def random_mechanism(rng: np.random.Generator, N: int, *, prismatic: float = 0.3, payload: bool = True) -> Mechanism:
    """N joints about arbitrary axes at arbitrary placements; a share `prismatic` of them slides."""
    axes = rng.normal(size=(N, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    mechanism = Mechanism(
        joint_names=tuple(f"j{i}" for i in range(N)),
        joint_types=tuple("prismatic" if rng.random() < prismatic else "revolute" for _ in range(N)),
        axes=axes,
        placement_rotation=Rotation.from_rotvec(rng.normal(size=(N, 3))).as_matrix().reshape(N, 3, 3),
        placement_position=rng.uniform(-0.5, 0.5, (N, 3)),
        mass=rng.uniform(0.5, 5.0, N),
        com=rng.uniform(-0.3, 0.3, (N, 3)),
        inertia=np.array([random_inertia(rng) for _ in range(N)]),
        tool_rotation=Rotation.from_rotvec(rng.normal(size=3)).as_matrix(),
        tool_position=rng.uniform(-0.3, 0.3, 3),
    )
    if not payload:
        return mechanism
    return with_payload(mechanism, Body(rng.uniform(0.1, 2.0), rng.uniform(-0.2, 0.2, 3), random_inertia(rng, 0.05)))


def random_damping(rng: np.random.Generator, stiffness: np.ndarray, kind: str) -> np.ndarray:
    """Base damping that is zero, proportional to the stiffness, a full matrix, or a full one beyond critical."""
    m = len(stiffness)
    if kind == "zero":
        return np.zeros((m, m))
    if kind == "proportional":
        return rng.uniform(1e-4, 1e-3) * stiffness
    root = rng.normal(size=(m, m))
    full = root @ root.T + 0.1 * np.eye(m)
    size = np.sqrt(np.trace(stiffness) / np.trace(full))  # with an inertia near 1, this factor means zeta near a half
    return full * size * (rng.uniform(0.01, 0.08) if kind == "full" else 60.0)


def random_pose(
    seed: int,
    m: int,
    n: int,
    k: int,
    *,
    damping: str = "full",
    gravity: bool = False,
    prismatic: float = 0.2,
    gains: bool = True,
) -> Pose:
    """A well-conditioned pose of a random plant; always the same for the same arguments."""
    rng = np.random.default_rng([seed, m, n, k])
    for _ in range(200):
        mechanism = random_mechanism(rng, m + n, prismatic=prismatic)
        root = rng.normal(size=(m, m))
        stiffness = rng.uniform(3e3, 3e4) * (root @ root.T + 0.5 * np.eye(m))
        base = make_base(stiffness, random_damping(rng, stiffness, damping), 0.1 * rng.normal(size=m), m)
        rows = tuple(np.array(ROWS)[np.sort(rng.choice(6, k, replace=False))])
        arm = MountedArm(
            f"random {seed}",
            mechanism,
            base,
            Task(rows),
            rng.normal(scale=6.0, size=3) if gravity else np.zeros(3),
            make_gains(np.full(k, 2e3), np.full(k, 80.0), k) if gains else None,
        )
        try:
            pose = Plant(arm).at(rng.uniform(-1.5, 1.5, n))
        except FlexbaseError:
            continue  # singular, or its base does not hold the arm: draw again
        singular_values = np.linalg.svd(pose.J[:, m:], compute_uv=False)
        if singular_values[-1] > 0.05 * singular_values[0]:
            return pose
    raise AssertionError("no well-conditioned pose in 200 draws")

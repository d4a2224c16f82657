"""Random poses over a workspace, the same for the same seed."""

from __future__ import annotations

import numpy as np

from flexbase.cautions import collected
from flexbase.dynamics.inverse.two_joint_arm import two_joint_arm
from flexbase.errors import InputError, SingularArm, Unreachable
from flexbase.plant import Plant, Pose

RIM = 0.02  # of the reach: kept clear of the edges of a planar arm's ring, where it is singular
BENT = 2.2  # rad or m: joints of other arms are drawn within this, where they are neither folded nor stretched
TRIES = 50  # draws a pose


def random_poses(plant: Plant, count: int, seed: int = 0) -> list[Pose]:
    """Poses drawn without regard to any measure.

    Planar arms with two joints: tips uniform over the area of the reachable ring, default branch. Other arms: joints
    uniform within 2.2 rad (or m), singular ones drawn again. Raises InputError where too few are found.
    """
    if count < 1:
        raise InputError(f"poses: {count} given, at least 1 needed.")
    rng, arm = np.random.default_rng(seed), plant.arm
    planar = two_joint_arm(arm.mechanism, arm.task, arm.base.equilibrium)
    found: list[Pose] = []
    for _ in range(TRIES * count):
        try:
            with collected(quietly=True):
                if planar is None:
                    found.append(plant.at(rng.uniform(-BENT, BENT, arm.n)))
                else:
                    inner, outer = abs(planar.upper - planar.fore), planar.upper + planar.fore
                    edge = RIM * outer
                    radius = np.sqrt(rng.uniform((inner + edge) ** 2, (outer - edge) ** 2))
                    angle = rng.uniform(-np.pi, np.pi)
                    found.append(plant.at_tip(planar.shoulder + radius * np.array([np.cos(angle), np.sin(angle)])))
        except (SingularArm, Unreachable):
            continue
        if len(found) == count:
            return found
    raise InputError(f"poses: only {len(found)} of {count} could be drawn for {plant.name}. Ask for fewer.")

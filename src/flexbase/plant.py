"""What a user holds: a `Plant` (an arm on its base) and a `Pose` of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from flexbase.cautions import caution
from flexbase.checks import FARTHEST, Array, check_length, check_within, finite_array, is_definite
from flexbase.dynamics.inertia import arm_on_free_base, mass_matrix
from flexbase.dynamics.inverse.arm_angles import Solution, arm_angles, arm_solutions
from flexbase.dynamics.kinematics import Frames, forward, task_jacobian
from flexbase.dynamics.statics import gravity_stiffness, gravity_torques, static_base
from flexbase.dynamics.task import Target, target_of, task_error, task_value
from flexbase.errors import InputError, SingularArm, Unreachable
from flexbase.model.files.project import load_project
from flexbase.model.mechanism import Mechanism
from flexbase.model.mounted import MountedArm
from flexbase.model.parts import Blocks
from flexbase.model.task import check_branch
from flexbase.sheets.numbers import listed
from flexbase.sheets.sheet import Facts, facts
from flexbase.trace.algebra import unstack

SINGULAR = 1e-8  # smallest to largest singular value of Jv, below which the arm counts as singular
ON_TARGET = 1e-9  # m or rad: a tip nearer than this is there
ILL_CONDITIONED = 1e12  # condition number of M above which results lose most of their digits


@dataclass(frozen=True, eq=False)
class Plant:
    """An arm on a compliant base, ready to be asked. Made by `load`."""

    arm: MountedArm

    @property
    def name(self) -> str:
        """The project's name."""
        return self.arm.name

    def at(self, joints: ArrayLike) -> Pose:
        """The pose with these joints: the n arm joints, or all N, base first; the base values are then its equilibrium.

        Under gravity the base sags from its equilibrium. Raises InputError, SingularArm.
        """
        given = check_within("joints", np.atleast_1d(finite_array("joints", joints)), FARTHEST, "rad or m")
        n, N, parts = self.arm.n, self.arm.N, self.arm.parts
        if given.shape not in ((n,), (N,)):
            raise InputError(
                f"joints: {given.size} values given, {n} (the arm) or {N} (base first) needed: "
                f"{', '.join(self.arm.mechanism.joint_names)}."
            )
        if given.size == N:
            return self._pose(parts.arm(given), parts.base(given))
        return self._pose(given, self.arm.base.equilibrium)

    def at_tip(self, target: ArrayLike, branch: str | None = None, near: ArrayLike | None = None) -> Pose:
        """The pose whose resting tip is at a target, one value for each task row [m, rad].

        Of several solutions on the branch the nearest to `near` is taken. Without it: of a redundant arm the
        posture with the most isotropic Jv over its self-motion; of an arm with named branches the first that exists;
        else the one nearest to zero. Joint limits are not looked at. One or two rotation rows on an arm that
        turns freely ask for those components of the tool's rotation vector (`Pose.tip`) and leave the others open.

        branch : sign of the elbow, "+" or "-", or of shoulder, elbow and wrist, such as "+-+" (docs/notation.md); the
            project's own if left out
        near : n arm joints
        Raises Unreachable with the distance that is missing, SingularArm, InputError.
        """
        wanted = check_length("tip", target, self.arm.k, f"one for each task row, {' '.join(self.arm.task.rows)}")
        check_within("tip", wanted, FARTHEST, "rad or m")
        side = check_branch(branch or self.arm.task.branch)
        centre = None if near is None else check_length("near", near, self.arm.n, "one for each arm joint")
        base = self.arm.base.equilibrium
        for _ in range(60):  # without gravity the first pass is exact; with it, the sag contracts
            found, missing = arm_angles(self.arm.mechanism, self.arm.task, base, wanted, side, centre)
            if found is None:
                raise Unreachable(self._missed(wanted, side, base, missing))
            sagged = static_base(self.arm, found, self.arm.base.equilibrium)
            if np.allclose(sagged, base, rtol=0.0, atol=1e-15):
                return self._pose(found, self.arm.base.equilibrium)
            base, centre = sagged, found
        raise Unreachable(f"tip: the sag of {self.name} at {wanted.tolist()} does not converge. Give a stiffer base.")

    def solutions(self, target: ArrayLike) -> tuple[Solution, ...]:
        """All ways to rest with the tip at a target, one value for each task row [m, rad]: branch and arm joints.

        Assumes as many task rows as arm joints. Arms of six joints with named branches have up to eight, with different
        names; a pose of any of them is `at_tip(target, branch)`, or `at(joints)`. Under gravity the base sags for each.
        Empty where the target is out of reach. Singular ones are left out. Raises InputError for redundant arms.
        """
        wanted = check_length("tip", target, self.arm.k, f"one for each task row, {' '.join(self.arm.task.rows)}")
        found = []
        for one in arm_solutions(self.arm.mechanism, self.arm.task, self.arm.base.equilibrium, wanted):
            try:
                pose = self.at_tip(wanted, one.branch, near=one.joints)
            except (SingularArm, Unreachable):
                continue
            found.append(Solution(one.branch, pose.joints))
        return tuple(found)

    def _missed(self, wanted: Array, side: str, base: Array, missing: float) -> str:
        """Why no joints were found, and what to ask for instead."""
        said = f"tip: {wanted.tolist()} is out of reach of {self.name} on branch {side}"
        if missing > ON_TARGET:
            return f"{said}, by {missing:.4g} m (or rad). Give a nearer target or the other branch."
        if self.arm.n > self.arm.k:
            return f"{said}, though not on every branch. Give another branch."
        others = [one.branch for one in arm_solutions(self.arm.mechanism, self.arm.task, base, wanted)]
        return f"{said}, but reached on {', '.join(dict.fromkeys(others)) or 'others'}. Give one of them."

    def _pose(self, arm_joints: Array, equilibrium: Array) -> Pose:
        q = self.arm.parts.whole(static_base(self.arm, arm_joints, equilibrium), arm_joints)
        pose = Pose(self, q, np.asarray(equilibrium))
        _check_inertia(pose)
        _check_regular(pose)
        return pose


@dataclass(frozen=True, eq=False)
class Pose:
    """A plant at rest in one configuration.

    q : joint positions at rest, base first, shape (N,) [rad or m]
    equilibrium : where the base springs are at rest, shape (m,); differs from the base's joints only under gravity
    """

    plant: Plant
    q: Array
    equilibrium: Array

    @property
    def arm(self) -> MountedArm:
        """The arm on its base."""
        return self.plant.arm

    @property
    def where(self) -> Facts:
        """Joints and tip, as a sheet says them."""
        chain, task = self.arm.mechanism, self.arm.task
        return facts(
            ("joints", listed(self.q, chain.joint_names, chain.joint_units)),
            ("tip", listed(self.tip, task.rows, task.units)),
        )

    @cached_property
    def frames(self) -> Frames:
        """Bodies, joint motions and tool, in world axes."""
        return forward(self.arm.mechanism, tuple(self.q.tolist()))

    @cached_property
    def M(self) -> Array:
        """Inertia matrix, shape (N, N)."""
        return np.array(mass_matrix(self.frames))

    @cached_property
    def J(self) -> Array:
        """Task Jacobian [Jp, Jv], shape (k, N)."""
        return np.array(task_jacobian(self.frames, self.arm.task.indices))

    @cached_property
    def joints(self) -> Array:
        """Arm joints, shape (n,) [rad or m]."""
        return self.arm.parts.arm(self.q)

    @cached_property
    def sag(self) -> Array:
        """Base joints, away from the equilibrium of their springs, shape (m,) [rad or m]."""
        return self.arm.parts.base(self.q) - self.equilibrium

    @cached_property
    def _inertia(self) -> Blocks:
        return self.arm.parts.blocks(self.M)

    @property
    def Mpp(self) -> Array:
        """Inertia of the base with the arm held, shape (m, m)."""
        return np.asarray(self._inertia.passive)

    @property
    def Map(self) -> Array:
        """Coupling of arm (rows) and base, shape (n, m)."""
        return np.asarray(self._inertia.coupling)

    @property
    def Mhat(self) -> Array:
        """Inertia of the arm with the base held, shape (n, n)."""
        return np.asarray(self._inertia.active)

    @cached_property
    def Ms(self) -> Array:
        """Mhat - Map Mpp^-1 Mpa, inertia of the arm while the base yields, shape (n, n).  [theory §8]"""
        return np.array(arm_on_free_base(self.M.tolist(), self.arm.parts))

    @cached_property
    def Jp(self) -> Array:
        """How the base moves the tip, shape (k, m)."""
        return self.arm.parts.base(self.J)

    @cached_property
    def Jv(self) -> Array:
        """How the arm moves the tip, shape (k, n)."""
        return self.arm.parts.arm(self.J)

    @cached_property
    def K(self) -> Array:
        """Stiffness of base and gravity, shape (N, N)."""
        return np.asarray(gravity_stiffness(self.arm, self.q) + self.arm.parts.on_base(self.arm.base.stiffness))

    @cached_property
    def D(self) -> Array:
        """Damping of base and joint friction, shape (N, N)."""
        return np.asarray(np.diag(self.arm.mechanism.friction) + self.arm.parts.on_base(self.arm.base.damping))

    @cached_property
    def Kp(self) -> Array:
        """Stiffness of the base with the arm held, gravity's included, shape (m, m)."""
        return np.asarray(self.arm.parts.blocks(self.K).passive)

    @cached_property
    def Dp(self) -> Array:
        """Damping of the base with the arm held, shape (m, m)."""
        return np.asarray(self.arm.parts.blocks(self.D).passive)

    @cached_property
    def tip(self) -> Array:
        """Task coordinates of the tip, shape (k,)."""
        return task_value(self.frames, self.arm.task)

    @cached_property
    def target(self) -> Target:
        """The whole tool frame, against which errors are measured."""
        return target_of(self.frames)

    @cached_property
    def holding_torque(self) -> Array:
        """Arm torques that hold the pose against gravity, shape (n,)."""
        return self.arm.parts.arm(gravity_torques(self.arm, self.q))

    def tip_error(self, q: Array) -> Array:
        """Task error of other configurations, shape (..., N), against this pose, shape (..., k)."""
        frames = forward(self.arm.mechanism, unstack(q, 1))
        return task_error(frames, self.arm.task, self.target)


def check_pose(pose: object) -> None:
    """Raises InputError where something else stands for a pose."""
    if not isinstance(pose, Pose):
        raise InputError(f"pose: {type(pose).__name__} given. Make one with plant.at(joints) or plant.at_tip(target).")


def check_plant(plant: object) -> None:
    """Raises InputError where something else stands for a plant."""
    if not isinstance(plant, Plant):
        raise InputError(f"plant: {type(plant).__name__} given. Make one with flexbase.load(robot).")


def load(robot: str | Path) -> Plant:
    """Load a bundled robot by name, a project file, or a bare URDF or MJCF by path. Raises InputError, MissingExtra."""
    return Plant(load_project(robot, inertia_at))


def inertia_at(mechanism: Mechanism, q: Array) -> Array:
    """M of a mechanism at a configuration, shape (N, N)."""
    return np.array(mass_matrix(forward(mechanism, tuple(q.tolist()))))


def _check_inertia(pose: Pose) -> None:
    eigenvalues = np.linalg.eigvalsh(pose.M)
    if eigenvalues[0] <= np.finfo(float).eps * eigenvalues[-1] or not is_definite(pose.M):
        raise InputError(
            f"{pose.plant.name}: the inertia matrix at q = {np.round(pose.q, 4).tolist()} is not positive definite "
            f"(smallest eigenvalue {eigenvalues[0]:.3g}). Give the massless links a mass or an inertia."
        )
    if eigenvalues[-1] > ILL_CONDITIONED * eigenvalues[0]:
        caution(
            f"{pose.plant.name}: condition number of M is {eigenvalues[-1] / eigenvalues[0]:.2g}; "
            "expect few correct digits."
        )


def _check_regular(pose: Pose) -> None:
    singular_values = np.linalg.svd(pose.Jv, compute_uv=False)
    if singular_values[-1] <= SINGULAR * singular_values[0]:
        raise SingularArm(
            f"{pose.plant.name}: the arm is singular at q = {np.round(pose.q, 4).tolist()} (singular values of Jv "
            f"{singular_values[0]:.3g} to {singular_values[-1]:.3g}). Give a pose away from it."
        )

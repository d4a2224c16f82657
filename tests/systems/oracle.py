"""Independent witnesses: rigid-body quantities from Pinocchio, linear ones from the full state space.

Nothing here uses flexbase's dynamics or its reduced form; only the frozen numbers of a `Mechanism` are read.
"""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import scipy.linalg

from flexbase.model.mechanism import Mechanism
from flexbase.plant import Pose


class RigidBodies:
    """A Pinocchio model built joint by joint from a `Mechanism`."""

    def __init__(self, mechanism: Mechanism, gravity: np.ndarray | None = None) -> None:
        model = pin.Model()
        parent = 0
        for i, kind in enumerate(mechanism.joint_types):
            joint = {"revolute": pin.JointModelRevoluteUnaligned, "prismatic": pin.JointModelPrismaticUnaligned}[kind]
            placement = pin.SE3(mechanism.placement_rotation[i], mechanism.placement_position[i])
            parent = model.addJoint(parent, joint(mechanism.axes[i]), placement, mechanism.joint_names[i])
            body = pin.Inertia(float(mechanism.mass[i]), mechanism.com[i], mechanism.inertia[i])
            model.appendBodyToJoint(parent, body, pin.SE3.Identity())
        tool = pin.SE3(mechanism.tool_rotation, mechanism.tool_position)
        self.tool = model.addFrame(pin.Frame("tool", parent, 0, tool, pin.FrameType.OP_FRAME))
        model.gravity = pin.Motion(np.concatenate([np.zeros(3) if gravity is None else gravity, np.zeros(3)]))
        self.model, self.data = model, model.createData()

    def inertia(self, q: np.ndarray) -> np.ndarray:
        """M(q); Pinocchio fills the upper triangle."""
        upper = np.triu(pin.crba(self.model, self.data, q))
        return upper + np.triu(upper, 1).T

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        """6 x N, world axes at the tool."""
        return pin.computeFrameJacobian(self.model, self.data, q, self.tool, pin.LOCAL_WORLD_ALIGNED).copy()

    def tool_pose(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rotation and position of the tool."""
        pin.framesForwardKinematics(self.model, self.data, q)
        placement = self.data.oMf[self.tool]
        return placement.rotation.copy(), placement.translation.copy()

    def bias(self, q: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """h + g."""
        return pin.nonLinearEffects(self.model, self.data, q, rates).copy()

    def torques(self, q: np.ndarray, rates: np.ndarray, accelerations: np.ndarray) -> np.ndarray:
        """M q'' + h + g."""
        return pin.rnea(self.model, self.data, q, rates, accelerations).copy()

    def gravity(self, q: np.ndarray) -> np.ndarray:
        """g(q)."""
        return pin.computeGeneralizedGravity(self.model, self.data, q).copy()

    def gravity_slope(self, q: np.ndarray) -> np.ndarray:
        """dg/dq."""
        return pin.computeGeneralizedGravityDerivatives(self.model, self.data, q).copy()

    def energy(self, q: np.ndarray, rates: np.ndarray) -> float:
        """Kinetic and potential."""
        kinetic = pin.computeKineticEnergy(self.model, self.data, q, rates)
        return float(kinetic + pin.computePotentialEnergy(self.model, self.data, q))


def rigid_bodies(pose: Pose) -> RigidBodies:
    """The Pinocchio model of a pose's plant, with its gravity."""
    return RigidBodies(pose.arm.mechanism, pose.arm.gravity)


class FullSystem:
    """M q'' + D q' + K q = B f, y = C q about a pose under a gain E, from Pinocchio and the base's numbers."""

    def __init__(self, pose: Pose, E: np.ndarray | None = None) -> None:
        bodies, m = rigid_bodies(pose), pose.arm.m
        N = pose.arm.N
        self.m, self.N = m, N
        self.inertia = bodies.inertia(pose.q)
        self.E = np.zeros((N, N))
        if E is not None:
            self.E[m:, m:] = E
        self.M = self.inertia - self.E
        self.D, self.K = np.zeros((N, N)), bodies.gravity_slope(pose.q) if pose.arm.has_gravity else np.zeros((N, N))
        self.D[:m, :m] += pose.arm.base.damping
        self.K[:m, :m] += pose.arm.base.stiffness
        self.C = bodies.jacobian(pose.q)[list(pose.arm.task.indices)]
        self.B = np.vstack([np.zeros((m, pose.arm.k)), self.C[:, m:].T])

    def close(self, stiffness: np.ndarray, damping: np.ndarray) -> FullSystem:
        """Close f = -(stiffness y + damping y'), in place."""
        self.K = self.K + self.B @ stiffness @ self.C
        self.D = self.D + self.B @ damping @ self.C
        return self

    def response(self, s: complex) -> np.ndarray:
        """P(s)."""
        return self.C @ np.linalg.solve(self.M * s**2 + self.D * s + self.K, self.B.astype(complex))

    def poles(self) -> np.ndarray:
        """All 2N, from a companion form that multiplies by no inverse (generalised eigenvalues)."""
        zero, eye = np.zeros_like(self.M), np.eye(self.N)
        left = np.block([[zero, eye], [-self.K, -self.D]])
        right = np.block([[eye, zero], [zero, self.M]])
        return scipy.linalg.eigvals(left, right)

    def lagged_poles(self, lag: float) -> np.ndarray:
        """All 3N of (1 + lag s)(M0 s^2 + D s + K) = E s^2: the acceleration reaches E through a first-order lag.

        M0 is the inertia without E. Assembled as a cubic matrix polynomial, unlike the library's state equations.
        """
        N, eye = self.N, np.eye(self.N)
        zero = np.zeros((N, N))
        cubic, square = lag * self.inertia, self.inertia - self.E + lag * self.D
        linear, constant = self.D + lag * self.K, self.K
        left = np.block([[zero, eye, zero], [zero, zero, eye], [-constant, -linear, -square]])
        right = scipy.linalg.block_diag(eye, eye, cubic)
        return scipy.linalg.eigvals(left, right)

    def vibrations(self) -> np.ndarray:
        """The m poles with positive imaginary part that are not rigid, slowest first. Assumes an underdamped base.

        Rigid poles are double zeros, so rounding spreads them to about the root of the machine epsilon.
        """
        poles = self.poles()
        upper = poles[(poles.imag > 0.0) & (np.abs(poles) > 1e-4 * np.abs(poles).max())]
        return upper[np.argsort(np.abs(upper))]

    def residue_at(self, pole: complex) -> np.ndarray:
        """The residue of P at a simple pole, by Cauchy's integral: trapezoids on a circle converge geometrically."""
        others = self.poles()
        distance = np.sort(np.abs(others - pole))[1]
        angles = 2.0 * np.pi * (np.arange(96) + 0.5) / 96
        ring = 0.5 * distance * np.exp(1j * angles)
        return sum(self.response(pole + step) * step for step in ring) / len(ring)

    def mode_residue(self, pole: complex) -> np.ndarray:
        """R_i, the constant part of the numerator that a conjugate pair of poles makes together.  [U03 eq 7]"""
        return -2.0 * np.real(np.conj(pole) * self.residue_at(pole))

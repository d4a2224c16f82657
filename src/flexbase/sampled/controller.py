"""A controller as it runs: from sampled measurements to torque commands, linear, at one pose."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from flexbase.checks import Array
from flexbase.control.null_space import self_motion_damping
from flexbase.linear.discrete.system import Discrete, parallel, series, static
from flexbase.model.loop import Gain
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Pose
from flexbase.sheets.numbers import listed, matrix, number
from flexbase.sheets.sheet import Sheet, facts, make_sheet
from flexbase.sheets.told import Told

SELF_MOTION = 20.0  # rad/s of a redundant arm's self-motion: below the base, so that it hardly drives it


@dataclass(frozen=True, eq=False)
class SampledController(Told):
    """tau[k] from the measurements up to k, all of them deviations from the pose it was made for.

    system : inputs are tip error (k), joints (n) and accelerations (n); outputs are n torques
    E : the gain on accelerations inside it, shape (n, n), or None
    notes : what its maker reports, such as b_opt
    judged : what its maker found out about it, a `flexbase.sampled.judged.Judged`; not sent to other processes
    """

    name: str
    pose: Pose
    sensing: Sensing
    system: Discrete
    E: Array | None = None
    notes: dict[str, Any] = field(default_factory=dict)
    judged: object = field(default=None, repr=False)

    document: ClassVar = (
        *("name", "robot=pose.plant.name", "q=pose.q", "equilibrium=pose.equilibrium", "sensing", "step=system.step"),
        *("A=system.A", "B=system.B", "C=system.C", "D=system.D", "E", "notes"),
    )

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "judged": None}

    def sheet(self) -> Sheet:
        """Where it was made, for which loop, its size, and what its maker reports."""
        gain = None if self.E is None else ("E [kg m^2 or kg]", matrix(self.E))
        notes = [(name.replace("_", " "), _said(value)) for name, value in self.notes.items()]
        return make_sheet(
            self.pose.plant.name,
            f"controller, method {self.name}, at joints {listed(self.pose.q)}",
            facts(("loop", self.sensing.summary()), ("states", str(self.system.order)), gain, *notes),
        )


def _said(value: Any) -> str:
    """What a maker reports."""
    if isinstance(value, bool | str):
        return str(value).lower()
    return listed(value) if np.ndim(value) else number(value, 7)


def task_pd(pose: Pose, sensing: Sensing, gains: Gains) -> Discrete:
    """tau = -Jv^T (Kp e + Kv (e - e before)/h): what a sampled task-space PD does, shape (n, k + 2n)."""
    n, k = pose.arm.n, pose.arm.k
    every, Jv = sensing.task_every, pose.Jv
    back = every * sensing.step
    pull = -Jv.T
    proportional, rate = pull @ gains.stiffness, pull @ gains.damping / back
    size = k * every
    A = np.eye(size, k=-k)
    B = np.hstack([np.eye(size, k), np.zeros((size, 2 * n))])
    C = np.zeros((n, size))
    C[:, size - k :] = -rate
    D = np.hstack([proportional + rate, np.zeros((n, 2 * n))])
    return Discrete(A, B, C, D, sensing.step)


def joint_damping(pose: Pose, sensing: Sensing, damping: Array, stiffness: Array | None = None) -> Discrete:
    """tau = -stiffness dq - damping (q - q before)/h on the joints, both shape (n, n)."""
    n, k = pose.arm.n, pose.arm.k
    K = np.zeros((n, n)) if stiffness is None else stiffness
    to = np.hstack([np.zeros((n, k)), np.eye(n), np.zeros((n, n))])
    rate = damping / sensing.step
    return Discrete(np.zeros((n, n)), to, rate, -(K + rate) @ to, sensing.step)


def self_motion(pose: Pose, sensing: Sensing, E: Array | None) -> Discrete:
    """Null-space damping of a redundant arm, sampled. Assumes n > k."""
    stiffness, damping = self_motion_gains(pose, E)
    return joint_damping(pose, sensing, damping, stiffness)


def self_motion_gains(pose: Pose, E: Array | None) -> tuple[Array, Array]:
    """Stiffness and damping on the joints, both (n, n): blind to the base if they can be, else consistent.  [theory §7]

    Assumes n > k. Which of the two needs no word: whoever judges the loop judges it with this law inside.
    """
    law, _ = self_motion_damping(pose, None if E is None else Gain(E), frequency=SELF_MOTION)
    return law.W.T @ law.stiffness @ law.W, law.W.T @ law.damping @ law.W


def acceleration_feedback(pose: Pose, sensing: Sensing, E: Array) -> Discrete:
    """tau = E times the measured or estimated joint acceleration, as the sensing declares it."""
    n, k = pose.arm.n, pose.arm.k
    if sensing.acceleration == "accelerometer":
        return static(np.hstack([np.zeros((n, k + n)), E]), sensing.step)
    to = static(np.hstack([np.zeros((n, k)), np.eye(n), np.zeros((n, n))]), sensing.step)
    return series(series(to, acceleration_estimator(n, sensing)), static(E, sensing.step))


def acceleration_estimator(n: int, sensing: Sensing) -> Discrete:
    """Joint acceleration from encoders: filtered second differences, or a Kalman filter of constant acceleration."""
    one = _kalman(sensing) if sensing.acceleration == "kalman" else _differences(sensing)
    A, B, C, D = (np.asarray(np.kron(np.eye(n), part)) for part in (one.A, one.B, one.C, one.D))
    return Discrete(A, B, C, D, sensing.step)


def _differences(sensing: Sensing) -> Discrete:
    """(q - 2 q' + q'')/h^2 through a first-order low-pass, p = exp(-2 pi f h)."""
    h, p = sensing.step, float(np.exp(-2.0 * np.pi * sensing.acceleration_filter * sensing.step))
    A = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, p]])
    before = np.array([-2.0, 1.0, 0.0]) / h**2
    A[2] += (1.0 - p) * before
    B = np.array([[1.0], [0.0], [(1.0 - p) / h**2]])
    C = np.array([[0.0, 0.0, p]]) + (1.0 - p) * before
    return Discrete(A, B, C, np.array([[(1.0 - p) / h**2]]), h)


def _kalman(sensing: Sensing) -> Discrete:
    """Steady-state Kalman filter of a joint whose acceleration is a random walk.

    In continuous time, with densities of process over measurement noise of corner^6, it is a Butterworth filter of
    third order on the acceleration: -3 dB at the corner. Sampled, with jerk constant between samples, the same holds
    for corners well below the rate; the noise of a sampled measurement is its density over the step. Time is counted in
    samples, so that the Riccati equation is of order one.
    """
    from scipy.linalg import solve_discrete_are

    h = sensing.step
    F = np.array([[1.0, 1.0, 0.5], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]])
    G = np.array([[1.0 / 6.0], [0.5], [1.0]])
    H = np.array([[1.0, 0.0, 0.0]])
    process = (2.0 * np.pi * sensing.acceleration_filter * h) ** 6
    P = solve_discrete_are(F.T, H.T, process * G @ G.T, np.eye(1))
    gain = P @ H.T / (H @ P @ H.T + 1.0)
    A = (np.eye(3) - gain @ H) @ F
    C = np.array([[0.0, 0.0, 1.0]]) / h**2
    return Discrete(A, gain, C @ A, C @ gain, h)


def pd_with_gain(
    pose: Pose, sensing: Sensing, gains: Gains, E: Array | None, name: str, damping: Array | None = None
) -> SampledController:
    """Task PD, null-space damping of a redundant arm, acceleration feedback and joint damping, each where given."""
    parts = [task_pd(pose, sensing, gains)]
    if pose.arm.n > pose.arm.k:
        parts.append(self_motion(pose, sensing, E))
    if E is not None and np.any(E):
        parts.append(acceleration_feedback(pose, sensing, E))
    if damping is not None:
        parts.append(joint_damping(pose, sensing, damping))
    return SampledController(name, pose, sensing, parallel(*parts), E)

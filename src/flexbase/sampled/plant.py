"""The plant as a sampled controller meets it: torques held and late, sensors late, everything else exact."""

from __future__ import annotations

import numpy as np

from flexbase.linear.discrete.system import Discrete, delay, hold, series, side_by_side, static
from flexbase.linear.second_order import StateSpace
from flexbase.model.sensing import Sensing
from flexbase.plant import Pose


def sampled_plant(pose: Pose, sensing: Sensing) -> Discrete:
    """From torque commands (n) and forces at the tip (k) to what is measured, exact for torques held over a sample.

    Outputs: tip error (k), joints (n), accelerations (n); after these the true tip displacement (k), not late. Tip
    forces act on base and arm alike, held too.
    """
    N, n, k = pose.arm.N, pose.arm.n, pose.arm.k
    inverse = np.linalg.inv(pose.M)
    drives = pose.arm.parts.arm(np.eye(N))  # how torques act on the joints, and, transposed, how joints are read
    A = np.block([[np.zeros((N, N)), np.eye(N)], [-inverse @ pose.K, -inverse @ pose.D]])
    B = np.vstack([np.zeros((N, n + k)), inverse @ np.hstack([drives, pose.J.T])])
    speeds = [N + joint for joint in pose.arm.parts.active]  # of the arm joints in the state
    still = np.zeros((n, N))
    if sensing.acceleration == "accelerometer" and sensing.accelerometer_lag > 0.0:
        T = sensing.accelerometer_lag
        A = np.block([[A, np.zeros((2 * N, n))], [A[speeds] / T, -np.eye(n) / T]])
        B = np.vstack([B, B[speeds] / T])
        seen, direct = np.hstack([still, still, np.eye(n)]), np.zeros((n, n + k))
    else:
        seen, direct = A[speeds], B[speeds]
    extra = A.shape[0] - 2 * N
    position = np.hstack([np.vstack([pose.J, drives.T]), np.zeros((k + n, N + extra))])
    C = np.vstack([position, seen, position[:k]])
    D = np.vstack([np.zeros((k + n, n + k)), direct, np.zeros((k, n + k))])
    held = hold(StateSpace(A, B, C, D), sensing.step)
    late_torque = side_by_side(delay(n, sensing.compute_delay, sensing.step), static(np.eye(k), sensing.step))
    late_tip = side_by_side(delay(k, sensing.task_delay, sensing.step), static(np.eye(2 * n + k), sensing.step))
    return series(series(late_torque, held), late_tip)

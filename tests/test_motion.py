"""The equation of motion, written once: against Pinocchio's inertia and forces, on floats, batches and symbols."""

from __future__ import annotations

from dataclasses import replace

import casadi
import numpy as np
import pytest

from flexbase.dynamics.kinematics import forward
from flexbase.dynamics.motion import equation_of_motion, under_gain
from flexbase.trace.algebra import stack, unstack
from systems.oracle import rigid_bodies
from systems.random_plants import random_pose


@pytest.fixture(scope="module")
def pose():
    """Two base joints with full matrices, four arm joints, three task rows, gravity; every joint rubs."""
    found = random_pose(22, 2, 4, 3, gravity=True, prismatic=0.3)
    mechanism = replace(found.arm.mechanism, friction=np.linspace(0.3, 2.0, found.arm.N))
    return type(found.plant)(replace(found.arm, mechanism=mechanism)).at(found.q)


def states(pose, count):
    rng = np.random.default_rng(4)
    arm = pose.arm
    sizes = (arm.N, arm.N, arm.n, arm.m, arm.k)
    q, rates, torque, rest, tip_force = (rng.uniform(-1.0, 1.0, (count, size)) for size in sizes)
    return q, rates, torque, rest, 10.0 * tip_force


def floats(values):
    return tuple(values.tolist())


def equation(pose, q, rates, torque, rest, tip_force=()):
    frames = forward(pose.arm.mechanism, q)
    return equation_of_motion(pose.arm, frames, q, rates, torque, rest, tip_force=tip_force)


def test_inertia_and_force_are_pinocchios(pose):
    """M, and springs, dampers, friction, torque and the tip's push less h + g, to 1e-12 of the largest."""
    arm, bodies = pose.arm, rigid_bodies(pose)
    for q, rates, torque, rest, tip_force in zip(*states(pose, 5), strict=True):
        M, force = (np.array(part) for part in equation(pose, *map(floats, (q, rates, torque, rest, tip_force))))
        spring = arm.base.stiffness @ (rest - q[: arm.m]) - arm.base.damping @ rates[: arm.m]
        pushed = bodies.jacobian(q)[list(arm.task.indices)].T @ tip_force
        resisted = np.linspace(0.3, 2.0, arm.N) * rates + bodies.bias(q, rates)
        wanted = np.concatenate([spring, torque]) + pushed - resisted
        assert pytest.approx(bodies.inertia(q), rel=0.0, abs=1e-12 * np.abs(M).max()) == M
        assert force == pytest.approx(wanted, rel=0.0, abs=1e-12 * np.abs(wanted).max())


def test_batches_and_symbols_are_the_floats(pose):
    """One formula: a batch of states and a traced function give what single floats give, to rounding."""
    given = states(pose, 5)
    together = [stack(part) for part in equation(pose, *(unstack(part, 1) for part in given))]
    symbols = [casadi.SX.sym(f"x{i}", part.shape[1]) for i, part in enumerate(given)]
    M, force = equation(pose, *(tuple(one[i] for i in range(one.shape[0])) for one in symbols))
    entries = casadi.vertcat(*(entry for row in M for entry in row))
    traced = casadi.Function("f", symbols, [entries, casadi.vertcat(*force)])
    for i in range(5):
        alone = [np.array(part) for part in equation(pose, *(floats(part[i]) for part in given))]
        by_symbols = [np.array(part)[:, 0] for part in traced(*(part[i] for part in given))]
        for other in ([together[0][i].ravel(), together[1][i]], by_symbols):
            for ours, wanted in zip(other, (alone[0].ravel(), alone[1]), strict=True):
                assert ours == pytest.approx(wanted, rel=0.0, abs=1e-13 * np.abs(wanted).max())


def test_a_gain_takes_inertia_from_the_arm_alone(pose):
    """M - blkdiag(0, E): the base's rows and columns stay; a share of E takes as much less; no gain takes nothing."""
    arm, M = pose.arm, pose.M
    E = np.diag([0.1, 0.2, 0.3, 0.4]) + 0.01
    whole = np.zeros((arm.N, arm.N))
    whole[arm.m :, arm.m :] = E
    assert np.array(under_gain(arm, M.tolist(), E.tolist())) == pytest.approx(M - whole, abs=1e-15)
    assert np.array(under_gain(arm, M.tolist(), E.tolist(), 0.5)) == pytest.approx(M - 0.5 * whole, abs=1e-15)
    assert under_gain(arm, M.tolist(), None) == M.tolist()

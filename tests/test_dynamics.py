"""Kinematics and dynamics: against Pinocchio, finite differences, energy, and themselves on other number types."""

from __future__ import annotations

import casadi
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from flexbase.dynamics.forces import bias_forces, gravity_forces, inverse_dynamics
from flexbase.dynamics.inertia import mass_matrix
from flexbase.dynamics.kinematics import forward, jacobian
from flexbase.simulation.plants.builtin import accelerations
from flexbase.trace.algebra import stack, unstack
from systems.oracle import RigidBodies, rigid_bodies
from systems.random_plants import random_mechanism, random_pose

GRAVITY = (1.5, -3.0, -9.0)
SIZES = [2, 3, 4, 5, 6, 7]


def everything(mechanism, q, rates):
    """Inertia, Jacobian and bias of one configuration, on whatever numbers q and the rates are."""
    frames = forward(mechanism, q)
    return mass_matrix(frames), jacobian(frames), bias_forces(frames, rates, GRAVITY)


def numbers(mechanism, q, rates):
    """The same as arrays of floats."""
    return [np.array(part) for part in everything(mechanism, tuple(q.tolist()), tuple(rates.tolist()))]


def samples(seed, N, count):
    rng = np.random.default_rng([seed, N])
    return rng.uniform(-3.0, 3.0, (count, N)), rng.uniform(-2.0, 2.0, (count, N))


@pytest.mark.parametrize("prismatic", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("N", SIZES)
def test_agrees_with_pinocchio(N, prismatic):
    """M, J, the tool's place, h + g, g and M q'' + h + g of random 3-D chains with payload equal another program's.

    1e-10 of the largest entry is the project's promise; the two differ by some 1e-15.
    """
    for seed in range(6):
        mechanism = random_mechanism(np.random.default_rng([seed, N]), N, prismatic=prismatic)
        oracle = RigidBodies(mechanism, np.array(GRAVITY))
        for q, rates in zip(*samples(seed, N, 5), strict=True):
            M, J, bias = numbers(mechanism, q, rates)
            frames = forward(mechanism, tuple(q.tolist()))
            rotation, position = oracle.tool_pose(q)
            push = np.cos(np.arange(N) + q)
            pairs = [
                (M, oracle.inertia(q)),
                (J, oracle.jacobian(q)),
                (bias, oracle.bias(q, rates)),
                (np.array(gravity_forces(frames, GRAVITY)), oracle.gravity(q)),
                (
                    np.array(inverse_dynamics(frames, rates.tolist(), push.tolist(), GRAVITY)),
                    oracle.torques(q, rates, push),
                ),
                (np.array(frames.tool_rotation), rotation),
                (np.array(frames.tool_position), position),
            ]
            for ours, theirs in pairs:
                assert ours == pytest.approx(theirs, rel=0.0, abs=1e-10 * max(1.0, np.abs(theirs).max()))


@pytest.mark.parametrize("N", [2, 4, 7])
def test_inertia_is_symmetric_positive_definite(N):
    """M = M^T exactly (entries are shared) and its eigenvalues are positive, at random configurations."""
    mechanism = random_mechanism(np.random.default_rng(N), N)
    for q in samples(7, N, 20)[0]:
        M = np.array(mass_matrix(forward(mechanism, tuple(q.tolist()))))
        assert np.array_equal(M, M.T)
        assert np.linalg.eigvalsh(M)[0] > 0.0


@pytest.mark.parametrize("N", [2, 4, 7])
def test_jacobian_is_the_slope_of_the_kinematics(N):
    """Columns of J are central differences of the tool's position and orientation.

    Step 1e-6: truncation 1e-12 and rounding 1e-10 leave 1e-8 with room.
    """
    mechanism = random_mechanism(np.random.default_rng([1, N]), N)
    q, step = samples(2, N, 1)[0][0], 1e-6
    J = np.array(jacobian(forward(mechanism, tuple(q.tolist()))))
    for joint in range(N):
        ends = []
        for sign in (1.0, -1.0):
            moved = q.copy()
            moved[joint] += sign * step
            frames = forward(mechanism, tuple(moved.tolist()))
            ends.append((np.array(frames.tool_position), np.array(frames.tool_rotation)))
        (p1, R1), (p0, R0) = ends
        turn = (R1 - R0) / (2.0 * step) @ (0.5 * (R1 + R0)).T  # a skew matrix: the angular velocity
        slope = np.concatenate([(p1 - p0) / (2.0 * step), [turn[2, 1], turn[0, 2], turn[1, 0]]])
        assert J[:, joint] == pytest.approx(slope, abs=1e-8)


@pytest.mark.parametrize("N", [2, 3, 5])
def test_coriolis_forces_do_no_net_work(N):
    """q'^T (dM/dt q' - 2 h) = 0, the skew symmetry of M' - 2 C, with dM/dt exact by a complex step.

    Relative to the sizes of the two terms, rounding leaves 1e-12.
    """
    mechanism = random_mechanism(np.random.default_rng([3, N]), N)
    for q, rates in zip(*samples(4, N, 10), strict=True):
        moved = tuple((q + 1e-30j * rates).tolist())
        dM = np.imag(np.array(mass_matrix(forward(mechanism, moved)))) / 1e-30
        h = np.array(bias_forces(forward(mechanism, tuple(q.tolist())), tuple(rates.tolist())))
        kinetic, work = rates @ dM @ rates, 2.0 * rates @ h
        assert abs(work) > 1e-6  # a witness at rest would prove nothing
        assert kinetic == pytest.approx(work, rel=1e-10, abs=1e-12)


@pytest.mark.filterwarnings("ignore:\\ncasadi. a numpy function was called:FutureWarning")
@pytest.mark.parametrize("N", SIZES)
def test_every_number_type_gives_the_same(N):
    """Floats, NumPy rows, complex numbers and CasADi symbols run the same text and agree to 1e-13 of the result."""
    mechanism = random_mechanism(np.random.default_rng([5, N]), N)
    q, rates = samples(6, N, 8)
    each = [numbers(mechanism, *pair) for pair in zip(q, rates, strict=True)]
    reference = [np.array(parts) for parts in zip(*each, strict=True)]

    batch = everything(mechanism, unstack(q, 1), unstack(rates, 1))
    rows = [  # a matrix that no joint changes carries no batch axis
        np.broadcast_to(stack(part), wanted.shape) for part, wanted in zip(batch, reference, strict=True)
    ]
    as_complex = [
        np.array(
            [
                np.array(everything(mechanism, tuple(map(complex, a)), tuple(map(complex, b)))[part])
                for a, b in zip(q, rates, strict=True)
            ]
        )
        for part in range(3)
    ]
    x, v = casadi.SX.sym("q", N), casadi.SX.sym("v", N)
    M, J, h = everything(mechanism, tuple(x[i] for i in range(N)), tuple(v[i] for i in range(N)))
    traced = casadi.Function(
        "all",
        [x, v],
        [casadi.vertcat(*(casadi.horzcat(*row) for row in A)) for A in (M, J)] + [casadi.vertcat(*h)],
    )
    symbols = [
        np.array(parts).reshape(shape.shape)
        for parts, shape in zip(
            zip(*([np.array(part) for part in traced(a, b)] for a, b in zip(q, rates, strict=True)), strict=True),
            reference,
            strict=True,
        )
    ]
    for other in (rows, as_complex, symbols):
        for ours, wanted in zip(other, reference, strict=True):
            assert ours == pytest.approx(wanted, rel=0.0, abs=1e-13 * np.abs(wanted).max())


def fall(pose, end):
    """Free motion of the nonlinear plant from a moving start, no arm torque; also the work that the dampers take."""
    N, m = pose.arm.N, pose.arm.m
    rng = np.random.default_rng(8)

    def rate(_, x):
        q, rates = x[:N], x[N : 2 * N]
        frames = forward(pose.arm.mechanism, tuple(q.tolist()))
        q2 = accelerations(pose, frames, q, rates, np.zeros(N - m), None)
        return np.concatenate([rates, q2, [rates[:m] @ pose.arm.base.damping @ rates[:m]]])

    start = np.concatenate([pose.q, rng.uniform(-2.0, 2.0, N), [0.0]])
    states = solve_ivp(rate, (0.0, end), start, method="DOP853", rtol=1e-11, atol=1e-13).y.T
    bodies = rigid_bodies(pose)

    def energy(x):
        bend = x[:m] - pose.equilibrium
        return bodies.energy(x[:N], x[N : 2 * N]) + 0.5 * bend @ pose.arm.base.stiffness @ bend

    return np.array([energy(x) for x in states]), states[:, -1]


@pytest.mark.parametrize("gravity", [False, True])
@pytest.mark.parametrize("damping", ["zero", "full"])
def test_energy_balance(damping, gravity):
    """Kinetic, elastic and gravity energy fall by exactly what the base's dampers take, and by nothing without them.

    The energies come from Pinocchio; 1e-8 of the largest change allows for the integrator's 1e-11 a step.
    """
    pose = random_pose(3, 2, 3, 3, damping=damping, gravity=gravity)
    energies, dissipated = fall(pose, 0.3)
    if damping == "zero":
        assert not dissipated.any()
    else:
        assert dissipated[-1] > 0.1 * pose.arm.N  # joules: the dampers matter here
    scale = np.abs(energies).max()
    assert energies + dissipated == pytest.approx(np.full(len(energies), energies[0]), rel=0.0, abs=1e-8 * scale)

"""Many runs at once: fixed steps in machine code against DOP853, on floats and on Pinocchio's equations."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import flexbase as fb
from flexbase.control.joint_tracking import BANDWIDTH, JointTracking
from flexbase.control.task_pd import TaskPD
from flexbase.control.trajectories import LAWS, JointPath
from flexbase.dynamics.rotation_vector import rotation_vector
from flexbase.model.mechanism import Body, with_payload
from flexbase.model.task import make_gains
from flexbase.simulation.many.result import DIVERGED, INDEFINITE, OK
from flexbase.simulation.observed import observe
from flexbase.trace.algebra import matvec
from systems.oracle import RigidBodies
from systems.planar import planar

GOAL, NEAR = [0.33, -0.25], [0.33, -0.2]
CLOSE = 1e-8  # rad: 1e-8 of both integrators, by their own tolerances
FASTER = {"switch": 0.06, "end": 0.12, "interval": 1e-3}


def starts_near(plant, target, count):
    return plant.at_tip(target).q[plant.arm.m :] + np.random.default_rng(0).uniform(-0.1, 0.1, (count, plant.arm.n))


@pytest.fixture(scope="module")
def compensator(paper_pose):
    return fb.design(paper_pose, "exact", natural_frequency=346.8)


@pytest.mark.parametrize("trajectory", ["quintic", pytest.param("trapezoidal", marks=pytest.mark.slow)])
@pytest.mark.parametrize("compensate", [None, "settle", "always"])
def test_runs_are_those_of_simulate(paper, compensator, compensate, trajectory):
    """End, peak and settling time of the paper's arm, the last to a sample of the one and a step of the other."""
    starts, gain = starts_near(paper, NEAR, 9), compensator if compensate else None
    how = {"compensate": compensate or "settle", "trajectory": trajectory, "end": 0.2}
    runs = fb.simulate_many(paper, starts, GOAL, gain, move=fb.Moves(**how))
    assert runs.step_error <= CLOSE
    for i in (0, 8):  # a whole block of lanes, and its tail
        one = fb.simulate(paper, paper.at(starts[i]), GOAL, gain, move=fb.Move(interval=5e-4, **how))
        np.testing.assert_allclose(runs.q[i], one.q[-1], rtol=0.0, atol=CLOSE)
        np.testing.assert_allclose(runs.rates[i], one.rates[-1], rtol=0.0, atol=1e3 * CLOSE)  # modes of 350 rad/s
        np.testing.assert_allclose(runs.tip_error[i], one.tip_error[-1], rtol=0.0, atol=CLOSE)
        assert runs.peak_error_m[i] == pytest.approx(one.peak_error_m, abs=1e-6)  # of a millimetre, between samples
        assert runs.settled[i] == one.settled
        if one.settled:
            assert abs(runs.settling_time_s[i] - one.settling_time_s) <= 5e-4 + runs.step[1]


def test_the_check_can_fail(paper, compensator):
    """Without the compensator, or with longer steps, the same runs are far off by the measure used above."""
    starts = starts_near(paper, NEAR, 8)
    right = fb.simulate_many(paper, starts, GOAL, compensator)
    assert np.abs(fb.simulate_many(paper, starts, GOAL).q - right.q).max() > 1e3 * CLOSE
    coarse = fb.simulate_many(paper, starts, GOAL, move=fb.Moves(tolerance=1e-3))
    fine = fb.simulate_many(paper, starts, GOAL)
    assert coarse.step[1] >= fine.step[1]


@pytest.mark.parametrize("rows", [("x", "y", "rz"), ("rz", "x")])
def test_rotation_rows_gravity_and_redundant_arms(rows):
    """Three arm joints under gravity, with the tool's rotation in the task; of two rows, with null-space damping."""
    plant = planar([0.3, 0.4, 0.35, 0.2], rows=rows, gravity=(0.0, -9.81, 0.0))
    goal = plant.at([0.4, 0.9, -0.5])
    starts = goal.q[1:] + np.random.default_rng(1).uniform(-0.05, 0.05, (3, 3))
    runs = fb.simulate_many(plant, starts, goal, move=fb.Moves(switch=0.06, end=0.12))
    one = fb.simulate(plant, plant.at(starts[2]), goal, move=fb.Move(**FASTER))
    np.testing.assert_allclose(runs.q[2], one.q[-1], rtol=0.0, atol=CLOSE)
    assert runs.peak_error_m[2] == pytest.approx(one.peak_error_m, rel=1e-3)  # samples of 1 ms miss the very peak
    assert runs.peak_error_m[2] >= one.peak_error_m - CLOSE


def independent_end(plant, start, goal, truth, E, stiffness, damping):
    """q at the end by DOP853 on Pinocchio's M and bias of another mechanism than the one that the laws know."""
    arm, bodies = plant.arm, RigidBodies(truth)
    m, N, switch, end = arm.m, arm.N, FASTER["switch"], FASTER["end"]
    path = JointPath(start.tolist(), goal.q[m:].tolist(), switch, LAWS["quintic"])
    laws = ((JointTracking(goal, path, BANDWIDTH), None, 0.0, switch), (TaskPD(goal, arm.gains), E, switch, end))
    x = np.concatenate([goal.q[:m], start, np.zeros(N)])
    for law, gain, begin, finish in laws:

        def rate(t, x, law=law, gain=gain):
            q, v = x[:N], x[N:]
            _, seen = observe(goal, t, q, v)
            M = bodies.inertia(q)
            if gain is not None:
                M[m:, m:] -= gain
            spring = np.array(matvec(stiffness, goal.equilibrium - q[:m])) - np.array(matvec(damping, v[:m]))
            force = np.concatenate([spring, np.array(law.torque(seen), dtype=float)])
            return np.concatenate([v, np.linalg.solve(M, force - bodies.bias(q, v))])

        x = solve_ivp(rate, (begin, finish), x, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
    return x[:N]


@pytest.mark.parametrize(
    "changes",
    [{"stiffness": 0.6, "damping": 3.0}, {"payload": 1.5}, {"link_mass": 1.3}, {"compensation": 0.5}],
    ids=lambda one: next(iter(one)),
)
def test_varied_robots_against_pinocchio(paper, paper_pose, compensator, changes):
    """The robot differs, the laws do not know: Pinocchio's equations of the changed robot, our laws on the nominal."""
    arm, start = paper.arm, starts_near(paper, NEAR, 1)[0]
    truth = arm.mechanism
    if "payload" in changes:
        truth = with_payload(truth, Body(changes["payload"], np.zeros(3), np.zeros((3, 3))))
    if "link_mass" in changes:
        factor = np.array([1.0, changes["link_mass"], changes["link_mass"]])
        truth = replace(truth, mass=factor * truth.mass, inertia=factor[:, None, None] * truth.inertia)
    E = changes.get("compensation", 1.0) * compensator.E
    stiffness = changes.get("stiffness", 1.0) * arm.base.stiffness
    damping = changes.get("damping", 1.0) * arm.base.damping
    wanted = independent_end(paper, start, paper_pose, truth, E, stiffness, damping)
    names = list(changes)
    vary = {name: [changes[name], nominal(name)] for name in names}
    faster = fb.Moves(switch=FASTER["switch"], end=FASTER["end"])
    runs = fb.simulate_many(paper, start, paper_pose, compensator, vary=vary, move=faster)
    np.testing.assert_allclose(runs.q[0], wanted, rtol=0.0, atol=CLOSE)
    assert np.abs(runs.q[1] - wanted).max() > 30.0 * CLOSE  # the nominal robot goes elsewhere


def nominal(name):
    return 0.0 if name == "payload" else 1.0


def test_factors_on_gains_are_other_gains(paper, paper_pose, compensator):
    start = starts_near(paper, NEAR, 1)[0]
    other = make_gains(2.0 * paper.arm.gains.stiffness, 0.7 * paper.arm.gains.damping, 2)
    vary = {"task_stiffness": 2.0, "task_damping": 0.7}
    by_factors = fb.simulate_many(paper, start, paper_pose, compensator, vary=vary)
    by_gains = fb.simulate_many(paper, start, paper_pose, fb.Loop(compensator, other))
    np.testing.assert_allclose(by_factors.q, by_gains.q, rtol=0.0, atol=2.0 * CLOSE)


def test_bad_runs_have_a_status_and_spoil_no_neighbour(paper, paper_pose, compensator):
    """Forty times the compensator leaves no inertia; the runs in the lanes beside it are what they are alone."""
    start = starts_near(paper, NEAR, 1)[0]
    vary = {"compensation": [40.0, 1.0, 1.0]}
    runs = fb.simulate_many(paper, start, paper_pose, compensator, vary=vary)
    alone = fb.simulate_many(paper, start, paper_pose, compensator)
    assert runs.status.tolist() == [INDEFINITE, OK, OK]
    assert np.isnan(runs.peak_error_m[0])
    assert np.isnan(runs.settling_time_s[0])
    np.testing.assert_allclose(runs.q[1], alone.q[0], rtol=0.0, atol=CLOSE)
    assert re.search(r"M - E not positive definite +1$", runs.summary(), re.MULTILINE)
    assert runs.to_dict()["peak_error_m"][0] is None


def test_runs_that_run_away_are_said_to_diverge(paper, paper_pose):
    """Damping taken away and a million times the stiffness: more than 1000 rad/s. The neighbour's step is no excuse."""
    start = starts_near(paper, NEAR, 1)[0]
    vary = {"task_stiffness": [1.0, 1e8], "task_damping": [1.0, 0.0]}
    runs = fb.simulate_many(paper, start, paper_pose, vary=vary, move=fb.Moves(end=0.15))
    assert runs.status.tolist() == [OK, DIVERGED]
    assert runs.step_error <= CLOSE
    alone = fb.simulate_many(paper, start, paper_pose, move=fb.Moves(end=0.15))
    np.testing.assert_allclose(runs.q[0], alone.q[0], rtol=0.0, atol=2.0 * CLOSE)


@pytest.mark.slow
def test_a_step_that_is_too_long_is_not_taken_for_divergence(paper, paper_pose):
    """Forty times the damping makes poles forty times as fast as those that the first step is chosen by."""
    start = starts_near(paper, NEAR, 1)[0]
    runs = fb.simulate_many(paper, start, paper_pose, vary={"task_damping": [1.0, 40.0]}, move=fb.Moves(end=0.15))
    assert runs.status.tolist() == [OK, OK]
    gains = make_gains(paper.arm.gains.stiffness, 40.0 * paper.arm.gains.damping, 2)
    one = fb.simulate(paper, paper.at(start), paper_pose, fb.Loop(gains=gains), move=fb.Move(end=0.15, interval=1e-3))
    np.testing.assert_allclose(runs.q[1], one.q[-1], rtol=0.0, atol=CLOSE)


def test_inputs_are_refused_by_name(paper):
    start = [0.5, 0.9]
    with pytest.raises(fb.InputError, match=r"starts: shape \(3,\); 2 arm joints"):
        fb.simulate_many(paper, [0.1, 0.2, 0.3], GOAL)
    with pytest.raises(fb.InputError, match=r'"stifness" is unknown.*stiffness'):
        fb.simulate_many(paper, start, GOAL, vary={"stifness": 1.0})
    with pytest.raises(fb.InputError, match=r"payload: -1 kg is below 0"):
        fb.simulate_many(paper, start, GOAL, vary={"payload": -1.0})
    with pytest.raises(fb.InputError, match=r"runs: 2 of starts, 3 of payload"):
        fb.simulate_many(paper, [start, start], GOAL, vary={"payload": [0.0, 1.0, 2.0]})
    with pytest.raises(fb.InputError, match=r"times: switch \(0.5 s\)"):
        fb.simulate_many(paper, start, GOAL, move=fb.Moves(switch=0.5, end=0.2))
    with pytest.raises(fb.InputError, match="threads: 0 is none"):
        fb.simulate_many(paper, start, GOAL, move=fb.Moves(threads=0))


def test_rotation_vectors_are_scipys():
    """Over all rotations but those near half a turn; exactly zero where there is none."""
    vectors = np.random.default_rng(2).normal(size=(500, 3))
    vectors *= np.random.default_rng(3).uniform(0.0, 3.0, (500, 1)) / np.linalg.norm(vectors, axis=1, keepdims=True)
    for vector in (*vectors, np.full(3, 1e-9)):
        matrix = Rotation.from_rotvec(vector).as_matrix().tolist()
        np.testing.assert_allclose(rotation_vector(matrix), vector, rtol=1e-12, atol=2e-14)
    assert rotation_vector(np.eye(3).tolist()) == (0.0, 0.0, 0.0)

"""The nonlinear run: the paper's Fig. 9, its torques, what its control laws see, and how it ends.  [U03 §IV B]"""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import scipy.linalg

import flexbase
from flexbase import InputError
from flexbase.control.joint_tracking import JointTracking
from flexbase.control.measured import Measured
from flexbase.control.task_pd import TaskPD
from flexbase.control.trajectories import LAWS, JointPath
from flexbase.model.loop import Gain, Loop
from flexbase.model.task import Gains, make_gains
from flexbase.simulation import Move, Run
from flexbase.simulation.observed import observe
from flexbase.simulation.settling import SETTLED
from systems.oracle import FullSystem, rigid_bodies
from systems.planar import planar, sliding_pair

START, GOAL = [0.33, 0.25], [0.33, -0.25]
NEAR = [0.33, -0.2]  # near enough that the goal's gain keeps M - E > 0 on the way


@pytest.fixture(scope="module")
def compensator(paper_pose):
    return flexbase.design(paper_pose, "exact", natural_frequency=346.8)


@pytest.fixture(scope="module")
def without(paper):
    return flexbase.simulate(paper, START, GOAL)


@pytest.fixture(scope="module")
def compensated(paper, compensator):
    return flexbase.simulate(paper, START, GOAL, compensator)


@pytest.fixture(scope="module")
def trapezoid(paper, compensator):
    return flexbase.simulate(
        paper,
        NEAR,
        GOAL,
        compensator,
        move=Move(trajectory="trapezoidal", compensate="always", switch=0.12, end=0.3),
    )


def test_without_compensator_the_tip_never_settles(without):
    """The oscillation is still far above 0.1 mm at the end: no settling time.  [U03 Fig. 9a]"""
    assert without.stopped is None
    assert not without.settled
    assert without.settling_time_s is None
    assert without.error_size[-len(without.t) // 10 :].max() > 2.0 * SETTLED
    assert not without.compensated


def test_with_compensator_it_settles_within_a_tenth_of_a_second(compensated):
    """Below 0.1 mm within 0.1 s of switching, and staying there.  [U03 Fig. 9b]"""
    assert compensated.settled
    assert compensated.settling_time_s < 0.1
    late = compensated.t >= compensated.switch + compensated.settling_time_s
    assert compensated.error_size[late].max() < SETTLED
    assert compensated.compensated


def test_run_starts_and_ends_at_rest_where_it_was_told(paper, compensated):
    """The first sample is the start pose, the times run evenly to the end, and the settled end is the goal."""
    start, goal = paper.at_tip(START), paper.at_tip(GOAL)
    assert np.array_equal(compensated.q[0], start.q)
    assert not compensated.rates[0].any()
    assert compensated.t[0] == 0.0
    assert compensated.t[-1] == pytest.approx(0.4, rel=1e-14)
    assert np.diff(compensated.t) == pytest.approx(np.full(len(compensated.t) - 1, 2e-4), rel=1e-9)
    assert compensated.q[-1] == pytest.approx(goal.q, abs=1e-3)


def test_tip_error_is_that_of_the_recorded_joints(paper, compensated):
    """r(q) - r(goal) by Pinocchio at every tenth sample, to 1e-12 m."""
    bodies, goal = rigid_bodies(paper.at_tip(GOAL)), np.array(GOAL)
    for i in range(0, len(compensated.t), 10):
        assert compensated.tip_error[i] == pytest.approx(bodies.tool_pose(compensated.q[i])[1][:2] - goal, abs=1e-12)


@pytest.mark.parametrize("which", ["without", "compensated"])
def test_reported_torque_drives_the_recorded_motion(paper_pose, compensator, which, request):
    """M q'' + h = [tau_p; tau] by Pinocchio gives q'' from the reported torque; then tau - E q_a'' is the law's torque.

    Both hold at every sample to rounding, so E q_a'' is solved implicitly and exactly; q'' is also the slope of the
    recorded rates, by five-point differences (whose own error at 350 rad/s and 0.2 ms is 1e-5).
    """
    run = request.getfixturevalue(which)
    E = compensator.E if which == "compensated" else np.zeros((2, 2))
    bodies, gains = rigid_bodies(paper_pose), paper_pose.arm.gains
    settling = np.flatnonzero(run.settling)
    accelerations = []
    for i in settling:
        q, rates = run.q[i], run.rates[i]
        spring = 3e4 * (0.0 - q[0]) - 10.0 * rates[0]
        force = np.concatenate([[spring], run.torque[i]]) - bodies.bias(q, rates)
        q2 = np.linalg.solve(bodies.inertia(q), force)
        accelerations.append(q2)
        seen = q.copy()
        seen[0] = 0.0  # the law's Jacobian stands on the undeflected base
        Jv = bodies.jacobian(seen)[:2, 1:].copy()
        tip_rate = bodies.jacobian(q)[:2] @ rates
        law = -Jv.T @ (gains.stiffness @ run.tip_error[i] + gains.damping @ tip_rate)
        assert run.torque[i] - E @ q2[1:] == pytest.approx(law, rel=0.0, abs=1e-8 * (1.0 + np.abs(run.torque).max()))
    q2, v, h = np.array(accelerations), run.rates[settling], 2e-4
    slope = (8.0 * (v[3:-1] - v[1:-3]) - (v[4:] - v[:-4])) / (12.0 * h)
    assert slope == pytest.approx(q2[2:-2], rel=0.0, abs=1e-3 * np.abs(q2).max())


def test_tail_decays_as_the_linear_model_says(paper_pose, compensator, compensated):
    """From 40 ms after switching on, the nonlinear run follows expm(A t) of the linear loop, to 1 % of its size.

    The state there is some 1e-3 rad, and the nonlinear terms are that fraction of the linear ones. The control: the
    linear model without E is more than ten times that far off.
    """
    gains = paper_pose.arm.gains
    first = int(np.searchsorted(compensated.t, compensated.switch + 0.04))
    state = np.concatenate([compensated.q[first] - paper_pose.q, compensated.rates[first]])
    samples = range(first, min(first + 400, len(compensated.t)), 8)
    measured = np.array([compensated.tip_error[i] for i in samples])

    def predicted(E):
        loop = FullSystem(paper_pose, E).close(gains.stiffness, gains.damping)
        lower = np.linalg.solve(loop.M, np.hstack([-loop.K, -loop.D]))
        A = np.vstack([np.hstack([np.zeros((3, 3)), np.eye(3)]), lower])
        return np.array(
            [loop.C @ (scipy.linalg.expm(A * (compensated.t[i] - compensated.t[first])) @ state)[:3] for i in samples]
        )

    size = np.abs(measured).max()
    assert size > 1e-7  # metres: still well above the integrator's 1e-10
    assert np.abs(predicted(compensator.E) - measured).max() < 0.01 * size
    assert np.abs(predicted(np.zeros((2, 2))) - measured).max() > 0.1 * size


@pytest.mark.parametrize("law", ["task", "joints"])
def test_control_laws_never_see_the_base(paper, paper_pose, law):
    """Two bases, bent and not, with the same arm joints and the same tip error: the torque is the same to the bit.

    What a law is given has no place for q_p. At the true base deflection Jv would differ: the control.
    """
    assert Measured._fields == ("time", "joints", "rates", "tip_error", "tip_rate")
    path = JointPath(paper.at_tip(START).q[1:], paper_pose.q[1:], 0.1, LAWS["quintic"])
    control = TaskPD(paper_pose, paper.arm.gains) if law == "task" else JointTracking(paper_pose, path)
    torques, jacobians = [], []
    for base, base_rate in ((0.0, 0.0), (0.05, -2.0)):
        q, rates = np.array([base, -1.9, 2.0]), np.array([base_rate, 0.7, -0.4])
        _, seen = observe(paper_pose, 0.03, q, rates)
        seen = seen._replace(tip_error=(1e-3, -2e-3), tip_rate=(0.1, 0.2))
        torques.append(control.torque(seen))
        jacobians.append(rigid_bodies(paper_pose).jacobian(q)[:2, 1:])
    assert torques[0] == torques[1]
    assert np.abs(jacobians[0] - jacobians[1]).max() > 1e-3


def test_task_law_under_gravity_stands_on_the_unloaded_base():
    """tau = -Jv(qbar_p, q_a)^T (Kp y + Kv y') + g_a(goal): Jv at the springs' rest, not at the sagged or true base."""
    goal = planar([0.2, 0.3, 0.25], gravity=(0.0, -9.81, 0.0), stiffness=500.0).at([0.4, 0.9])
    assert abs(goal.q[0]) > 0.01  # the sag would show
    joints, error, rate = np.array([0.5, 0.8]), np.array([1e-3, -2e-3]), np.array([0.1, 0.2])
    torque = TaskPD(goal, goal.arm.gains).torque(Measured(0.0, *map(tuple, (joints, joints, error, rate))))
    bodies = rigid_bodies(goal)
    Jv = bodies.jacobian(np.concatenate([goal.equilibrium, joints]))[:2, 1:]
    pull = goal.arm.gains.stiffness @ error + goal.arm.gains.damping @ rate
    assert torque == pytest.approx(bodies.gravity(goal.q)[1:] - Jv.T @ pull, rel=1e-12)


def test_what_is_observed_is_what_is_there(paper_pose):
    """Arm joints and rates without the base's, the true tip error, and J q' as its rate, by Pinocchio."""
    q, rates = np.array([0.02, -1.9, 2.0]), np.array([-1.0, 0.7, -0.4])
    _, seen = observe(paper_pose, 0.0, q, rates)
    bodies = rigid_bodies(paper_pose)
    assert seen.joints == (-1.9, 2.0)
    assert seen.rates == (0.7, -0.4)
    assert seen.tip_error == pytest.approx(bodies.tool_pose(q)[1][:2] - np.array(GOAL), abs=1e-13)
    assert seen.tip_rate == pytest.approx(bodies.jacobian(q)[:2] @ rates, abs=1e-13)


@pytest.mark.parametrize("name", sorted(LAWS))
def test_motion_laws_go_from_rest_to_rest(name):
    """0 to 1 and back to rest, velocity and acceleration being the slopes of position and velocity.

    Integrals by the trapezoidal rule on 30001 points: 1e-8 for smooth laws, the step 3e-5 times the jump at a corner.
    """
    u = np.linspace(0.0, 1.0, 30001)
    position, velocity, acceleration = LAWS[name](u)
    assert [position[0], velocity[0]] == pytest.approx([0.0, 0.0], abs=1e-14)
    assert [position[-1], velocity[-1]] == pytest.approx([1.0, 0.0], abs=1e-13)
    step = u[1]
    moved = np.concatenate([[0.0], np.cumsum(0.5 * step * (velocity[1:] + velocity[:-1]))])
    gained = np.concatenate([[0.0], np.cumsum(0.5 * step * (acceleration[1:] + acceleration[:-1]))])
    assert position == pytest.approx(moved, abs=1e-7)
    assert velocity == pytest.approx(gained, abs=2.5e-4)
    assert np.all(velocity >= -1e-14)


def test_quintic_starts_and_ends_without_acceleration():
    """The fifth-order law's acceleration vanishes at both ends; the trapezoid's does not (the control)."""
    ends = np.array([0.0, 1.0])
    assert LAWS["quintic"](ends)[2].tolist() == [0.0, 0.0]
    assert np.abs(LAWS["trapezoidal"](ends)[2]).min() > 1.0


def test_trapezoid_has_a_third_of_each():
    """Speeding up, cruising at 1.5 times the mean speed, braking: a third each."""
    u = np.array([1.0 / 6.0, 0.5, 5.0 / 6.0])
    position, velocity, acceleration = LAWS["trapezoidal"](u)
    assert velocity == pytest.approx([0.75, 1.5, 0.75])
    assert acceleration == pytest.approx([4.5, 0.0, -4.5])
    assert position == pytest.approx([0.0625, 0.5, 0.9375])


def test_joint_path_rests_at_its_end():
    """After the duration the path stays at its end, at rest; halfway it is in the middle, at its speed in seconds."""
    path = JointPath(np.array([1.0, -1.0]), np.array([2.0, 3.0]), 0.2, LAWS["trapezoidal"])
    wanted, rates, _ = path.at(0.1)
    assert wanted == pytest.approx((1.5, 1.0))
    assert rates == pytest.approx((1.5 / 0.2, 1.5 * 4.0 / 0.2))
    for late in (0.2, 5.0):
        wanted, rates, accelerations = path.at(late)
        assert wanted == pytest.approx((2.0, 3.0))
        assert (*rates, *accelerations) == (0.0, 0.0, 0.0, 0.0)


def test_joint_tracking_on_its_path_is_inverse_dynamics(paper, paper_pose):
    """On the path, with a rigid base at rest, the torque is Pinocchio's for the wanted acceleration: no correction."""
    path = JointPath(paper.at_tip(START).q[1:], paper_pose.q[1:], 0.1, LAWS["quintic"])
    wanted, rates, accelerations = path.at(0.03)
    torque = JointTracking(paper_pose, path).torque(Measured(0.03, wanted, rates, (0.0, 0.0), (0.0, 0.0)))
    at_rest = [np.concatenate([[0.0], values]) for values in (wanted, rates, accelerations)]
    assert torque == pytest.approx(rigid_bodies(paper_pose).torques(*at_rest)[1:], rel=1e-11)


def test_trapezoidal_move_with_the_compensator_always_on(trapezoid, paper_pose, compensator):
    """Another law, another switching time, E acting from the start: the run settles, with E in the torque throughout.

    During the move, q'' by Pinocchio from the reported torque; the torque less E q_a'' is the tracking law's.
    """
    assert trapezoid.switch == 0.12
    assert trapezoid.t[-1] == pytest.approx(0.3)
    assert trapezoid.settled
    bodies = rigid_bodies(paper_pose)
    path = JointPath(trapezoid.q[0][1:], paper_pose.q[1:], 0.12, LAWS["trapezoidal"])
    tracking = JointTracking(paper_pose, path)
    for i in range(5, 590, 45):
        q, rates = trapezoid.q[i], trapezoid.rates[i]
        force = np.concatenate([[-3e4 * q[0] - 10.0 * rates[0]], trapezoid.torque[i]]) - bodies.bias(q, rates)
        q2 = np.linalg.solve(bodies.inertia(q), force)
        law = tracking.torque(Measured(trapezoid.t[i], q[1:], rates[1:], (0.0, 0.0), (0.0, 0.0)))
        assert trapezoid.torque[i] - compensator.E @ q2[1:] == pytest.approx(law, rel=1e-8, abs=1e-6)


def test_torque_jumps_only_at_the_switch(compensated):
    """The move's last torque and the settling's first belong to different laws; each law alone is continuous."""
    jumps = np.abs(np.diff(compensated.torque, axis=0)).max(axis=1)
    assert np.argmax(jumps) == int(np.flatnonzero(compensated.settling)[0]) - 1


def test_gravity_is_held_at_the_goal():
    """Under gravity a run from the goal to the goal stays there: the law holds the arm, the springs the base.

    Joint tracking works from the unloaded base, 6e-4 rad away from the sagged one, so the tip drifts by micrometres in
    the move; a law that forgot gravity would drop the tip by 2 mm (holding torque over task stiffness).
    """
    pose = planar([0.2, 0.3, 0.25], gravity=(9.81, 0.0, 0.0)).at([0.4, 0.9])
    run = flexbase.simulate(pose.plant, pose, pose, move=Move(switch=0.01, end=0.03, interval=1e-3))
    assert np.abs(pose.holding_torque).max() > 0.1
    assert run.q == pytest.approx(np.tile(pose.q, (len(run.t), 1)), abs=2e-5)
    assert run.torque == pytest.approx(np.tile(pose.holding_torque, (len(run.t), 1)), rel=1e-2, abs=0.2)
    assert run.settled


def test_a_diverging_run_stops_and_says_so():
    """A slider whose loop is unstable (by its poles, 4 /s) runs away: the run ends early with its reason."""
    plant = sliding_pair(1.2, stiffness=5e3, damping=1.0)
    gains, goal = make_gains([1e4], [0.0], 1), plant.at([0.3])
    assert FullSystem(goal).close(gains.stiffness, gains.damping).poles().real.max() > 4.0
    run = flexbase.simulate(
        plant, plant.at([0.0]), goal, Loop(gains=gains), move=Move(switch=0.05, end=5.0, interval=1e-2)
    )
    assert "diverged at" in run.stopped
    assert run.t[-1] < 4.0
    assert len(run.t) == len(run.q) == len(run.torque) == len(run.tip_error)
    assert np.all(np.isfinite(run.q))
    assert not run.settled
    assert run.to_dict()["stopped"] == run.stopped


def test_leaving_the_definite_inertia_stops_the_run(paper, paper_pose):
    """A gain that is fine at the goal but not on the way there: with compensate="always" the run ends at once."""
    smallest = np.linalg.eigh(paper_pose.M[1:, 1:])[1][:, 0]
    E = None
    for size in np.linspace(0.02, 0.2, 60):  # the largest that still leaves the goal's inertia positive
        trial = paper_pose.M.copy()
        trial[1:, 1:] -= size * np.outer(smallest, smallest)
        if np.linalg.eigvalsh(trial)[0] > 1e-6:
            E = size * np.outer(smallest, smallest)
    far = paper_pose.plant.at([0.5, 0.6])
    trial = far.M.copy()
    trial[1:, 1:] -= E
    assert np.linalg.eigvalsh(trial)[0] < 0.0
    run = flexbase.simulate(paper, far, paper_pose, Gain(E), move=Move(compensate="always"))
    assert "no longer positive definite" in run.stopped
    assert len(run.t) < 10
    assert run.peak_error_m is None


def made_up(paper_pose, error, stopped=None, switch=0.1):
    """A run with a given tip error on 11 samples of 20 ms."""
    t = np.linspace(0.0, 0.2, 11)
    error = np.asarray(error, dtype=float)
    zeros = np.zeros((11, 3))
    torque = np.outer(np.sin(np.arange(11)), [2.0, -5.0])
    rates = np.outer(np.cos(np.arange(11)), [9.0, -3.0, 4.0])
    return Run(paper_pose, t, zeros, rates, error, torque, switch, paper_pose, True, -1.0, stopped=stopped)


def test_settling_counts_from_switching_to_the_last_time_outside(paper_pose):
    """Settled means below 0.1 mm from some time until the end; an early dip does not count, nor does the move."""
    error = np.zeros((11, 2))
    error[3] = 1.0  # before switching: no matter
    error[5], error[6], error[7] = [2e-4, 0.0], [0.0, 0.0], [0.0, 1.5e-4]
    run = made_up(paper_pose, error)
    assert run.settled
    assert run.settling_time_s == pytest.approx(0.16 - 0.1, rel=1e-12)
    assert run.peak_error_m == pytest.approx(2e-4)
    late = error.copy()
    late[10] = [1.01e-4, 0.0]
    assert not made_up(paper_pose, late).settled
    assert not made_up(paper_pose, error, stopped="the motion diverged at 0.2 s").settled
    assert made_up(paper_pose, 0.0 * error).settling_time_s == 0.0


def test_error_size_is_the_distance(paper_pose):
    """The length of the position error, not its largest component: 3-4-5."""
    run = made_up(paper_pose, np.tile([3e-3, 4e-3], (11, 1)))
    assert run.error_size == pytest.approx(np.full(11, 5e-3))


def test_peaks_are_the_largest_of_each_arm_joint(paper_pose, compensated):
    """Peak torque and speed over the whole run, a value an arm joint, the base left out."""
    run = made_up(paper_pose, np.zeros((11, 2)))
    sines, cosines = np.abs(np.sin(np.arange(11))).max(), np.abs(np.cos(np.arange(11))).max()
    assert run.peak_torque == pytest.approx([2.0 * sines, 5.0 * sines])
    assert run.peak_speed == pytest.approx([3.0 * cosines, 4.0 * cosines])
    assert compensated.peak_torque.tolist() == np.abs(compensated.torque).max(axis=0).tolist()
    settled = compensated.error_size[compensated.settling]
    assert compensated.peak_error_m == settled.max()


def test_dictionary_carries_the_promised_keys(compensated):
    """t, q, tip_error, settled, settling_time_s, peak_error_m as plain lists and numbers."""
    plain = compensated.to_dict()
    assert plain["settled"] is True
    assert plain["settling_time_s"] == compensated.settling_time_s
    assert plain["peak_error_m"] == compensated.peak_error_m
    assert len(plain["t"]) == len(plain["q"]) == len(plain["tip_error"]) == len(compensated.t)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"switch": 0.0}, "times"),
        ({"switch": 0.5}, "times"),
        ({"interval": 0.0}, "times"),
        ({"interval": 1.0}, "times"),
        ({"end": float("nan")}, "times"),
        ({"end": float("inf")}, "times"),
        ({"trajectory": "cubic"}, 'trajectory: "cubic" is unknown'),
        ({"compensate": "never"}, 'compensate: "never" is unknown'),
        ({"bandwidth": 0.0}, "bandwidth"),
        ({"bandwidth": float("nan")}, "bandwidth"),
        ({"bandwidth": "fast"}, "bandwidth: 'fast' is not a number"),
        ({"switch": 0.1j}, "switch"),
        ({"self_motion": -1.0}, "self_motion: -1 rad/s"),
    ],
)
def test_wrong_options_are_refused(paper, options, message):
    """Times, names, bandwidth and gain are checked before anything runs."""
    with pytest.raises(InputError, match=message):
        flexbase.simulate(paper, START, GOAL, move=Move(**options))


@pytest.mark.parametrize(
    ("loop", "message"),
    [
        (Gain(np.eye(3)), r"E has shape \(3, 3\)"),
        (Gain(np.array([[0.0, 1.0], [0.0, 0.0]])), "not symmetric"),
        (Gain(np.full((2, 2), np.nan)), "not finite"),
        (Loop(gains=Gains(-np.eye(2), np.eye(2))), "stiffness"),
        (Loop(gains=Gains(np.eye(3), np.eye(3))), "stiffness"),
    ],
)
def test_wrong_loops_are_refused_by_both(paper, loop, message):
    """One run and many have one door."""
    with pytest.raises(InputError, match=message):
        flexbase.simulate(paper, START, GOAL, loop)
    with pytest.raises(InputError, match=message):
        flexbase.simulate_many(paper, [0.5, 0.9], GOAL, loop)


def test_other_things_than_plants_poses_and_moves_are_refused_by_both(paper, paper_pose):
    """Another robot's pose, a pose in place of a plant, the options of another verb."""
    other = flexbase.load("scara").at([0.3, 0.5, 0.1, 0.0])
    joints = [0.5, 0.9]
    for verb, start, foreign in (
        (flexbase.simulate, START, flexbase.SampledMove()),
        (flexbase.simulate_many, joints, Move()),
    ):
        with pytest.raises(InputError, match="a pose of scara is no pose of ueda2003"):
            verb(paper, start, other)
        with pytest.raises(InputError, match="a pose of scara is no pose of ueda2003"):
            verb(paper, other, GOAL)
        with pytest.raises(InputError, match="plant: Pose given"):
            verb(paper_pose, start, GOAL)
        with pytest.raises(InputError, match=f"move: {type(foreign).__name__} given"):
            verb(paper, start, GOAL, move=foreign)


def test_cautions_are_kept_with_the_run(paper, paper_pose, compensator):
    """A compensator of another robot is used, and said to be; so with many runs."""
    borrowed = dataclasses.replace(compensator, robot="another")
    short = {"switch": 0.005, "end": 0.01}
    with pytest.warns(flexbase.FlexbaseWarning, match='designed for "another"'):
        run = flexbase.simulate(paper, paper_pose, paper_pose, borrowed, move=Move(**short, interval=1e-3))
    with pytest.warns(flexbase.FlexbaseWarning, match='designed for "another"'):
        runs = flexbase.simulate_many(paper, paper_pose, paper_pose, borrowed, move=flexbase.Moves(**short))
    assert run.cautions == runs.cautions == ('compensator: designed for "another", used on "ueda2003".',)


def test_missing_gains_are_asked_for(paper):
    """A project without [control] needs gains given."""
    plant = flexbase.Plant(dataclasses.replace(paper.arm, gains=None))
    with pytest.raises(InputError, match=r"no task gains. Add a \[control\] table"):
        flexbase.simulate(plant, START, GOAL)


def test_a_gain_too_large_for_the_goal_is_refused_at_once(paper, paper_pose):
    """M - E indefinite at the goal already: nothing can be simulated, and the reason is given."""
    E = 1.5 * paper_pose.M[1:, 1:]
    try:
        run = flexbase.simulate(paper, START, GOAL, Gain(E), move=Move(switch=0.005, end=0.01))
    except InputError as refusal:
        assert "not positive definite" in str(refusal)  # noqa: PT017
    else:
        assert "no longer positive definite" in run.stopped

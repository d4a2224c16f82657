"""Sampled runs on both plants: against the linear loop, an adaptive integrator, MuJoCo, and statics."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import flexbase as fb
from flexbase import Gains, InputError, MissingExtra
from flexbase.dynamics.kinematics import forward
from flexbase.errors import import_extra
from flexbase.model.sensing import Sensing
from flexbase.sampled.changes import Changed, changed_pose
from flexbase.sampled.controller import pd_with_gain
from flexbase.sampled.plant import sampled_plant
from flexbase.simulation import Push, SampledMove, SampledRun, simulate_sampled, simulate_sampled_many
from flexbase.simulation.plants import builtin_held
from flexbase.simulation.plants.builtin import accelerations
from flexbase.simulation.plants.builtin_held import BuiltinHeld
from flexbase.synthesis import controller_for
from flexbase.trace.algebra import unstack

TINY = 1e-7  # rad: the second-order terms of the motion are as small against the first
SENSINGS = [
    Sensing(),
    Sensing(rate=2000.0, compute_delay=0, task_delay=3),
    Sensing(task_every=3, task_delay=2, compute_delay=2),
    Sensing(accelerometer_lag=0.0),
    Sensing(rate=4000.0, acceleration="encoders"),
    Sensing(rate=2000.0, acceleration="kalman", task_every=2),
]
REAL = Sensing(
    task_every=2,
    encoder_counts=2.0**18,
    task_noise=5e-6,
    acceleration_noise=1.0,
    torque_limit=(200.0, 200.0),
    torque_slew=(2e5, 2e5),
)
E = np.array([[0.12, 0.079], [0.079, -0.15]])  # as the paper prints it
ENGINES = ("builtin", "mujoco")


def softer(pose, share=1.0 / 16.0):
    """Task gains, the damping ratio kept."""
    gains = pose.arm.gains
    return Gains(share * gains.stiffness, np.sqrt(share) * gains.damping)


def soft(pose, sensing, gain=None, share=1.0 / 16.0):
    """A controller that is stable at 1 kHz."""
    return pd_with_gain(pose, sensing, softer(pose, share), gain, "soft")


def linear_run(pose, controller, joints, samples):
    """Tip error of the linear loop from joints displaced at rest, with the conventions of `Sensing` and nothing else.

    The plant's own samples, fed by hand: delays as lists, the controller by its matrices.
    """
    sensing, system = controller.sensing, controller.system
    n, k, N = pose.arm.n, pose.arm.k, pose.arm.N
    prompt = sampled_plant(pose, replace(sensing, compute_delay=0, task_delay=0))
    x = np.zeros(prompt.order)
    x[pose.arm.m : N] = joints
    still = prompt.C @ x
    still[k + n : k + 2 * n] = 0.0
    rest = np.concatenate([still[:k], joints, np.zeros(n)])
    c = np.linalg.solve(np.eye(system.order) - system.A, system.B @ rest)
    waiting, late, held, errors = [np.zeros(n)] * sensing.compute_delay, [still[:k]] * sensing.task_delay, None, []
    for sample in range(samples):
        known = waiting[0] if waiting else np.zeros(n)
        y = prompt.C @ x + prompt.D[:, :n] @ known
        late.append(y[:k])
        arrived = late.pop(0)
        held = arrived if held is None or sample % sensing.task_every == 0 else held
        seen = np.concatenate([held, y[k : k + 2 * n]])
        waiting.append(system.C @ c + system.D @ seen)
        c = system.A @ c + system.B @ seen
        errors.append(y[:k])
        x = prompt.A @ x + prompt.B[:, :n] @ waiting.pop(0)
    return np.array(errors)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("sensing", SENSINGS, ids=str)
def test_a_tiny_motion_is_the_linear_loops(paper_pose, sensing, engine):
    """Every rate, delay, hold and sensor, sample by sample: what the verdict is about is what is simulated.

    Tolerance: 3e-4 of the largest error, for the lag that MuJoCo's accelerometers are given piece by piece.
    """
    if engine == "mujoco":
        pytest.importorskip("mujoco")
    controller = soft(paper_pose, sensing, 0.3 * E)
    away = TINY * np.array([1.0, -0.7])
    run = simulate_sampled(controller, paper_pose.q[1:] + away, move=SampledMove(end=0.1, engine=engine))
    expected = linear_run(paper_pose, controller, away, len(run.t))
    assert np.abs(run.tip_error - expected).max() < 3e-4 * np.abs(expected).max()


@pytest.mark.parametrize(("robot", "tip"), [("ueda2003", (0.33, -0.25)), ("ur5e-pedestal", None)])
def test_between_samples_the_steps_follow_an_adaptive_integrator(robot, tip):
    """0.1 s under held torques against DOP853 at 1e-12: 1e-8 of the motion, as steps of 0.05 rad promise."""
    plant = fb.load(robot)
    rng = np.random.default_rng(5)
    pose = plant.at(rng.uniform(-1.0, 1.0, plant.arm.n)) if tip is None else plant.at_tip(tip)
    n, N, m = pose.arm.n, pose.arm.N, pose.arm.m
    torque = pose.holding_torque + rng.uniform(-2.0, 2.0, n)
    physics = BuiltinHeld([pose], pose.q[None], Sensing(rate=100.0))
    for _ in range(10):
        physics.advance(torque[None], np.zeros((1, pose.arm.k)), np.array([True]))

    def slope(_, x):
        frames = forward(pose.arm.mechanism, unstack(x[:N], 1))
        return np.concatenate([x[N:], accelerations(pose, frames, x[:N], x[N:], torque, None)])

    whole = solve_ivp(slope, (0.0, 0.1), np.concatenate([pose.q, np.zeros(N)]), method="DOP853", rtol=1e-12, atol=1e-14)
    seen = physics.observe(torque[None], np.zeros((1, pose.arm.k)))
    assert whole.success
    assert np.abs(whole.y[:N, -1] - pose.q)[m:].max() > 1e-3
    assert np.abs(seen.q[0] - whole.y[:N, -1]).max() < 1e-8 * np.abs(whole.y[:N, -1] - pose.q).max()


def test_both_plants_make_the_same_move(paper, paper_pose):
    """Counts, noise, limits, a slow task sensor, a push: MuJoCo's integrator and kinematics agree to 1 um of 23 mm."""
    pytest.importorskip("mujoco")
    controller = soft(paper_pose, REAL)
    push = Push((50.0, 0.0), 0.5, 0.02)
    runs = [
        simulate_sampled(
            controller,
            paper.at_tip([0.33, 0.25]),
            push=push,
            move=SampledMove(switch=0.15, end=0.8, engine=engine),
        )
        for engine in ENGINES
    ]
    assert runs[0].saturated_samples > 20
    assert runs[0].saturated_samples == runs[1].saturated_samples
    assert 0.01 < runs[0].peak_error_m < 0.1
    assert np.abs(runs[0].tip_error - runs[1].tip_error).max() < 1e-6
    assert all(run.settled for run in runs)


def test_mujoco_runs_without_our_dynamics(paper_pose, monkeypatch):
    """The witness is independent: it steps by mj_step even where ours is broken."""
    mujoco = pytest.importorskip("mujoco")
    steps = []
    own = mujoco.mj_step
    monkeypatch.setattr(mujoco, "mj_step", lambda *words: (steps.append(1), own(*words)))
    monkeypatch.setattr(builtin_held, "functions_of", None)
    run = simulate_sampled(
        soft(paper_pose, Sensing()), paper_pose.q[1:] + 1e-3, move=SampledMove(end=0.2, engine="mujoco")
    )
    assert len(steps) == 5 * 200
    assert run.peak_error_m > 1e-4


@pytest.mark.parametrize("engine", ENGINES)
def test_the_papers_gain_is_unstable_and_a_softer_loop_settles(paper_pose, engine):
    """One sample of delay at 1 kHz: the printed E with the printed gains diverges on both plants."""
    if engine == "mujoco":
        pytest.importorskip("mujoco")
    near = paper_pose.q[1:] + 1e-4
    papers = pd_with_gain(paper_pose, Sensing(), paper_pose.arm.gains, E, "the paper's E")
    move = SampledMove(engine=engine)
    found = simulate_sampled(papers, near, move=move)
    assert found.diverged
    assert not found.settled
    assert not found.predicted
    assert "diverged" in found.summary()
    assert found.t[-1] < 0.3
    assert simulate_sampled(soft(paper_pose, Sensing()), near, move=move).settled
    assert simulate_sampled(
        controller_for(paper_pose, "coprime", Sensing()), near, move=SampledMove(engine=engine)
    ).settled


def test_a_long_push_meets_the_static_stiffness(paper_pose):
    """A force of 0.1 N held until all is still: the linear plant's static gain, to 1e-4 (it moves the tip by 10 um)."""
    controller, force = soft(paper_pose, Sensing()), np.array([0.06, -0.08])
    run = simulate_sampled(controller, push=Push(tuple(force), 0.0, 1.4), move=SampledMove(end=1.5))
    still = run.tip_error[round(1.39 * 1000)]
    Jv, K = paper_pose.J[:, 1:], paper_pose.K
    loop = K + np.block([[np.zeros((1, 3))], [np.zeros((2, 1)), np.zeros((2, 2))]])
    loop[1:] += Jv.T @ softer(paper_pose).stiffness @ paper_pose.J
    expected = paper_pose.J @ np.linalg.solve(loop, paper_pose.J.T @ force)
    assert still == pytest.approx(expected, rel=1e-4)
    assert run.judged_from == pytest.approx(1.4)


def test_a_changed_robot_is_run_with_the_old_controller(paper_pose):
    """The joint offset moves the goal, the stiffness the motion; the linear loop of the changed pose says how."""
    change = Changed("both", base_stiffness=0.8, joints=((0, 0.1),))
    real, controller = changed_pose(paper_pose, change), soft(paper_pose, Sensing())
    away = TINY * np.array([1.0, 0.5])
    run = simulate_sampled(controller, real.q[1:] + away, pose=real, move=SampledMove(end=0.1))
    expected = linear_run(real, controller, away, len(run.t))
    nominal = linear_run(paper_pose, controller, away, len(run.t))
    assert np.abs(run.tip_error - expected).max() < 1e-4 * np.abs(expected).max()
    assert np.abs(nominal - expected).max() > 1e-2 * np.abs(expected).max()


def test_gravity_is_held_by_the_controllers_model():
    """The UR5e under gravity rests where it is; one that is 10 % heavier at the last link sinks."""
    plant = fb.load("ur5e-pedestal")
    pose = plant.at([0.3, -1.2, 1.4, -1.0, -1.2, 0.2])
    sensing = Sensing(rate=4000.0)
    gains = Gains(2e3 * np.eye(3), 80.0 * np.eye(3))
    controller = pd_with_gain(pose, sensing, gains, None, "soft")
    if plant.arm.has_gravity:
        assert simulate_sampled(controller, move=SampledMove(end=0.05)).peak_error_m < 1e-9
    heavier = changed_pose(pose, Changed("heavy", last_link=1.1))
    moved = simulate_sampled(controller, pose=heavier, move=SampledMove(end=0.05)).peak_error_m
    assert (moved > 1e-7) == plant.arm.has_gravity


def test_side_by_side_is_one_by_one(paper):
    """Controllers of different order and sensing, on poses of their own; the order of the answers is the given one.

    To 1e-9 m: runs that go side by side take the steps of the fastest among them.
    """
    poses = [paper.at([0.4 * i, 1.0 + 0.2 * i]) for i in range(4)]
    made = [soft(pose, SENSINGS[0 if i % 2 else 2], 0.2 * E if i > 1 else None) for i, pose in enumerate(poses)]
    starts = [pose.q[1:] + 1e-3 for pose in poses]
    together = simulate_sampled_many(made, starts, move=SampledMove(end=0.1))
    for one, start, found in zip(made, starts, together, strict=True):
        alone = simulate_sampled(one, start, move=SampledMove(end=0.1))
        assert found.controller is one
        assert np.abs(alone.tip_error - found.tip_error).max() < 1e-9


def test_rows_do_without_the_extra(paper_pose, monkeypatch):
    """NumPy rows give what the machine code gives."""
    import_extra("casadi", "fast")
    compiled = simulate_sampled(soft(paper_pose, REAL), paper_pose.q[1:] + 1e-3, move=SampledMove(end=0.05))

    def missing(*_, **__):
        raise MissingExtra("no")

    monkeypatch.setattr(builtin_held, "kernel_of", missing)
    builtin_held.functions_of.cache_clear()
    rows = simulate_sampled(soft(paper_pose, REAL), paper_pose.q[1:] + 1e-3, move=SampledMove(end=0.05))
    builtin_held.functions_of.cache_clear()
    assert np.abs(rows.tip_error - compiled.tip_error).max() < 1e-11


def test_joint_tracking_has_its_own_limit(paper, paper_pose):
    """Sampled, the move's own law is unstable at the continuous one's bandwidth: rho(Ms^-1 Mhat) = 11 at its start."""
    start = paper.at_tip([0.33, 0.25])
    controller, times = soft(paper_pose, Sensing()), {"switch": 0.1, "end": 0.3}
    assert simulate_sampled(controller, start, move=SampledMove(**times, bandwidth=60.0)).diverged
    assert not simulate_sampled(controller, start, move=SampledMove(**times)).diverged


@pytest.mark.parametrize(
    ("words", "match"),
    [
        ({"move": SampledMove(end=-1.0)}, "times"),
        ({"move": SampledMove(end=0.005)}, "5 samples"),
        ({"move": SampledMove(switch=0.6)}, "switch"),
        ({"move": SampledMove(engine="real")}, "engine"),
        ({"move": SampledMove(bandwidth=0.0)}, "bandwidth"),
        ({"move": SampledMove(tolerance=-1.0)}, "tolerance"),
        ({"move": SampledMove(seed=-1)}, "seed: -1 is below 0"),
        ({"move": SampledMove(seed=0.5)}, "seed: 0.5 is not a whole number"),
        ({"move": fb.Move()}, "move: Move given"),
        ({"pose": [0.1, 0.2]}, "pose: list given"),
        ({"push": (1.0, 0.0)}, "push: tuple given"),
        ({"push": Push((1.0, 0.0), float("nan"), 0.1)}, "push"),
        ({"push": Push((1.0,), 0.1, 0.1)}, "push"),
        ({"push": Push((1.0, 0.0), 0.4, 0.2)}, "does not end"),
        ({"start": [0.1]}, "start"),
    ],
)
def test_wrong_words_are_named(paper_pose, words, match):
    with pytest.raises(InputError, match=match):
        simulate_sampled(soft(paper_pose, Sensing()), **words)


def test_other_robots_and_algebraic_loops_are_refused(paper_pose):
    with pytest.raises(InputError, match="other joints"):
        simulate_sampled(soft(paper_pose, Sensing()), pose=fb.load("scara").at([0.3, 0.5, 0.1, 0.0]))
    with pytest.raises(InputError, match="other joints"):
        simulate_sampled(soft(paper_pose, Sensing()), fb.load("scara").at([0.3, 0.5, 0.1, 0.0]))
    with pytest.raises(InputError, match="controller: Pose given"):
        simulate_sampled(paper_pose)
    ideal = Sensing(compute_delay=0, accelerometer_lag=0.0)
    with pytest.raises(InputError, match="depends on the torque"):
        simulate_sampled(soft(paper_pose, ideal, E))


def judged(paper_pose, error):
    """A run of this tip error along x, judged from its begin."""
    t = np.arange(len(error)) / 1000.0
    both = np.stack([error, np.zeros(len(error))], axis=1)
    q = np.zeros((len(error), 3))
    return SampledRun(paper_pose, t, q, q, both, both, 0.0, soft(paper_pose, Sensing()), None, 0.99, 0, "builtin", 0)


@pytest.mark.parametrize(
    ("error", "settled"),
    [
        (1e-3 * np.exp(-np.arange(800) / 100.0), True),
        (1e-3 * np.exp(-np.arange(800) / 400.0), False),  # 0.22 mm at the begin of the last quarter
        (1e-8 * np.exp(np.arange(800) / 100.0), False),  # 0.03 mm, and grows
        (2e-5 * np.sin(np.arange(800.0)), True),  # a limit cycle of counts
        (2e-5 * np.random.default_rng(0).standard_normal(800), True),
        (np.where(np.arange(800) == 650, 1.1e-4, 0.0), False),
    ],
)
def test_settled_is_small_and_not_growing(paper_pose, error, settled):
    assert judged(paper_pose, error).settled == settled


def test_settling_time_is_that_of_the_exponential(paper_pose):
    """exp(-t/100 ms) falls from 1 mm to 0.1 mm in 230.3 ms: the first sample after that."""
    assert judged(paper_pose, 1e-3 * np.exp(-np.arange(1600) / 100.0)).settling_time_s == pytest.approx(0.231)

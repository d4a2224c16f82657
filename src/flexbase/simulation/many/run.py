"""Many moves and settlings at once: fixed steps in machine code, a run in every lane."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexbase.checks import FARTHEST, Array, check_within, choose, finite_array, positive_number
from flexbase.control.joint_tracking import BANDWIDTH
from flexbase.control.trajectories import LAWS, SMOOTH_PARTS
from flexbase.dynamics.kinematics import forward
from flexbase.dynamics.statics import static_base
from flexbase.dynamics.task import task_error
from flexbase.dynamics.variation import Parameter, parameters_of
from flexbase.errors import FlexbaseWarning, InputError
from flexbase.linear.closed_loop import close_loop
from flexbase.linear.linearise import check_definite_inertia, linearise
from flexbase.model.loop import HasGain, Loop, loop_on
from flexbase.model.task import Gains
from flexbase.plant import Plant, Pose, check_plant
from flexbase.simulation.many.phase import Always, Phase, Tracking
from flexbase.simulation.many.result import DIVERGED, INDEFINITE, OK, Runs
from flexbase.simulation.many.step import Step
from flexbase.simulation.result import SETTLED
from flexbase.simulation.run import FASTEST, SELF_MOTION, WHEN, settling_law

TOLERANCE = 1e-8  # rad or m of a joint
LONGEST = 2e-4  # s, a step
SHORT = 0.25  # rad or 1/e of the fastest pole, a step, to begin with
PROBES, REFINEMENTS = 8, 8
SURE = 16.0  # steps shorter by this must also see a run diverge, or the step is to blame
OF_LOOP = {
    "task_stiffness": Parameter("1", "factor on the stiffness of the task-space law", 1.0, 0.0),
    "task_damping": Parameter("1", "factor on the damping of the task-space law", 1.0, 0.0),
    "compensation": Parameter("1", "factor on the compensator's gain E", 1.0, -np.inf),
}


def simulate_many(
    plant: Plant,
    starts: Pose | ArrayLike,
    goal: Pose | ArrayLike,
    compensator: HasGain | None = None,
    *,
    vary: Mapping[str, ArrayLike] | None = None,
    gains: Gains | None = None,
    switch: float = 0.1,
    end: float = 0.4,
    trajectory: str = "quintic",
    compensate: str = "settle",
    bandwidth: float = BANDWIDTH,
    self_motion: float = SELF_MOTION,
    tolerance: float = TOLERANCE,
    threads: int | None = None,
) -> Runs:
    """The runs of `simulate` for many starts, or for robots that differ from the one that the laws know; see there.

    Runge-Kutta steps of fixed size, chosen so that halving them moves no joint by more than `tolerance` [rad or m] at
    `switch` and at `end`, judged in a few of the runs. No history is kept. Assumes that the tool is less than half a
    turn from the goal after switching; gravity's sag at the start is that of the nominal robot.

    starts : arm joints at rest, shape (runs, n), or (n,) or a pose for all
    vary : parameter -> values, shape (runs,): `stiffness`, `damping`, `payload`, `link_mass`, `link_com`, such as
        `stiffness.JOINT`, of the robot; `task_stiffness`, `task_damping`, `compensation` of the loop (factors)
    threads : all cores if left out
    Raises InputError, MissingExtra. A run that diverges, or leaves M - E > 0, has a status that says so.
    """
    check_plant(plant)
    arm = plant.arm
    m = arm.m
    loop = loop_on(arm, Loop(compensator, gains))
    gains, E = loop.gains, loop.E
    there = goal if isinstance(goal, Pose) else plant.at_tip(goal)
    if not 0.0 < switch < end < np.inf:
        raise InputError(f"times: switch ({switch:g} s) must lie above 0 and below end ({end:g} s). Give such times.")
    if compensate not in WHEN:
        raise InputError(f'compensate: "{compensate}" is unknown. Give one of {", ".join(WHEN)}.')
    positive_number("bandwidth", bandwidth, "rad/s")
    positive_number("tolerance", tolerance, "rad or m")
    if E is not None:
        check_definite_inertia(there, E)
    joints, varied = _inputs(plant, starts, dict(vary or {}))
    names, gain = tuple(varied), None if E is None else E.tolist()
    motion = choose("trajectory", trajectory, LAWS)
    settling = Always(settling_law(there, gains, compensator, self_motion))
    moving = Step(there, Tracking(there, motion, bandwidth), gain if compensate == "always" else None, names)
    phases = (
        Phase(moving, 0.0, switch, SMOOTH_PARTS[trajectory]),
        Phase(Step(there, settling, gain, names), switch, end),
    )
    N = arm.N
    state = np.zeros((phases[0].step.state, len(joints)))
    state[:m], state[m:N], state[-1] = _rests(plant, joints).T, joints.T, np.inf  # the least pivot so far
    constants = np.vstack([joints.T, *varied.values()])

    def ends(which: NDArray[np.intp], longest: float) -> list[Array]:
        """States of some of the runs after each phase."""
        found = [state[:, which]]
        for phase in phases:
            found.append(phase.run(found[-1], constants[:, which], longest, threads))
        return found[1:]

    poles = np.linalg.eigvals(np.asarray(close_loop(linearise(there, compensator), gains).state_space().A))
    probes, first_try = _probes(varied, len(joints)), min(LONGEST, SHORT / float(np.abs(poles).max()))

    def probe(step: float) -> Array:
        """Joints after each phase, NaN where they run away."""
        return np.array([np.where(end[2 * N + 3] <= FASTEST, end[:N], np.nan) for end in ends(probes, step)])

    longest, error = _short_enough(probe, first_try, tolerance)
    found = ends(np.arange(len(joints)), longest)[-1]
    q, rates = found[:N].T, found[N : 2 * N].T
    tip_error = task_error(forward(arm.mechanism, tuple(q.T)), arm.task, there.target)
    steps = (phases[0].length(longest)[1], phases[1].length(longest)[1])
    _, peak, outside, speed, pivot = found[2 * N :]
    status = np.where(np.isfinite(found[: 2 * N]).all(axis=0) & (speed <= FASTEST), OK, DIVERGED)
    status = np.where(pivot > 0.0, status, INDEFINITE).astype(np.int8)
    size = np.asarray(phases[1].step.size(tuple(tip_error.T)))
    settled = (status == OK) & (size < SETTLED)
    return Runs(
        there, joints, varied, q, rates, tip_error,
        peak_error_m=np.where(status == OK, np.fmax(peak, size), np.nan),
        settling_time_s=np.where(settled, (outside + 1.0) * steps[1], np.nan),
        status=status, switch=switch, end=end, step=steps, step_error=error,
    )  # fmt: skip


def _inputs(plant: Plant, starts: Pose | ArrayLike, vary: dict[str, ArrayLike]) -> tuple[Array, dict[str, Array]]:
    """Arm joints (runs, n), and the varied values (runs,) of every run, checked."""
    arm = plant.arm
    joints = starts.q[arm.m :] if isinstance(starts, Pose) else finite_array("starts", starts)
    if joints.shape[-1:] != (arm.n,) or joints.ndim > 2:
        raise InputError(
            f"starts: shape {joints.shape}; {arm.n} arm joints are needed for each run, shape (runs, {arm.n})."
        )
    check_within("starts", joints, FARTHEST, "rad or m")
    known = {**parameters_of(arm), **OF_LOOP}
    varied = {}
    for name, values in vary.items():
        parameter = choose("parameter", name, known)
        varied[name] = array = finite_array(name, values)
        if array.ndim > 1:
            raise InputError(f"{name}: shape {array.shape}; one value for each run is needed, shape (runs,).")
        if array.size and array.min() < parameter.least:
            raise InputError(f"{name}: {array.min():g} {parameter.unit} is below {parameter.least:g}. Give more.")
    counts = {"starts": joints.shape[0]} if joints.ndim == 2 else {}
    counts |= {name: values.size for name, values in varied.items() if values.ndim == 1}
    if len(set(counts.values())) > 1:
        given = ", ".join(f"{count} of {name}" for name, count in counts.items())
        raise InputError(f"runs: {given}. Give as many of each.")
    runs = next(iter(counts.values()), 1)
    if runs == 0:
        raise InputError("runs: there are none. Give at least one start.")
    everywhere = {name: np.broadcast_to(values, (runs,)) for name, values in varied.items()}
    return np.broadcast_to(joints, (runs, arm.n)), everywhere


def _rests(plant: Plant, joints: Array) -> Array:
    """Where the base rests at each start, shape (runs, m)."""
    if not plant.arm.has_gravity:
        return np.tile(plant.arm.base.equilibrium, (len(joints), 1))
    different, which = np.unique(joints, axis=0, return_inverse=True)
    return np.array([static_base(plant.arm, one, plant.arm.base.equilibrium) for one in different])[which.ravel()]


def _probes(varied: dict[str, Array], runs: int) -> NDArray[np.intp]:
    """A few runs that stand for all: evenly spaced ones, and the extremes of what varies."""
    extremes = [int(find(values)) for values in varied.values() for find in (np.argmin, np.argmax)]
    return np.unique([*np.linspace(0, runs - 1, min(runs, PROBES)).astype(int), *extremes])


def _short_enough(probe: Callable[[float], Array], longest: float, tolerance: float) -> tuple[float, float]:
    """The longest step that is short enough for the probes, and what it costs them: the change by halving it."""
    coarse, error = probe(longest), np.inf
    for _ in range(REFINEMENTS):
        fine = probe(0.5 * longest)
        error = _difference(coarse, fine)
        if error <= tolerance and (not np.isnan(fine).any() or np.isfinite(_difference(fine, probe(longest / SURE)))):
            return longest, error
        longest, coarse = 0.5 * longest, fine
    warnings.warn(
        f"simulate_many: halving the step of {longest:.3g} s still moves a joint by {error:.2g}, more "
        f"than the tolerance of {tolerance:g}: the motion may be unstable. Give a larger tolerance or a shorter run.",
        FlexbaseWarning,
        stacklevel=3,
    )
    return longest, error


def _difference(one: Array, other: Array) -> float:
    """The largest, of the runs that neither sees run away; infinite where only one does."""
    if np.any(np.isnan(one) != np.isnan(other)):
        return float(np.inf)
    gaps = np.abs(one - other)
    return float(np.max(gaps[~np.isnan(gaps)], initial=0.0))

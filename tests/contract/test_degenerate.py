"""Degenerate robots, gains and clocks: every verb answers, or refuses in words; never numpy's own errors or noise."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flexbase as fb
from flexbase.cautions import collected
from flexbase.checks import is_definite
from flexbase.errors import Unsolvable
from flexbase.linear.discrete import riccati
from flexbase.linear.discrete.system import Discrete, feedback, hold, spectral_radius, static
from flexbase.linear.discrete.tustin import to_continuous, to_discrete
from flexbase.linear.second_order import StateSpace
from flexbase.model.files.project import parse_project
from flexbase.simulation.plants.builtin import solved
from flexbase.synthesis.methods.deflection import with_deflection

TURN: dict[str, Any] = {"length": 0.4, "mass": 3.0, "com": 0.2, "inertia": 0.05}
LIGHT = {**TURN, "mass": 1e-9, "inertia": 1e-12}


def slide(x: float, y: float) -> dict[str, Any]:
    return {**TURN, "type": "prismatic", "axis": [x, y]}


def project(
    links: list[dict[str, Any]],
    m: int = 1,
    rows: tuple[str, ...] = ("x", "y"),
    stiffness: float = 3e4,
    damping: float = 10.0,
    gravity: float = 0.0,
    gains: tuple[float, float] = (1e4, 200.0),
) -> str:
    lines = ['name = "degenerate"', f"gravity = [0.0, {gravity}, 0.0]", "[robot]"]
    for i, link in enumerate(links):
        lines += ["[[robot.links]]", f'joint = "q{i}"']
        lines += [f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value}" for key, value in link.items()]
    if m:
        lines += ["[base]", f"joints = {[f'q{i}' for i in range(m)]}"]
        lines += [f"stiffness = {[stiffness] * m}", f"damping = {[damping] * m}"]
    lines += ["[task]", f"rows = {list(rows)}", "[control]"]
    return "\n".join([*lines, f"stiffness = {[gains[0]] * len(rows)}", f"damping = {[gains[1]] * len(rows)}"])


ROBOTS = {
    "links without mass": project([TURN, LIGHT, LIGHT]),
    "all light, undamped": project([{**LIGHT, "com": 0.0, "inertia": 0.0}] * 3, stiffness=1e-5, damping=0.0),
    "a heavy base": project([{**TURN, "mass": 1e9, "inertia": 1e9}, LIGHT, LIGHT]),
    "nanometres": project([{"length": 1e-9, "mass": 1e-3, "com": 5e-10, "inertia": 1e-20}] * 3, stiffness=1e-15),
    "no lengths": project([{**TURN, "length": 0.0, "com": 0.0}] * 3),
    "parallel sliders": project([TURN, slide(1.0, 0.0), slide(1.0, 0.0)]),
    "almost parallel sliders": project([TURN, slide(1.0, 0.0), slide(1.0, 1e-7)]),
    "a slider under sliders": project([slide(1.0, 0.0), slide(1.0, 0.0), slide(0.0, 1.0)], damping=0.0),
    "a rigid base": project([TURN, TURN], m=0),
    "redundant": project([TURN] * 4),
    "twin bases, undamped": project([{**TURN, "length": 0.0, "com": 0.0}, *[TURN] * 3], m=2, damping=0.0),
    "no damping": project([TURN] * 3, damping=0.0),
    "a base that falls": project([TURN] * 3, gravity=9.81, stiffness=200.0),
    "huge gains": project([TURN] * 3, gains=(1e12, 1e12)),
    "no stiffness asked": project([TURN] * 3, gains=(0.0, 200.0)),
}


def load(robot: str) -> fb.Plant | None:
    with collected(quietly=True):
        return answered(lambda: fb.Plant(parse_project(ROBOTS[robot], "degenerate.toml")))


def answered(ask: Callable[[], Any]) -> Any:
    """The answer, or None where it is refused: in a sentence that ends."""
    with collected(quietly=True):
        try:
            return ask()
        except fb.FlexbaseError as fault:
            refusal = str(fault)
    assert refusal.endswith((".", "?")), refusal
    return None


def poses(plant: fb.Plant) -> Iterator[fb.Pose]:
    n = plant.arm.n
    for joints in (np.linspace(0.4, 1.3, n), np.r_[0.3, np.full(n - 1, 1e-7)], np.zeros(n)):
        pose = answered(lambda joints=joints: plant.at(joints))
        if pose is not None:
            yield pose


def gains(pose: fb.Pose) -> Iterator[fb.Gain | None]:
    """None, and gains at the edge of M - E > 0, beyond it, and beyond all reason."""
    Ms, eye = pose.Ms, np.eye(pose.arm.n)
    Ms, least = 0.5 * (Ms + Ms.T), np.linalg.eigvalsh(Ms)[0]
    yield None
    yield from (fb.Gain(E) for E in (Ms, (1.0 - 1e-13) * Ms, least * eye, -1e9 * eye, -1e300 * eye))


ABOUT_A_POSE: tuple[Callable[[fb.Pose, Any], Any], ...] = (
    lambda pose, loop: fb.modes(pose, loop).summary(),
    lambda pose, loop: fb.verdict(pose, loop).summary(),
    lambda pose, loop: fb.linearise(pose, loop).state_space(),
    lambda pose, loop: fb.linearise(pose, loop).transfer_function([0.0, 1j * fb.modes(pose).modes[0].frequency]),
    lambda pose, loop: fb.manipulability(pose, loop, "torque").summary(),
)


@pytest.mark.parametrize("robot", ROBOTS)
def test_every_verb_on_a_degenerate_robot(robot: str) -> None:
    plant = load(robot)
    for pose in [] if plant is None else poses(plant):
        for loop in gains(pose):
            for verb in ABOUT_A_POSE if pose.arm.m else ABOUT_A_POSE[:3]:
                answered(lambda pose=pose, loop=loop, verb=verb: verb(pose, loop))


@pytest.mark.parametrize("robot", ["no damping", "links without mass", "nanometres"])
def test_runs_that_begin_at_the_edge(robot: str) -> None:
    """The compensator acts from the start, where M - E may be singular: the run ends, or is refused."""
    plant = load(robot)
    assert plant is not None
    move = fb.Move(switch=1e-3, end=2e-3, interval=1e-3, compensate="always")
    for pose in poses(plant):
        for loop in gains(pose):
            answered(lambda pose=pose, loop=loop: fb.simulate(plant, pose, pose, loop, move=move).summary())


SIZE = st.floats(-9.0, 9.0).map(lambda power: 10.0**power)
LINK = st.fixed_dictionaries({"length": SIZE, "mass": SIZE, "com": SIZE, "inertia": SIZE})


@given(st.lists(LINK, min_size=3, max_size=4), SIZE, SIZE, st.lists(st.floats(-3.2, 3.2), min_size=3, max_size=3))
@settings(max_examples=40)
def test_sizes_over_eighteen_decades(links: list[dict[str, Any]], stiffness: float, damping: float, at: list[float]):
    text = project(links, stiffness=stiffness, damping=damping)
    pose = answered(lambda: fb.Plant(parse_project(text, "sizes.toml")).at(at[: len(links) - 1]))
    for loop in () if pose is None else gains(pose):
        for verb in ABOUT_A_POSE:
            answered(lambda loop=loop, verb=verb: verb(pose, loop))


CLOCKS = {
    "slow": {"rate": 2e-3},
    "fast": {"rate": 1e6},
    "no delay at all": {"compute_delay": 0, "task_delay": 0, "accelerometer_lag": 0.0},
    "late": {"compute_delay": 3, "task_delay": 6},
    "a slow sensor": {"task_every": 12, "compute_delay": 0},
    "a lag of years": {"accelerometer_lag": 1e6},
    "a filter at half the rate": {"acceleration": "encoders", "acceleration_filter": 499.9999},
    "a slow Kalman filter": {"acceleration": "kalman", "acceleration_filter": 1e-3},
    "drives of nothing": {"torque_limit": (1e-300, 1e-300), "torque_slew": (1e-300, 1e-300)},
}


@pytest.mark.parametrize(("robot", "clock"), [*(("no damping", one) for one in CLOCKS), ("a base that falls", "slow")])
def test_sampled_loops_of_any_clock(robot: str, clock: str) -> None:
    plant, sensing = load(robot), fb.Sensing(**CLOCKS[clock])
    assert plant is not None
    pose = answered(lambda: plant.at([0.4, 1.3]))
    if pose is None:
        return
    for loop in (None, fb.Gain(0.3 * pose.Mhat), fb.Gain(pose.Ms), fb.Gain(-1e6 * pose.Mhat)):
        made = answered(lambda loop=loop: fb.make_controller(pose, loop=fb.Loop(loop, sensing=sensing)))
        if made is not None:
            answered(lambda made=made: fb.hardware_verdict(made, brief=True).to_dict())
            answered(lambda made=made: fb.simulate_sampled(made, move=fb.SampledMove(end=16.0 / sensing.rate)))
    made = answered(lambda: fb.make_controller(pose, "lqg", fb.Loop(sensing=sensing)))
    if made is not None:
        answered(lambda: fb.hardware_verdict(made, brief=True))


# --- each fault by itself ---


@pytest.fixture(scope="module")
def pose() -> fb.Pose:
    return fb.load("ueda2003").at([0.4, 1.3])


@pytest.mark.parametrize("verb", ABOUT_A_POSE)
def test_a_gain_that_leaves_no_inertia_to_rounding(pose: fb.Pose, verb: Callable[..., Any]) -> None:
    """E = Ms makes M - E singular; its smallest eigenvalue is rounding, of either sign."""
    with pytest.raises(fb.InputError, match="M - E is not positive definite"):
        verb(pose, fb.Gain(pose.Ms))


def test_definite_whatever_the_units() -> None:
    """Rows in other units change no answer; what is left of a difference is judged by what it came from."""
    M = np.array([[2.0, 1.0], [1.0, 2.0]])
    unit = np.diag([1e-9, 1e9])
    assert is_definite(M)
    assert is_definite(unit @ M @ unit)
    assert not is_definite(unit @ np.ones((2, 2)) @ unit)
    assert is_definite(1e-18 * M)
    assert not is_definite(1e-18 * M, M)


def test_a_pole_is_no_place_for_a_response(pose: fb.Pose) -> None:
    with pytest.raises(fb.InputError, match=r"frequency: .*0.* is a pole"):
        fb.linearise(pose).transfer_function([1j, 0.0])
    with pytest.raises(fb.InputError, match="is a pole"):
        Discrete(np.eye(1), np.eye(1), np.eye(1), np.zeros((1, 1)), 1e-3).transfer_function(np.zeros(1))


def test_an_algebraic_loop_of_gain_one() -> None:
    with pytest.raises(Unsolvable, match="depend on itself"):
        feedback(static(np.eye(2), 1e-3), static(np.diag([0.5, 1.0]), 1e-3))


def test_a_pole_at_half_the_rate_has_no_continuous_image() -> None:
    flips = Discrete(-np.eye(1), np.eye(1), np.eye(1), np.zeros((1, 1)), 1e-3)
    with pytest.raises(Unsolvable, match="half the sampling rate"):
        to_continuous(flips)
    with pytest.raises(Unsolvable, match="half the sampling rate"):
        to_discrete(StateSpace(np.eye(1), np.eye(1), np.eye(1), np.zeros((1, 1))), 1e-3)


@pytest.mark.parametrize("solve", [riccati.continuous, riccati.discrete])
def test_a_riccati_equation_without_solution(solve: Callable[..., Any]) -> None:
    """An unstable state that nothing drives."""
    eye = np.eye(1)
    with pytest.raises(Unsolvable, match="Riccati"):
        solve(2.0 * eye, 0.0 * eye, eye, eye)


def test_a_plant_that_runs_away_in_a_sample() -> None:
    with pytest.raises(Unsolvable, match="sample of 1000 s the plant runs away"):
        hold(StateSpace(np.eye(1), np.eye(1), np.eye(1), np.zeros((1, 1))), 1e3)


def test_what_overflows_does_not_die_out() -> None:
    assert spectral_radius(np.array([[np.nan, 0.0], [0.0, 0.5]])) == np.inf


def test_a_trial_step_at_a_singular_inertia(pose: fb.Pose) -> None:
    """The state is NaN there, so that an integrator shortens its step; its neighbours in a batch have their answer."""
    inertia = np.stack([pose.M, pose.M])
    E, force = np.diag([0.0, 0.0]), np.ones((2, 3))
    inertia[0, :, 2] = inertia[0, 2, :] = 0.0
    found = solved(pose.arm, np.moveaxis(inertia, 0, 2), force, E)
    assert np.isnan(found[0]).all()
    assert found[1] == pytest.approx(np.linalg.solve(pose.M, force[1]), rel=1e-12)  # the same solver, three unknowns


def test_a_drift_is_not_stable() -> None:
    """Nothing damps this arm's self-motion: a radius of 1, which rounding puts on either side."""
    plant = load("redundant")
    assert plant is not None
    found = fb.hardware_verdict(fb.make_controller(plant.at([0.4, 0.85, 1.3]), "notch"), brief=True)
    assert not found.stable


def test_a_design_whose_inertia_is_lost_to_rounding() -> None:
    plant = load("links without mass")
    assert plant is not None
    with collected(quietly=True):
        there = plant.at([0.3, 1e-7])
        target = 1e6 * fb.modes(there)[0].frequency
        with pytest.raises(fb.Infeasible, match="no inertia in some direction"):
            fb.design(there, "exact", natural_frequency=target)


def test_the_deflection_law_needs_less_than_the_free_inertia(pose: fb.Pose) -> None:
    """E = Ms exactly, where rounding leaves it singular: an identity."""
    assert pose.arm.gains is not None
    answered(lambda: with_deflection(pose, fb.Sensing(), pose.arm.gains, pose.Ms))


@pytest.mark.parametrize("method", ["lqg", "coprime", "robust"])
def test_a_task_without_stiffness_in_a_direction(method: str) -> None:
    plant = load("no stiffness asked")
    assert plant is not None
    with pytest.raises(fb.Infeasible, match="zero in some direction"):
        fb.make_controller(plant.at([0.4, 1.3]), method, fb.Loop(gains=fb.Gains([0.0, 1e4], [0.0, 0.0])))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"rate": 1e-9}, "rate: 1e-09 must be above 0.001"),
        ({"accelerometer_lag": 1e-300}, "accelerometer_lag: 1e-300 s is below 1e-09 s. Give 0."),
        ({"acceleration": "kalman", "acceleration_filter": 1e-6}, "a millionth of the rate"),
        ({"encoder_counts": 1e-300}, "encoder_counts: 1e-300 must be above 0.001"),
    ],
)
def test_sensing_below_what_numbers_bear(pose: fb.Pose, given: dict[str, Any], said: str) -> None:
    with pytest.raises(fb.InputError, match=said):
        fb.make_controller(pose, loop=fb.Loop(sensing=fb.Sensing(**given)))


def test_a_gain_beyond_all_numbers(pose: fb.Pose) -> None:
    with pytest.raises(fb.InputError, match=r"compensator E: -1e.300 is beyond the largest value that is read, 1e.100"):
        fb.modes(pose, fb.Gain(-1e300 * np.eye(2)))


def test_a_sweep_without_modes_has_a_summary() -> None:
    """A rigid base: values of modes have no entries at all."""
    plant = load("a rigid base")
    assert plant is not None
    found = answered(lambda: fb.sweep(plant, ["frequency"], cells=fb.Cells(shape=(3, 3))))
    assert found is None or "nan" not in fb.summary(found).lower()

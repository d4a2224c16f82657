"""[sensing] of a project file: what is read, what is refused; estimators of the acceleration."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal

import flexbase as fb
from flexbase.errors import InputError
from flexbase.model.files.project import parse_project
from flexbase.model.files.sensing_table import samples_between
from flexbase.model.sensing import TYPICAL, Sensing, checked_sensing
from flexbase.sampled.controller import acceleration_estimator
from flexbase.synthesis import controller_for
from systems.planar import PAPER

FULL = """
[sensing]
rate = 2000
task_rate = 500.0
compute_delay = 2
task_delay = 3
encoder_counts = 65536
acceleration = "kalman"
accelerometer_lag = 1e-3
acceleration_filter = 150.0
acceleration_noise = 0.2
task_noise = 1e-6
torque_limit = [150, 80.0]
torque_slew = [2e4, 1e4]
"""


def read(table: str) -> Sensing | None:
    return parse_project(PAPER + table, "arm.toml").sensing


def test_every_key_is_read() -> None:
    assert read(FULL) == Sensing(2000.0, 4, 2, 3, 65536.0, "kalman", 1e-3, 150.0, 0.2, 1e-6, (150.0, 80.0), (2e4, 1e4))


def test_nothing_declared_and_nothing_given() -> None:
    """No table: None, not the typical one. An empty table declares the typical one."""
    assert read("") is None
    assert read("[sensing]\n") == TYPICAL


FAULTS = {
    "misspelt": ("rat = 1000.0", ["[sensing] rat", 'Did you mean "rate"?']),
    "rate": ("rate = 0.0", ["[sensing] rate", "above 0"]),
    "text": ('rate = "1 kHz"', ["[sensing] rate", "1 kHz", "without quotes"]),
    "infinite": ("rate = inf", ["[sensing] rate", "not finite"]),
    "half a sample": ("compute_delay = 0.5", ["[sensing] compute_delay", "0.5"]),
    "negative delay": ("task_delay = -1", ["[sensing] task_delay", "-1", "0 or more"]),
    "long delay": ("task_delay = 1000", ["[sensing] task_delay", "1000", "50 or less"]),
    "no whole number": ("task_rate = 300.0", ["[sensing] task_rate", "300 Hz", "1000 Hz", "333.333"]),
    "faster than the rate": ("task_rate = 4000.0", ["[sensing] task_rate", "4000 Hz", "such as 1000"]),
    "both": ("task_rate = 500.0\ntask_every = 2", ["[sensing] task_rate", "task_every", "Give one"]),
    "source": ('acceleration = "gyro"', ["[sensing] acceleration", '"gyro"', "'kalman'"]),
    "one limit": ("torque_limit = [100.0]", ["[sensing] torque_limit", "1 value given, 2 needed"]),
    "zero limit": ("torque_limit = [100.0, 0.0]", ["[sensing] torque_limit", "0 N m", "above 0"]),
    "slew as text": ('torque_slew = ["fast", "slow"]', ["[sensing] torque_slew", "fast", "not a number"]),
    "filter": (
        'acceleration = "encoders"\nacceleration_filter = 600.0',
        ["[sensing] acceleration_filter", "600 Hz", "half the rate, 500 Hz"],
    ),
    "lag": ("accelerometer_lag = -1e-3", ["[sensing] accelerometer_lag", "-0.001"]),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_names_place_value_and_mend(fault: str) -> None:
    line, words = FAULTS[fault]
    with pytest.raises(InputError) as found:
        read(f"[sensing]\n{line}\n")
    message = str(found.value)
    assert message.startswith("arm.toml, ")
    assert "\n" not in message
    for word in words:
        assert word in message, message


def test_made_by_hand_is_checked_too(paper_pose: fb.Pose) -> None:
    """The same bounds hold where no file is read."""
    for wrong in (Sensing(rate=-1.0), Sensing(task_every=0), Sensing(compute_delay=True), Sensing(torque_limit=(1.0,))):
        with pytest.raises(InputError, match="sensing, "):
            controller_for(paper_pose, "none", wrong)
    with pytest.raises(InputError, match="half the rate"):
        checked_sensing(Sensing(rate=300.0, acceleration="kalman"), 2)
    assert samples_between(1000.0, 1000.0 / 3.0, "x") == 3


def test_the_projects_own_sensing_is_used() -> None:
    pose = fb.Plant(parse_project(PAPER + FULL, "arm.toml")).at_tip([0.33, -0.25])
    assert controller_for(pose, "none").sensing.rate == 2000.0
    assert controller_for(pose, "none", Sensing(rate=500.0)).sensing.rate == 500.0


def responses(sensing: Sensing, hertz: np.ndarray) -> np.ndarray:
    """Estimate over true acceleration of q = exp(j omega t)."""
    omega = 2.0 * np.pi * hertz
    return acceleration_estimator(2, sensing).transfer_function(omega)[:, 1, 1] / -(omega**2)


def test_kalman_filter_is_a_butterworth_of_its_corner() -> None:
    """Random-walk acceleration, white measurement noise: s^2 times a third-order Butterworth filter. What a sample
    changes is of first order in the corner over the rate: 8 % at 100, 0.8 % at 1000 (seen at 120 Hz)."""
    corner = 50.0
    hertz = np.array([1.0, 20.0, 50.0, 120.0])
    _, expected = scipy.signal.freqs(*scipy.signal.butter(3, corner, analog=True), worN=hertz)
    found = responses(Sensing(rate=100.0 * corner, acceleration="kalman", acceleration_filter=corner), hertz)
    np.testing.assert_allclose(found, expected, rtol=0.09)
    finer = responses(Sensing(rate=1000.0 * corner, acceleration="kalman", acceleration_filter=corner), hertz)
    np.testing.assert_allclose(finer, expected, rtol=9e-3)
    assert abs(finer[2]) == pytest.approx(np.sqrt(0.5), rel=2e-3)


def test_kalman_filter_beats_its_neighbours_on_its_own_noise() -> None:
    """Optimal: on simulated random-walk acceleration its error is smaller than that of filters of other bandwidths."""
    h, corner, rng = 1e-3, 40.0, np.random.default_rng(3)
    steps = 60_000
    ratio = (2.0 * np.pi * corner) ** 6 * h  # process density over that of measurement noise of variance 1
    jerk = rng.normal(size=steps) * np.sqrt(ratio / h)
    q, v, a = np.zeros(steps), 0.0, 0.0
    truth, place = np.zeros(steps), 0.0
    for i in range(steps):
        place += h * v + h * h / 2.0 * a + h**3 / 6.0 * jerk[i]
        v += h * a + h * h / 2.0 * jerk[i]
        a += h * jerk[i]
        q[i], truth[i] = place, a
    measured = q + rng.normal(size=steps)

    def error(bandwidth: float) -> float:
        one = acceleration_estimator(1, Sensing(1.0 / h, acceleration="kalman", acceleration_filter=bandwidth))
        states = scipy.signal.dlsim((one.A, one.B, one.C, one.D, h), measured - measured[0])[1][:, 0]
        return float(np.sqrt(np.mean((states - truth)[2000:] ** 2)))

    assert error(corner) < min(error(0.8 * corner), error(1.25 * corner))


def test_differences_are_the_filtered_second_difference() -> None:
    """Against their definition, sample by sample: a low-pass of (q - 2 q' + q'')/h^2."""
    sensing = Sensing(acceleration="encoders", acceleration_filter=120.0)
    h, p = 1e-3, np.exp(-2.0 * np.pi * 120.0 * 1e-3)
    q = np.random.default_rng(0).normal(size=50)
    one = acceleration_estimator(1, sensing)
    _, found, _ = scipy.signal.dlsim((one.A, one.B, one.C, one.D, h), q)
    padded = np.concatenate([[0.0, 0.0], q])
    rough = (padded[2:] - 2.0 * padded[1:-1] + padded[:-2]) / h**2
    expected = scipy.signal.lfilter([1.0 - p], [1.0, -p], rough)
    np.testing.assert_allclose(found[:, 0], expected, rtol=1e-9, atol=1e-6)

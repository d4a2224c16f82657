"""What the one door makes of a loop that is asked for: whose gains, whose sensing, which compensator."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.model.loop import loop_on

OWN, OTHER = fb.Sensing(rate=2000.0), fb.Sensing(rate=500.0)
GAINS = fb.Gains([2e4, 3e4], [600.0, 700.0])


class Made:
    """What a design returns, as far as the door looks."""

    def __init__(self, E, robot="ueda2003", q=(0.0, 0.5, 0.7), method="exact"):
        self.E, self.robot, self.q, self.method = np.array(E), robot, np.array(q), method


def test_nothing_asked_is_the_projects_own(paper):
    arm = replace(paper.arm, sensing=OWN)
    spec = loop_on(arm)
    assert (spec.name, spec.E, spec.designed_at) == ("none", None, None)
    assert spec.gain.tolist() == [[0.0, 0.0], [0.0, 0.0]]
    assert (spec.gains, spec.sensing, spec.declared) == (arm.gains, OWN, True)
    spec.check_bare()


def test_a_sensing_that_nobody_declared_is_typical(paper):
    spec = loop_on(replace(paper.arm, sensing=None))
    assert (spec.sensing, spec.declared) == (fb.Sensing(), False)


def test_what_is_asked_goes_first(paper):
    spec = loop_on(replace(paper.arm, sensing=OWN), fb.Loop(gains=GAINS, sensing=OTHER))
    assert (spec.sensing, spec.declared) == (OTHER, True)
    assert np.array_equal(spec.gains.stiffness, np.diag([2e4, 3e4]))
    assert np.array_equal(spec.gains.damping, np.diag([600.0, 700.0]))


@pytest.mark.parametrize("wrapped", [False, True])
def test_a_compensator_alone_is_a_loop_of_it(paper, wrapped):
    made = Made([[0.1, 0.02], [0.02, 0.2]])
    spec = loop_on(paper.arm, fb.Loop(made) if wrapped else made)
    assert (spec.name, spec.designed_at.tolist()) == ("exact", [0.5, 0.7])
    assert np.array_equal(spec.E, made.E)
    assert np.array_equal(spec.gain, made.E)
    with pytest.raises(fb.InputError, match="a compensator is given too"):
        spec.check_bare()


def test_a_bare_gain_has_no_method_and_no_place(paper):
    spec = loop_on(paper.arm, fb.Gain(np.eye(2)))
    assert (spec.name, spec.designed_at) == ("compensator", None)
    assert loop_on(paper.arm, Made(np.eye(2), q=[0.5, 0.7])).designed_at is None  # of an arm with other joints


def test_another_robots_compensator_is_said(paper):
    with pytest.warns(fb.FlexbaseWarning, match='designed for "panda", used on "ueda2003"'):
        loop_on(paper.arm, Made(np.eye(2), robot="panda"))


def test_scaled_gains_keep_the_damping_ratio(paper):
    """Four times as stiff is twice as damped."""
    scaled = loop_on(paper.arm, fb.Loop(gains=GAINS)).scaled(4.0)
    assert np.array_equal(scaled.stiffness, 4.0 * np.diag([2e4, 3e4]))
    assert np.array_equal(scaled.damping, 2.0 * np.diag([600.0, 700.0]))


def test_without_task_gains_the_mend_is_named(paper):
    with pytest.raises(fb.InputError, match=r"ueda2003: no task gains\. Add a \[control\] table"):
        _ = loop_on(replace(paper.arm, gains=None)).gains

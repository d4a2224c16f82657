"""When a design's certificate cautions, and in which words: each bound from both sides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.compensators.judge import certificate
from flexbase.compensators.judge.certificate import certify
from systems.planar import PAPER_TIP, planar

SMALL = 1e-3 * np.eye(2)


@pytest.mark.parametrize(("residual", "said"), [(None, None), (1e-3, None), (1.1e-3, "0.11"), (0.25, "25")])
def test_a_miss_of_a_thousandth_deserves_a_word(paper_pose, residual, said):
    found = certificate._cautions_of_targets(residual)
    assert found == () if said is None else f"misses its targets by {said} %" in found[0]


def test_a_methods_own_words_take_the_place_of_the_general_ones(paper_pose):
    for own, said in (((), "misses its targets by 50 %"), (("of its own",), "of its own")):
        with pytest.warns(fb.FlexbaseWarning, match=said):
            found = certify(paper_pose, "exact", SMALL, target_residual=0.5, cautions=own)
        assert len(found.certificate.warnings) == 1
        assert said in found.certificate.warnings[0]
    assert certify(paper_pose, "exact", SMALL).certificate.warnings == ()


@pytest.mark.parametrize(
    ("rho", "mu", "said"),
    [
        (0.999, 0.999, None),
        (1.0, 1.0, "algebraic-loop radius 1.000 is 1 or more"),
        (2.5, 3.0, "algebraic-loop radius 2.500 is 1 or more"),
        (0.9, 1.0, "radius 1.000 with unequal delays is 1 or more"),
        (0.9, 4.0, "radius 4.000 with unequal delays is 1 or more: give all joints the same delay (radius 0.900)"),
    ],
)
def test_radii_from_one_up(rho, mu, said):
    found = certificate._cautions_of_loop(rho, mu)
    assert found == () if said is None else said in found[0]
    assert len(found) == (said is not None)


@pytest.mark.parametrize(("left", "cautioned"), [(0.0101, False), (0.0099, True)])
def test_a_hundredth_of_the_inertia_is_nearly_singular(paper_pose, left, cautioned):
    """E takes all but a part of the lightest direction, found by its Rayleigh quotient on the whole of M."""
    lightest = float(np.linalg.eigvalsh(paper_pose.M)[0])

    def smallest(size):
        inertia = paper_pose.M.copy()
        inertia[1:, 1:] -= size * np.eye(2)
        return float(np.linalg.eigvalsh(inertia)[0])

    low, high = 0.0, 10.0 * lightest
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if smallest(middle) > left * lightest else (low, middle)
    found = certificate._cautions_of_inertia(paper_pose, low * np.eye(2))
    assert bool(found) == cautioned
    assert not cautioned or "M - E is nearly singular" in found[0]


def test_arms_that_the_equations_leave_out_are_told_so(paper_pose):
    assert certificate._cautions_of_arm(paper_pose) == ()
    one, two = (planar([0.3] * (n + 1), rows=("x", "y")).at(np.linspace(0.4, 1.2, n)) for n in (3, 4))
    assert "1 self-motion, damped" in certificate._cautions_of_arm(one)[0]
    assert "2 self-motions, damped" in certificate._cautions_of_arm(two)[0]
    heavy = planar([0.3, 0.25, 0.2], gravity=(1.0, 0.0, 0.0)).at([0.4, 0.9])
    assert "gravity stiffness and joint friction are left out" in certificate._cautions_of_arm(heavy)[0]


def test_without_task_gains_there_is_no_closed_loop(paper):
    bare = fb.Plant(replace(paper.arm, gains=None)).at_tip(PAPER_TIP)
    found = certify(bare, "exact", SMALL)
    assert (found.certificate.lag_margin_s, found.certificate.closed_loop_abscissa) == (None, None)
    closed = certify(bare, "exact", SMALL, loop=fb.Loop(gains=paper.arm.gains)).certificate
    assert closed == certify(paper.at_tip(PAPER_TIP), "exact", SMALL).certificate
    assert closed.closed_loop_abscissa is not None


def test_a_history_is_kept(paper_pose):
    assert certify(paper_pose, "exact", SMALL).history == {}
    history = {"robustness": np.arange(3.0)}
    assert certify(paper_pose, "exact", SMALL, history=history).history is history

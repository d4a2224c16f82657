"""What an exact verdict says of figures that are given: intervals with and without their ends, shortages, indices."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb

SLIGHT, MUCH = 0.9e-8, 1.1e-8  # relative skew parts: below 1e-8 they count as rounding [theory §5]


@pytest.fixture(scope="module")
def verdict(paper_pose):
    return fb.verdict(paper_pose)


@pytest.mark.parametrize(
    ("fails_at", "skew_low", "bandwidth", "skew_high", "said"),
    [
        ((), MUCH, None, MUCH, "nowhere"),
        (((1.0, 2.0),), SLIGHT, None, SLIGHT, "1 to 2 rad/s"),
        (((1.0, 2.0),), None, None, SLIGHT, "1 to 2 rad/s"),
        (((1.0, 2.0),), MUCH, None, SLIGHT, "0 to 2 rad/s"),
        (((1.0, 2.0),), SLIGHT, None, MUCH, "1 to all above rad/s"),
        (((1.0, 2.0),), SLIGHT, 50.0, MUCH, "1 to 2 rad/s"),
        (((1.0, 2.0),), MUCH, 50.0, MUCH, "0 to 2 rad/s"),
        (((1.0, 2.0),), MUCH, None, MUCH, "at all frequencies"),
        (((1.0, 2.0), (3.0, 4.0)), MUCH, None, MUCH, "0 to 2, 3 to all above rad/s"),
        (((1.23456789, 2.0), (3.0, 4.0)), SLIGHT, None, SLIGHT, "1.2346 to 2, 3 to 4 rad/s"),
    ],
)
def test_where_it_fails(verdict, fails_at, skew_low, bandwidth, skew_high, said):
    """A skew part that is more than rounding proves failure to the very end; a bandwidth has no end above it."""
    told = replace(verdict, fails_at=fails_at, skew_low=skew_low, bandwidth=bandwidth, skew_high=skew_high)
    assert told.failing_in_words() == said


def test_how_far(verdict):
    told = replace(verdict, shortage=-0.0, relative_shortage=-0.0)
    assert told.in_words() == "0 m/(N s), 0 % of the largest gain"
    told = replace(verdict, shortage=0.00123456789, relative_shortage=0.25)
    assert told.in_words() == "0.00123456789 m/(N s), 25 % of the largest gain"
    assert replace(verdict, shortage=np.inf).in_words() == "without bound"


def test_where_it_is_half(verdict):
    assert replace(verdict, half_at=()).half_in_words() == "nowhere"
    assert replace(verdict, half_at=((1.0, 2.0), (3.0, 4.5))).half_in_words() == "1 to 2, 3 to 4.5 rad/s"


def test_the_sheet_turns_with_each_figure(verdict):
    """Each fact as given, and again with the figure on its other side."""
    shown = {
        "Not positive real": {"positive_real": False},
        "without compensator": {"compensated": False},
        "with compensator": {"compensated": True},
        "up to 50 rad/s": {"bandwidth": 50.0},
        "open": {"output_index": None},
        "none: no feedback of the velocity makes it passive": {"output_index": -np.inf},
        "0.125": {"output_index": 0.125},
        "yes": {"negative_imaginary": True},
        "no": {"negative_imaginary": False},
        "7 rad/s": {"worst_at": 7.0, "half_at": ((6.0, 8.0),)},
        "6 to 8 rad/s": {"half_at": ((6.0, 8.0),)},
        "3 to 4 rad/s": {"fails_at": ((3.0, 4.0),), "skew_low": None, "skew_high": 0.0},
    }
    for words, figures in shown.items():
        assert words in replace(verdict, **figures).summary(), words
    assert "Not positive" not in replace(verdict, positive_real=True).summary()
    assert "up to" not in replace(verdict, bandwidth=None).summary()
    for words, figures in (("fails", {"fails_at": ()}), ("worst at", {"half_at": ()}), ("half of it", {"half_at": ()})):
        assert words not in replace(verdict, **figures).summary()
    assert "x 0.33 m, y -0.25 m" in verdict.summary()


def test_a_system_without_a_pose_is_a_system(verdict):
    told = replace(verdict, pose=None)
    assert told.name == "system"
    assert (verdict.name, verdict.compensated) == ("ueda2003", False)
    assert "q" not in told.to_dict()
    assert {"q", "tip"} <= set(verdict.to_dict())


def test_a_system_has_no_compensator(paper_pose):
    found = fb.verdict(fb.linearise(paper_pose))
    assert (found.name, found.compensated, found.positive_real) == ("system", False, False)

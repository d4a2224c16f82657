"""Exact verdicts on the smallest systems, where every figure is known by hand."""

from __future__ import annotations

import numpy as np
import pytest

import flexbase as fb
from flexbase.linear.passivity import judge


def small(M=1.0, D=0.0, K=0.0, b=1.0, c=1.0):
    """m q'' + d q' + k q = b f, y = c q."""
    parts = [np.array([[float(value)]]) for value in (M, D, K, b, c)]
    return fb.SecondOrder(*parts, ("q",), ("f",), ("y",))


def test_a_braked_mass_in_a_band():
    """G = 1/(s + 1), Re G = 1/(1 + w^2): at least a half up to 1 rad/s, so nothing is short; largest at rest."""
    found = fb.verdict(small(D=1.0), bandwidth=1.0)
    assert (found.positive_real, found.shortage, found.relative_shortage) == (True, 0.0, 0.0)
    assert found.input_index == pytest.approx(0.5, rel=1e-6)
    assert found.largest_gain == pytest.approx(1.0, rel=1e-6)
    assert (found.bandwidth, found.fails_at, found.half_at, found.worst_at) == (1.0, (), (), None)


def test_what_does_not_answer_lacks_nothing():
    found = fb.verdict(small(D=1.0, K=1.0, c=0.0))
    assert (found.positive_real, found.shortage, found.relative_shortage, found.largest_gain) == (True, 0.0, 0.0, 0.0)
    assert found.output_index == 0.0


def test_pushed_one_way_and_seen_the_other():
    """G = -s/(s^2 + s + 1): Re G is least at resonance, -1 there, and half of it where w = |1 - w^2|."""
    found = fb.verdict(small(D=1.0, K=1.0, c=-1.0))
    assert (found.positive_real, found.compensated) == (False, False)
    assert found.shortage == pytest.approx(-1.0, rel=1e-9)
    assert found.relative_shortage == pytest.approx(-1.0, rel=1e-9)
    assert found.worst_at == pytest.approx(1.0, rel=1e-4)  # a flat minimum: half of its digits
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    assert found.half_at == (pytest.approx((golden - 1.0, golden), rel=1e-6),)


@pytest.mark.parametrize("K", [-0.01, -25.0])
def test_what_tips_over_has_no_bound(K):
    """Slowly or fast: q'' = |K| q grows at its root."""
    found = fb.verdict(small(K=K))
    assert (found.positive_real, found.shortage, found.input_index, found.output_index) == (False, *3 * (-np.inf,))
    assert f"falls, at a rate of about {np.sqrt(-K):.3g} 1/s" in found.caveats[0]


@pytest.mark.parametrize(("c", "positive"), [(1.0, True), (-1.0, False)])
def test_an_undamped_one_is_judged_by_its_residue(c, positive):
    found = fb.verdict(small(K=4.0, c=c))
    assert (found.positive_real, found.undamped) == (positive, (pytest.approx(2.0),))
    assert found.output_index == (0.0 if positive else -np.inf)
    assert ("judged by their residues" in found.caveats[0]) == positive
    assert found.fails_at == (() if positive else ((pytest.approx(2.0), pytest.approx(2.0)),))
    outside = fb.verdict(small(K=4.0, c=c), bandwidth=1.9)
    assert outside.positive_real  # below 2 rad/s it has a reactance only
    assert outside.shortage == 0.0


def test_a_mass_pushed_one_way_and_seen_the_other_fails_at_rest():
    found = fb.verdict(small(c=-1.0))
    assert (found.positive_real, found.shortage, found.worst_at) == (False, -np.inf, 0.0)
    assert "The rigid motion R0 is not symmetric" in found.caveats[0]


def test_a_compensator_is_told(paper_pose):
    assert not fb.verdict(paper_pose).compensated
    assert fb.verdict(paper_pose, fb.Gain(np.zeros((2, 2)))).compensated


class Port:
    """Responses at three resonances, the second with a part of it missing, the third not seen at all."""

    def __init__(self, missing):
        self.missing = missing

    def seeds(self):
        return np.array([3.0, 50.0, 60.0])

    def largest_singular_value(self, omega):
        return np.array([1.0, 0.5, 0.0])[: len(omega)]

    def least_eigenvalue(self, omega):
        return np.array([0.0, -0.5 * self.missing, 0.0])[: len(omega)]


@pytest.mark.parametrize(("missing", "said"), [(0.9e-6, False), (1.1e-6, True), (0.01, True)])
def test_a_millionth_of_a_resonance_deserves_a_word(missing, said):
    found = judge._hidden(Port(missing), 3.0, (0.0, np.inf))
    assert bool(found) == said
    if said:
        assert (
            f"resonance at 3 rad/s: near 50 rad/s, {100.0 * missing:.2g} % of the response there is missing" in found[0]
        )
    assert judge._hidden(Port(missing), 3.0, (0.0, 49.0)) == ()
    assert judge._hidden(Port(missing), 3.0, (0.0, 1.0)) == ()


def test_a_shortage_beside_a_high_resonance_is_told():
    """s/(s^2 + 1e-3 s + 1) - 1e-6 s/(s^2 + s + 2500): 6e-7 short at 50 rad/s, against a thousand at 1 rad/s."""
    one, pair = np.eye(2), ("q", "r")
    parts = (one, np.diag([1e-3, 1.0]), np.diag([1.0, 2500.0]), np.array([[1.0], [1e-3]]), np.array([[1.0, -1e-3]]))
    found = fb.verdict(fb.SecondOrder(*parts, pair, ("f",), ("y",)))
    assert found.positive_real
    assert 1e-10 < -found.relative_shortage < 1e-8
    assert "Within the tolerance only beside the resonance at 1 rad/s: near 50" in found.caveats[0]


def test_what_is_not_positive_real_needs_no_such_word():
    assert fb.verdict(small(D=1.0, K=1.0, c=-1.0)).caveats == ()


def test_a_search_that_did_not_settle_is_told(monkeypatch):
    search = judge.input_index
    assert fb.verdict(small(D=1.0, K=1.0)).caveats == ()
    monkeypatch.setattr(judge, "input_index", lambda *asked: search(*asked)._replace(settled=False))
    assert "did not settle" in fb.verdict(small(D=1.0, K=1.0)).caveats[0]


@pytest.mark.parametrize("damping", [0.25, 4.0])
def test_the_output_index_is_the_damping(damping):
    """Re 1/G = Re (s + d + 1/s) = d at every frequency."""
    assert fb.verdict(small(D=damping, K=1.0)).output_index == pytest.approx(damping, rel=1e-6)


def test_a_residue_misses_by_more_than_rounding():
    """diag(1, -x) misses x of its size, and 1e-8 counts as rounding [theory §5]."""
    for missing, fails in ((0.9e-8, False), (1.1e-8, True)):
        assert judge._misses(np.diag([1.0, -missing])) == fails
    assert not judge._misses(np.zeros((2, 2)))


def test_at_rest_there_is_no_skew_part_without_springs():
    assert fb.verdict(small(D=1.0, K=0.25)).skew_low == 0.0
    assert fb.verdict(small(D=1.0)).skew_low is None


def test_what_else_is_counted_or_left_out(paper_pose):
    good = fb.verdict(small(D=1.0, K=1.0))
    bad = fb.verdict(small(D=1.0, K=1.0, c=-1.0))
    assert judge._cautions(None, None) == judge._cautions(paper_pose, None) == ()
    assert judge._cautions(None, good)[0].endswith("of the base alone: positive real.")
    assert "of the base alone: not positive real, shortage -1 m/(N s)" in judge._cautions(None, bad)[0]
    redundant = fb.load("iiwa-platform").at(np.full(7, 0.4))
    assert [text.partition(":")[0] for text in judge._cautions(redundant, None)] == ["Redundant arm"]


def test_no_inertia_is_refused():
    with pytest.raises(fb.InputError, match="is no inertia"):
        fb.verdict(small(M=0.0, D=1.0))

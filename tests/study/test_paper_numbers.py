"""The numbers behind the paper's figures, against theory §9 and against independent computations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flexbase as fb
from flexbase.measures.manipulability import Ellipsoid, Manipulability
from flexbase.model.loop import Gain
from flexbase.study import paper
from flexbase.study.paper import ellipses, printed
from flexbase.sweeps.engine.status import INDEFINITE, OK
from systems.planar import planar

FIRST = np.array([[0.142473, 0.047450], [0.047450, -0.103979]])  # theory §9: 800 iterations with exact slopes
LEAST = np.array([[0.164677, 0.016120], [0.016120, -0.059773]])  # theory §9: least gain


@pytest.fixture(scope="module")
def case() -> paper.Example:
    return paper.example()


@pytest.fixture(scope="module")
def shaped(case) -> paper.Shaping:
    return paper.shaping(case.pose)


@pytest.fixture(scope="module")
def settled(case, shaped) -> paper.Settling:
    return paper.settling(case.plant, shaped.recursion)


@pytest.fixture(scope="module")
def without(case) -> paper.RobustnessMap:
    return paper.robustness_map(case.plant, shape=(61, 181))


@pytest.fixture(scope="module")
def compensated(case, shaped) -> paper.RobustnessMap:
    return paper.robustness_map(case.plant, shaped.recursion, shape=(61, 181))


def test_the_recursion_ends_where_theory_says(shaped):
    """Estimated slopes end 1e-5 from those of exact slopes: their step is 1e-5 of the arm's inertia."""
    assert pytest.approx(FIRST, abs=2e-5) == shaped.recursion.E
    history = shaped.recursion.history
    assert len(shaped.iterations) == 801
    assert history["robustness"][0] == pytest.approx(-0.0708320860, rel=1e-8)
    assert history["frequency_rad_s"][0] == pytest.approx(277.1029065, rel=1e-9)
    assert history["robustness"][-1] == pytest.approx(0.0, abs=1e-7)
    assert history["frequency_rad_s"][-1] == pytest.approx(346.8, rel=5e-8)  # 0.98^800 of the way, 7e-6 rad/s, is left
    assert 0.06 < history["min_eig_modified_inertia"].min() < history["min_eig_modified_inertia"].max() < 0.07


def test_the_exact_design_is_the_least_gain_of_theory(shaped):
    assert pytest.approx(LEAST, abs=1e-6) == shaped.exact.E  # six decimals are given
    assert shaped.exact.certificate.min_eig_modified_inertia == pytest.approx(0.062976, abs=1e-6)
    assert np.linalg.norm(shaped.exact.E) < np.linalg.norm(shaped.recursion.E)


def test_the_printed_gain_misses_its_targets_and_cannot_be_built(shaped):
    facts = shaped.printed.certificate
    assert pytest.approx(printed.GAIN) == shaped.printed.E
    assert facts.robustness_after[0] == pytest.approx(-8e-6, abs=5e-7)
    assert facts.frequency_after_rad_s[0] == pytest.approx(345.9, abs=0.05)
    assert facts.algebraic_loop_radius == pytest.approx(1.775, abs=1e-3)
    assert shaped.exact.certificate.algebraic_loop_radius < 1.0 < facts.algebraic_loop_radius


def test_times_are_positive_and_make_the_ratio(shaped):
    assert min(shaped.recursion_seconds, shaped.exact_seconds) > 0.0
    assert shaped.time_ratio == pytest.approx(shaped.recursion_seconds / shaped.exact_seconds)


def test_only_the_compensated_arm_settles(settled):
    assert settled.without.settling_time_s is None
    assert settled.compensated.settling_time_s is not None
    assert settled.compensated.settling_time_s < 0.1
    last, before = settled.without.t > 0.3, (settled.without.t > 0.2) & (settled.without.t <= 0.3)
    size = settled.without.error_size
    assert size[last].max() > size[before].max() > 1e-4  # it grows: the rightmost pole is at +3.67


@pytest.mark.parametrize("which", ["without", "compensated"])
def test_maps_agree_with_single_poses(case, shaped, which, request):
    """`modes` at a pose takes another road than the map: closed inverse kinematics there, rows of numbers here."""
    chart = request.getfixturevalue(which)
    gain = shaped.recursion if chart.compensated else None
    rng = np.random.default_rng(1)
    good = np.argwhere(chart.status == OK)
    for i, j in rng.choice(good[(good[:, 0] > 3) & (good[:, 0] < 57)], 20):
        pose = case.plant.at_tip([chart.x[i, j], chart.y[i, j]])
        assert chart.robustness[i, j] == pytest.approx(fb.modes(pose, gain)[0].robustness, rel=1e-7, abs=1e-12)
        inertia = pose.M - (0.0 if gain is None else np.pad(gain.E, ((1, 0), (1, 0))))
        assert chart.smallest_inertia[i, j] == pytest.approx(np.linalg.eigvalsh(inertia)[0], rel=1e-9)


def test_maps_hold_no_value_exactly_where_the_inertia_is_indefinite(without, compensated):
    assert not without.indefinite
    assert compensated.indefinite
    for chart in (without, compensated):
        assert np.array_equal(chart.status == INDEFINITE, chart.smallest_inertia <= 0.0)
        assert np.array_equal(np.isfinite(chart.robustness), chart.status == OK)
        assert np.nanmax(chart.robustness) <= 0.0


def test_the_turn_tells_the_robustness(without):
    """w = |a||b| (cos - 1) is 0 where the turn is 0; the null case: not where the turn is pi."""
    near = np.abs(without.turn) < 0.01
    opposite = np.abs(without.turn) > 3.1
    assert near.any()
    assert opposite.any()
    assert np.abs(without.robustness[near]).max() < 1e-4
    assert np.abs(without.robustness[opposite]).min() > 1e-3


def test_a_map_needs_the_papers_kind_of_arm():
    with pytest.raises(fb.InputError, match="two parallel arm joints"):
        paper.robustness_map(planar([0.3, 0.3, 0.3, 0.2]))


def test_an_ellipse_turns_as_its_eigenvectors_do(case):
    """The design point, against the eigenvectors of Jv X^-1 Jv^T by hand."""
    cell = paper.ellipse_cell(case.plant, paper.DESIGN_TIP)
    assert cell.frequency == pytest.approx(277.1029065, rel=1e-9)
    assert (cell.recursion_status, cell.exact_status) == (ellipses.REACHED, ellipses.REACHED)
    pose, gain = case.pose, cell.recursion_gain
    assert fb.modes(pose, Gain(gain))[0].frequency == pytest.approx(cell.frequency + 100.0, rel=1e-6)
    assert fb.modes(pose, Gain(gain))[0].robustness == pytest.approx(0.0, abs=1e-6)
    angles, areas = [], []
    for E in (np.zeros((2, 2)), gain):
        R0 = pose.J[:, 1:] @ np.linalg.inv(pose.M[1:, 1:] - E) @ pose.J[:, 1:].T
        angles.append(0.5 * np.arctan2(2.0 * R0[0, 1], R0[0, 0] - R0[1, 1]))  # of the longest axis
        areas.append(np.linalg.det(R0))
    turn = (angles[1] - angles[0] + 0.5 * np.pi) % np.pi - 0.5 * np.pi
    assert cell.recursion.rotation == pytest.approx(turn, abs=1e-9)
    assert cell.recursion.volume_ratio == pytest.approx(areas[1] / areas[0], rel=1e-9)


@pytest.mark.parametrize(("tip", "status"), [((0.33, 0.03), ellipses.NO_GAIN), ((0.33, -0.11), ellipses.OUT_OF_REACH)])
def test_a_configuration_without_a_design_says_why(case, tip, status):
    cell = paper.ellipse_cell(case.plant, tip)
    assert cell.exact is None
    assert cell.recursion is None
    assert cell.exact_status == status
    assert cell.recursion_status in (ellipses.LOST, ellipses.UNFINISHED)


def _field(turns: list[float], robustness: list[float], cell: paper.EllipseCell, pose: fb.Pose) -> paper.EllipseField:
    """Cells whose longest axes turn by given angles."""
    cells = []
    for turn, w in zip(turns, robustness, strict=True):
        c, s = np.cos(turn), np.sin(turn)
        turned = Ellipsoid("force", np.array([2.0, 1.0]), np.array([[c, -s], [s, c]]))
        pair = Manipulability(pose, Ellipsoid("force", np.array([2.0, 1.0]), np.eye(2)), turned)
        cells.append(replace(cell, robustness=w, recursion=pair))
    return paper.EllipseField(tuple(cells))


def test_the_rank_correlation_has_the_sign_of_the_papers_claim(case):
    cell = paper.ellipse_cell(case.plant, (0.33, 0.25))
    turns, w = [0.0, -0.1, 0.2, -0.3], [0.0, -0.01, -0.02, -0.03]
    assert _field(turns, w, cell, case.pose).rank_correlation()[0] == pytest.approx(1.0)
    assert _field(turns, w[::-1], cell, case.pose).rank_correlation()[0] == pytest.approx(-1.0)


def test_ellipse_tips_hold_the_design_point_and_only_what_is_reached(case):
    tips = np.array(paper.ellipse_tips(case.plant))
    assert np.linalg.norm(tips - paper.DESIGN_TIP, axis=1).min() == pytest.approx(0.0, abs=1e-12)
    distance = np.linalg.norm(tips - [0.2, 0.0], axis=1)
    assert distance.min() > 0.05
    assert distance.max() < 0.55
    assert 40 <= len(tips) <= 50


@pytest.fixture(scope="module")
def table(case, shaped, settled) -> paper.Reproduction:
    return paper.compare(case, shaped, settled, paper.ellipse_field(case.plant, spacing=0.25))


def test_the_table_holds_theorys_reference_values(table):
    ours = {row.quantity: row.ours for row in table.rows}
    assert [ours[f"Mhat ({i},{j}) [kg m²]"] for i, j in ((1, 1), (1, 2), (2, 2))] == pytest.approx(
        [0.581375, 0.01275, 0.104125], rel=1e-12
    )
    before = [ours[f"R_1 before ({i},{j}) [m/(N s²)]"] for i in (1, 2) for j in (1, 2)]
    assert before == pytest.approx([-0.03250938, -0.07462994, 0.03716396, 0.08531520], abs=5e-9)
    after = [ours[f"R_1 after exact ({i},{j}) [m/(N s²)]"] for i in (1, 2) for j in (1, 2)]
    assert after == pytest.approx([0.036302, 0.047918, 0.047918, 0.063252], abs=5e-7)
    assert ours["Rightmost closed-loop pole without E [1/s]"] == pytest.approx(3.66851755, rel=1e-7)
    assert ours["Fig. 9a: settles without E"] == "no"
    assert str(ours["Fig. 9b: settles with E"]).startswith("yes")


def test_the_bundled_robot_is_table_i(table):
    rows = [row for row in table.rows if row.quantity.startswith(("Table I", "kp1", "kv1"))]
    assert len(rows) == 14
    assert [row.difference for row in rows] == pytest.approx([0.0] * 14, abs=1e-12)


def test_what_cannot_be_reproduced_is_said(table):
    odd = [row for row in table.rows if row.quantity.startswith("R_1 after exact (2,")]
    assert all(abs(row.difference) > 2e-3 and "does not follow" in row.remark for row in odd)
    fair = [row for row in table.rows if row.quantity.startswith("R_1 after exact (1,")]
    assert all(abs(row.difference) < 5e-4 for row in fair)  # half a unit of the paper's last digit
    assert any("not unique" in row.remark for row in table.rows if row.quantity.startswith("E by recursion"))


def test_rows_are_five_words_each(table):
    rows = table.summary_rows()
    assert len(rows) == len(table.rows) == len(table.to_dict()["rows"])
    assert all(len(row) == 5 and all(isinstance(word, str) for word in row) for row in rows)
    assert len({row[0] for row in rows}) == len(rows)
    assert not any("nan" in word.lower().split() for row in rows for word in row)

"""Robust arm configurations as curves and as points: by modal analysis, and complete against maps of `turn`."""

from __future__ import annotations

import csv
import dataclasses
from pathlib import Path

import numpy as np
import pytest

import flexbase as fb
from flexbase.errors import InputError
from flexbase.plant import Plant
from flexbase.study.robust_configurations.continuation import follow, near_polyline
from flexbase.study.robust_configurations.curves import robust_curves
from flexbase.study.robust_configurations.points import robust_points
from systems.planar import planar

TWO_MODES = planar([0.1, 0.15, 0.3, 0.25], m=2, damping=0.0)


def undamped(robot: str) -> Plant:
    """Without damping the modal analysis has real shapes, as the curves and points assume."""
    arm = fb.load(robot).arm
    return Plant(dataclasses.replace(arm, base=dataclasses.replace(arm.base, damping=0.0 * arm.base.damping)))


@pytest.mark.parametrize("plant", [fb.load("ueda2003"), TWO_MODES], ids=["ueda2003", "two modes"])
def test_modes_are_positive_real_along_the_curves(plant: Plant) -> None:
    """Every 40th point, by modal analysis: 1 - alignment below 1e-12, w below 1e-12 of the largest residue."""
    found = robust_curves(plant)
    assert found.residual <= 1e-10
    assert {one.mode for one in found.curves} == set(range(1, plant.arm.m + 1))
    for one in found.curves:
        for joints, tip in zip(one.joints[7::40], one.tip[7::40], strict=True):
            pose = plant.at(joints)
            mode = fb.modes(pose).modes[one.mode - 1]
            assert mode.alignment == pytest.approx(1.0, abs=1e-12)
            assert abs(mode.robustness) <= 1e-12 * max(1.0, np.abs(mode.residue).max())
            assert tip == pytest.approx(pose.tip, abs=1e-12)


@pytest.mark.parametrize("plant", [fb.load("ueda2003"), TWO_MODES], ids=["ueda2003", "two modes"])
def test_curves_are_complete_and_nothing_else(plant: Plant) -> None:
    """Sign changes of `turn` near zero along 40 lines of 4001 cells: each is within 2 cells of a curve's crossing of
    the line, and there are as many crossings."""
    found = robust_curves(plant)
    first, second = (plant.arm.mechanism.joint_names[plant.arm.m + i] for i in range(2))
    lines = np.linspace(-3.1, 3.1, 40) + 0.0123
    lost = 0
    for line in lines:
        edge = 1e-9
        chart = fb.sweep(
            plant,
            ["turn"],
            fb.Cells(over="joints", shape=(4001, 2), axes=(second, first), bounds=[-3.1, 3.1, line, line + edge]),
            execution=fb.Execution(engine="rows"),
        )
        ticks = chart[second].values
        for mode in range(plant.arm.m):
            turn = chart.turn.isel({first: 0}).values[:, mode]
            near = np.abs(turn) < 0.5
            places = np.flatnonzero(near[1:] & near[:-1] & (turn[1:] * turn[:-1] < 0.0))
            crossings = []
            for one in found.curves:
                if one.mode != mode + 1:
                    continue
                offset = (one.joints[:, 0] - line + np.pi) % (2.0 * np.pi) - np.pi
                hits = np.flatnonzero((offset[1:] * offset[:-1] < 0.0) & (np.abs(offset[1:] - offset[:-1]) < 1.0))
                at = one.joints[hits, 1] + (one.joints[hits + 1, 1] - one.joints[hits, 1]) * offset[hits] / (
                    offset[hits] - offset[hits + 1]
                )
                crossings += ((at + np.pi) % (2.0 * np.pi) - np.pi).tolist()
            inside = sorted(x for x in crossings if abs(x) < 3.1 - 1e-3)
            expected = sorted(x for x in ticks[places] if abs(x) < 3.1 - 1e-3)
            if len(inside) != len(expected):
                lost += 1  # a curve that touches the line, or ends at it
            else:
                assert inside == pytest.approx(expected, abs=2.0 * (ticks[1] - ticks[0]))
    assert lost <= 1


def test_curves_are_ordered_and_within_the_step() -> None:
    """Neighbouring points are less than three cells apart; the paper's arm has one curve from fold to fold."""
    found = robust_curves(fb.load("ueda2003"))
    (curve,) = found.curves
    steps = np.linalg.norm(np.diff(curve.joints, axis=0), axis=1)
    assert steps.max() < 3.0 * 2.0 * np.pi / 360.0
    assert curve.length == pytest.approx(steps.sum())
    assert not curve.closed
    assert np.abs(curve.joints[[0, -1], 1]) == pytest.approx([np.pi, np.pi], abs=1e-5)  # the arm folded: b vanishes
    finer = robust_curves(fb.load("ueda2003"), cells=900)
    assert finer.curves[0].length == pytest.approx(curve.length, rel=1e-4)
    assert "open" in found.summary()


def test_a_compensator_moves_the_curve_through_its_pose() -> None:
    plant = fb.load("ueda2003")
    pose = plant.at_tip([0.33, -0.25])
    E = fb.design(pose, method="exact", natural_frequency=346.8)
    found = robust_curves(plant, loop=E)
    gaps = [np.abs(np.angle(np.exp(1j * (one.joints - pose.q[1:])))).max(axis=1).min() for one in found.curves]
    assert min(gaps) < 0.02
    assert found.compensated


def test_a_curve_that_is_known() -> None:
    """sin(x)/2 - y = 0 over a full turn of x is one closed curve; a circle of radius 0.5 about 0 closes with length
    pi, to the chords' 1e-4; a window without a period cuts a line at its edges."""
    window = np.array([[-np.pi, -2.0], [np.pi, 2.0]])
    around = np.array([2.0 * np.pi, np.inf])

    def wave(q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        slope = np.column_stack([0.5 * np.cos(q[:, 0]), -np.ones(len(q))])
        return 0.5 * np.sin(q[:, 0]) - q[:, 1], slope, np.ones(len(q))

    found = follow(wave, np.array([0.0, 0.0]), 0.05, 1e-10, around, window)
    assert found.closed
    assert np.abs(wave(found.points)[0]).max() <= 1e-10
    assert abs(found.points[-1, 0]) == pytest.approx(2.0 * np.pi, abs=0.05)
    cut = follow(wave, np.array([0.0, 0.0]), 0.05, 1e-10, np.full(2, np.inf), window)
    assert not cut.closed
    assert np.sort(cut.points[[0, -1], 0]) == pytest.approx([-np.pi, np.pi], abs=1e-5)
    assert near_polyline(np.array([[7.0, 0.5 * np.sin(7.0)], [1.0, 0.0]]), found.points, 1e-3, around).tolist() == [
        True,
        False,
    ]

    def circle(q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return (q**2).sum(axis=1) - 0.25, 2.0 * q, np.where(np.abs(q[:, 1]) > 0.6, -1.0, 1.0)

    found = follow(circle, np.array([0.5, 0.0]), 0.02, 1e-10, np.full(2, np.inf), window)
    chords = np.linalg.norm(np.diff(np.vstack([found.points, found.points[:1]]), axis=0), axis=1)
    assert found.closed
    assert chords.sum() == pytest.approx(np.pi, abs=1e-3)


@pytest.mark.parametrize(
    ("robot", "modes"),
    [("ur5e-pedestal", 1), ("ur5e-pedestal", None), pytest.param("iiwa-platform", [1, 3], marks=pytest.mark.slow)],
)
def test_points_by_modal_analysis(robot: str, modes: int | list[int] | None) -> None:
    """The modes asked for are positive real, to 1e-12; alignment of the others is what the modal analysis says."""
    plant = undamped(robot)
    found = robust_points(plant, modes, 400)
    assert found.residual <= 1e-10
    assert len(found.joints) >= 10
    for joints, tip, alignment in list(zip(found.joints, found.tip, found.alignment, strict=True))[:10]:
        pose = plant.at(joints)
        shown = [mode.alignment for mode in fb.modes(pose).modes]
        assert shown == pytest.approx(alignment.tolist(), abs=1e-9)
        assert [shown[mode - 1] for mode in found.modes] == pytest.approx([1.0] * len(found.modes), abs=1e-12)
        assert tip == pytest.approx(pose.tip, abs=1e-12)


def test_points_lie_near_their_samples() -> None:
    """In a small box about the paper's curve steps of least length go to the nearest point: within 10 % plus the
    spacing of the curve's own points."""
    plant = fb.load("ueda2003")
    (curve,) = robust_curves(plant, cells=2000).curves
    centre = curve.joints[len(curve.joints) // 2 + 200]
    box = np.column_stack([centre - 0.05, centre + 0.05]).ravel()
    found = robust_points(plant, count=200, bounds=box.tolist())
    assert len(found.joints) == 200
    starts = found.joints  # of those, the curve passes through every one
    gaps = np.array([np.linalg.norm(np.angle(np.exp(1j * (curve.joints - row))), axis=1).min() for row in starts])
    assert gaps.max() < 4e-3
    assert found.distance.max() < 1.1 * np.hypot(0.1, 0.1)
    assert "200 of 200" in found.summary()


def test_where_there_are_none_it_says_how_near_one_gets() -> None:
    """SCARA: no posture comes near; a sweep of 2e5 samples agrees on the largest alignment to 1 %."""
    plant = fb.load("scara")
    found = robust_points(plant, count=300)
    chart = fb.sweep(
        plant, ["alignment"], fb.Cells(over="samples", shape=(200_000,)), execution=fb.Execution(engine="rows")
    )
    assert len(found.joints) == 0
    assert found.nearest == pytest.approx(float(np.nanmax(chart.alignment.values)), rel=1e-2)
    assert found.to_dict()["nearest_alignment"] == found.nearest


def test_tables(tmp_path: Path) -> None:
    """CSV files hold what the results hold."""
    plant = fb.load("ueda2003")
    curves, points = robust_curves(plant, cells=100), robust_points(plant, count=50)
    curves.save_csv(tmp_path / "curves.csv")
    points.save_csv(tmp_path / "points.csv")
    rows = list(csv.DictReader((tmp_path / "curves.csv").read_text().splitlines()))
    assert [float(row["q3"]) for row in rows] == curves.curves[0].joints[:, 1].tolist()
    rows = list(csv.DictReader((tmp_path / "points.csv").read_text().splitlines()))
    assert [float(row["alignment_1"]) for row in rows] == points.alignment[:, 0].tolist()


def test_questions_without_meaning_are_refused() -> None:
    with pytest.warns(fb.FlexbaseWarning, match="rigid base"):
        rigid = planar([0.3, 0.25], m=0)
    with pytest.raises(InputError, match="no mode 3"):
        robust_points(fb.load("ur5e-pedestal"), 3)
    with pytest.raises(InputError, match="count: 0"):
        robust_points(fb.load("ueda2003"), count=0)
    with pytest.raises(InputError, match="rigid base"):
        robust_points(rigid)
    with pytest.raises(InputError, match="one task row"):
        robust_points(planar([0.1, 0.3, 0.25], rows=("x",)))
    with pytest.raises(InputError, match="3 task rows"):
        robust_curves(fb.load("ur5e-pedestal"))
    with pytest.raises(InputError, match="cells: 3"):
        robust_curves(fb.load("ueda2003"), cells=3)

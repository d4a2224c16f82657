"""Pictures of Monte Carlo studies: what is drawn is what was found."""

from __future__ import annotations

import numpy as np
import pytest

import flexbase as fb
from flexbase.report.plot import save_plot

VARY = {"payload": "uniform(0,3)", "stiffness": "normal(1,0.15)", "damping": 0.9}


def test_a_map_shows_its_cells_contours_and_shares(paper, tmp_path):
    found = fb.montecarlo(paper, fb.Draws(VARY, samples=100), redesign=True, cells=fb.Cells(shape=(24, 20)))
    figure = fb.plot(found)
    ax, beside = figure.axes[:2]
    drawn = ax.collections[0].get_array()
    assert np.array_equal(np.ma.filled(drawn, np.nan), found.dataset["probability"].values, equal_nan=True)
    assert {patch.get_hatch() for patch in ax.patches} == {"///", "|||"}
    named = [text.get_text() for text in figure.legends[0].get_texts()]
    assert named == ["probability 0.5", "probability 0.95", "out of reach", "no gain aligns the mode"]
    step = beside.lines[0].get_xydata()
    assert step[np.argmin(np.abs(step[:, 0] - 0.9)), 1] == pytest.approx(found.share_at_least(0.9).value, abs=0.01)
    assert np.all(np.diff(step[:, 1]) <= 0.0)
    save_plot(found, tmp_path / "map.svg")
    assert (tmp_path / "map.svg").stat().st_size > 10_000


def test_contours_lie_where_the_probability_is(paper):
    """Interpolated there, the probability is the contour's, to one draw and the width of a cell's slope."""
    found = fb.montecarlo(
        paper, {"stiffness": "normal(1,0.15)"}, criteria=["frequency=280:"], cells=fb.Cells(shape=(60, 60))
    )
    chart = found.dataset["probability"]
    half = [line for line in fb.plot(found).axes[0].lines if line.get_linestyle() == "--"]
    points = np.concatenate([line.get_xydata() for line in half])
    here = [float(chart.interp(x=x, y=y)) for x, y in points[:: max(1, len(points) // 40)]]
    assert np.nanmax(np.abs(np.array(here) - 0.5)) < 0.1


def test_a_pose_shows_criteria_and_who_is_to_blame(paper_pose):
    found = fb.montecarlo(paper_pose, fb.Draws(VARY, samples=300), criteria=["definite", "frequency=280:"])
    bars, payload, stiffness = fb.plot(found).axes
    assert [label.get_text() for label in bars.get_yticklabels()] == ["all", "definite", "frequency"]
    assert [bar.get_width() for bar in bars.patches] == pytest.approx([found.at_pose.value, 1.0, found.at_pose.value])
    for ax in (payload, stiffness):
        heights = np.array([bar.get_height() for bar in ax.patches]).reshape(2, -1)
        assert heights.sum(axis=1) == pytest.approx([found.dataset["held"].item(), 300 - found.dataset["held"].item()])
    assert [payload.get_xlabel(), stiffness.get_xlabel()] == ["payload [kg]", "stiffness"]  # damping does not vary


def test_one_axis_is_a_curve_and_three_are_refused(paper):
    curve = fb.montecarlo(
        paper, fb.Draws(VARY, samples=50), redesign=True, cells=fb.Cells(over="joints", axes=["q3"], shape=(30,))
    )
    line = fb.plot(curve).axes[0].lines[0]
    assert np.array_equal(line.get_ydata(), curve.dataset["probability"].values, equal_nan=True)
    three = fb.montecarlo(
        fb.load("scara"),
        fb.Draws(VARY, samples=2),
        criteria="definite",
        cells=fb.Cells(over="joints", axes=["shoulder", "elbow", "turn"], shape=(2, 2, 2)),
    )
    with pytest.raises(fb.InputError, match="this study has 3 axes"):
        fb.plot(three)


def test_a_study_that_was_kept_is_drawn_again(paper, tmp_path):
    found = fb.montecarlo(paper, fb.Draws(VARY, samples=30), redesign=True, cells=fb.Cells(shape=(12, 10)))
    found.save_netcdf(tmp_path / "m.nc")
    kept = fb.open_dataset(tmp_path / "m.nc")
    for name in ("a", "b"):
        save_plot(found if name == "a" else kept, tmp_path / f"{name}.png")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    with pytest.raises(fb.InputError, match=r"pictures are written as \.png"):
        save_plot(kept, tmp_path / "m.html")

"""Pictures of sweeps: lines where the zeros are, hatches where there is no value, axes and colours with names."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_hex
from matplotlib.patches import PathPatch

import flexbase as fb
from flexbase.report.maps.line_curves import runs, zero_crossings
from flexbase.report.maps.signs import PATTERN, level_paths, outlines, scale_of
from flexbase.report.plot import plot
from flexbase.report.style import BLUE
from flexbase.sweeps.answers.chart import INFINITE, Layer, chart_of
from flexbase.sweeps.engine.status import INFEASIBLE, LOST, UNREACHABLE


def blue_lines(ax):
    return [line.get_xydata() for line in ax.lines if to_hex(line.get_color()) == BLUE.lower()]


def hatches(ax):
    return {patch.get_hatch() for patch in ax.patches if isinstance(patch, PathPatch)}


def meshes(figure):
    panels = [ax for ax in figure.axes if ax.get_title("left")]  # not the colour bars
    return [mesh for ax in panels for mesh in ax.collections if isinstance(mesh, QuadMesh)]


def across(plant, point) -> float:
    """R12 - R21 = a1 b2 - a2 b1 of the one mode at a tip position: 0 on a robust arm configuration, by single poses."""
    residue = fb.modes(plant.at_tip(point)).modes[0].residue
    return float(residue[0, 1] - residue[1, 0])


def test_the_zero_contour_lies_on_robust_arm_configurations(paper):
    """A quarter of a cell to either side of the drawn line the residue's skew part has both signs."""
    chart = fb.sweep(paper, cells=fb.Cells(shape=(121, 121)))
    cell = float(chart.x[1] - chart.x[0])
    (ax, *_) = plot(chart).axes
    points = np.concatenate(blue_lines(ax))
    assert len(points) > 200
    checked = 0
    for line in blue_lines(ax):
        for one, two in zip(line[1:-2:9], line[2:-1:9], strict=True):
            middle, along = 0.5 * (one + two), (two - one) / np.linalg.norm(two - one)
            aside = 0.25 * cell * np.array([-along[1], along[0]])
            try:
                signs = [np.sign(across(paper, middle + side * aside)) for side in (-1.0, 1.0)]
            except fb.InputError:  # at the edge of reach
                continue
            assert signs[0] * signs[1] < 0.0
            checked += 1
    assert checked > 25


def test_level_lines_follow_a_circle():
    """Linear between cells of size h: within h^2/(8 r) + h^2/8r of the true circle, for x^2 + y^2."""
    x = np.linspace(-1.0, 1.0, 81)
    h, radius = x[1] - x[0], 0.6
    (line,) = level_paths(x, x, x[:, None] ** 2 + x**2, radius**2)
    assert np.abs(np.linalg.norm(line, axis=1) - radius).max() < h**2 / (4.0 * radius)
    assert line[0] == pytest.approx(line[-1])


def test_outlines_hold_the_marked_cells_and_no_others():
    """Every marked cell's middle is inside an odd number of lines, every other one inside an even number."""
    from matplotlib.path import Path

    random = np.random.default_rng(3)
    where = random.random((14, 17)) < 0.4
    x, y = np.linspace(0.0, 4.0, 17), np.linspace(-1.0, 2.0, 14)
    inner = np.zeros_like(where)
    inner[1:-1, 1:-1] = True  # middles of border cells lie on the clipped lines
    grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    count = sum(Path(line).contains_points(grid) for region in outlines(x, y, where) for line in region)
    assert np.array_equal((count % 2 == 1)[inner.ravel()], where[inner])


def test_hatches_mark_cells_without_a_value_and_hide_none(paper):
    """Where no gain aligns the mode the design's gain is hatched, and robustness is drawn all the same."""
    chart = fb.sweep(paper, ("robustness", "exact_gain"), fb.Cells(shape=(61, 61)))
    robust, gain = plot(chart).axes[:2]
    assert hatches(robust) == {PATTERN[UNREACHABLE]}
    assert hatches(gain) == {PATTERN[UNREACHABLE], PATTERN[INFEASIBLE]}
    drawn = robust.collections[0].get_array().filled(np.nan)
    assert np.isfinite(drawn[chart.status.values == INFEASIBLE]).all()


def test_axes_and_colour_bars_have_names_and_units(paper):
    figure = plot(fb.sweep(paper, ("robustness", "frequency"), fb.Cells(shape=(21, 21))))
    one, two, *bars = figure.axes
    assert (one.get_xlabel(), one.get_ylabel(), one.get_aspect()) == ("x [m]", "y [m]", 1.0)
    assert [bar.get_ylabel() for bar in bars] == ["robustness [m/(N s$^{2}$)]", "frequency [rad/s]"]
    assert "zero: the robust arm configuration" in one.get_title("left")
    assert two.get_title("left") == "frequency"
    joints = plot(fb.sweep(paper, cells=fb.Cells(over="joints", shape=(11, 11)))).axes[0]
    assert (joints.get_xlabel(), joints.get_ylabel(), joints.get_aspect()) == ("q2 [rad]", "q3 [rad]", "auto")


def test_slices_share_their_colours_and_name_their_values(paper):
    """Nine payloads: five evenly spaced slices with both ends, drawn by one scale, each the plane itself."""
    dataset = fb.sweep(paper, cells=fb.Cells(shape=(25, 21), vary={"payload": (0.0, 2.0, 9)}))
    figure = plot(dataset)
    titles = [ax.get_title("left") for ax in figure.axes if ax.get_title("left")]
    assert titles == [f"payload = {value:g} kg" for value in (0.0, 0.5, 1.0, 1.5, 2.0)]
    drawn = meshes(figure)
    assert len({(mesh.norm.vmin, mesh.norm.vmax) for mesh in drawn}) == 1
    for mesh, payload in zip(drawn, (0, 2, 4, 6, 8), strict=True):
        shown = mesh.get_array().filled(np.nan)
        assert np.array_equal(shown, dataset.robustness.values[payload, ..., 0], equal_nan=True)


def test_curves_cross_zero_where_the_arm_is_robust(paper):
    """Along y = -0.25 the skew part of the residue changes sign within a cell's hundredth of each circle."""
    dataset = fb.sweep(paper, cells=fb.Cells(axes=["x"], hold=[-0.25], shape=[400]))
    (ax, *_) = plot(dataset).axes
    rings = next(line for line in ax.lines if line.get_marker() == "o").get_xdata()
    assert len(rings) == 2
    step = 0.05 * float(dataset.x[1] - dataset.x[0])
    for x in rings:
        assert across(paper, [x - step, -0.25]) * across(paper, [x + step, -0.25]) < 0.0
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "robustness [m/(N s$^{2}$)]")


def test_curves_of_several_modes_share_a_panel():
    dataset = fb.sweep(
        fb.load("ur5e-pedestal"), ("frequency",), fb.Cells(over="joints", axes=["elbow_joint"], shape=[30])
    )
    (ax,) = plot(dataset).axes
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["mode 1", "mode 2"]
    for line, mode in zip(ax.lines, dataset.frequency.values.T, strict=False):
        assert line.get_ydata() == pytest.approx(mode)


def test_runs_and_crossings():
    x = np.arange(6.0)
    assert runs(x, np.array([True, False, True, True, False, True])) == [(0.0, 0.5), (1.5, 3.5), (4.5, 5.0)]
    line = np.array([1.0, -1.0, np.nan, -1.0, 3.0, 4.0])
    assert zero_crossings(x, Layer("a", "a", "1", line, "nothing", line)) == pytest.approx([0.5, 3.25])
    assert zero_crossings(x, Layer("a", "a", "1", line)).size == 0


def test_samples_are_counted_and_placed(paper):
    dataset = fb.sweep(paper, ("exact_gain",), fb.Cells(over="samples", shape=[3000]))
    histogram, cloud = plot(dataset).axes[:2]
    known = np.isfinite(dataset.exact_gain.values)
    shares = sum(bar.get_height() for bar in histogram.patches)
    assert shares <= 100.0 * known.mean() + 1e-9
    assert shares > 97.0 * known.mean()  # a hundredth at each end may lie beyond
    assert any("not shown: no gain" in text.get_text() for text in histogram.get_legend().get_texts())
    places = cloud.collections[0].get_offsets()
    expected = np.column_stack([dataset.q2.values, dataset.q3.values])[known]
    assert np.array_equal(np.asarray(places), expected)
    assert (cloud.get_xlabel(), cloud.get_ylabel()) == ("q2 [rad]", "q3 [rad]")


def test_differences_are_centred_and_mark_what_is_lost(paper, paper_pose):
    exact = fb.design(paper_pose, "exact", natural_frequency=346.8)
    asked = {"measures": ("frequency", "exact_gain"), "cells": fb.Cells(shape=(41, 41))}
    figure = plot(fb.difference(fb.sweep(paper, **asked), fb.sweep(paper, **asked, loop=exact)))
    changed, same = figure.axes[:2]
    mesh = changed.collections[0]
    assert mesh.norm.vmin == -mesh.norm.vmax
    assert PATTERN[LOST] in hatches(changed)
    assert [text.get_text() for text in same.texts] == ["zero in every cell"]
    assert "ok before only" in [text.get_text() for text in figure.legends[0].get_texts()]


@pytest.mark.parametrize("values", [[2.0, 2.0, 2.0], [0.0, 0.0, 0.0], [np.nan, 5.0, np.nan]])
@pytest.mark.parametrize("zero_is", [None, "nothing"])
def test_constants_have_a_scale(values, zero_is):
    scale = scale_of(Layer("a", "a", "1", np.array(values), zero_is))
    assert scale.low < scale.high
    assert scale.low <= np.nanmax(values) <= scale.high


def test_too_many_axes_and_a_single_cell_are_refused_with_a_mend(paper):
    vary = {"payload": (0, 1, 2), "stiffness": (1, 2, 2)}
    four = fb.sweep(paper, cells=fb.Cells(shape=(2, 2), bounds=(0.3, 0.4, -0.3, -0.2), vary=vary))
    with pytest.raises(
        fb.InputError, match=r'4 axes \(payload, stiffness, y, x\).*sel\(payload=VALUE, method="nearest"\)'
    ):
        plot(four)
    three = four.sel(payload=0.9, method="nearest")
    assert "payload = 1 kg" in chart_of(three).heading
    assert len(meshes(plot(three))) == 2
    with pytest.raises(fb.InputError, match="single cell"):
        plot(fb.sweep(paper, cells=fb.Cells(shape=(1, 1))))


def test_an_axis_of_one_value_does_not_count(paper):
    chart = chart_of(fb.sweep(paper, cells=fb.Cells(shape=(9, 1), bounds=(0.3, 0.4, -0.25, -0.24))))
    assert [axis.name for axis in chart.axes] == ["x"]
    assert chart.heading == "ueda2003, y = -0.25 m"


def test_infinite_values_are_told_apart(paper):
    """The highest gain has no bound where all scales are stable: pale, in the key, and no part of the colours."""
    dataset = fb.sweep(paper, ("highest_gain",), fb.Cells(shape=(21, 21)))
    endless = np.isinf(dataset.highest_gain.values)
    assert 20 < endless.sum() < endless.size
    chart = chart_of(dataset)
    (layer,) = chart.layers
    assert np.array_equal(chart.missing(layer)[INFINITE], endless)
    figure = plot(dataset)
    assert "infinite" in [text.get_text() for text in figure.legends[0].get_texts()]
    assert np.isfinite(figure.axes[0].collections[0].norm.vmax)
    same = fb.difference(dataset, dataset)
    assert not same.highest_gain.values[endless].any()

"""Every result can be drawn, into every kind of file, and the drawing shows the result."""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib import image

import flexbase as fb
from flexbase.report.arm.in_plane import joint_points
from flexbase.report.plot import plot, save_plot
from flexbase.report.save import METADATA, save_figure
from flexbase.report.style import new_figure
from systems.planar import PAPER_TIP, planar, sliding_pair


@pytest.fixture(scope="module")
def recursion(paper_pose) -> fb.Compensator:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fb.FlexbaseWarning)
        return fb.design(paper_pose, "recursive", natural_frequency=346.8, iterations=30)


@pytest.fixture(scope="module")
def exact(paper_pose) -> fb.Compensator:
    return fb.design(paper_pose, "exact", natural_frequency=346.8)


@pytest.fixture(scope="module")
def results(paper, paper_pose, recursion, exact) -> dict[str, object]:
    two = planar([0.3, 0.3, 0.3, 0.3], m=2)
    with pytest.warns(fb.FlexbaseWarning, match="rigid base"):
        rigid = planar([0.3, 0.2], m=0)
    cart = sliding_pair(0.4)
    run = {"start": [0.33, -0.24], "goal": PAPER_TIP, "move": fb.Move(switch=0.02, end=0.05)}
    return {
        "recursion": recursion,
        "exact": exact,
        "modes": fb.modes(paper_pose, exact),
        "two modes": fb.modes(two.at([0.5, 0.7])),
        "no mode": fb.modes(rigid.at([0.5, 0.7])),
        "mode of a cart": fb.modes(cart.at([0.1])),
        "verdict": fb.verdict(paper_pose),
        "verdict of a band": fb.verdict(paper_pose, exact, bandwidth=300.0),
        "verdict of no mode": fb.verdict(rigid.at([0.5, 0.7])),
        "verdict without damping": fb.verdict(planar([0.3, 0.3, 0.3], damping=0.0).at([0.5, 0.7])),
        "run": fb.simulate(paper, **run),
        "compensated run": fb.simulate(paper, **run, loop=exact),
        "manipulability": fb.manipulability(paper_pose, exact),
        "torque manipulability": fb.manipulability(paper_pose, exact, "torque"),
        "one axis": fb.manipulability(cart.at([0.1])),
        "chart": fb.sweep(paper, ("robustness", "compensability", "frequency"), fb.Cells(shape=(41, 41))),
        "compensated chart": fb.sweep(paper, loop=recursion, cells=fb.Cells(shape=(41, 41))),
        "joint chart": fb.sweep(paper, ("alignment",), fb.Cells(over="joints", shape=(31, 31))),
        "empty chart": fb.sweep(paper, cells=fb.Cells(shape=(5, 5), bounds=(5.0, 6.0, 5.0, 6.0))),
    }


CASES = (
    "recursion", "exact", "modes", "two modes", "no mode", "mode of a cart", "verdict", "verdict of a band",
    "verdict of no mode", "verdict without damping", "run", "compensated run", "manipulability",
    "torque manipulability", "one axis", "chart", "compensated chart", "joint chart", "empty chart",
)  # fmt: skip


def ink(path: Path) -> float:
    """Share of the picture that is not white."""
    return float((image.imread(path)[..., :3].min(axis=-1) < 0.9).mean())


@pytest.mark.parametrize("name", CASES)
def test_every_result_is_drawn(results, name, tmp_path):
    figure = plot(results[name])
    assert all(ax.has_data() or ax.texts or not ax.axison for ax in figure.axes)
    assert any(ax.get_xlabel() for ax in figure.axes)
    save_figure(figure, tmp_path / "a.png")
    save_figure(new_figure(*figure.get_size_inches()), tmp_path / "blank.png")
    assert ink(tmp_path / "blank.png") == 0.0
    assert ink(tmp_path / "a.png") > 0.01


@pytest.mark.parametrize("suffix", METADATA)
def test_every_suffix_is_written_and_the_same_twice(results, suffix, tmp_path):
    """The same result gives the same bytes: no dates, no random ids."""
    for name in ("a", "b"):
        save_plot(results["compensated chart"], tmp_path / f"{name}{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()
    start = (tmp_path / f"a{suffix}").read_bytes()[:5]
    assert {".png": b"\x89PNG\r", ".svg": b"<?xml", ".pdf": b"%PDF-"}[suffix] == start


def test_an_svg_is_valid_xml(results, tmp_path):
    save_plot(results["modes"], str(tmp_path / "a.SVG"))
    root = ElementTree.parse(tmp_path / "a.SVG").getroot()
    assert root.tag.endswith("svg")
    assert len(list(root.iter("{http://www.w3.org/2000/svg}path"))) > 20


@pytest.mark.parametrize("name", ["a.jpeg", "a", "png"])
def test_other_suffixes_are_refused(results, name, tmp_path):
    with pytest.raises(fb.InputError, match=r"\.png, \.svg, \.pdf"):
        save_plot(results["modes"], tmp_path / name)
    assert not (tmp_path / name).exists()


def test_an_unwritable_place_is_named(results, tmp_path):
    with pytest.raises(fb.InputError, match="nowhere"):
        save_plot(results["modes"], tmp_path / "nowhere" / "a.png")


def test_what_cannot_be_drawn_is_refused():
    with pytest.raises(fb.InputError, match=r"a list cannot be drawn.*Modes"):
        plot([1, 2])


def test_drawing_leaves_the_users_settings_alone(results):
    before = dict(matplotlib.rcParams)
    with matplotlib.rc_context({"font.size": 31.0, "axes.facecolor": "red"}):
        figure = plot(results["modes"])
        assert matplotlib.rcParams["font.size"] == 31.0
    assert figure.axes[0].get_facecolor() == (1.0, 1.0, 1.0, 1.0)
    assert dict(matplotlib.rcParams) == before


def test_run_plots_show_the_error_in_millimetres(results):
    run = results["run"]
    drawn = plot(run).axes[0].lines[0].get_ydata()
    assert drawn == pytest.approx(1e3 * run.tip_error[:, 0])


def test_history_plots_show_the_history(recursion):
    axes = plot(recursion).axes
    assert axes[0].lines[0].get_ydata() == pytest.approx(recursion.history["robustness"])
    assert axes[1].lines[0].get_ydata() == pytest.approx(recursion.history["frequency_rad_s"])


def test_a_verdict_shades_where_it_fails(paper_pose):
    """The curve is the least eigenvalue, its lowest point the shortage, and the dark band the worst half."""
    found = fb.verdict(paper_pose)
    ax = plot(found).axes[0]
    line = next(line for line in ax.lines if "least" in str(line.get_label()))
    omega, least = line.get_data()
    assert least == pytest.approx(found.least_eigenvalue(np.asarray(omega)))
    assert min(least) == pytest.approx(found.shortage, rel=1e-3)
    ((low, high),) = found.half_at
    band = (
        next(patch for patch in ax.patches if "half" in str(patch.get_label()))
        .get_extents()
        .transformed(ax.transData.inverted())
    )
    assert (band.x0, band.x1) == pytest.approx((low, high), rel=1e-9)


def test_joint_points_are_where_the_geometry_puts_them(paper_pose):
    points = joint_points(paper_pose)
    q2, q3 = paper_pose.q[1:]
    elbow = np.array([0.2 + 0.3 * np.cos(q2), 0.3 * np.sin(q2), 0.0])
    tip = elbow + 0.25 * np.array([np.cos(q2 + q3), np.sin(q2 + q3), 0.0])
    assert points == pytest.approx(np.array([[0.0, 0.0, 0.0], [0.2, 0.0, 0.0], elbow, tip]), abs=1e-15)


@pytest.mark.parametrize("robot", ["ur5e-gantry", "ur5e-pedestal", "ur5e-platform"])
def test_an_arm_in_space_is_drawn_in_space(robot, tmp_path):
    """Three axes with names, equal scales, one panel a mode; the resting arm's line runs through its joints and tip.

    The swing reaches 12 % of the arm's extent, both ways; a planar arm keeps its plane.
    """
    pose = fb.load(robot).at([0.4, -1.2, 1.3, -0.6, 0.9, 0.3])
    figure, points, m = plot(fb.modes(pose)), joint_points(pose), pose.arm.m
    assert len(figure.axes) == m
    for ax in figure.axes:
        assert [ax.get_xlabel(), ax.get_ylabel(), ax.get_zlabel()] == ["x [m]", "y [m]", "z [m]"]
        sides = [np.ptp(limits) for limits in (ax.get_xlim(), ax.get_ylim(), ax.get_zlim())]
        scales = np.array(sides) / np.array(ax._box_aspect)  # matplotlib has no public way to ask for it in space
        assert np.ptp(scales) < 1e-9 * scales.max()
        lines = [np.array(line.get_data_3d()).T for line in ax.lines]
        assert any(line.shape == points[m:].shape and np.allclose(line, points[m:]) for line in lines)
        bent = [line for line in lines if line.shape == points[m:].shape and not np.allclose(line, points[m:])]
        moved = max(np.linalg.norm(line - points[m:], axis=1).max() for line in bent if np.ptp(line[:, 2]) > 0.0)
        assert 0.03 < moved / np.ptp(points, axis=0).max() < 0.2
    save_figure(figure, tmp_path / "a.png")
    assert ink(tmp_path / "a.png") > 0.01


def test_a_planar_arm_stays_in_its_plane(results):
    assert not any(hasattr(ax, "get_zlim") for ax in plot(results["modes"]).axes)


def test_a_half_map_is_white_at_zero_and_a_full_one_is_centred(results):
    meshes = [
        next(part for part in ax.collections if type(part).__name__ == "QuadMesh")
        for ax in plot(results["chart"]).axes[:2]
    ]
    assert meshes[0].norm.vmax == 0.0
    assert meshes[1].norm.vmin == -meshes[1].norm.vmax
    for mesh in meshes:
        assert min(mesh.cmap(mesh.norm(0.0))[:3]) > 0.95

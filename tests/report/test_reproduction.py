"""`reproduce` writes every panel, and the panels show what the study computed."""

from __future__ import annotations

import csv
import json
import xml.etree.ElementTree as ElementTree
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from matplotlib import image

import flexbase as fb
from flexbase.report import paper as panels
from flexbase.report.paper import all_figures as reproduction
from flexbase.report.paper import ring
from flexbase.report.paper.all_figures import PANELS, reproduce
from flexbase.study import paper as study

COARSE = 0.25  # m between ellipses: a third of a minute less than the real spacing


@pytest.fixture(scope="module")
def reproduced(tmp_path_factory):
    """Folder, table and progress calls of one run with fewer ellipses."""
    folder, calls = tmp_path_factory.mktemp("paper") / "new" / "folder", []
    with pytest.MonkeyPatch.context() as patch:
        for name in ("ellipse_tips", "ellipse_field"):
            patch.setattr(reproduction, name, partial(getattr(study, name), spacing=COARSE))
        table = reproduce(folder, lambda *call: calls.append(call))
    return folder, table, calls


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def column(path: Path, name: str) -> np.ndarray:
    return np.array([float(row[name]) for row in rows_of(path)])


@pytest.mark.slow
@pytest.mark.parametrize("name", PANELS)
def test_every_panel_is_written_and_shows_something(reproduced, name):
    folder = reproduced[0]
    picture = image.imread(folder / f"{name}.png")[..., :3]
    assert (picture.min(axis=-1) < 0.9).mean() > 0.01
    assert picture[:3].min() == picture[:, :3].min() == 1.0  # nothing is cropped at the upper and left edges
    root = ElementTree.parse(folder / f"{name}.svg").getroot()
    assert root.tag.endswith("svg")
    assert "Date" not in (folder / f"{name}.svg").read_text("utf-8")[:4000]
    assert len(rows_of(folder / f"{name}.csv")) >= 4


def test_the_panels_are_those_of_the_paper():
    names = ["05", "06a", "06b", "07a", "07b", "07c", "08a", "08b", "09a", "09b", "10"]
    assert [f"fig{name}" for name in names] == list(PANELS)


@pytest.mark.slow
def test_progress_runs_to_the_end(reproduced):
    calls = reproduced[2]
    total = calls[0][2]
    assert [call[1] for call in calls] == list(range(total + 1))
    assert {call[2] for call in calls} == {total}
    assert all(isinstance(call[0], str) and call[0] for call in calls)


@pytest.mark.slow
def test_the_table_is_written_as_it_is_returned(reproduced):
    folder, table, _ = reproduced
    written = rows_of(folder / "table.csv")
    assert [tuple(row.values()) for row in written] == table.summary_rows()
    markdown = (folder / "table.md").read_text("utf-8").splitlines()
    assert len(markdown) == len(table.rows) + 2
    assert {line.replace("\\|", "").count("|") for line in markdown} == {6}
    json.dumps(table.to_dict(), allow_nan=False)


@pytest.mark.slow
def test_numbers_behind_figure_7_meet_the_targets(reproduced):
    folder = reproduced[0]
    w, omega = column(folder / "fig07a.csv", "robustness"), column(folder / "fig07c.csv", "frequency_rad_s")
    assert (len(w), w[0], omega[0]) == (
        801,
        pytest.approx(-0.0708320860, rel=1e-8),
        pytest.approx(277.1029065, rel=1e-8),
    )
    assert w[-1] == pytest.approx(0.0, abs=1e-7)
    assert omega[-1] == pytest.approx(346.8, rel=5e-8)  # 0.98^800 of the way, 7e-6 rad/s, is left


@pytest.mark.slow
def test_numbers_behind_figure_9_settle_only_with_the_compensator(reproduced):
    folder = reproduced[0]
    late = {}
    for name in ("fig09a", "fig09b"):
        t = column(folder / f"{name}.csv", "t_s")
        error = np.hypot(column(folder / f"{name}.csv", "error_x_m"), column(folder / f"{name}.csv", "error_y_m"))
        late[name] = error[t > 0.2].max()
    assert late["fig09b"] < 1e-4 < 1e-3 < late["fig09a"]


@pytest.mark.slow
def test_numbers_behind_figure_8_name_what_is_meaningless(reproduced):
    rows = rows_of(reproduced[0] / "fig08b.csv")
    void = [row for row in rows if float(row["min_eig_modified_inertia"]) <= 0.0]
    assert void
    assert all(row["w_1_m_per_N_s2"] == "" and "positive definite" in row["status"] for row in void)
    assert not any("positive definite" in row["status"] for row in rows_of(reproduced[0] / "fig06b.csv"))


@pytest.fixture(scope="module")
def charts(paper) -> dict[str, object]:
    exact = fb.design(paper.at_tip([0.33, -0.25]), "exact", natural_frequency=346.8)

    return {"without": study.robustness_map(paper), "with": study.robustness_map(paper, exact), "exact": exact}


def test_drawn_robust_configurations_are_robust(paper, charts):
    """The emphasised curves, judged by `modes`: aligned to 3 degrees (linear interpolation), w a thousandth of typical.

    Not within 2 cm of a curve's ends: those are points where a or b vanish and the angle between them jumps.
    """
    for name, gain in (("without", None), ("with", charts["exact"])):
        judged = 0
        for line in ring.robust_curves(charts[name]):
            radius = np.linalg.norm(line - [0.2, 0.0], axis=1)
            ends = np.linalg.norm(line[:, None] - line[[0, -1]], axis=2).min(axis=1)
            for tip in line[(radius > 0.06) & (radius < 0.54) & (ends > 0.02)][::5]:
                mode = fb.modes(paper.at_tip(tip), gain)[0]
                assert mode.alignment > 0.9986
                assert mode.robustness > -1e-4
                judged += 1
        assert judged > 20


def test_the_curve_passes_through_the_work_point_only_with_the_compensator(charts):
    distance = {
        name: np.linalg.norm(np.vstack(ring.robust_curves(charts[name])) - [0.33, -0.25], axis=1).min()
        for name in ("without", "with")
    }
    assert distance["with"] < 5e-3  # the spacing of the grid
    assert distance["without"] > 0.05


def test_maps_have_equal_aspect_and_units(charts):
    ax = panels.contours(charts["with"]).axes[0]
    assert ax.get_aspect() == 1.0
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "y [m]")
    assert ax.get_xlim()[0] <= -0.4
    assert ax.get_xlim()[1] >= 0.8


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(fb.InputError, match="file"):
        reproduce(tmp_path / "file" / "out")

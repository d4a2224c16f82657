"""Pages: one file that fetches nothing, holds the numbers of the sweep, and says what they are."""

from __future__ import annotations

import base64
import json
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import flexbase as fb
from flexbase.report.page.write import CELLS, page
from flexbase.report.plot import save_plot
from flexbase.sweeps.answers.chart import chart_of
from flexbase.sweeps.engine.status import INFEASIBLE, UNREACHABLE


class Reader(HTMLParser):
    """Tags with their attributes, and the text of each script."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.scripts: list[str] = []
        self._inside = False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if self._inside or tag == "script":
            self._inside = True
            self.scripts.append("")

    def handle_data(self, data):
        if self._inside:
            self.scripts[-1] += data

    def handle_endtag(self, tag):
        self._inside = self._inside and tag != "script"


@pytest.fixture(scope="module")
def results(paper, paper_pose):
    exact = fb.design(paper_pose, "exact", natural_frequency=346.8)
    plane = fb.sweep(paper, ("robustness", "exact_gain"), fb.Cells(shape=(61, 51)))
    return {
        "plane": plane,
        "change": fb.difference(plane, fb.sweep(paper, ("robustness",), fb.Cells(shape=(61, 51)), loop=exact)),
        "slices": fb.sweep(paper, cells=fb.Cells(shape=(31, 25), vary={"payload": (0.0, 2.0, 3)})),
        "curve": fb.sweep(paper, ("robustness", "frequency"), fb.Cells(axes=["x"], hold=[-0.25], shape=[80])),
        "samples": fb.sweep(paper, ("exact_gain",), fb.Cells(over="samples", shape=[400])),
        "nothing": fb.sweep(paper, cells=fb.Cells(shape=(5, 5), bounds=(5.0, 6.0, 5.0, 6.0))),
    }


def content(path: Path) -> dict:
    reader = Reader(path.read_text("utf-8"))
    return json.loads(reader.scripts[1])


def decode(array: dict) -> np.ndarray:
    values = np.frombuffer(base64.b64decode(array["bdata"]), {"f8": "<f8", "f4": "<f4", "i1": "<i1"}[array["dtype"]])
    return values.reshape([int(size) for size in array["shape"].split(",")]) if "shape" in array else values


@pytest.mark.parametrize("name", ["plane", "change", "slices", "curve", "samples", "nothing"])
def test_a_page_fetches_nothing(results, name, tmp_path):
    """No tag points anywhere, and the page's own policy forbids whatever a script might try."""
    save_plot(results[name], tmp_path / "a.html")
    text = (tmp_path / "a.html").read_text("utf-8")
    reader = Reader(text)
    for tag, attributes in reader.tags:
        assert not {"src", "href", "data", "action", "poster", "srcset"} & set(attributes), tag
    policy = next(found["content"] for _, found in reader.tags if found.get("http-equiv") == "Content-Security-Policy")
    assert policy.startswith("default-src 'none'")
    assert "http" not in policy
    assert "unsafe-eval" not in policy
    style = text[text.index("<style>") : text.index("</style>")]
    assert "url(" not in style
    assert "@import" not in style
    assert "http" not in reader.scripts[2]
    assert "http" not in reader.scripts[1]
    assert reader.scripts[0].lstrip().startswith("/**\n* plotly.js")
    assert len(text) < 6_500_000
    assert len(reader.scripts) == 3
    assert f'id="panel-{len(content(tmp_path / "a.html")["panels"]) - 1}"' in text


def test_a_map_holds_the_values_their_words_and_the_zero_line(results, tmp_path):
    save_plot(results["plane"], tmp_path / "a.html")
    found = content(tmp_path / "a.html")
    assert found["words"][str(UNREACHABLE)] == "out of reach"
    robust, gain = found["panels"]
    dataset = results["plane"]
    values, gaps = robust["data"][:2]
    assert np.array_equal(decode(values["z"]), dataset.robustness.values[..., 0].astype("f4"), equal_nan=True)
    assert decode(values["x"]) == pytest.approx(dataset.x.values)
    codes = decode(gaps["codes"])
    assert np.array_equal(codes % 16, dataset.status.values)
    assert np.array_equal(codes >= 16, np.isnan(dataset.robustness.values[..., 0]))
    assert not (codes[dataset.status.values == INFEASIBLE] >= 16).any()
    assert (decode(gain["data"][1]["codes"])[dataset.status.values == INFEASIBLE] >= 16).all()
    for words in ("x %{x:.5g} m", "y %{y:.5g} m", "robustness %{z:.5g} m/(N s<sup>2</sup>)", "%{text}"):
        assert words in values["hovertemplate"]
    names = [trace.get("name") for trace in robust["data"]]
    assert names.count("zero") == 1
    assert "status 1" in names
    assert robust["layout"]["yaxis"]["scaleanchor"] == "x"
    assert robust["layout"]["xaxis"]["title"]["text"] == "x [m]"
    place, colour = robust["data"][0]["colorscale"][-1]
    assert (place, robust["data"][0]["zmax"]) == (1.0, 0.0)
    assert min(map(int, colour[4:-1].split(","))) > 240  # white at zero, the upper end of robustness


def test_slices_have_a_slider_and_stand_in_space(results, tmp_path):
    save_plot(results["slices"], tmp_path / "a.html")
    plane, space = content(tmp_path / "a.html")["panels"]
    (slider,) = plane["layout"]["sliders"]
    assert [step["label"] for step in slider["steps"]] == ["0", "1", "2"]
    maps = [i for i, trace in enumerate(plane["data"]) if trace["type"] == "heatmap" and "codes" not in trace]
    for step, one, values in zip(slider["steps"], maps, results["slices"].robustness.values[..., 0], strict=True):
        visible = step["args"][0]["visible"]
        assert [visible[i] for i in maps] == [i == one for i in maps]
        assert np.array_equal(decode(plane["data"][one]["z"]), values.astype("f4"), equal_nan=True)
    assert len({(plane["data"][i]["zmin"], plane["data"][i]["zmax"]) for i in maps}) == 1
    assert [trace["type"] for trace in space["data"]] == ["surface"] * 3
    heights = [float(np.nanmax(decode(trace["z"]))) for trace in space["data"]]
    assert heights == [0.0, 1.0, 2.0]
    assert space["layout"]["scene"]["zaxis"]["title"]["text"] == "payload [kg]"


def test_large_sweeps_are_thinned(paper, tmp_path):
    """Two layers of 700 x 700: at most 600 along an axis and CELLS in all."""
    dataset = fb.sweep(paper, ("robustness", "frequency"), fb.Cells(shape=(700, 700)))
    save_plot(dataset, tmp_path / "a.html")
    shapes = [decode(panel["data"][0]["z"]).shape for panel in content(tmp_path / "a.html")["panels"]]
    assert sum(rows * columns for rows, columns in shapes) <= CELLS
    assert max(max(shape) for shape in shapes) <= 600
    assert (tmp_path / "a.html").stat().st_size < 11_000_000
    assert "700 x 700 cells, 350 x 350 of them shown" in (tmp_path / "a.html").read_text("utf-8")


def test_names_cannot_break_out_of_the_page(results):
    """A robot's name comes from a file."""
    dataset = results["plane"].assign_attrs(robot="</title></script><script src=http://x>@DATA@")
    reader = Reader(page(chart_of(dataset)))
    assert len(reader.scripts) == 3
    assert all("src" not in attributes for _, attributes in reader.tags)


def test_only_sweeps_become_pages(paper_pose, tmp_path):
    with pytest.raises(fb.InputError, match=r"a.html: suffix"):
        save_plot(fb.modes(paper_pose), tmp_path / "a.html")


def test_an_unwritable_page_is_named(results, tmp_path):
    with pytest.raises(fb.InputError, match="nowhere"):
        save_plot(results["curve"], tmp_path / "nowhere" / "a.html")

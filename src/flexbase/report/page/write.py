"""Write a sweep as one HTML file: plotly's script, the panels' data and a few lines that put them together."""

from __future__ import annotations

import base64
import html
import json
import re
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flexbase.errors import import_extra, writing
from flexbase.report.page.others import curve_panels, sample_panels
from flexbase.report.page.planes import Panel, plane_panels, slice_panels
from flexbase.report.page.traces import SHAPES
from flexbase.sweeps.answers.chart import Chart, chart_of
from flexbase.sweeps.answers.summary import measures_of
from flexbase.sweeps.engine.question import MODE

if TYPE_CHECKING:
    import xarray

LARGEST, LEAST = 600, 100  # cells along an axis
CELLS = 720_000  # in all panels together: about 5 MB
SLICES = 12


def save_page(result: Chart | xarray.Dataset, path: str | Path) -> None:
    """A sweep's dataset or chart as an interactive page, self-contained. Raises InputError, MissingExtra."""
    chart = result if isinstance(result, Chart) else chart_of(result, _fineness(result), SLICES)
    text = page(chart)
    with writing(path):
        Path(path).write_text(text, "utf-8", newline="\n")


def page(chart: Chart) -> str:
    """The page's source. Raises MissingExtra."""
    plotly = import_extra("plotly.offline", "maps").get_plotlyjs()
    kinds = {1: curve_panels, 2: plane_panels, 3: slice_panels}
    make = sample_panels if chart.axes[0].name == "sample" else kinds[len(chart.axes)]
    panels = make(chart)
    parts = files(__package__)
    content = {
        "panels": panels,
        "words": {str(code): words for code, words in chart.meanings.items()},
        "linked": len(chart.axes) < 3 and not chart.drawn,
    }
    filled = {
        "TITLE": html.escape(chart.heading),
        "FACTS": _facts(chart),
        "KEY": _key(chart, panels),
        "PANELS": "".join(f'<div class="panel" id="panel-{i}"></div>' for i in range(len(panels))),
        "DATA": json.dumps(_plain(content), allow_nan=False, separators=(",", ":")).replace("</", "<\\/"),
        "SCRIPT": (parts / "page.js").read_text("utf-8"),
        "PLOTLY": plotly.replace("</script", "<\\/script"),
    }
    return re.sub("@([A-Z]+)@", lambda sign: filled[sign[1]], (parts / "page.html").read_text("utf-8"))


def _fineness(dataset: xarray.Dataset) -> int:
    """Cells along an axis, so that all panels together stay small."""
    layers = sum(dataset.sizes[MODE] if MODE in dataset[name].dims else 1 for name in measures_of(dataset))
    outer = [dataset.sizes[dim] for dim in dataset["status"].dims[:-2]]
    planes = max(1, layers) * min(SLICES, int(np.prod(outer, dtype=np.int64)))
    return max(LEAST, min(LARGEST, int((CELLS / planes) ** 0.5)))


def _plain(thing: Any) -> Any:
    """JSON values; arrays of floats and codes as base64, as plotly.js reads them."""
    if isinstance(thing, dict):
        return {name: _plain(part) for name, part in thing.items()}
    if isinstance(thing, list | tuple):
        return [_plain(part) for part in thing]
    if not isinstance(thing, np.ndarray):
        return thing.item() if isinstance(thing, np.generic) else thing
    kind = (
        {"f": "f8", "i": "i4"}[thing.dtype.kind]
        if thing.dtype.itemsize > 4
        else {"f": "f4", "i": "i1"}[thing.dtype.kind]
    )
    shape = {"shape": ",".join(map(str, thing.shape))} if thing.ndim > 1 else {}
    stored = np.ascontiguousarray(thing, dtype="<" + kind)
    return {"dtype": kind, "bdata": base64.b64encode(stored.tobytes()).decode(), **shape}


def _facts(chart: Chart) -> str:
    shown = " x ".join(str(axis.values.size) for axis in chart.axes)
    cells = f"{chart.cells} {'samples' if chart.drawn else 'cells'}" + (
        f", {shown} of them shown" if chart.cells not in ("", shown) else ""
    )
    axes = [
        f"{axis.name} from {axis.values.min():.4g} to {axis.values.max():.4g} {'' if axis.unit == '1' else axis.unit}"
        for axis in (chart.drawn or chart.axes)
    ]
    return "".join(f"<li>{html.escape(words)}</li>" for words in (cells, *axes))


def _key(chart: Chart, panels: list[Panel]) -> str:
    """What the signs mean."""
    found = {code for layer in chart.layers for code in chart.missing(layer)}
    names = {trace.get("name") for panel in panels for trace in panel["data"]}
    entries = ['<span><i class="zero"></i>zero</span>'] if "zero" in names else []
    if not chart.drawn:
        order = list(SHAPES)
        entries += [
            f'<span><i class="sign sign-{order.index(code)}"></i>{html.escape(words)}</span>'
            for code, words in chart.meanings.items()
            if code in found and code in SHAPES
        ]
    return "".join(entries)

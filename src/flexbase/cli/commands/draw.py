"""`flexbase draw`: pictures of maps that were written earlier."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import App, Parameter

from flexbase.cli.options.common import option
from flexbase.cli.options.values import names, number
from flexbase.cli.terminal.out import PICTURES, OutFile, check_out, written
from flexbase.cli.terminal.screen import put
from flexbase.errors import InputError
from flexbase.sheets.sheet import Sheet
from flexbase.study.montecarlo import is_study
from flexbase.sweeps.answers.chart import chart_of

app = App(
    name="draw",
    help_epilogue="""Examples:
  flexbase draw big.zarr --out robustness.png
  flexbase draw map.nc --at payload=2.5 --out map.html
  flexbase draw with.zarr --before without.zarr --out change.png""",
)
Values = tuple[tuple[str, float], ...]


def _values(text: str, given: str) -> Values:
    """Names with a number each. Raises InputError."""
    pairs = [part.partition("=") for part in names(text, given)]
    for name, sign, _ in pairs:
        if not sign:
            raise InputError(f'{given}: "{name}" has no value. Give NAME=VALUE, such as payload=2.5.')
    return tuple((name.strip(), number(value, given)) for name, _, value in pairs)


@app.default
def draw(
    sweep: Annotated[Path, Parameter(help="a .zarr store that sweep wrote, or a .nc file")],
    /,
    *,
    before: Annotated[
        Path | None, Parameter(metavar="FILE", help="another map of the same cells: draw what changes from it")
    ] = None,
    at: Annotated[Values, option(_values, "NAME=VALUE", "the nearest cells of an axis; with commas")] = (),
    out: Annotated[OutFile, Parameter(help="write a picture (.png .svg .pdf) or page (.html)")] = None,
) -> None:
    """Curves, a map or slices, by the number of axes; large stores are thinned evenly, not read whole."""
    if out is None:
        raise InputError("--out is missing. Say where the picture goes, such as --out map.png.")
    check_out(out, (*PICTURES, ".html"))
    from flexbase.report.draw import draw as draw_file

    found = draw_file(sweep, out, before=before, at=dict(at))
    if is_study(found):
        return put(Sheet(found.attrs["robot"], f"{found.attrs['design']}, probability that it holds"), *written(out))
    chart = chart_of(found)
    axes = ", ".join(axis.name for axis in chart.drawn or chart.axes)
    put(Sheet(chart.heading, f"{', '.join(layer.title for layer in chart.layers)} over {axes}"), *written(out))

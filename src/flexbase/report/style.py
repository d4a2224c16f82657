"""One look for all figures: fonts, lines, colours that survive colour blindness and grey printing."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from matplotlib import style
from matplotlib.figure import Figure

BLUE, ORANGE, GREEN, RED, SKY, PURPLE = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9", "#CC79A7"  # Okabe, Ito
INK, GREY, PALE = "#1a1a1a", "#7f7f7f", "#d9d9d9"
HATCH = "#9a9a9a"
DIVERGING = "RdBu"  # red below zero, blue above, white at zero; told apart by colour-blind eyes
SCREEN_DPI = 200

LOOK: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "mathtext.fontset": "dejavusans",
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "regular",
    "axes.labelsize": 9.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "axes.linewidth": 0.8,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "lines.linewidth": 1.4,
    "hatch.color": HATCH,
    "hatch.linewidth": 0.5,
    "axes.grid": False,
    "grid.color": PALE,
    "grid.linewidth": 0.5,
    "figure.dpi": 100.0,
    "svg.hashsalt": "flexbase",  # ids in SVG files are then the same in every run
    "svg.fonttype": "path",
    "pdf.fonttype": 42,
}


@contextmanager
def styled() -> Iterator[None]:
    """The look, whatever the user's own settings are; theirs come back afterwards. Also a decorator."""
    with style.context(["default", LOOK]):
        yield


def new_figure(width: float = 5.0, height: float = 3.6) -> Figure:
    """An empty figure of a size [inch], belonging to no window and no global state."""
    return Figure(figsize=(width, height), layout="constrained")


def in_mathtext(unit: str) -> str:
    """A unit with its powers raised: m/(N s^2)."""
    return re.sub(r"\^(-?\w+)", r"$^{\1}$", unit)

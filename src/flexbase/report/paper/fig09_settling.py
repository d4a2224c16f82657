"""Fig. 9: the positioning error while moving and settling."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from flexbase.report.style import BLUE, GREY, INK, RED, new_figure, styled
from flexbase.simulation import Run


@styled()
def positioning_error(run: Run) -> Figure:
    """Fig. 9: the tip's error in x and y, while moving and settling."""
    figure = new_figure(5.2, 3.0)
    ax = figure.add_subplot()
    ax.axhspan(-0.1, 0.1, color="#eaeaea", zorder=0)
    ax.axhline(0.0, color=GREY, linewidth=0.5, zorder=1)
    for column, (name, color, line) in enumerate((("x", BLUE, "-"), ("y", RED, (0, (4, 1.2))))):
        ax.plot(run.t, 1e3 * run.tip_error[:, column], color=color, linestyle=line, linewidth=1.2, label=name)
    ax.axvline(run.switch, color=INK, linewidth=0.9)
    for text, begin, end in (("Move", 0.0, run.switch), ("Settling", run.switch, float(run.t[-1]))):
        ax.annotate(
            "",
            (begin, 2.72),
            (end, 2.72),
            arrowprops={"arrowstyle": "<->", "linewidth": 0.7, "shrinkA": 0, "shrinkB": 0},
        )
        ax.text(0.5 * (begin + end), 2.72, text, ha="center", va="center", backgroundcolor="white")
    ax.set_xlim(0.0, float(run.t[-1]))
    ax.set_ylim(-3.0, 3.0)
    ax.set_xlabel("time [s]")
    ax.set_ylabel(r"positioning error [$10^{-3}$ m]")
    ax.legend(loc="lower right", ncols=2)
    _verdict(ax, run)
    return figure


def _verdict(ax: Axes, run: Run) -> None:
    after = run.settling_time_s
    if after is None:
        last, before = (
            run.error_size[(run.t > run.t[-1] - ago) & (run.t <= run.t[-1] - ago + 0.1)] for ago in (0.1, 0.2)
        )
        text = (
            f"does not settle: up to {1e3 * last.max():.2f} mm in the last 0.1 s,\n"
            f"{1e3 * before.max():.2f} mm in the 0.1 s before\n"
        )
    else:
        moment = run.switch + after
        ax.plot([moment, moment], [-0.9, 0.1], color=INK, linewidth=0.8)
        ax.annotate(
            f"below 0.1 mm (band)\nfrom {1e3 * after:.0f} ms after switching",
            (moment, -0.1),
            (moment + 0.008, -0.95),
            va="center",
        )
        text = ""
    peak = run.peak_error_m
    if peak is not None and peak > 3e-3:
        text += f"(off the scale: {1e3 * peak:.1f} mm right after switching)"
    ax.text(0.5 * (run.switch + run.t[-1]), 2.4, text, ha="center", va="top", fontsize=8, color=INK)

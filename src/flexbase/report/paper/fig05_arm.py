"""Fig. 5: the arm at the work point, with dimensions."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from flexbase.report.arm.in_plane import draw_arm, draw_ground, draw_twist, joint_points
from flexbase.report.style import BLUE, GREY, INK, ORANGE, new_figure, styled
from flexbase.study.paper import DESIGN_TIP, Example

MINUS = str.maketrans("-", "−")


@styled()
def configuration(case: Example) -> Figure:
    """Fig. 5: the arm with its tip at the work point."""
    figure = new_figure(4.8, 3.65)
    ax = figure.add_subplot()
    points = joint_points(case.pose)[:, :2]
    x, y = DESIGN_TIP
    draw_ground(ax, points[0], 0.03)
    draw_twist(ax, points[0], 0.045)
    draw_arm(ax, points, case.pose.arm.parts)
    ax.plot(x, y, "s", color=BLUE, markersize=8, zorder=6)
    ax.annotate("work point", (x, y), (x + 0.02, y - 0.035), color=BLUE, ha="left", va="center")
    _dimension(ax, (0.0, -0.34), (x, -0.34), "0.33 m")
    _dimension(ax, (0.5, 0.0), (0.5, y), "0.25 m")
    for line in (
        ((0.0, -0.055), (0.0, -0.355)),
        ((x, -0.27), (x, -0.355)),
        ((0.22, 0.0), (0.515, 0.0)),
        ((0.35, y), (0.515, y)),
    ):
        ax.plot(*zip(*line, strict=True), color=GREY, linewidth=0.6, zorder=1)
    q = np.degrees(case.pose.q)
    ax.annotate("passive joint $q_1$\n(twist of the base)", points[0], (-0.085, 0.075), ha="left", va="bottom")
    for i, shift in enumerate(((0.022, 0.025), (0.012, -0.038))):
        text = f"$q_{i + 2}$ = {q[i + 1]:.1f}°".translate(MINUS)
        ax.annotate(text, points[i + 1], points[i + 1] + np.array(shift), ha="left", va="bottom")
    for i, name in enumerate(("base link", "link 2", "link 3")):
        middle = 0.5 * (points[i] + points[i + 1])
        ax.annotate(
            name,
            middle,
            middle + np.array([(0.0, 0.02), (-0.02, 0.0), (0.02, 0.03)][i]),
            color=GREY,
            ha=["center", "right", "left"][i],
            va="bottom",
        )
    ax.set_aspect("equal")
    ax.set_xlim(-0.14, 0.6)
    ax.set_ylim(-0.38, 0.16)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.legend(
        handles=[
            Line2D(
                [],
                [],
                marker="o",
                color="none",
                markerfacecolor=ORANGE,
                markeredgecolor=INK,
                markersize=8,
                label="passive joint",
            ),
            Line2D(
                [],
                [],
                marker="o",
                color="none",
                markerfacecolor="white",
                markeredgecolor=INK,
                markersize=7,
                label="actuated joint",
            ),
        ],
        loc="upper right",
    )
    return figure


def _dimension(ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    ax.annotate("", start, end, arrowprops={"arrowstyle": "<->", "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0})
    ax.text(
        0.5 * (start[0] + end[0]),
        0.5 * (start[1] + end[1]),
        text,
        ha="center",
        va="center",
        rotation=0 if start[1] == end[1] else 90,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
    )

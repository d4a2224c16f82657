"""A layout before and after: where the targets are, the arm on the worst of them, and what each is worth."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from flexbase.checks import Array
from flexbase.report.arm.in_plane import AXES, draw_arm, joint_points
from flexbase.report.style import BLUE, GREY, INK, RED, SKY, in_mathtext, new_figure
from flexbase.study.layout.best_layout import Layout, Station
from flexbase.study.robust_configurations.curves import robust_curves


def draw_layout(result: Layout) -> Figure:
    """One view a pair of position rows, and a row a target with its value before and after."""
    rows = [row for row in result.plant.arm.task.rows if row in AXES]
    views = [(rows[0], rows[1])] if len(rows) > 1 else []
    views += [(rows[0], rows[2])] if len(rows) > 2 else []
    figure = new_figure(4.2 * (len(views) + 1), 4.6)
    axes = figure.subplots(1, len(views) + 1, squeeze=False)[0]
    for ax, view in zip(axes, views, strict=False):
        _view(ax, result, view)
    _values(axes[-1], result)
    moved = [f"{row} {value:+.3f} m" for row, value in zip(result.along, result.shift, strict=True)]
    moved += [f"turned {np.degrees(result.turn):+.1f}°"] if result.turn else []
    moves = ", ".join(moved).replace("-", "−")
    figure.suptitle(f"{result.plant.name}: work moved by {moves}", x=0.01, ha="left", fontsize=10)
    lines = robust_lines(result)
    for line in lines:
        axes[0].plot(*line.T, color=SKY, linewidth=1.3, zorder=1)
    signs = [
        Line2D([], [], marker="o", color="none", markeredgecolor=GREY, label="target before"),
        Line2D([], [], marker="o", color="none", markeredgecolor=INK, markerfacecolor=BLUE, label="target after"),
        Line2D([], [], color=INK, linewidth=2.0, label="arm on the worst target after"),
    ]
    signs += [Line2D([], [], color=SKY, linewidth=1.3, label="a mode positive real, on a branch")] if lines else []
    figure.legend(handles=signs, loc="outside lower center", ncols=4)
    return figure


def _view(ax: Axes, result: Layout, view: tuple[str, str]) -> None:
    task = result.plant.arm.task.rows
    columns = [task.index(row) for row in view]
    plane = tuple(AXES.index(row) for row in view)
    worst = _worst(result)
    if worst is not None and worst.joints is not None:
        pose = result.plant.at(worst.joints)
        draw_arm(ax, joint_points(pose)[:, plane], pose.arm.parts, alpha=0.8, width=1.8)
    for a, b in zip(result.before, result.after, strict=True):
        ax.plot(*np.array([a.tip[columns], b.tip[columns]]).T, color=GREY, linewidth=0.6, zorder=5)
    before, after = (np.array([one.tip[columns] for one in stations]) for stations in (result.before, result.after))
    ax.plot(*before.T, "o", color="none", markeredgecolor=GREY, markersize=6, zorder=6)
    lost = np.array([one.value is None for one in result.after])
    ax.plot(*after[~lost].T, "o", color="none", markeredgecolor=INK, markerfacecolor=BLUE, markersize=6.5, zorder=7)
    ax.plot(*after[lost].T, "x", color=RED, markersize=7, zorder=7)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.12)
    ax.grid(True)
    ax.set_xlabel(f"{view[0]} [m]")
    ax.set_ylabel(f"{view[1]} [m]")


def _values(ax: Axes, result: Layout) -> None:
    """A row a target: hollow before, filled after; out of reach at the left edge."""
    for i, (a, b) in enumerate(zip(result.before, result.after, strict=True)):
        if a.value is not None and b.value is not None:
            ax.plot([a.value, b.value], [i, i], color=GREY, linewidth=0.8)
        if a.value is not None:
            ax.plot(a.value, i, "o", color="none", markersize=6.5, markeredgecolor=GREY)
        if b.value is not None:
            ax.plot(b.value, i, "o", color="none", markersize=6.5, markeredgecolor=INK, markerfacecolor=BLUE)
        if a.value is None or b.value is None:
            words, color = ("out of reach", RED) if b.value is None else ("was out of reach", GREY)
            ax.text(0.02, i, words, transform=ax.get_yaxis_transform(), color=color, va="center", fontsize=8)
    score = result.score(result.after)
    if score is not None:
        ax.axvline(score, color=BLUE, linewidth=0.9, linestyle=(0, (4, 2)), zorder=0)
    ax.set_yticks(range(len(result.after)), [one.name for one in result.after])
    ax.set_ylim(len(result.after) - 0.4, -0.6)
    unit = "" if result.measure.unit == "1" else f" [{in_mathtext(result.measure.unit)}]"
    ax.set_xlabel(f"{result.measure.name}{unit}; dashed: {result.goal} after")
    ax.set_ylabel("target")
    ax.grid(axis="x")


def _worst(result: Layout) -> Station | None:
    reached = [one for one in result.after if one.value is not None]
    values = [one.value for one in reached if one.value is not None]
    if not values:
        return None
    return reached[int(np.argmax(values) if result.measure.small_is_good else np.argmin(values))]


def robust_lines(result: Layout) -> list[Array]:
    """Where the tip of an arm with two joints and two task rows is robust, on either branch; none for others."""
    arm = result.plant.arm
    if result.compensated or not (arm.n == arm.k == 2 and arm.m and set(arm.task.rows) <= set(AXES)):
        return []
    return [one.tip for one in robust_curves(result.plant).curves]

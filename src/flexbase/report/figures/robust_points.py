"""Robust arm configurations as a set of points: where the tip is, and how the joints are spread."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from flexbase.report.arm.in_plane import AXES
from flexbase.report.style import BLUE, new_figure
from flexbase.study.robust_configurations.points import RobustPoints


def draw_robust_points(result: RobustPoints) -> Figure:
    """The tip in each pair of position rows; the joints as strips below one another."""
    arm = result.plant.arm
    rows = [i for i, row in enumerate(arm.task.rows) if row in AXES]
    pairs = [(a, b) for n, a in enumerate(rows) for b in rows[n + 1 :]][:2]
    figure = new_figure(3.9 * (len(pairs) + 1), 4.1)
    axes = figure.subplots(1, len(pairs) + 1, squeeze=False)[0]
    size = float(np.clip(60.0 / max(1, len(result.joints)) ** 0.5, 1.0, 12.0))
    for ax, (a, b) in zip(axes, pairs, strict=False):
        ax.scatter(result.tip[:, a], result.tip[:, b], s=size, color=BLUE, linewidths=0)
        ax.set_xlabel(f"{arm.task.rows[a]} of the tip [m]")
        ax.set_ylabel(f"{arm.task.rows[b]} of the tip [m]")
        ax.set_aspect("equal", adjustable="datalim")
        ax.grid(True)
    strips = axes[-1]
    shake = np.random.default_rng(0).uniform(-0.3, 0.3, result.joints.shape)
    strips.scatter(result.joints, np.arange(arm.n) + shake, s=size, color=BLUE, linewidths=0)
    strips.set_yticks(range(arm.n), arm.joint_names)
    strips.set_ylim(arm.n - 0.4, -0.6)
    strips.set_xlabel("joint [rad or m]")
    strips.grid(axis="x")
    which = "mode " + ", ".join(map(str, result.modes)) if len(result.modes) < arm.m else "all modes"
    end = ", compensated" if result.compensated else ""
    title = f"{result.plant.name}: {which} positive real{end}, {len(result.joints)} postures"
    figure.suptitle(title, x=0.01, ha="left", fontsize=10)
    return figure

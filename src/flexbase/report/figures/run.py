"""A simulated move: tip error and torques against time."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from flexbase.checks import Array
from flexbase.plant import Pose
from flexbase.report.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, RED, SKY, new_figure
from flexbase.simulation import Run

LINES = (BLUE, RED, GREEN, ORANGE, PURPLE, SKY)
HEADROOM = 1.25  # of the error scale over the error after the first tenth of the settling phase


class Drawable(Protocol):
    """What a run must have to be drawn: see `Run` for what they are."""

    @property
    def goal(self) -> Pose: ...
    @property
    def t(self) -> Array: ...
    @property
    def tip_error(self) -> Array: ...
    @property
    def torque(self) -> Array: ...
    @property
    def switch(self) -> float: ...


def draw_run(run: Run) -> Figure:
    """Tip error (positions, and rotations below) and joint torques; the switch to the task loop is marked."""
    return draw_motion(run, _headline(run))


def draw_motion(run: Drawable, headline: str) -> Figure:
    """Tip error and joint torques of any run."""
    rows, units = run.goal.arm.task.rows, run.goal.arm.task.units
    kinds = [kind for kind in ("m", "rad") if kind in units]
    figure = new_figure(5.6, 1.9 * (len(kinds) + 1) + 0.4)
    axes = figure.subplots(len(kinds) + 1, 1, sharex=True)
    for ax, kind in zip(axes, kinds, strict=False):
        columns = [i for i, unit in enumerate(units) if unit == kind]
        _error(ax, run, columns, [rows[i] for i in columns], "mm" if kind == "m" else "mrad")
    _torques(axes[-1], run)
    for ax in axes:
        if run.switch > 0.0:
            ax.axvline(run.switch, color=INK, linewidth=0.8, linestyle=(0, (2, 2)))
        ax.grid(axis="y")
        ax.set_xlim(float(run.t[0]), float(run.t[-1]))
    moved = ", task-space control from the dashed line on" if run.switch > 0.0 else ""
    axes[-1].set_xlabel(f"time [s]{moved}")
    axes[0].set_title(headline, loc="left")
    return figure


def _error(ax: Axes, run: Drawable, columns: list[int], names: list[str], unit: str) -> None:
    error = 1e3 * run.tip_error[:, columns]
    for i, name in enumerate(names):
        ax.plot(run.t, error[:, i], color=LINES[i], linewidth=1.1, label=name)
    ax.axhspan(-0.1, 0.1, color="#e4e4e4", zorder=0, label=f"±0.1 {unit}")
    shown = run.t >= run.switch + 0.1 * (run.t[-1] - run.switch)
    if shown.any():
        largest = HEADROOM * max(float(np.abs(error[shown]).max()), 0.4)
        if largest < float(np.abs(error).max()):
            ax.set_ylim(-largest, largest)
            text = f"off the scale: {np.abs(error).max():.3g} {unit} at most"
            ax.text(0.99, 0.03, text, transform=ax.transAxes, ha="right", va="bottom", fontsize=7.5, color=GREY)
    ax.set_ylabel(f"tip error [{unit}]")
    ax.legend(loc="upper right", ncols=len(names) + 1)


def _torques(ax: Axes, run: Drawable) -> None:
    arm = run.goal.arm
    for i, name in enumerate(arm.joint_names):
        ax.plot(run.t, run.torque[:, i], color=LINES[i % len(LINES)], linewidth=1.1, label=name)
    efforts = {"rad": "torque [N m]", "m": "force [N]"}
    ax.set_ylabel(" or ".join(efforts[unit] for unit in efforts if unit in arm.joint_units))
    ax.legend(loc="upper right", ncols=3)


def _headline(run: Run) -> str:
    who = f"{run.goal.plant.name}, {'with' if run.compensated else 'without'} compensator: "
    if run.settling_time_s is not None:
        return who + f"settles {1e3 * run.settling_time_s:.0f} ms after switching"
    return who + (f"stopped, {run.stopped}" if run.stopped else "does not settle")

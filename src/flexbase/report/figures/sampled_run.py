"""A run of a sampled controller: tip error and torques against time."""

from __future__ import annotations

from matplotlib.figure import Figure

from flexbase.report.figures.run import draw_motion
from flexbase.report.style import INK
from flexbase.simulation import SampledRun


def draw_sampled(run: SampledRun) -> Figure:
    """Tip error (positions, and rotations below) and joint torques as the drives gave them; a push is shaded."""
    figure = draw_motion(run, _headline(run))
    if run.push is not None:
        for ax in figure.axes:
            ax.axvspan(run.push.start, run.push.start + run.push.duration, color=INK, alpha=0.12, linewidth=0.0)
    return figure


def _headline(run: SampledRun) -> str:
    who = f"{run.goal.plant.name}, {run.controller.name} at {run.controller.sensing.rate:g} Hz: "
    if run.settling_time_s is not None:
        return who + f"settles within {1e3 * run.settling_time_s:.0f} ms"
    return who + ("diverges" if run.diverged else "does not settle")

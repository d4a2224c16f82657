"""The figures of a verdict on a sampled loop, one registry line each; maps, studies and documents read them here."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from flexbase.linear.discrete.loop_margins import delay_margin, lag_margin
from flexbase.linear.margins import algebraic_loop_radius, algebraic_loop_radius_per_joint
from flexbase.sampled.closed import dynamic_stiffness, loop_gain, tip_correction, tip_stiffness
from flexbase.sheets.numbers import kilo

if TYPE_CHECKING:
    from flexbase.sampled.judged import Judged


class Shown(NamedTuple):
    """The column of a table that has a figure; figures with the same one share it.

    legend : what the heading means
    of : the value [unit of the figure] in words
    """

    heading: str
    unit: str
    legend: str
    of: Callable[[float], str]


RADIUS = Shown("radius", "", "spectral, a sample, below 1 it settles", "{:.4f}".format)
MARGINS = Shown("margins", "", "disk, at torques and sensors", lambda v: f"{v:.2f}" if v else "-")
BEARS = Shown("delay lag", "ms", "what all torques bear beyond their own, -: no limit", lambda v: f"{1e3 * v:.2f}")
WORST = Shown("worst\nradius", "", "on the changed robots", "{:.4f}".format)
STIFF = Shown("stiff", "kN/m", "of the tip, at rest and at its worst frequency, of rotations in kN m/rad", kilo)
TIP = Shown(
    "tip", "%", "of a constant tip error that the joints do not show, what is taken away", lambda v: f"{100.0 * v:.0f}"
)
TAU = Shown("tau", "ms", "of the slowest motion", lambda v: f"{1e3 * v:.{0 if v >= 0.1 else 1}f}")


class Figure(NamedTuple):
    """A registered figure.

    brief : whether brief verdicts have it, and with them maps and studies; the others take longest
    of_the_tip : whether studies tabulate its median over the stable loops
    run : of a judged loop; None where the figure has no meaning
    shown : how tables give it; None: in words, below them
    """

    name: str
    unit: str
    purpose: str
    brief: bool
    of_the_tip: bool
    run: Callable[[Judged], float | None]
    shown: Shown | None = None

    @property
    def words(self) -> str:
        """The name as people read it."""
        return self.name.removesuffix("_s").replace("_", " ")


FIGURES: dict[str, Figure] = {}
Run = Callable[["Judged"], "float | None"]


def figure(
    name: str,
    unit: str,
    purpose: str,
    shown: Shown | None = None,
    *,
    brief: bool = True,
    stable: bool = False,
    of_the_tip: bool = False,
) -> Callable[[Run], Run]:
    """Register a function of a judged loop under a name; `stable`: it has a meaning for stable loops only."""

    def register(run: Run) -> Run:
        def where_it_means_something(judged: Judged) -> float | None:
            return None if stable and not judged.stable else run(judged)

        FIGURES[name] = Figure(name, unit, purpose, brief, of_the_tip, where_it_means_something, shown)
        return run

    return register


@figure("spectral_radius", "1", "spectral radius of a sample: below 1 the loop settles", RADIUS)
def _radius(judged: Judged) -> float:
    return judged.radius


@figure("disk_margin_torque", "1", "disk margin with all torques perturbed; 0 if unstable", MARGINS)
def _margin_torque(judged: Judged) -> float:
    return judged.margins[0]


@figure("disk_margin_sensor", "1", "disk margin with all sensors perturbed; 0 if unstable", MARGINS)
def _margin_sensor(judged: Judged) -> float:
    return judged.margins[1]


@figure("delay_margin_s", "s", "further delay of all torques that the loop bears", BEARS, brief=False, stable=True)
def _delay(judged: Judged) -> float | None:
    return _finite(delay_margin(loop_gain(judged.pose, judged.controller)))


@figure("lag_margin_s", "s", "further first-order lag of all torques that it bears", BEARS, brief=False, stable=True)
def _lag(judged: Judged) -> float | None:
    return _finite(lag_margin(loop_gain(judged.pose, judged.controller)))


@figure("algebraic_loop_radius", "1", "algebraic loop of E, one delay in all joints", brief=False)
def _loop_radius(judged: Judged) -> float | None:
    E = judged.controller.E
    return None if E is None else algebraic_loop_radius(judged.pose, E)


@figure("algebraic_loop_radius_per_joint", "1", "algebraic loop of E, a delay a joint", brief=False)
def _loop_radius_per_joint(judged: Judged) -> float | None:
    E = judged.controller.E
    return None if E is None else algebraic_loop_radius_per_joint(judged.pose, E)


@figure("worst_radius", "1", "largest spectral radius over the changed robots", WORST)
def _worst(judged: Judged) -> float:
    return judged.worst_radius


@figure(
    "tip_stiffness",
    "N/m or N m/rad",
    "smallest static stiffness of the tip, where stable",
    STIFF,
    stable=True,
    of_the_tip=True,
)
def _tip_stiffness(judged: Judged) -> float:
    return tip_stiffness(judged.pose, judged.controller)


@figure(
    "dynamic_stiffness",
    "N/m or N m/rad",
    "the same at the frequency where a force moves the tip most",
    STIFF,
    stable=True,
    of_the_tip=True,
)
def _dynamic_stiffness(judged: Judged) -> float:
    return dynamic_stiffness(judged.pose, judged.controller)


@figure(
    "tip_correction",
    "1",
    "share of a constant tip error, unseen by the joints, that is taken away at rest",
    TIP,
    stable=True,
    of_the_tip=True,
)
def _tip_correction(judged: Judged) -> float:
    return tip_correction(judged.pose, judged.controller)


@figure("time_constant_s", "s", "of the slowest motion, where stable", TAU, stable=True, of_the_tip=True)
def _time_constant(judged: Judged) -> float | None:
    radius = judged.radius
    return -judged.controller.sensing.step / float(np.log(radius)) if radius > 0.0 else None


def _finite(margin: float) -> float | None:
    return margin if np.isfinite(margin) else None

"""Fig. 7: three quantities against the iteration of the recursion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from flexbase.report.paper import ring
from flexbase.report.style import BLUE, RED, new_figure, styled
from flexbase.study.paper import Shaping


class Curve(NamedTuple):
    """One of the three curves of Fig. 7: the key in the history, the axis, and the limits of the paper's axis."""

    key: str
    label: str
    limits: tuple[float, float]
    ticks: int


CURVES = {
    "fig07a": Curve("robustness", f"$w_1$ [{ring.UNIT}]", (-0.1, 0.05), 4),
    "fig07b": Curve("min_eig_modified_inertia", r"$\lambda_{\min}$(M − E) [kg m$^2$]", (0.06, 0.07), 6),
    "fig07c": Curve("frequency_rad_s", r"$\omega_1$ [rad/s]", (250.0, 350.0), 5),
}


def exact_value(shaped: Shaping, key: str) -> float:
    """What the exact design gives for one of the curves of Fig. 7."""
    facts = shaped.exact.certificate
    return {
        "robustness": facts.robustness_after[0],
        "frequency_rad_s": facts.frequency_after_rad_s[0],
        "min_eig_modified_inertia": facts.min_eig_modified_inertia,
    }[key]


@styled()
def iteration_curve(shaped: Shaping, curve: Curve) -> Figure:
    """Fig. 7: one quantity against the iteration of the recursion."""
    figure = new_figure(4.4, 3.0)
    ax = figure.add_subplot()
    ax.plot(
        shaped.iterations,
        shaped.recursion.history[curve.key],
        color=BLUE,
        linewidth=1.8,
        label="recursion, estimated slopes",
    )
    ax.axhline(
        exact_value(shaped, curve.key), color=RED, linewidth=0.9, linestyle=(0, (6, 2)), label="exact design, one solve"
    )
    ax.set_xlim(0, 800)
    ax.set_ylim(*curve.limits)
    ax.set_yticks(np.linspace(*curve.limits, curve.ticks))
    ax.set_xlabel("iteration")
    ax.set_ylabel(curve.label)
    ax.grid(axis="y")
    ax.legend(loc="lower right")
    return figure

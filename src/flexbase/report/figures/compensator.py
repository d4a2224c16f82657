"""A compensator: its iteration curves where it has a history, otherwise its gain and what it does to each mode."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from flexbase.control.compensator import Certificate, Compensator
from flexbase.report.style import BLUE, DIVERGING, GREEN, GREY, INK, RED, new_figure

CURVES = {
    "robustness": ("$w_1$", BLUE),
    "frequency_rad_s": (r"$\omega_1$ [rad/s]", RED),
    "min_eig_modified_inertia": (r"$\lambda_{\min}$(M − E)", GREEN),
}


def draw_compensator(compensator: Compensator) -> Figure:
    """Curves against the iteration, or the gain beside frequencies and robustness before and after."""
    return _history(compensator) if compensator.history else _certificate(compensator)


def _history(compensator: Compensator) -> Figure:
    figure = new_figure(4.8, 5.2)
    axes = figure.subplots(len(CURVES), 1, sharex=True)
    for ax, (key, (label, color)) in zip(axes, CURVES.items(), strict=True):
        values = compensator.history[key]
        ax.plot(np.arange(len(values)), values, color=color)
        ax.set_ylabel(label)
        ax.set_xlim(0, len(values) - 1)
        ax.grid(axis="y")
    axes[0].axhline(0.0, color=INK, linewidth=0.8, linestyle=(0, (4, 2)))
    axes[-1].set_xlabel("iteration")
    figure.align_ylabels(axes)
    axes[0].set_title(_headline(compensator), loc="left")
    return figure


def _certificate(compensator: Compensator) -> Figure:
    figure = new_figure(6.8, 3.2)
    gain, frequency, robustness = figure.subplots(1, 3, width_ratios=[1.25, 1.0, 1.0])
    facts = compensator.certificate
    _matrix(gain, compensator.E)
    _before_after(frequency, facts.frequency_before_rad_s, facts.frequency_after_rad_s, r"$\omega_i$ [rad/s]")
    _before_after(robustness, facts.robustness_before, facts.robustness_after, "$w_i$")
    robustness.axhline(0.0, color=INK, linewidth=0.8, linestyle=(0, (4, 2)))
    figure.suptitle(_headline(compensator), fontsize=10, x=0.01, ha="left")
    figure.supxlabel(_facts(facts), fontsize=8, color=INK)
    return figure


def _matrix(ax: Axes, E: np.ndarray) -> None:
    size = float(np.abs(E).max()) or 1.0
    ax.imshow(E, cmap=DIVERGING, norm=Normalize(-size, size))
    if len(E) <= 8:
        for (i, j), entry in np.ndenumerate(E):
            color = "white" if abs(entry) > 0.7 * size else INK
            ax.text(
                j,
                i,
                f"{entry:.3g}".replace("-", "−"),
                ha="center",
                va="center",
                fontsize=8 if len(E) < 5 else 6,
                color=color,
            )
    ax.set_xticks(range(len(E)), [str(i + 1) for i in range(len(E))])
    ax.set_yticks(range(len(E)), [str(i + 1) for i in range(len(E))])
    ax.tick_params(length=0)
    ax.set_title("E", loc="center")
    ax.set_xlabel("arm joint")
    ax.set_ylabel("arm joint")


def _before_after(ax: Axes, before: tuple[float, ...], after: tuple[float, ...], label: str) -> None:
    for first, second in zip(before, after, strict=True):
        ax.annotate(
            "", (1, second), (0, first), arrowprops={"arrowstyle": "->", "color": GREY, "shrinkA": 4, "shrinkB": 4}
        )
    ax.plot(np.zeros(len(before)), before, "o", color=INK, markerfacecolor="white")
    ax.plot(np.ones(len(after)), after, "o", color=BLUE)
    ax.set_xticks([0, 1], ["before", "after"])
    ax.set_xlim(-0.35, 1.35)
    ax.margins(y=0.15)
    ax.set_title(label, loc="center")
    ax.ticklabel_format(axis="y", useOffset=False)
    ax.grid(axis="y")


def _headline(compensator: Compensator) -> str:
    return f"{compensator.robot}, {compensator.method} design"


def _facts(facts: Certificate) -> str:
    parts = [
        f"$\\lambda_{{\\min}}$(M − E) = {facts.min_eig_modified_inertia:.4g}",
        f"loop radius {facts.algebraic_loop_radius:.3f} (joint by joint {facts.algebraic_loop_radius_per_joint:.3f})",
    ]
    if facts.lag_margin_s is not None:
        parts.append(f"lag margin {1e3 * facts.lag_margin_s:.2f} ms")
    return ",  ".join(parts)

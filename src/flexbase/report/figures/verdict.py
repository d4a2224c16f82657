"""An exact verdict: the least eigenvalue of the Hermitian part over frequency, and the bands where it fails."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from flexbase.checks import Array
from flexbase.linear.passivity.verdict import Verdict
from flexbase.report.style import BLUE, GREY, INK, RED, SKY, new_figure

AROUND = 12.0  # how far beyond the outermost poles the axis goes


def draw_verdict(result: Verdict) -> Figure:
    """lambda_min of (F + F*)/2 over frequency; where it is below 0 the band is shaded, its worst half darker."""
    figure = new_figure(6.2, 3.8)
    ax = figure.add_subplot()
    omega = _frequencies(result)
    least = result.least_eigenvalue(omega)
    largest = result.port.largest_singular_value(omega)
    ax.axhline(0.0, color=INK, linewidth=0.8)
    _shade(ax, result, omega, least)
    ax.plot(omega, largest, color=GREY, linewidth=1.0, linestyle=(0, (4, 2)), label="largest gain, both signs")
    ax.plot(omega, -largest, color=GREY, linewidth=1.0, linestyle=(0, (4, 2)))
    ax.plot(omega, least, color=BLUE, label=r"least eigenvalue of $(G + G^*)/2$")
    if result.worst_at is not None and np.isfinite(result.shortage) and result.worst_at > 0.0:
        ax.plot([result.worst_at], [result.shortage], "o", color=RED, markersize=4.5, label="shortage", zorder=5)
    for mode in result.undamped:
        ax.axvline(mode, color=RED, linewidth=1.0, linestyle=":", label="undamped mode")
    if result.bandwidth is not None:
        ax.axvline(result.bandwidth, color=INK, linewidth=0.9, linestyle=(0, (2, 2)), label="bandwidth")
    ax.set_xscale("log")
    ax.set_xlim(float(omega[0]), float(omega[-1]))
    ax.set_xlabel("frequency [rad/s]")
    ax.set_ylabel("mobility at the tip [m/(N s)]")
    ax.set_title(_headline(result), loc="left")
    handles, labels = ax.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    figure.legend(once.values(), once.keys(), loc="outside lower center", ncols=2)
    return figure


def _frequencies(result: Verdict) -> Array:
    """From well below the slowest pole to well above the fastest, closer around each."""
    seeds = np.concatenate([result.port.seeds(), result.undamped, [result.bandwidth] if result.bandwidth else []])
    if not len(seeds):
        seeds = np.array([1.0])
    low, high = float(seeds.min()) / AROUND, float(seeds.max()) * AROUND
    own = [np.array(interval) for interval in (*result.half_at, *result.fails_at)]
    near = [seed * (1.0 + np.linspace(-0.2, 0.2, 81)) for seed in seeds]
    omega = np.unique(np.concatenate([np.geomspace(low, high, 900), *near, *own]))
    return omega[(omega >= low) & (omega <= high)]


def _shade(ax: Axes, result: Verdict, omega: Array, least: Array) -> None:
    if result.positive_real:
        return
    inside = np.zeros(len(omega), dtype=bool)
    for low, high in result.fails_at:
        inside |= (omega >= low) & (omega <= high)
    ax.fill_between(omega, least, 0.0, where=list(inside), color=SKY, alpha=0.35, linewidth=0.0, label="fails")
    for low, high in result.half_at:
        ax.axvspan(low, high, color=RED, alpha=0.10, linewidth=0.0, label="more than half of the shortage")


def _headline(result: Verdict) -> str:
    said = f"{result.name}: {'' if result.positive_real else 'not '}positive real"
    if result.positive_real:
        return said
    if not np.isfinite(result.shortage):
        return f"{said}, shortage without bound"
    share = f"{100.0 * -result.relative_shortage:.3g} % of the largest gain is missing"
    return f"{said}, {share}"

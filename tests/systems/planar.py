"""Planar arms, written as project files: what a user would write."""

from __future__ import annotations

from importlib import resources

import numpy as np

from flexbase.model.files.project import parse_project
from flexbase.plant import Plant

PAPER = (resources.files("flexbase.model.library") / "ueda2003.toml").read_text("utf-8")
PAPER_TIP = (0.33, -0.25)


def planar_text(
    lengths: list[float],
    *,
    m: int = 1,
    rows: tuple[str, ...] = ("x", "y"),
    slide: tuple[int, ...] = (),
    axes: dict[int, tuple[float, float]] | None = None,
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0),
    stiffness: float = 3e4,
    damping: float = 10.0,
) -> str:
    """A project file with one link a length, the joints in `slide` prismatic along `axes` (x if not given)."""
    parts = [f'name = "planar {len(lengths)}"', f"gravity = {list(gravity)}", "[robot]"]
    for i, length in enumerate(lengths):
        parts += ["[[robot.links]]", f'joint = "q{i + 1}"', f"length = {length}", f"mass = {8.0 - i}"]
        parts += [f"com = {0.5 * length + 0.01}", f"inertia = {0.05 + 0.01 * i}"]
        if i in slide:
            parts += ['type = "prismatic"', f"axis = {list((axes or {}).get(i, (1.0, 0.0)))}"]
    if m:
        parts += ["[base]", f"joints = {[f'q{i + 1}' for i in range(m)]}"]
        parts += [f"stiffness = {[stiffness * (1.0 + 0.3 * i) for i in range(m)]}", f"damping = {[damping] * m}"]
    parts += ["[task]", f"rows = {list(rows)}"]
    parts += ["[control]", f"stiffness = {[1e4] * len(rows)}", f"damping = {[200.0] * len(rows)}"]
    return "\n".join(parts) + "\n"


def planar(lengths: list[float], **options: object) -> Plant:
    """The plant of `planar_text`."""
    return Plant(parse_project(planar_text(lengths, **options), "planar.toml"))  # type: ignore[arg-type]


def sliding_pair(
    angle: float, m1: float = 12.0, m2: float = 3.0, stiffness: float = 5e4, damping: float = 20.0
) -> Plant:
    """A cart on a spring along x, carrying a mass that slides at `angle` to x; the task is the mass's x.

    Closed form: M = [[m1 + m2, m2 c], [m2 c, m2]], J = [1, c] with c = cos(angle).
    """
    c, s = float(np.cos(angle)), float(np.sin(angle))
    text = f"""
name = "sliding pair"
[robot]
[[robot.links]]
joint = "cart"
length = 0.0
mass = {m1}
com = 0.0
inertia = 0.1
type = "prismatic"
[[robot.links]]
joint = "slide"
length = 0.0
mass = {m2}
com = 0.0
inertia = 0.1
type = "prismatic"
axis = [{c!r}, {s!r}]
[base]
joints = ["cart"]
stiffness = [{stiffness}]
damping = [{damping}]
[task]
rows = ["x"]
[control]
stiffness = [1e4]
damping = [100.0]
"""
    return Plant(parse_project(text, "pair.toml"))

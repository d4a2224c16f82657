"""`flexbase modes`: vibration modes and their distance from positive realness."""

from __future__ import annotations

from math import pi

from cyclopts import App
from rich.console import RenderableType

from flexbase.cli.options.common import CompensatorFile, Json
from flexbase.cli.options.pose import PoseOptions, Robot, compensator_of, where
from flexbase.cli.terminal.document import document
from flexbase.cli.terminal.out import Out, check_out, write_out, written
from flexbase.cli.terminal.show import facts, put, table, title, verdict
from flexbase.linear.modal import Modes
from flexbase.linear.modal import modes as modes_of
from flexbase.plant import load
from flexbase.sheets.numbers import number

app = App(
    name="modes",
    help_epilogue="""Examples:
  flexbase modes ueda2003 --tip 0.33,-0.25
  flexbase modes ueda2003 --tip -0.3,0.2 --elbow - --json
  flexbase modes ueda2003 --joints -1.59,1.40 --compensator compensator.json

w = 0 (alignment 1) is the robust arm configuration; the farther below, the
sooner a stiff task-space loop goes unstable.""",
)


@app.default
def modes(
    robot: Robot,
    /,
    *,
    pose: PoseOptions = PoseOptions(),  # noqa: B008
    compensator: CompensatorFile = None,
    out: Out = None,
    json: Json = False,
) -> None:
    """Frequencies, damping, residues, robustness w, alignment and the verdict at one pose."""
    check_out(out)
    plant = load(robot)
    found = modes_of(pose.pose(plant), compensator_of(plant, compensator))
    content = found.to_dict()
    write_out(out, "modes", found, content)
    put(document("modes", content)) if json else put(*_tables(found, compensator is not None), *written(out))


def _tables(found: Modes, compensated: bool) -> list[RenderableType]:
    columns = ["mode", "frequency\n[rad/s]", "\n[Hz]", "damping\nratio", "robustness w\n[m/(N s^2)]", "alignment\n[1]"]
    rows = [
        [
            mode.label,
            number(mode.frequency),
            number(mode.frequency / (2.0 * pi), 6),
            number(mode.damping_ratio, 6),
            number(mode.robustness),
            number(mode.alignment),
        ]
        for mode in found.modes
    ]
    damped = any(mode.residue_s.any() for mode in found.modes)
    matrices: list[tuple[str, object]] = []
    for i, mode in enumerate(found.modes, start=1):
        matrices.append((f"R_{i} [m/(N s^2)]", mode.residue))
        matrices += [(f"R'_{i} [m/(N s)]", mode.residue_s)] if damped else []
    matrices.append(("R_0 [m/(N s^2)]", found.rigid_mode))
    heading = f"vibration modes {'with' if compensated else 'without'} compensator"
    return [
        title(found.pose.plant.name, heading),
        "",
        where(found.pose),
        *([table(columns, rows)] if rows else [""]),
        facts(matrices),
        "",
        verdict(found.positive_real, "Positive real", "Not positive real", found.caveat),
    ]

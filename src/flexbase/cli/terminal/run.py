"""The outcome of a simulation, as tables."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.terminal.show import facts, table, title, verdict
from flexbase.sheets import units
from flexbase.sheets.numbers import number
from flexbase.simulation import Run


def tables(found: Run) -> list[RenderableType]:
    """Heading, peak torques and speeds, times and errors, and whether the tip settles."""
    arm = found.goal.arm
    kinds = arm.joint_units
    torque, speed = units.each("effort", kinds), units.each("speed", kinds)
    rows = [
        [name, f"{number(t, 6)} {t_unit}", f"{number(s, 6)} {s_unit}"]
        for name, t, t_unit, s, s_unit in zip(
            arm.joint_names, found.peak_torque, torque, found.peak_speed, speed, strict=True
        )
    ]
    unit = "mm (or mrad)" if "rad" in arm.task.units else "mm"
    time, peak = found.settling_time_s, found.peak_error_m
    said = [
        ("settling time from the switch", "none" if time is None else f"{number(1e3 * time, 4)} ms"),
        ("largest tip error after the switch", "none" if peak is None else f"{number(1e3 * peak, 6)} {unit}"),
        ("samples", f"{len(found.t)}, to {number(float(found.t[-1]), 6)} s"),
    ]
    heading = f"simulated {'with' if found.compensated else 'without'} compensator, switch at {found.switch:g} s"
    if found.caution:
        said.append(("caution", found.caution))
    end = verdict(found.settled, "Settles below 0.1 mm", "Does not settle below 0.1 mm", found.stopped or "")
    drives = table(["joint", "peak torque", "peak speed"], rows)
    return [title(found.goal.plant.name, heading), drives, facts(said), "", end]

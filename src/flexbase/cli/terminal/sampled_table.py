"""The outcome of a sampled run, as a table."""

from __future__ import annotations

from rich.console import RenderableType

from flexbase.cli.terminal.show import facts, title, verdict
from flexbase.sheets.numbers import number as shown
from flexbase.simulation import SampledRun


def tables(found: SampledRun) -> list[RenderableType]:
    """What was run, the linear verdict, and whether the tip settles."""
    time, size = found.settling_time_s, 1e3 * found.tolerance
    word = "stable" if found.predicted else "unstable"
    said = [
        ("linear verdict", f"{word}, spectral radius {found.spectral_radius:.5f} a sample"),
        (f"settling time after {found.judged_from:g} s", "none" if time is None else f"{shown(1e3 * time, 4)} ms"),
        ("largest tip error after the switch", f"{shown(1e3 * found.peak_error_m, 4)} mm (or mrad)"),
        ("peak torque", ", ".join(shown(torque, 4) for torque in found.peak_torque) + " N m (or N)"),
        ("samples saturated", f"{found.saturated_samples} of {len(found.t)}"),
    ]
    heading = f"{found.controller.name} at {found.controller.sensing.rate:g} Hz, plant {found.engine}"
    end = verdict(
        found.settled, f"Settles below {size:g} mm", f"Does not settle below {size:g} mm", found.stopped or ""
    )
    return [title(found.goal.plant.name, heading), facts(said), "", end]

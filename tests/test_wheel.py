"""The built wheel, not only the checkout: what a user installs holds the bundled robots and runs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent


def test_the_wheel_runs_outside_the_checkout(tmp_path):
    """Build, unpack into an empty folder, and ask the packaged program for the paper's mode."""
    build = [sys.executable, "-m", "pip", "wheel", str(ROOT), "--no-deps", "--no-build-isolation", "-q", "-w", tmp_path]
    subprocess.run(build, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("flexbase-*.whl")
    site = tmp_path / "site"
    subprocess.run(
        [sys.executable, "-m", "pip", "install", "--no-deps", "-q", "--target", site, wheel],
        check=True,
        capture_output=True,
    )
    program = "import flexbase, sys; print(flexbase.__file__); from flexbase.cli.main import main; main()"
    run = subprocess.run(
        [sys.executable, "-P", "-c", program, "modes", "ueda2003", "--tip", "0.33,-0.25", "--json"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(site)},
        check=True,
        capture_output=True,
        text=True,
    )
    place, _, document = run.stdout.partition("\n")
    assert Path(place).is_relative_to(site)
    assert abs(json.loads(document)["modes"][0]["frequency_rad_s"] - 277.1029065) < 1e-6
    assert (site / "flexbase" / "py.typed").is_file()

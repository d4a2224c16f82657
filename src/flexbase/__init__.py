"""flexbase: where may a manipulator on a flexible base be driven hard, and what makes it safe elsewhere."""

from importlib import import_module
from typing import Any

from flexbase.compensators import METHODS, design
from flexbase.control.compensator import Certificate, Compensator, load_compensator
from flexbase.errors import (
    FlexbaseError,
    FlexbaseWarning,
    Infeasible,
    InputError,
    MissingExtra,
    SingularArm,
    Unreachable,
)
from flexbase.linear.linearise import linearise
from flexbase.linear.modal import Mode, Modes, modes
from flexbase.linear.passivity.judge import verdict
from flexbase.linear.passivity.verdict import Verdict
from flexbase.linear.second_order import SecondOrder
from flexbase.measures import MEASURES
from flexbase.measures.manipulability import Ellipsoid, Manipulability, manipulability
from flexbase.model.files.bundled import Robots, robots
from flexbase.model.files.start import init
from flexbase.model.loop import Gain, Loop
from flexbase.model.sensing import Sensing
from flexbase.model.task import Gains
from flexbase.plant import Plant, Pose, load
from flexbase.sampled.changes import Changed, changed_pose, eight_changes
from flexbase.sampled.controller import SampledController
from flexbase.sampled.figures import FIGURES
from flexbase.sampled.files import load_controller, save_controller
from flexbase.sampled.verdict import HardwareVerdict, hardware_verdict
from flexbase.simulation import (
    Move,
    Moves,
    Push,
    Run,
    Runs,
    SampledMove,
    SampledRun,
    simulate,
    simulate_many,
    simulate_sampled,
    simulate_sampled_many,
)
from flexbase.simulation.plants.mjcf import to_mjcf
from flexbase.study.agreement.study import Agreement, agreement
from flexbase.study.check import Check, check
from flexbase.study.layout.best_layout import Layout, layout
from flexbase.study.layout.targets import read_targets
from flexbase.study.montecarlo import Criterion, Draws, Fixed, Lognormal, MonteCarlo, Normal, Uniform, montecarlo
from flexbase.study.postures.best_postures import Postures, postures
from flexbase.study.robust_configurations.curves import RobustCurves, robust_curves
from flexbase.study.robust_configurations.points import RobustPoints, robust_points
from flexbase.study.running.as_it_runs import AsItRuns, as_it_runs
from flexbase.study.running.comparison import Comparison, compare
from flexbase.study.running.hardware_map import hardware_map
from flexbase.study.running.hardware_path import HardwarePath, hardware_path
from flexbase.study.running.hardware_study import HardwareStudy, Setting, hardware_study
from flexbase.study.running.recommend import Recommendation, recommend
from flexbase.study.running.region import Region, region
from flexbase.study.running.safe_gain import SafeGain, safe_gain
from flexbase.study.telling import sheet, summary
from flexbase.sweeps import Cells, Execution, difference, open_dataset, save_csv, save_netcdf, sweep
from flexbase.synthesis import HARDWARE_METHODS
from flexbase.synthesis.make import make_controller

__version__ = "0.1.0"

__all__ = [
    "Agreement",
    "AsItRuns",
    "Cells",
    "Certificate",
    "Changed",
    "Check",
    "Comparison",
    "Compensator",
    "Criterion",
    "Draws",
    "Ellipsoid",
    "Execution",
    "FIGURES",
    "Fixed",
    "FlexbaseError",
    "FlexbaseWarning",
    "Gain",
    "Gains",
    "HARDWARE_METHODS",
    "HardwarePath",
    "HardwareStudy",
    "HardwareVerdict",
    "Infeasible",
    "InputError",
    "Layout",
    "Lognormal",
    "Loop",
    "MEASURES",
    "METHODS",
    "Manipulability",
    "MissingExtra",
    "Mode",
    "Modes",
    "MonteCarlo",
    "Move",
    "Moves",
    "Normal",
    "Plant",
    "Pose",
    "Postures",
    "Push",
    "Recommendation",
    "Region",
    "Reproduction",
    "Robots",
    "RobustCurves",
    "RobustPoints",
    "Run",
    "Runs",
    "SafeGain",
    "SampledController",
    "SampledMove",
    "SampledRun",
    "SecondOrder",
    "Sensing",
    "Setting",
    "SingularArm",
    "Uniform",
    "Unreachable",
    "Verdict",
    "__version__",
    "agreement",
    "as_it_runs",
    "changed_pose",
    "check",
    "compare",
    "design",
    "difference",
    "draw",
    "eight_changes",
    "hardware_map",
    "hardware_path",
    "hardware_study",
    "hardware_verdict",
    "init",
    "layout",
    "linearise",
    "load",
    "load_compensator",
    "load_controller",
    "make_controller",
    "manipulability",
    "modes",
    "montecarlo",
    "open_dataset",
    "plot",
    "postures",
    "read_targets",
    "recommend",
    "region",
    "reproduce",
    "robots",
    "robust_curves",
    "robust_points",
    "safe_gain",
    "save_controller",
    "save_csv",
    "save_netcdf",
    "save_plot",
    "sheet",
    "simulate",
    "simulate_many",
    "simulate_sampled",
    "simulate_sampled_many",
    "summary",
    "sweep",
    "to_mjcf",
    "verdict",
]


LATER = {  # what draws imports matplotlib, which takes most of a second
    "Reproduction": "flexbase.study.paper.table",
    "draw": "flexbase.report.draw",
    "plot": "flexbase.report.plot",
    "reproduce": "flexbase.report.paper.all_figures",
    "save_plot": "flexbase.report.plot",
}
RENAMED = {
    "Description": "Check",
    "Probability": "MonteCarlo",
    "agreement_study": "agreement",
    "best_layout": "layout",
    "best_posture": "postures",
    "describe": "check",
}


def __getattr__(name: str) -> Any:
    """What draws, on first use; and what a name of before is called now."""
    if name in LATER:
        return getattr(import_module(LATER[name]), name)
    now = f". It is now called {RENAMED[name]}" if name in RENAMED else ""
    raise AttributeError(f"module 'flexbase' has no attribute {name!r}{now}")

"""flexbase: where may a manipulator on a flexible base be driven hard, and what makes it safe elsewhere."""

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
from flexbase.model.loop import Loop
from flexbase.model.task import Gains
from flexbase.plant import Plant, Pose, load
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
from flexbase.study.agreement.study import Agreement, agreement_study
from flexbase.study.layout.layout import Layout, best_layout
from flexbase.study.layout.targets import read_targets
from flexbase.study.montecarlo import Criterion, Fixed, Lognormal, Normal, Probability, Uniform, montecarlo
from flexbase.study.postures.posture import Postures, best_posture
from flexbase.study.robust_configurations.curves import RobustCurves, robust_curves
from flexbase.study.robust_configurations.points import RobustPoints, robust_points
from flexbase.sweeps import difference, open_dataset, summary, sweep

__version__ = "0.1.0"

__all__ = [
    "MEASURES",
    "METHODS",
    "Agreement",
    "Certificate",
    "Compensator",
    "Criterion",
    "Ellipsoid",
    "Fixed",
    "FlexbaseError",
    "FlexbaseWarning",
    "Gains",
    "Infeasible",
    "InputError",
    "Layout",
    "Lognormal",
    "Loop",
    "Manipulability",
    "MissingExtra",
    "Mode",
    "Modes",
    "Move",
    "Moves",
    "Normal",
    "Plant",
    "Pose",
    "Postures",
    "Probability",
    "Push",
    "RobustCurves",
    "RobustPoints",
    "Run",
    "Runs",
    "SampledMove",
    "SampledRun",
    "SecondOrder",
    "SingularArm",
    "Uniform",
    "Unreachable",
    "Verdict",
    "__version__",
    "agreement_study",
    "best_layout",
    "best_posture",
    "design",
    "difference",
    "linearise",
    "load",
    "load_compensator",
    "manipulability",
    "modes",
    "montecarlo",
    "open_dataset",
    "plot",
    "read_targets",
    "robust_curves",
    "robust_points",
    "simulate",
    "simulate_many",
    "simulate_sampled",
    "simulate_sampled_many",
    "summary",
    "sweep",
    "to_mjcf",
    "verdict",
]


def __getattr__(name: str) -> Any:
    """`fb.plot` on first use: drawing imports matplotlib, which takes most of a second."""
    if name == "plot":
        from flexbase.report.plot import plot

        return plot
    raise AttributeError(f"module 'flexbase' has no attribute {name!r}")

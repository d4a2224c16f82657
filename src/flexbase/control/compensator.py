"""The mode shape compensator: a constant gain on the joint accelerations, and the certificate that comes with it."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from flexbase.checks import Array, check_symmetric, finite_array
from flexbase.errors import InputError, writing

FORMAT = "flexbase compensator 1"
MEND = "Give a file that `flexbase design --out` or `Compensator.save` wrote."


@dataclass(frozen=True)
class Certificate:
    """What a compensator does at the pose it was designed for. Lists run over the base modes, softest first.

    min_eig_modified_inertia : smallest eigenvalue of M - E, positive if the arm stays an inertia  [U03 eq 11]
    robustness_before, robustness_after : w_i  [U03 eq 9]
    frequency_before_rad_s, frequency_after_rad_s : omega_i
    target_residual : how far the design's own equations are from holding, relative; None for a gain from elsewhere
    algebraic_loop_radius : rho; one common delay destabilises at 1 and above  [theory §8]
    algebraic_loop_radius_per_joint : mu; the same with another delay in each joint  [theory §8]
    lag_margin_s : first-order lag of the acceleration feedback that the loop bears; None: no limit to 1 s, or no gains
    closed_loop_abscissa : rightmost pole of the task-space loop [1/s]; None without gains
    lag_limit_s : smallest total lag of the acceleration that takes all damping of a base mode without the task loop, by
        the first-order delay law: accurate to about 0.1 ms on the paper's arm, over-predicting beyond; 0 on an undamped
        base that a lag pumps. None: E pumps no mode, none within 1 s, or a file of an older version  [theory §8]
    statement : why the plant is positive real with this gain, or that it is not; empty in files of older versions
    warnings : plain words on what to beware of
    """

    min_eig_modified_inertia: float
    robustness_before: tuple[float, ...]
    robustness_after: tuple[float, ...]
    frequency_before_rad_s: tuple[float, ...]
    frequency_after_rad_s: tuple[float, ...]
    target_residual: float | None
    algebraic_loop_radius: float
    algebraic_loop_radius_per_joint: float
    lag_margin_s: float | None
    closed_loop_abscissa: float | None
    lag_limit_s: float | None = None
    statement: str = ""
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Compensator:
    """tau_a = tau~_a + E q_a'', designed for one arm configuration.  [U03 eq 10]

    E : symmetric, shape (n, n) [kg m^2, kg m or kg]
    q : the pose it was designed for, shape (N,)
    history : for recursive methods, a value an iteration of w_1, omega_1 and lambda_min(M - E)
    """

    method: str
    robot: str
    E: Array
    q: Array
    certificate: Certificate
    history: dict[str, Array] = field(default_factory=dict, repr=False)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers."""
        return {
            "method": self.method,
            "robot": self.robot,
            "E": self.E.tolist(),
            "q": self.q.tolist(),
            "certificate": json.loads(json.dumps(asdict(self.certificate))),
        }

    def summary(self) -> str:
        """The gain and its certificate in plain text."""
        rows = "\n".join("      " + "  ".join(f"{entry: .6f}" for entry in row) for row in self.E)
        facts = "\n".join(f"  {key}: {_shown(value)}" for key, value in asdict(self.certificate).items())
        return f"{self.robot}, method {self.method}\n  E =\n{rows}\n{facts}"

    def save(self, path: str | Path) -> None:
        """Write as JSON. Raises InputError where the place cannot be written."""
        text = json.dumps({"format": FORMAT, **self.to_dict()}, indent=2) + "\n"
        with writing(path):
            Path(path).write_text(text, encoding="utf-8")


def load_compensator(path: str | Path) -> Compensator:
    """Read a compensator that `save` wrote. Raises InputError."""
    try:
        document = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as fault:
        raise InputError(f"{path}: cannot be read ({fault.strerror}). {MEND}") from fault
    except json.JSONDecodeError as fault:
        raise InputError(f"{path}: not valid JSON, line {fault.lineno}, column {fault.colno}. {MEND}") from fault
    except (ValueError, RecursionError) as fault:
        raise InputError(f"{path}: not a JSON text. {MEND}") from fault
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise InputError(f"{path}: not a compensator. {MEND}")
    try:
        E = np.atleast_2d(finite_array(f"{path}: E", document["E"]))
        facts: dict[str, Any] = {
            key: tuple(v) if isinstance(v, list) else v for key, v in document["certificate"].items()
        }
        if E.ndim != 2 or E.shape[0] != E.shape[1]:
            raise InputError(f"{path}: E has shape {E.shape}, a square matrix is needed. {MEND}")
        return Compensator(
            str(document["method"]),
            str(document["robot"]),
            check_symmetric(f"{path}: E", E, ""),
            finite_array(f"{path}: q", document["q"]),
            Certificate(**facts),
        )
    except (KeyError, TypeError, AttributeError) as fault:
        raise InputError(f"{path}: a compensator whose entries are missing or unknown. {MEND}") from fault


def _shown(value: Any) -> str:
    if value is None:
        return "none"
    if isinstance(value, tuple):
        return "\n    ".join(value) if value and isinstance(value[0], str) else ", ".join(map(_shown, value)) or "none"
    return value if isinstance(value, str) else f"{value:.6g}"

"""The mode shape compensator: a constant gain on the joint accelerations, and the certificate that comes with it."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from textwrap import indent
from typing import Any, ClassVar

import numpy as np

from flexbase.checks import Array, check_symmetric, finite_array
from flexbase.errors import InputError, read_document, writing
from flexbase.sheets.numbers import listed, matrix, number
from flexbase.sheets.sheet import Column, Facts, Note, Sheet, Table, answer, facts, make_sheet, table, words
from flexbase.sheets.told import Told

FORMAT = "flexbase compensator 1"
IDEAL = "Continuous time, ideal acceleration."
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

    def modes(self) -> Table:
        """A row a mode, before and after."""
        before = zip(self.robustness_before, self.frequency_before_rad_s, strict=True)
        after = zip(self.robustness_after, self.frequency_after_rad_s, strict=True)
        rows = [
            [str(i), *(number(value) for pair in zip(one, other, strict=True) for value in pair)]
            for i, (one, other) in enumerate(zip(before, after, strict=True), start=1)
        ]
        columns = [Column(f"w {when}", "m/(N s^2)") for when in ("before", "after")]
        columns += [Column(f"frequency {when}", "rad/s") for when in ("before", "after")]
        return table([words("mode"), *columns], rows)

    def margins(self) -> Facts:
        """What the gain costs, and what its loop bears."""
        lag, limit, loop = self.lag_margin_s, self.lag_limit_s, self.closed_loop_abscissa
        bears = "no limit to 1 s" if lag is None else f"{number(1e3 * lag, 6)} ms"
        undefined = "undefined: no task gains"
        return facts(
            ("smallest eigenvalue of M - E", number(self.min_eig_modified_inertia, 6)),
            ("target residual, relative", number(self.target_residual, 3)),
            ("algebraic-loop radius, one delay", number(self.algebraic_loop_radius, 6)),
            ("algebraic-loop radius, a delay a joint", number(self.algebraic_loop_radius_per_joint, 6)),
            ("lag margin of the acceleration signal", undefined if loop is None else bears),
            (
                "lag that takes a mode's whole damping",
                "none within 1 s" if limit is None else f"{number(1e3 * limit, 6)} ms",
            ),
            ("closed loop, rightmost pole [1/s]", undefined if loop is None else number(loop, 6)),
        )


@dataclass(frozen=True, eq=False)
class Compensator(Told):
    """tau_a = tau~_a + E q_a'', designed for one arm configuration.  [U03 eq 10]

    E : symmetric, shape (n, n) [kg m^2, kg m or kg]
    q : the pose it was designed for, shape (N,)
    history : for recursive methods, a value an iteration of w_1, omega_1 and lambda_min(M - E)
    unit : of the entries of E
    """

    method: str
    robot: str
    E: Array
    q: Array
    certificate: Certificate
    history: dict[str, Array] = field(default_factory=dict, repr=False)
    unit: str = "kg m^2, kg m or kg"

    document: ClassVar = ("method", "robot", "E", "q", "certificate")

    def sheet(self) -> Sheet:
        """E, the modes before and after, the margins, and whether the task-space loop settles."""
        proof, said, loop = self.certificate, self.certificate.statement, self.certificate.closed_loop_abscissa
        loop_is = "The task-space loop is {} here".format
        return make_sheet(
            self.robot,
            f"compensator, method {self.method}, at joints {listed(self.q)}",
            self._gain(),
            proof.modes(),
            proof.margins(),
            Note(f"{said[0].upper()}{said[1:]}") if said else None,
            None if loop is None else answer(loop < 0.0, loop_is("stable"), loop_is("unstable"), IDEAL),
            cautions=proof.warnings,
        )

    def _gain(self) -> Facts | Note:
        """E beside its name, or below it where it is wide."""
        if len(self.E) <= 4:
            return facts((f"E [{self.unit}]", matrix(self.E)))
        head = f"E [{self.unit}], three digits; all of them in the JSON document and file"
        return Note(f"{head}\n{indent(matrix(self.E), '  ')}")

    def save(self, path: str | Path) -> None:
        """Write as JSON. Raises InputError where the place cannot be written."""
        text = json.dumps({"format": FORMAT, **self.to_dict()}, indent=2) + "\n"
        with writing(path):
            Path(path).write_text(text, encoding="utf-8")


def load_compensator(path: str | Path) -> Compensator:
    """Read a compensator that `save` wrote. Raises InputError."""
    document = read_document(path, "compensator", FORMAT, MEND)
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

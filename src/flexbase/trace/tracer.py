"""Record what a generic function does: one list of elementary operations, common subexpressions shared."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

from flexbase.errors import import_extra
from flexbase.trace.algebra import Scalar, Vector

# Operations that programs are made of, as CasADi calls them without its prefix.
ARITHMETIC = ("ADD", "SUB", "MUL", "DIV", "NEG", "SQ", "TWICE", "INV", "SQRT", "FABS", "FMIN", "FMAX", "FLOOR", "SIGN")
CIRCULAR = ("SIN", "COS", "ATAN2")
LOGIC = ("LT", "LE", "EQ", "NE", "NOT", "AND", "OR", "IF_ELSE_ZERO")
OPERATIONS = ("INPUT", "OUTPUT", "CONST", "ASSIGN", *ARITHMETIC, *CIRCULAR, *LOGIC)


class Instruction(NamedTuple):
    """One step: slot[result] = operation(slot[arguments]).

    INPUT and OUTPUT move a value between a slot and the place `number` of the inputs or outputs; CONST writes `value`.
    """

    operation: str
    result: int
    arguments: tuple[int, ...] = ()
    number: int = 0
    value: float = 0.0


@dataclass(frozen=True)
class Program:
    """A function of scalars as straight-line code.

    inputs, outputs : how many values go in and come out; slots : how many are alive at once
    """

    inputs: int
    outputs: int
    slots: int
    instructions: tuple[Instruction, ...]

    def digest(self) -> str:
        """A name for exactly this program."""
        return hashlib.sha256(repr(self).encode()).hexdigest()


def trace(function: Callable[[Vector], Sequence[Scalar]], inputs: int, *, derivative: bool = False) -> Program:
    """The program of a function that takes a vector of `inputs` scalars and gives a sequence of them.

    derivative : append the exact derivatives of every value by every input, value by value
    Raises MissingExtra without CasADi, NotImplementedError for an operation that no target prints.
    """
    casadi = import_extra("casadi", "fast")
    q = casadi.SX.sym("q", inputs)
    values = casadi.vertcat(*function(tuple(q[i] for i in range(inputs))))
    if derivative:
        slopes = casadi.densify(casadi.jacobian(values, q))
        values = casadi.vertcat(values, casadi.vec(slopes.T))
    return _listed(casadi.Function("traced", [q], [casadi.densify(casadi.cse(values))]), inputs)


def _listed(function: Any, inputs: int) -> Program:
    names, instructions = _names(), []
    for k in range(function.n_instructions()):
        name = names.get(function.instruction_id(k))
        if name is None:
            raise NotImplementedError(f"operation {function.instruction_id(k)} of a traced function has no printer")
        read, written = function.instruction_input(k), function.instruction_output(k)
        if name == "INPUT":
            instructions.append(Instruction(name, written[0], number=read[1]))
        elif name == "OUTPUT":
            instructions.append(Instruction(name, -1, (read[0],), number=written[1]))
        elif name == "CONST":
            instructions.append(Instruction(name, written[0], value=float(function.instruction_constant(k))))
        else:
            instructions.append(Instruction(name, written[0], tuple(read)))
    return Program(inputs, function.nnz_out(0), function.sz_w(), tuple(instructions))


@cache
def _names() -> dict[int, str]:
    import casadi

    return {getattr(casadi, f"OP_{name}"): name for name in OPERATIONS}

"""Print a program as LLVM IR: straight-line code on vector registers, one loop over the configurations."""

from __future__ import annotations

from collections.abc import Sequence

from flexbase.trace.targets.circular import arc_tangent, sine_and_cosine
from flexbase.trace.targets.emitter import LANES, Emitter, declarations
from flexbase.trace.tracer import Instruction, Program

ENTRY = "evaluate"
RELATIONS = {"LT": "olt", "LE": "ole", "EQ": "oeq", "NE": "une"}


def print_llvm(program: Program, iterate: bool = False) -> str:
    """IR of void evaluate(const double *x, double *y, int64 x_stride, int64 y_stride, int64 cells, int64 steps).

    Input i of configuration c is x[i * x_stride + c], output likewise; cells is a positive multiple of LANES.

    iterate : run `steps` (at least 1) times before anything is stored, the outputs of one time being the first inputs
        of the next; further inputs stay as they are. Else `steps` is not looked at
    """
    body = _repeated(program) if iterate else _once(program)
    return "\n".join(
        [
            *declarations(),
            f"define void @{ENTRY}(ptr noalias readonly %x, ptr noalias %y, i64 %x_stride, i64 %y_stride, i64 %cells, "
            'i64 %steps) "prefer-vector-width"="512" {',
            "entry:",
            "  br label %block",
            "block:",
            f"  %cell = phi i64 [0, %entry], [%next, %{'after' if iterate else 'block'}]",
            *body,
            f"  %next = add i64 %cell, {LANES}",
            "  %more = icmp slt i64 %next, %cells",
            "  br i1 %more, label %block, label %done",
            "done:",
            "  ret void",
            "}",
        ]
    )


def _once(program: Program) -> list[str]:
    body = _Printer()
    for instruction in program.instructions:
        body.step(instruction)
    return body.lines


def _repeated(program: Program) -> list[str]:
    """A loop over the steps: inputs are read before the first, the state stays in registers and is written at last."""
    before, after, state = Emitter("first"), Emitter("last"), range(program.outputs)
    read = [_load(before, i) for i in range(program.inputs)]
    body = _Printer([f"%state{i}" for i in state] + read[program.outputs :])
    for instruction in program.instructions:
        body.step(instruction)
    for i in state:
        _store(after, i, body.results[i])
    return [
        *before.lines,
        "  br label %step",
        "step:",
        "  %count = phi i64 [0, %block], [%counted, %step]",
        *(f"  %state{i} = phi {Emitter.vector} [{read[i]}, %block], [{body.results[i]}, %step]" for i in state),
        *body.lines,
        "  %counted = add i64 %count, 1",
        "  %again = icmp slt i64 %counted, %steps",
        "  br i1 %again, label %step, label %after",
        "after:",
        *after.lines,
    ]


class _Printer(Emitter):
    """Keeps what each slot holds: a name of a value or a constant, and which of them are comparisons.

    inputs : names of the inputs where they are in registers already; outputs then stay there too, in `results`
    """

    def __init__(self, inputs: Sequence[str] | None = None) -> None:
        super().__init__()
        self._inputs = inputs
        self.results: dict[int, str] = {}
        self._slots: dict[int, str] = {}
        self._masks: dict[str, str] = {}
        self._turned: dict[str, tuple[str, str]] = {}
        self._inverses: dict[str, str] = {}

    def step(self, i: Instruction) -> None:
        operands = [self._slots[slot] for slot in i.arguments]
        if i.operation == "OUTPUT":
            value = self._number(operands[0])
            if self._inputs is None:
                _store(self, i.number, value)
            self.results[i.number] = value
        elif i.operation == "INPUT":
            self._slots[i.result] = _load(self, i.number) if self._inputs is None else self._inputs[i.number]
        elif i.operation == "CONST":
            self._slots[i.result] = self.constant(i.value)
        elif i.operation == "IF_ELSE_ZERO":
            self._slots[i.result] = self.select(self._mask(operands[0]), self._number(operands[1]), self.constant(0.0))
        elif i.operation in ("AND", "OR", "NOT"):
            self._slots[i.result] = self._logic(i.operation, [self._mask(x) for x in operands])
        elif i.operation in RELATIONS:
            mask = self.compare(RELATIONS[i.operation], *map(self._number, operands))
            self._slots[i.result] = self._as_slot(mask)
        else:
            self._slots[i.result] = self._arithmetic(i.operation, [self._number(x) for x in operands])

    def _arithmetic(self, operation: str, x: list[str]) -> str:
        match operation:
            case "ADD" | "SUB" | "MUL" | "NEG":
                return str(getattr(self, operation.lower())(*x))
            case "DIV":
                return self.mul(x[0], self._inverse(x[1]))
            case "ASSIGN":
                return x[0]
            case "SQ":
                return self.mul(x[0], x[0])
            case "TWICE":
                return self.add(x[0], x[0])
            case "INV":
                return self._inverse(x[0])
            case "SQRT" | "FABS" | "FLOOR":
                return self.call(operation.lower(), x[0])
            case "FMIN" | "FMAX":
                return self.call({"FMIN": "minnum", "FMAX": "maxnum"}[operation], *x)
            case "SIGN":
                one, zero = self.call("copysign", self.constant(1.0), x[0]), self.constant(0.0)
                return self.select(self.compare("oeq", x[0], zero), zero, one)
            case "SIN" | "COS":
                if x[0] not in self._turned:
                    self._turned[x[0]] = sine_and_cosine(self, x[0])
                return self._turned[x[0]][operation == "COS"]
            case "ATAN2":
                return arc_tangent(self, *x)
        raise NotImplementedError(operation)

    def _inverse(self, x: str) -> str:
        """1/x, once a value: pivots and lengths divide many times, and nothing is dearer than a division."""
        if x not in self._inverses:
            self._inverses[x] = self.div(self.constant(1.0), x)
        return self._inverses[x]

    def _logic(self, operation: str, masks: list[str]) -> str:
        if operation == "NOT":
            return self._as_slot(self.emit(f"xor {self.mask} {masks[0]}, <{', '.join(['i1 true'] * LANES)}>"))
        return self._as_slot(self.emit(f"{operation.lower()} {self.mask} {masks[0]}, {masks[1]}"))

    def _as_slot(self, mask: str) -> str:
        """Remember a mask; it becomes a number only where one is asked for."""
        self._masks[mask] = ""
        return mask

    def _number(self, name: str) -> str:
        """A slot as doubles: a comparison counts 1 or 0."""
        if name not in self._masks:
            return name
        if not self._masks[name]:
            self._masks[name] = self.emit(f"uitofp {self.mask} {name} to {self.vector}")
        return self._masks[name]

    def _mask(self, name: str) -> str:
        """A slot as a mask: nonzero counts as true."""
        return name if name in self._masks else self.compare("une", name, self.constant(0.0))


def _load(e: Emitter, number: int) -> str:
    """Input `number` of the lanes' configurations."""
    return e.emit(f"load {e.vector}, ptr {_place(e, 'x', number)}, align 8")


def _store(e: Emitter, number: int, value: str) -> None:
    """A value as output `number` of the lanes' configurations."""
    e.line(f"store {e.vector} {value}, ptr {_place(e, 'y', number)}, align 8")


def _place(e: Emitter, array: str, number: int) -> str:
    row = e.emit(f"mul i64 %{array}_stride, {number}")
    start = e.emit(f"add i64 {row}, %cell")
    return e.emit(f"getelementptr double, ptr %{array}, i64 {start}")

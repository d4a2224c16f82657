"""Print a program as LLVM IR: straight-line code on vector registers, one loop over the configurations."""

from __future__ import annotations

from flexbase.trace.targets.circular import arc_tangent, sine_and_cosine
from flexbase.trace.targets.emitter import LANES, Emitter, declarations
from flexbase.trace.tracer import Instruction, Program

ENTRY = "evaluate"
RELATIONS = {"LT": "olt", "LE": "ole", "EQ": "oeq", "NE": "une"}


def print_llvm(program: Program) -> str:
    """IR of void evaluate(const double *x, double *y, int64 x_stride, int64 y_stride, int64 cells).

    Input i of configuration c is x[i * x_stride + c], output likewise; cells is a positive multiple of LANES.
    """
    body = _Printer()
    for instruction in program.instructions:
        body.step(instruction)
    return "\n".join(
        [
            *declarations(),
            f"define void @{ENTRY}(ptr noalias readonly %x, ptr noalias %y, i64 %x_stride, i64 %y_stride, i64 %cells)"
            ' "prefer-vector-width"="512" {',
            "entry:",
            "  br label %block",
            "block:",
            "  %cell = phi i64 [0, %entry], [%next, %block]",
            *body.lines,
            f"  %next = add i64 %cell, {LANES}",
            "  %more = icmp slt i64 %next, %cells",
            "  br i1 %more, label %block, label %done",
            "done:",
            "  ret void",
            "}",
        ]
    )


class _Printer(Emitter):
    """Keeps what each slot holds: a name of a value or a constant, and which of them are comparisons."""

    def __init__(self) -> None:
        super().__init__()
        self._slots: dict[int, str] = {}
        self._masks: dict[str, str] = {}
        self._turned: dict[str, tuple[str, str]] = {}
        self._inverses: dict[str, str] = {}

    def step(self, i: Instruction) -> None:
        operands = [self._slots[slot] for slot in i.arguments]
        if i.operation == "OUTPUT":
            value = self._number(operands[0])
            self.line(f"store {self.vector} {value}, ptr {self._place('y', i.number)}, align 8")
        elif i.operation == "INPUT":
            self._slots[i.result] = self.emit(f"load {self.vector}, ptr {self._place('x', i.number)}, align 8")
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

    def _place(self, array: str, number: int) -> str:
        row = self.emit(f"mul i64 %{array}_stride, {number}")
        start = self.emit(f"add i64 {row}, %cell")
        return self.emit(f"getelementptr double, ptr %{array}, i64 {start}")

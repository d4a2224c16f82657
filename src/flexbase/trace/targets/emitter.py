"""Lines of LLVM IR on vectors of doubles: one lane a configuration."""

from __future__ import annotations

import struct

LANES = 8  # one AVX-512 register; narrower machines split it


class Emitter:
    """Collects instructions; every method appends one and returns the name of its result.

    prefix : of the names that it gives
    Multiplications and additions may be contracted to one fused operation; nothing else is left to the compiler.
    """

    vector = f"<{LANES} x double>"
    mask = f"<{LANES} x i1>"

    def __init__(self, prefix: str = "v") -> None:
        self.lines: list[str] = []
        self._prefix = prefix

    def line(self, text: str) -> None:
        """An instruction without a result."""
        self.lines.append(f"  {text}")

    def emit(self, text: str) -> str:
        """An instruction and the name of its result."""
        name = f"%{self._prefix}{len(self.lines)}"
        self.lines.append(f"  {name} = {text}")
        return name

    def constant(self, value: float) -> str:
        """The same number in every lane, bit by bit."""
        bits = struct.unpack("<Q", struct.pack("<d", value))[0]
        return "<" + ", ".join([f"double 0x{bits:016X}"] * LANES) + ">"

    def add(self, x: str, y: str) -> str:
        return self.emit(f"fadd contract {self.vector} {x}, {y}")

    def sub(self, x: str, y: str) -> str:
        return self.emit(f"fsub contract {self.vector} {x}, {y}")

    def mul(self, x: str, y: str) -> str:
        return self.emit(f"fmul contract {self.vector} {x}, {y}")

    def div(self, x: str, y: str) -> str:
        return self.emit(f"fdiv {self.vector} {x}, {y}")

    def neg(self, x: str) -> str:
        return self.emit(f"fneg {self.vector} {x}")

    def call(self, function: str, *arguments: str) -> str:
        """One of LLVM's own functions: sqrt, fabs, floor, rint, fma, minnum, maxnum, copysign."""
        typed = ", ".join(f"{self.vector} {argument}" for argument in arguments)
        return self.emit(f"call {self.vector} @llvm.{function}.v{LANES}f64({typed})")

    def fma(self, x: str, y: str, z: str) -> str:
        return self.call("fma", x, y, z)

    def compare(self, relation: str, x: str, y: str) -> str:
        """A mask; `relation` as in LLVM: oeq, olt, ole, une, ..."""
        return self.emit(f"fcmp {relation} {self.vector} {x}, {y}")

    def select(self, mask: str, x: str, y: str) -> str:
        return self.emit(f"select {self.mask} {mask}, {self.vector} {x}, {self.vector} {y}")

    def polynomial(self, x: str, *coefficients: float) -> str:
        """Horner's scheme, highest power first."""
        total = self.constant(coefficients[0])
        for coefficient in coefficients[1:]:
            total = self.fma(total, x, self.constant(coefficient))
        return total


DECLARED = {"sqrt": 1, "fabs": 1, "floor": 1, "rint": 1, "fma": 3, "minnum": 2, "maxnum": 2, "copysign": 2}


def declarations() -> list[str]:
    """IR that makes LLVM's own functions known."""
    v = Emitter.vector
    return [f"declare {v} @llvm.{name}.v{LANES}f64({', '.join([v] * count)})" for name, count in DECLARED.items()]

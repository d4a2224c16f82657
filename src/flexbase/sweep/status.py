"""What became of a cell."""

from __future__ import annotations

OK, UNREACHABLE, SINGULAR, INDEFINITE, INFEASIBLE = range(5)
STATUS = {
    OK: "ok",
    UNREACHABLE: "out of reach",
    SINGULAR: "singular arm",
    INDEFINITE: "M - E not positive definite",
    INFEASIBLE: "no gain aligns the mode",
}

"""Wrong programs made of a right one: each differs in one decision.

A comparison turned round, and/or, any/all and min/max exchanged, `not` left out, a condition negated, a constant ten
times as large or one more, True for False.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from dataclasses import dataclass

TURNED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.GtE,
    ast.GtE: ast.Lt,
    ast.Gt: ast.LtE,
    ast.LtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
EXCHANGED = {"any": "all", "all": "any", "min": "max", "max": "min", "argmin": "argmax", "argmax": "argmin"}
SILENT = {"strict", "axis", "axes", "repr", "eq", "frozen", "kw_only", "init", "dtype", "ndmin", "copy", "stacklevel"}
DECIDED = (ast.If, ast.IfExp, ast.While)  # what has a condition


@dataclass(frozen=True)
class Mutant:
    """One wrong program. name : function: before -> after, with the number of its like from the second on"""

    name: str
    line: int
    tree: ast.Module


def mutants_of(source: str) -> Iterator[Mutant]:
    """Every mutant of a module, in the order of its lines."""
    tree = ast.parse(source)
    count = len(list(_places(tree)))
    seen: dict[str, int] = {}
    for number in range(count):
        changed = copy.deepcopy(tree)
        where, node, field, index, new = list(_places(changed))[number]
        old = getattr(node, field) if index is None else getattr(node, field)[index]
        shown = _context(node, old)
        before = ast.unparse(shown)
        if index is None:
            setattr(node, field, new)
        else:
            getattr(node, field)[index] = new
        after = ast.unparse(new if shown is old else shown)
        name = f"{where}: {before} -> {after}"
        seen[name] = seen.get(name, 0) + 1
        if seen[name] > 1:
            name += f" ({seen[name]})"
        yield Mutant(name, getattr(old, "lineno", getattr(node, "lineno", 0)), ast.fix_missing_locations(changed))


def _context(node: ast.AST, old: ast.AST) -> ast.AST:
    """What shows a change: the expression around an operator, a name or a constant."""
    small = isinstance(old, ast.cmpop | ast.boolop | ast.Name | ast.Constant)
    return node if small and isinstance(node, ast.expr | ast.keyword | ast.Assign | ast.AnnAssign | ast.Return) else old


Place = tuple[str, ast.AST, str, "int | None", ast.AST]


def _places(tree: ast.Module) -> Iterator[Place]:
    """Where a module may be changed: function, node, field, index in the field, and what comes there instead."""
    yield from _below(tree, "")


def _below(node: ast.AST, where: str) -> Iterator[Place]:
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        where = f"{where}.{node.name}".lstrip(".")
    if where.rpartition(".")[2].startswith("sheet"):  # what sheets say is no decision: tests/contract/test_results.py
        return
    if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
        return
    if isinstance(node, ast.Raise) or (isinstance(node, ast.keyword) and node.arg in SILENT):
        return
    for field, value in ast.iter_fields(node):
        if field in {"annotation", "returns", "bases", "type_comment"} or (field == "slice"):
            continue
        if field == "decorator_list":
            value = [one for one in value if isinstance(one, ast.Call) and "dataclass" not in ast.unparse(one)]
        if isinstance(value, list):
            for index, one in enumerate(value):
                if isinstance(one, ast.AST):
                    yield from ((where, node, field, index, new) for new in _instead(node, field, one))
                    yield from _below(one, where)
        elif isinstance(value, ast.AST):
            yield from ((where, node, field, None, new) for new in _instead(node, field, value))
            yield from _below(value, where)


def _instead(parent: ast.AST, field: str, node: ast.AST) -> Iterator[ast.AST]:
    """What a node may be exchanged for."""
    match node:
        case ast.cmpop():
            yield TURNED[type(node)]()
        case ast.And():
            yield ast.Or()
        case ast.Or():
            yield ast.And()
        case ast.UnaryOp(op=ast.Not()):
            yield node.operand
        case ast.Name(id=name) if field == "func" and name in EXCHANGED:
            yield ast.Name(EXCHANGED[name], ast.Load())
        case ast.Attribute(value=value, attr=name) if field == "func" and name in EXCHANGED:
            yield ast.Attribute(value, EXCHANGED[name], ast.Load())
        case ast.Constant(value=bool() as value):
            yield ast.Constant(not value)
        case ast.Constant(value=int() as value):
            yield ast.Constant(value + 1)
        case ast.Constant(value=float() as value) if value != 0.0:
            yield ast.Constant(10.0 * value)
        case ast.Constant(value=float()):
            yield ast.Constant(1.0)
    if field == "test" and isinstance(parent, DECIDED) and not isinstance(node, ast.Compare | ast.UnaryOp):
        yield ast.UnaryOp(ast.Not(), node)  # type: ignore[arg-type]


__all__ = ["Mutant", "mutants_of"]

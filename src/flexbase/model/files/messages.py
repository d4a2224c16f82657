"""Turn a validation fault into one line: the field, the value, the bound, the mend."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from flexbase.errors import nearest_name
from flexbase.model.files.schema import LARGEST, ProjectFile, shown


def first_fault(fault: ValidationError) -> str:
    """The first fault in a line, and how many more there are. Unknown keys come first: they explain missing ones."""
    errors = sorted(fault.errors(), key=lambda error: error["type"] != "extra_forbidden")
    more = f" ({len(errors) - 1} more after this one)" if len(errors) > 1 else ""
    return f"{_place(errors[0]['loc'])}{_what(errors[0])}{more}"


def _place(loc: tuple[int | str, ...]) -> str:
    """('robot', 'links', 1, 'mass') -> '[[robot.links]] number 2, mass: '."""
    tables, key = list(loc[:-1]), str(loc[-1])
    if isinstance(loc[-1], int):
        return _place(loc[:-1])[:-2] + f" entry {loc[-1] + 1}: "
    if not tables:
        return f"{key}: "
    if isinstance(tables[-1], int):
        return f"[[{'.'.join(map(str, tables[:-1]))}]] number {tables[-1] + 1}, {key}: "
    return f"[{'.'.join(map(str, tables))}] {key}: "


def _what(error: ErrorDetails) -> str:
    kind, value, context = error["type"], error["input"], error.get("ctx", {})
    match kind:
        case "extra_forbidden":
            noun = "table" if isinstance(value, dict) else "key"
            return f"unknown {noun}. {nearest_name(str(error['loc'][-1]), _valid_keys(error['loc'][:-1]))}"
        case "missing":
            return "is missing. Add it."
        case "greater_than":
            return f"{value:g} must be above {context['gt']:g}. Give a larger number."
        case "greater_than_equal":
            return f"{value:g} must be {context['ge']:g} or more. Give a larger number."
        case "less_than_equal":
            return f"{shown(value)} must be {context['le']:g} or less. Give a smaller number."
        case "finite_number":
            return f"{value} is not finite. Give a finite number."
        case "float_type" | "int_type" if isinstance(value, int) and not isinstance(value, bool):
            return f"{shown(value)}, beyond {LARGEST:g}. Give a smaller one."
        case "float_type" | "int_type":
            return f"{shown(value)} is not a number. Give a number in SI units, without quotes."
        case "string_type":
            return f"{shown(value)} is not a string. Put it in quotes."
        case "string_too_short":
            return "is empty. Give at least one character."
        case "bool_type":
            return f"{shown(value)} is neither true nor false. Give one of them, without quotes."
        case "too_short":
            least = context["min_length"]
            return f"{len(value)} entries given, {least} or more needed. Name at least {least}."
        case "too_long":
            return f"{len(value)} entries given, at most {context['max_length']} are supported. Remove some."
        case "list_type":
            return f"{shown(value)} is not a list. Put it in brackets."
        case "model_type" | "dict_type":
            return f"{shown(value)} stands where a table is needed."
        case "literal_error":
            return f"{shown(value)} is not valid. Give {context['expected']}."
        case "value_error":
            return f"{context['error']}. Give finite numbers in SI units, in brackets."
        case _:
            return f"{shown(value)} does not fit here. `flexbase init` writes a project file to compare with."


def _valid_keys(tables: tuple[int | str, ...]) -> list[str]:
    """The keys that the table at this place knows."""
    model: Any = ProjectFile
    for name in tables:
        if isinstance(name, str):
            model = _table_in(model.model_fields[name].annotation)
    return list(model.model_fields)


def _table_in(annotation: Any) -> type[BaseModel]:
    """The table class inside X, X | None or list[X]."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next(table for part in annotation.__args__ if (table := _table_in(part)))

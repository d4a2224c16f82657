"""The one vocabulary with which public functions check what they are given."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from inspect import Parameter, signature
from numbers import Integral, Real
from types import UnionType
from typing import Any, TypeVar, Union, get_args, get_origin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flexbase.errors import InputError, Unsolvable, nearest_name
from flexbase.requests import Option, options_of

Array = NDArray[np.float64]
Choice = TypeVar("Choice")
WORDS = {float: "a number", int: "a whole number", str: "a word", bool: "True or False"}
LARGEST = 1e100  # of an entry of a gain or a base matrix: products of some stay finite
FARTHEST = 1e6  # rad or m of a joint or a target: beyond, sine and cosine lose their digits


def finite_array(name: str, value: ArrayLike) -> Array:
    """Return `value` as a read-only array of finite doubles: real numbers, no words, no truths. Raises InputError."""
    try:
        given = np.asarray(value)
    except ValueError as fault:  # rows of different lengths
        raise InputError(f"{name}: {str(value)[:60]} is not an array of numbers. Give rows of one length.") from fault
    if given.dtype.kind not in "iuf":
        raise InputError(f"{name}: {str(value)[:60]} is not an array of numbers. Give real numbers.")
    array = np.array(given, dtype=np.float64)
    if not np.all(np.isfinite(array)):
        raise InputError(f"{name}: {str(value)[:60]} is not finite. Give finite numbers.")
    array.flags.writeable = False
    return array


def positive_number(name: str, value: object, unit: str) -> float:
    """Return a finite number above 0. Raises InputError."""
    if isinstance(value, bool) or not isinstance(value, Real) or not 0.0 < float(value) < np.inf:
        raise InputError(f"{name}: {value!r} is not a positive number. Give one in {unit}.")
    return float(value)


def check_length(name: str, value: ArrayLike, length: int, meaning: str) -> Array:
    """Return a vector of `length` finite numbers. Raises InputError naming the count that was given."""
    array = np.atleast_1d(finite_array(name, value))
    if array.shape != (length,):
        given = (
            f"{array.size} value{'s' * (array.size != 1)}" if array.ndim == 1 else f"an array of shape {array.shape}"
        )
        raise InputError(f"{name}: {given} given, {length} needed: {meaning}.")
    return array


def check_within(name: str, array: Array, most: float, unit: str) -> Array:
    """Return an array whose entries are at most `most` in size. Raises InputError naming the largest and the bound."""
    if array.size and np.abs(array).max() > most:
        worst = array.flat[np.abs(array).argmax()]
        raise InputError(
            f"{name}: {worst:g} is beyond the largest value that is read, {most:g} {unit}. Give a smaller one."
        )
    return array


def check_symmetric(name: str, matrix: Array, unit: str) -> Array:
    """Return a symmetric matrix, exactly so. Raises InputError where it is not symmetric to rounding."""
    gap = float(np.max(np.abs(matrix - matrix.T), initial=0.0))
    if gap > 1e-9 * float(np.max(np.abs(matrix), initial=0.0)):
        i, j = np.unravel_index(np.argmax(np.abs(matrix - matrix.T)), matrix.shape)
        raise InputError(
            f"{name}: not symmetric, entry ({i + 1},{j + 1}) is {matrix[i, j]:g} {unit} but "
            f"({j + 1},{i + 1}) is {matrix[j, i]:g}. Give a symmetric matrix."
        )
    symmetric = 0.5 * (matrix + matrix.T)
    symmetric.flags.writeable = False
    return symmetric


def square_or_diagonal(name: str, value: ArrayLike, size: int, unit: str) -> Array:
    """Return a symmetric (size, size) matrix from a vector (its diagonal) or from a full matrix."""
    array = finite_array(name, value)
    if array.ndim <= 1:
        array = np.diag(check_length(name, array, size, "one for each joint or task row, or a full matrix"))
    if array.shape != (size, size):
        raise InputError(
            f"{name}: shape {array.shape} given, ({size}, {size}) or {size} number{'s' * (size != 1)} needed."
        )
    return check_symmetric(name, check_within(name, array, LARGEST, unit), unit)


def is_definite(matrix: Array, of: Array | None = None) -> bool:
    """Whether a symmetric matrix is positive definite beyond rounding, whatever the units of its rows.

    Its Cholesky factor exists then, so neither it nor a principal block or a Schur complement of it is singular.
    [H02 thm 10.7]

    of : what it is a difference of, whose rounding it has; itself if left out
    """
    sizes = np.maximum(np.diag(matrix), np.diag(matrix if of is None else of))
    if not np.all(sizes > 0.0):
        return False
    unit = np.sqrt(sizes)
    return float(np.linalg.eigvalsh(matrix / unit / unit[:, None])[0]) > 2.0 * len(sizes) ** 2 * float(
        np.finfo(float).eps
    )


def inverse(matrix: Array, refusal: str) -> Array:
    """The inverse of a matrix, or a stack, that may be singular. Raises Unsolvable: what that means, and the mend."""
    try:
        return np.asarray(np.linalg.inv(matrix))
    except np.linalg.LinAlgError as fault:
        raise Unsolvable(refusal) from fault


def check_definite(name: str, matrix: Array, unit: str, *, allow_zero: bool, why: str) -> Array:
    """Return a positive (semi)definite matrix. Raises InputError with its smallest eigenvalue and the reason `why`."""
    if matrix.size == 0:
        return matrix
    eigenvalues = np.linalg.eigvalsh(matrix)
    scale = float(np.max(np.abs(eigenvalues)))
    bound = -1e-12 * scale if allow_zero else 1e-14 * scale
    if eigenvalues[0] < bound or (not allow_zero and eigenvalues[0] <= 0.0):
        diagonal = np.array_equal(matrix, np.diag(np.diag(matrix)))
        needed = (
            ("zero or more" if diagonal else "a positive semidefinite matrix")
            if allow_zero
            else ("a positive number" if diagonal else "a positive definite matrix")
        )
        what = "" if diagonal else "smallest eigenvalue "
        raise InputError(f"{name}: {what}{eigenvalues[0]:g} {unit} {why}. Give {needed}.")
    return matrix


def choose(name: str, value: str, valid: Mapping[str, Choice]) -> Choice:
    """Return valid[value]. Raises InputError with the nearest valid name."""
    if value not in valid:
        raise InputError(f'{name}: "{value}" is unknown. {nearest_name(value, valid)}')
    return valid[value]


def check_request(name: str, request: object, kind: type) -> None:
    """Raises InputError where something else stands for a request, or a field holds another kind of value or choice.

    Whether a number is one that makes sense is for the request itself to say.
    """
    if not isinstance(request, kind):
        raise InputError(f"{name}: {type(request).__name__} given. Give a {kind.__name__}, such as {kind.__name__}().")
    _check_values(options_of(kind), vars(request))


def check_options(method: str, run: Callable[..., object], given: Mapping[str, object]) -> None:
    """Raises InputError for an option that a method does not have, or another kind of value or choice than it says.

    Options are what a function takes by keyword only, but for its `loop`.
    """
    parameters = signature(run).parameters.values()
    known = [one.name for one in parameters if one.kind is Parameter.KEYWORD_ONLY and one.name != "loop"]
    for name in given:
        if name not in known:
            raise InputError(f'method {method}: the option "{name}" is unknown. {nearest_name(name, known)}')
    _check_values((one for one in options_of(run) if one.name in given), given)


def _check_values(options: Iterable[Option], given: Mapping[str, object]) -> None:
    for one in options:
        value = given[one.name]
        if not _is_of(one.kind, value):
            wanted = getattr(one.kind, "__name__", str(one.kind))
            raise InputError(f"{one.name}: {value!r} is not {WORDS.get(one.kind, wanted)}. Give {one.text}.")
        if one.choices and value is not None:
            choose(one.name, str(value), dict.fromkeys(one.choices))


def check_left_out(request: object, names: Collection[str], why: str) -> None:
    """Raises InputError where a field of a request is given that has no meaning here; `why` ends with the mend."""
    for one in options_of(type(request)):
        value = getattr(request, one.name)
        if one.name in names and (isinstance(value, np.ndarray) or value != one.default):
            raise InputError(f"{one.name}: {why}")


def _is_of(kind: Any, value: object) -> bool:
    """Whether a value is of a field's kind."""
    if get_origin(kind) in (Union, UnionType):
        return any(_is_of(one, value) for one in get_args(kind))
    if get_origin(kind) is tuple:
        kinds = get_args(kind)
        if not (isinstance(value, tuple | list) or (isinstance(value, np.ndarray) and value.ndim == 1)):
            return False
        each = kinds[:1] * len(value) if kinds[1:] == (...,) else kinds
        return len(each) == len(value) and all(map(_is_of, each, value))
    if get_origin(kind) is Mapping:
        of, to = get_args(kind)
        return isinstance(value, Mapping) and all(_is_of(of, a) and _is_of(to, b) for a, b in value.items())
    if kind in (float, int):
        return not isinstance(value, bool) and isinstance(value, Real if kind is float else Integral)
    return isinstance(value, kind)

"""The full recipe of a sweep: equal recipes give equal results, cell by cell; unequal ones are never mixed."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from flexbase.checks import Array
from flexbase.model.digest import model_digest
from flexbase.model.mounted import MountedArm
from flexbase.sweeps.cells.domain import Domain, Samples
from flexbase.sweeps.cells.grids import Place
from flexbase.sweeps.engine.question import Question

VERSIONED = ("flexbase", "numpy")


def recipe_of(question: Question, arm: MountedArm, place: Place, branch: str, block: tuple[int, ...]) -> dict[str, Any]:
    """Everything that decides the result, as plain JSON values."""
    from importlib.metadata import version

    return {
        "robot": arm.name,
        "model": model_digest(arm),
        "measures": [one.name for one in question.columns],
        "domain": _domain(place.domain),
        "held": list(place.held),
        "branch": branch,
        **question.recipe,
        "block": list(block),
        "versions": {name: version(name) for name in VERSIONED},
    }


def _domain(domain: Domain) -> dict[str, Any]:
    if isinstance(domain, Samples):
        return {
            "samples": domain.count,
            "sampling": domain.sampling,
            "seed": domain.seed,
            **{name: [float(a), float(b)] for name, a, b in zip(domain.names, domain.low, domain.high, strict=True)},
        }
    return {axis.name: _ends(axis.values) for axis in domain.axes}


def _ends(values: Array) -> dict[str, Any]:
    exact = hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()[:16]
    return {"from": float(values[0]), "to": float(values[-1]), "count": int(values.size), "values": exact}


def digest(recipe: Mapping[str, Any]) -> str:
    """A short name for exactly this recipe."""
    return hashlib.sha256(json.dumps(recipe, sort_keys=True).encode()).hexdigest()[:32]


def differences(one: Mapping[str, Any], other: Mapping[str, Any]) -> str:
    """Which entries of two recipes differ, in words."""
    names = [name for name in {**one, **other} if one.get(name) != other.get(name)]
    return ", ".join(names) or "nothing"

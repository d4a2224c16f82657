"""The option that chooses among the poses of a tip: `--elbow`, or `--branch` where it has three signs."""

from __future__ import annotations

from typing import Annotated

from flexbase.cli.options.common import option
from flexbase.cli.options.values import sign

Elbow = Annotated[
    str | None,
    option(sign, "+|-", "elbow; or shoulder, elbow, wrist: +-+; else the project's", ("--elbow", "--branch")),
]
AnyElbow = Annotated[
    str | None,
    option(sign, "+|-", "elbow; or shoulder, elbow, wrist: +-+; else the best", ("--elbow", "--branch")),
]

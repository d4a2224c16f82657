"""Options that several methods have, with what each means."""

from __future__ import annotations

from typing import Annotated

from flexbase.requests import Says

Wanted = Annotated[float | None, Says("wanted", unit="rad/s", written="W")]
Radius = Annotated[float, Says("bound on the algebraic loop's radius", written="G")]
Lag = Annotated[float | None, Says("of the acceleration; may take part of the damping", unit="s", written="S")]
LagShare = Annotated[float, Says("of the damping, that the lag may take", written="ETA")]
Slopes = Annotated[str, Says("slopes", choices=("estimated", "exact"))]
Step = Annotated[float, Says("share of the way in a step, up to 1", written="G")]
Iterations = Annotated[int, Says("number of steps")]
Seed = Annotated[int, Says("of what is random")]

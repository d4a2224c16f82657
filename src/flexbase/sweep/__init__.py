"""Maps: many configurations at once."""

from flexbase.sweep.chart import STATUS, Axis, Chart
from flexbase.sweep.run import sweep

__all__ = ["STATUS", "Axis", "Chart", "sweep"]

"""Where a sweep looks: axes, grids, samples, parameters."""

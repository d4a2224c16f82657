"""Questions that need design, simulation and sweeps together."""

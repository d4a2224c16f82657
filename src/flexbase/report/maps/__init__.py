"""Pictures of sweeps and probabilities, by their number of axes."""

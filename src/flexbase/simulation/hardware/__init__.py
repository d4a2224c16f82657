"""Runs as hardware makes them: held and late torques, counts, noise, limits."""

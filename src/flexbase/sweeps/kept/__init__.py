"""Sweeps on disk: arrays, recipe, store, and reading them back."""

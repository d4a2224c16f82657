"""Answers as arrays, in memory or on disk: layout, recipe, store, and reading them back."""

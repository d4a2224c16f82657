"""Measures of a configuration, one file each."""

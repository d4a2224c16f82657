"""Thousands of ideal runs at once, compiled."""

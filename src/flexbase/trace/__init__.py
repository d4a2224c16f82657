"""Scalar algebra that runs on any number type; knows nothing of robots."""

"""Kinematics and dynamics, each written once on any number type."""

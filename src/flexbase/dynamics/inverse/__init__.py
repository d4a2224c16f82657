"""Inverse kinematics: closed forms, Newton steps, self-motion, branches by name."""

"""Design methods, one file each; importing them fills the registry."""

from flexbase.compensators.methods import bounded, convex, exact, recursive, task_priority
from flexbase.compensators.registry import METHODS, Method, design

__all__ = ["METHODS", "Method", "bounded", "convex", "design", "exact", "recursive", "task_priority"]

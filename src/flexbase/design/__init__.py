"""Design methods, one file each; importing them fills the registry."""

from flexbase.design import exact, recursive, task_priority
from flexbase.design.registry import METHODS, Method, design

__all__ = ["METHODS", "Method", "design", "exact", "recursive", "task_priority"]

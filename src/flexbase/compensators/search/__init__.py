"""How methods look for a gain: recursion, convex programs, descents, closed forms."""

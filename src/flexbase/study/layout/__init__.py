"""Where to put the work, or the base."""

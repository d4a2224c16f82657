"""The robust arm configurations as curves and points."""

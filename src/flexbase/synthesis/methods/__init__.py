"""Controllers for the loop as it runs, one file a method."""

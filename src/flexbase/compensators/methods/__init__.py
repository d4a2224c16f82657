"""Mode shape compensators, one file a method; `design` finds them by name."""

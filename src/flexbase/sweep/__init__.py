"""Maps: many configurations at once."""

"""Linear models of a pose: reduced form, modes, loops, margins."""

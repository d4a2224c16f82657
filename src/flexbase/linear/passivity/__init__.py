"""Exact verdicts: positive real, negative imaginary, passivity indices, by the whole response."""

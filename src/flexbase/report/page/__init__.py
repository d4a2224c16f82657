"""Sweeps as interactive pages: one file that opens in a browser without a network."""

"""Sampled linear systems: margins, coprime factors, Riccati equations."""

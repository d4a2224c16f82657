"""Inputs to answers: the question, its evaluation, and who runs the blocks."""

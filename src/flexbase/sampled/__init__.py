"""The loop as it runs: sampled plant and controller, closed, changed, judged."""

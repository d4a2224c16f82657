"""One printer a target: a traced program becomes code."""

"""Project files: their words, their reading, their faults."""

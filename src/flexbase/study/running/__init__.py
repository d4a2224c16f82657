"""Which controllers run, where, and which one to use."""

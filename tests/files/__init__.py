"""Robot files: what is read from sound ones, and how unsound ones are refused."""

"""What is made of an answer: summaries, tables, files, differences, charts."""

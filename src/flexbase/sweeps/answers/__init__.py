"""What is made of a sweep's answer: summaries, differences, charts."""

"""Right or wrong: numbers only, no messages."""

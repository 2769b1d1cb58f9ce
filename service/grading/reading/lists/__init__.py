"""Lists of values as handed in -> entries."""

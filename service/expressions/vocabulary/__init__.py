"""The names that may stand in an answer: symbols and functions."""

"""Split plain characters into tokens."""

"""The names that an answer may use: symbols and functions."""

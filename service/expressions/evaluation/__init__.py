"""A syntax tree -> numbers."""

"""Plain characters -> tokens -> a syntax tree."""

"""Parse plain characters into tokens, and tokens into a syntax tree."""

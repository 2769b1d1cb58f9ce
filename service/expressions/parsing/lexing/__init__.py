"""Characters -> tokens."""

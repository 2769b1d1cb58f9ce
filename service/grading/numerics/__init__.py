"""Numbers at random joint values, and the tolerances for comparing them."""

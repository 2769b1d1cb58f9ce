"""How many students one installation can serve."""

"""A search for the costliest request: what an attacker would find who has the code."""

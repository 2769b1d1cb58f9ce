"""Variants of exercises with ``[vary]``, one for each seed, and generated robots."""

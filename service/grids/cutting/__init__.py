"""Cutting a text into cells without losing the place of a character."""

"""Decide which answers are right, by comparing numbers."""

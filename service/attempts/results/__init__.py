"""Recorded attempts as lists, grades and statistics."""

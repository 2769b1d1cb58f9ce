"""Grading by a server instead of this program."""

"""Grading by a server in the place of this program."""

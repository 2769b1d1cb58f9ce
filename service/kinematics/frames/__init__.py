"""Frames of a student's own choice: which tables describe the same robot."""

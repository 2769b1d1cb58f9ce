"""Compute the frames and the formulas of a student's table."""

"""Matrices and screw axes as handed in -> entries."""

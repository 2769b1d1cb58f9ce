"""Repair a table by changing a few cells."""

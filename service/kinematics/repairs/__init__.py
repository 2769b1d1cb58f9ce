"""Repair a table by other values of a few cells."""

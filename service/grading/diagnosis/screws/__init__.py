"""Slips in screw axes."""

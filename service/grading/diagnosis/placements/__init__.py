"""Slips in the placement of frames."""

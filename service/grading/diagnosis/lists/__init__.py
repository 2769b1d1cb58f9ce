"""Slips in a list of values: positions, angles and Euler angles."""

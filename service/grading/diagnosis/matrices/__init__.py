"""Slips in a rotation, a transform or a list of transforms."""
